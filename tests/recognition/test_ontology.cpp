#include <hoist/recognition/ontology.h>

#include <gtest/gtest.h>

#include <string>

namespace hoist {
namespace {

const char* const good = R"(name: shed
version: 1
materials:
  wood: {density: [350, 700]}
  metal: {density: [2650, 7850]}
attributes:
  color: {type: numeric, components: [r, g, b], unit: sRGB, range: [0, 255], encoding: linear, loss: quadratic, truth: base_rgb}
  age: {type: numeric, range: [0, 100], encoding: linear, loss: quadratic, truth: age}
  material: {type: categorical, values: [wood, metal], encoding: one-hot, loss: cross-entropy, truth: material}
  open: {type: boolean, encoding: binary, loss: cross-entropy, truth: open}
classes:
  - {name: door, attributes: [material, open], box_like: true}
  - {name: cat, attributes: [age, color]}
)";

std::string
replaced(const std::string& from, const std::string& to)
{
  std::string text = good;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string
complaint(const std::string& text)
{
  try {
    ontologyFromYaml(text, "shed.yaml");
  }
  catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(Ontology, TellsWhatTheTextSays)
{
  const Ontology shed = ontologyFromYaml(good);
  EXPECT_EQ(shed.name, "shed");
  ASSERT_EQ(shed.classes.size(), 2u);
  EXPECT_EQ(shed.classes[0].name, "door");
  EXPECT_TRUE(shed.classes[0].box_like);
  EXPECT_FALSE(shed.classes[1].box_like);
  ASSERT_EQ(shed.classes[1].attributes.size(), 2u);
  EXPECT_EQ(shed.attributes[shed.classes[1].attributes[0]].name, "age");
  const AttributeSpec* color = shed.findAttribute("color");
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->range[1], 255);
  EXPECT_EQ(color->truth, "base_rgb");
  ASSERT_NE(shed.findMaterial("metal"), nullptr);
  EXPECT_EQ(shed.findMaterial("metal")->density[0], 2650);
  EXPECT_EQ(shed.findClass("dog"), nullptr);
}

TEST(Ontology, CountsTheNumbersThatSayAnAttribute)
{
  const Ontology shed = ontologyFromYaml(good);
  EXPECT_EQ(shed.findAttribute("color")->outputs(), 3u);
  EXPECT_EQ(shed.findAttribute("age")->outputs(), 1u);
  EXPECT_EQ(shed.findAttribute("material")->outputs(), 2u);
  EXPECT_EQ(shed.findAttribute("open")->outputs(), 1u);
}

TEST(Ontology, MistakesAreToldWithLinePathAndReason)
{
  EXPECT_EQ(complaint(replaced("[0, 255]", "wide")),
            "shed.yaml:7: attributes.color.range: expected two numbers, found 'wide'");
  EXPECT_EQ(complaint(replaced("[0, 255]", "[255, 0]")),
            "shed.yaml:7: attributes.color.range: its low end is not below its high "
            "end");
  EXPECT_EQ(complaint(replaced("[age, color]", "[age, colour]")),
            "shed.yaml:13: classes[1].attributes: there is no attribute 'colour'");
  EXPECT_EQ(complaint(replaced("name: cat", "name: door")),
            "shed.yaml:13: classes[1].name: there is a class 'door' already");
  EXPECT_EQ(complaint(replaced("type: boolean", "type: bool")),
            "shed.yaml:10: attributes.open.type: expected numeric or categorical or "
            "boolean, found 'bool'");
  EXPECT_EQ(complaint(replaced("encoding: one-hot", "encoding: linear")),
            "shed.yaml:9: attributes.material.encoding: expected one-hot, found "
            "'linear'");
  EXPECT_EQ(complaint(replaced("[wood, metal]", "[wood, stone]")),
            "shed.yaml:9: attributes.material.values: 'stone' has no density in "
            "'materials'");
  EXPECT_EQ(complaint(replaced("[350, 700]", "[-1, 700]")),
            "shed.yaml:4: materials.wood.density: must be 0 < low <= high [kg/m3]");
  EXPECT_EQ(complaint(replaced("box_like", "boxlike")),
            "shed.yaml:12: classes[0]: unknown entry 'boxlike'");
  EXPECT_EQ(complaint(replaced("version: 1", "version: 2")),
            "shed.yaml:2: version: expected 1, found '2'");
  EXPECT_EQ(complaint(replaced(", truth: age", "")),
            "shed.yaml:8: attributes.age: 'truth' is missing");
  EXPECT_EQ(complaint(replaced("  wood: {", "  metal: {")),
            "shed.yaml:5: materials: 'metal' is given twice");
}

TEST(Ontology, WhatIsNoOntologyIsRefused)
{
  EXPECT_NE(complaint("").find("shed.yaml"), std::string::npos);
  EXPECT_NE(complaint("- 1").find("expected a map, found a list"), std::string::npos);
  EXPECT_NE(complaint("name: [1").find("not YAML"), std::string::npos);
  EXPECT_THROW(loadOntology("no/such.yaml"), LoadError);
  EXPECT_THROW(loadOntology("."), LoadError); // a folder
}

TEST(Ontology, ThoseOfTheRepositoryAreGood)
{
  const std::string folder = HOIST_ONTOLOGY_FOLDER;
  const Ontology worksite = loadOntology(folder + "/worksite.yaml");
  EXPECT_EQ(worksite.classes.size(), 8u);
  const Ontology lifting = loadOntology(folder + "/lifting.yaml");
  for (const ClassSpec& spec : lifting.classes)
    EXPECT_TRUE(spec.box_like) << spec.name;
}

} // namespace
} // namespace hoist
