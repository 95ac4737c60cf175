// What is written into a model: geometry there and back, and nothing else touched.
#include "data/ifc/ifc_things.h"

#include <hoist/data/ifc/ifc_guid.h>

#include <gtest/gtest.h>

#include <pcl/exceptions.h>

#include <map>
#include <set>
#include <sstream>
#include <string>

namespace {

using hoist::IfcEdit;
using hoist::IfcElement;
using hoist::IfcModel;
using hoist::IfcObject;
using hoist::IfcPropertySet;
using hoist::OrientedBox;
using hoist::Part21Value;
using hoist::test::boxAt;
using hoist::test::cornerDistance;
using hoist::test::edited;
using hoist::test::exportedModel;
using hoist::test::modelOf;
using hoist::test::randomBox;
using hoist::test::thing;

constexpr double tenth_of_a_millimetre = 1e-4;

IfcObject
fullThing(const std::string& key, const OrientedBox& box)
{
  IfcObject object = thing(key, box);
  object.rgb = {200, 30, 7};
  object.material = "Holz \u00e4";
  object.weight = 12.25;
  IfcPropertySet set;
  set.name = "Hoist_Test";
  set.properties = {{"Length", "IFCLENGTHMEASURE", 0.0125},
                    {"Mass", "IFCMASSMEASURE", 3.5},
                    {"Text", "IFCLABEL", std::string("a 'b'")},
                    {"Flag", "IFCBOOLEAN", true},
                    {"Count", "IFCINTEGER", std::int64_t(7)},
                    {"Nothing", "IFCREAL", std::monostate()}};
  object.property_sets = {set};
  return object;
}

// Every line of the old file that is not among those of the new one.
std::vector<std::string>
linesLost(const std::string& before, const std::string& after)
{
  std::multiset<std::string> there;
  std::istringstream in(after);
  for (std::string line; std::getline(in, line);)
    there.insert(line);
  std::vector<std::string> lost;
  std::istringstream old(before);
  for (std::string line; std::getline(old, line);) {
    const auto found = there.find(line);
    if (found == there.end())
      lost.push_back(line);
    else
      there.erase(found);
  }
  return lost;
}

// Own rules for what is written, beside those of other programs: every GlobalId is one
// and used once, every reference leads somewhere, lists are not empty.
void
expectSound(const std::string& bytes)
{
  const IfcModel model = modelOf(bytes);
  std::set<std::string> ids;
  for (const hoist::Part21Instance& instance : model.file().instances()) {
    const auto arguments = model.file().arguments(instance);
    const std::string_view name = model.file().entity(instance);
    const bool rooted = name.substr(0, 6) == "IFCREL" || name == "IFCPROPERTYSET" ||
                        name == "IFCELEMENTQUANTITY" || name == "IFCPROJECT" ||
                        name == "IFCSITE" || name == "IFCBUILDING" ||
                        name == "IFCBUILDINGSTOREY";
    if (!rooted)
      continue;
    const std::string id = arguments.at(0).text();
    EXPECT_TRUE(hoist::fromIfcGuid(id)) << name << " " << id;
    EXPECT_TRUE(ids.insert(id).second) << name << " " << id;
    if (name.substr(0, 6) == "IFCREL") {
      for (const std::size_t i : {4, 5}) {
        if (arguments.at(i).is(Part21Value::Kind::list)) {
          EXPECT_FALSE(arguments[i].items.empty()) << name;
        }
      }
    }
  }
  for (const IfcElement& element : model.elements()) {
    EXPECT_TRUE(hoist::fromIfcGuid(element.global_id));
    EXPECT_TRUE(ids.insert(element.global_id).second);
  }
}

struct Kind {
  hoist::IfcSchema schema;
  double unit;
  bool turned;
};

class Kinds : public testing::TestWithParam<Kind> {
protected:
  static hoist::IfcNewModel
  settings()
  {
    hoist::IfcNewModel out;
    out.schema = GetParam().schema;
    out.length_unit = GetParam().unit;
    if (GetParam().turned) { // and far from the origin, as surveyed sites are
      out.site_pose = Eigen::Translation3d(3456.7, -81234.5, 123.4) *
                      Eigen::AngleAxisd(1, Eigen::Vector3d(0.1, 0.2, 1).normalized());
    }
    return out;
  }
};

TEST_P(Kinds, WhatIsWrittenIsReadBack)
{
  std::mt19937 random(11);
  std::vector<IfcObject> objects;
  for (const std::string& entity : hoist::ifcEntities()) {
    objects.push_back(fullThing(entity, randomBox(random)));
    objects.back().entity = entity;
  }
  const std::string bytes = hoist::ifcModelOf(objects, settings());
  expectSound(bytes);
  const IfcModel model = modelOf(bytes);
  ASSERT_EQ(model.elements().size(), objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const IfcElement& element = model.elements()[i];
    const bool old_furniture = GetParam().schema == hoist::IfcSchema::ifc2x3 &&
                               objects[i].entity == "IfcFurniture";
    EXPECT_EQ(element.entity,
              old_furniture ? "IfcFurnishingElement" : objects[i].entity);
    EXPECT_EQ(element.name, objects[i].name);
    EXPECT_EQ(element.tag, objects[i].key);
    EXPECT_EQ(element.object_type, "crate");
    EXPECT_EQ(element.material, objects[i].material);
    EXPECT_EQ(element.weight, 12.25);
    EXPECT_EQ(element.storey, "ground");
    ASSERT_TRUE(element.box) << element.box_source;
    EXPECT_LT(cornerDistance(*element.box, objects[i].box), tenth_of_a_millimetre);
    for (const IfcPropertySet& set : model.propertySets(element.id)) {
      if (set.name != "Hoist_Test")
        continue;
      EXPECT_NEAR(std::get<double>(set.find("Length")->value), 0.0125, 1e-9);
      EXPECT_EQ(std::get<double>(set.find("Mass")->value), 3.5);
      EXPECT_EQ(std::get<std::string>(set.find("Text")->value), "a 'b'");
      EXPECT_EQ(std::get<bool>(set.find("Flag")->value), true);
      EXPECT_EQ(std::get<std::int64_t>(set.find("Count")->value), 7);
    }
  }
}

TEST_P(Kinds, ASecondTimeChangesNoByte)
{
  std::mt19937 random(12);
  std::vector<IfcObject> objects;
  for (int i = 0; i < 20; ++i)
    objects.push_back(fullThing(std::to_string(i), randomBox(random)));
  const auto put = [&](IfcEdit& edit) {
    for (const IfcObject& object : objects)
      edit.put(object);
  };
  const std::string once = edited(hoist::newIfcModel(settings()), put);
  EXPECT_EQ(edited(once, put), once);
  const IfcModel model = modelOf(once);
  IfcEdit edit(model);
  put(edit);
  EXPECT_TRUE(edit.part21().empty());
  for (const hoist::IfcChange& change : edit.changes())
    EXPECT_EQ(change.action, "unchanged");
}

TEST_P(Kinds, MovingAndResizingTouchesOnlyTheThing)
{
  std::mt19937 random(13);
  std::vector<IfcObject> objects;
  for (int i = 0; i < 10; ++i)
    objects.push_back(fullThing(std::to_string(i), randomBox(random)));
  const std::string before = hoist::ifcModelOf(objects, settings());
  for (int round = 0; round < 10; ++round) {
    IfcObject moved = objects[round];
    moved.box = randomBox(random);
    const std::string after = edited(before, [&](IfcEdit& edit) { edit.put(moved); });
    EXPECT_EQ(edited(after, [&](IfcEdit& edit) { edit.put(moved); }), after);
    // point, two directions, placement, profile, solid, three quantities: in place
    EXPECT_LE(linesLost(before, after).size(), 9u);
    expectSound(after);
    const IfcModel model = modelOf(after);
    for (int i = 0; i < 10; ++i) {
      const IfcElement* const element =
          model.find(hoist::ifcGuidOf(model.spatial()[0].global_id, std::to_string(i)));
      ASSERT_NE(element, nullptr);
      EXPECT_LT(cornerDistance(*element->box, i == round ? moved.box : objects[i].box),
                tenth_of_a_millimetre);
    }
  }
}

std::string
kindName(const testing::TestParamInfo<Kind>& test)
{
  return std::string(toString(test.param.schema)) + "_" +
         std::to_string(static_cast<int>(test.param.unit * 10000)) +
         (test.param.turned ? "_turned" : "");
}

INSTANTIATE_TEST_SUITE_P(All,
                         Kinds,
                         testing::Values(Kind{hoist::IfcSchema::ifc4, 1, false},
                                         Kind{hoist::IfcSchema::ifc4, 0.001, true},
                                         Kind{hoist::IfcSchema::ifc2x3, 1, true},
                                         Kind{hoist::IfcSchema::ifc2x3, 0.001, false},
                                         Kind{hoist::IfcSchema::ifc4, 0.0254, true}),
                         kindName);

TEST(IfcEdit, AddsToAModelOfAnotherProgram)
{
  const std::string before = exportedModel();
  const IfcObject low = fullThing("low", boxAt(4, -1, 0.3));
  const IfcObject high = fullThing("high", boxAt(5, -2, 4));
  const auto put = [&](IfcEdit& edit) {
    edit.put(low);
    edit.put(high);
  };
  const std::string after = edited(before, put);
  EXPECT_EQ(edited(after, put), after);
  expectSound(after);
  // only the two lists of what the storeys contain have changed, and only at their ends
  EXPECT_EQ(linesLost(before, after).size(), 2u);
  EXPECT_NE(after.find("(#232 ,#"), std::string::npos);
  EXPECT_NE(after.find("(#332,#333,#"), std::string::npos);
  const IfcModel model = modelOf(after);
  ASSERT_EQ(model.elements().size(), 5u);
  EXPECT_EQ(model.elements()[3].storey, "Level 1");
  EXPECT_EQ(model.elements()[4].storey, "Level 2");
  EXPECT_LT(cornerDistance(*model.elements()[3].box, low.box), tenth_of_a_millimetre);
  EXPECT_LT(cornerDistance(*model.elements()[4].box, high.box), tenth_of_a_millimetre);
}

TEST(IfcEdit, MovesWhatOthersModelledWithoutTheirNeighbours)
{
  const std::string before = exportedModel();
  const IfcModel model = modelOf(before);
  const IfcElement& wall = model.elements()[1];
  OrientedBox target = *wall.box;
  target.center += Eigen::Vector3d(0.5, 0.25, 0);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  target.axes = turn * target.axes;
  const std::string after = edited(
      before, [&](IfcEdit& edit) { EXPECT_TRUE(edit.move(wall.global_id, target)); });
  const IfcModel moved = modelOf(after);
  EXPECT_LT(cornerDistance(*moved.elements()[1].box, target), tenth_of_a_millimetre);
  // the wall that shares its placement, and the column, are where they were
  for (const int i : {0, 2})
    EXPECT_LT(cornerDistance(*moved.elements()[i].box, *model.elements()[i].box),
              1e-12);
  EXPECT_EQ(linesLost(before, after).size(), 1u);
  EXPECT_EQ(edited(after, [&](IfcEdit& edit) { edit.move(wall.global_id, target); }),
            after);
  // a placement of its own is rewritten where it stands
  const IfcElement& column = model.elements()[0];
  OrientedBox column_target = *column.box;
  column_target.center.x() += 1;
  const std::string last = edited(before, [&](IfcEdit& edit) {
    EXPECT_TRUE(edit.move(column.global_id, column_target));
  });
  EXPECT_LT(cornerDistance(*modelOf(last).elements()[0].box, column_target),
            tenth_of_a_millimetre);
  for (const std::string& line : linesLost(before, last))
    EXPECT_TRUE(line.rfind("#229=", 0) == 0) << line;
}

TEST(IfcEdit, SharedSetsAreLeftToTheOthers)
{
  const std::string before = exportedModel();
  IfcPropertySet set;
  set.name = "Pset_ColumnCommon"; // the column and a wall share it
  set.properties = {{"Reference", "IFCIDENTIFIER", std::string("other")}};
  const IfcModel model = modelOf(before);
  const std::string column = model.elements()[0].global_id;
  const auto change = [&](IfcEdit& edit) { edit.setProperties(column, set); };
  const std::string after = edited(before, change);
  EXPECT_EQ(edited(after, change), after);
  expectSound(after);
  const IfcModel changed = modelOf(after);
  const auto reference = [&](int i) {
    for (const IfcPropertySet& one : changed.propertySets(changed.elements()[i].id))
      if (one.name == set.name)
        return std::get<std::string>(one.find("Reference")->value);
    return std::string("none");
  };
  EXPECT_EQ(reference(0), "other");
  EXPECT_EQ(reference(1), "300x400");
}

TEST(IfcEdit, ColoursAndMaterialsChange)
{
  IfcObject a = fullThing("a", boxAt(0, 0, 1)), b = fullThing("b", boxAt(3, 0, 1));
  const std::string before = hoist::ifcModelOf({a, b});
  a.rgb = {1, 2, 3};
  a.material = "steel";
  const auto put = [&](IfcEdit& edit) { edit.put(a); };
  const std::string after = edited(before, put);
  EXPECT_EQ(edited(after, put), after);
  const IfcModel model = modelOf(after);
  EXPECT_EQ(model.elements()[0].material, "steel");
  EXPECT_EQ(model.elements()[1].material, b.material);
  EXPECT_EQ(model.file().ofType("IFCSTYLEDITEM").size(), 2u);
  EXPECT_EQ(model.file().ofType("IFCCOLOURRGB").size(), 2u);
  EXPECT_EQ(model.file().ofType("IFCRELASSOCIATESMATERIAL").size(), 2u);
}

TEST(IfcEdit, GoesOnAfterItsBytesWereAskedFor)
{
  const IfcModel empty = modelOf(hoist::newIfcModel());
  IfcEdit edit(empty);
  for (const char* const key : {"a", "b", "c"}) {
    edit.put(thing(key, boxAt(*key, 0, 1)));
    (void)edit.part21();
  }
  const std::string bytes = edit.part21().bytes();
  expectSound(bytes);
  const IfcModel again = modelOf(bytes);
  EXPECT_EQ(again.file().ofType("IFCRELCONTAINEDINSPATIALSTRUCTURE").size(), 1u);
  EXPECT_EQ(again.elements().size(), 3u);
  for (const IfcElement& element : again.elements())
    EXPECT_EQ(element.storey, "ground");
}

TEST(IfcEdit, RefusesWhatIsNone)
{
  const IfcModel model = modelOf(hoist::newIfcModel());
  IfcEdit edit(model);
  IfcObject object = thing("x", boxAt(0, 0, 0));
  const auto refused = [&](auto change) {
    IfcObject wrong = object;
    change(wrong);
    EXPECT_THROW(edit.put(wrong), pcl::BadArgumentException);
  };
  refused([](IfcObject& o) { o.box.size.x() = 0; });
  refused([](IfcObject& o) { o.box.center.x() = std::nan(""); });
  refused([](IfcObject& o) { o.box.axes *= 2; });
  refused([](IfcObject& o) { o.entity = "IfcDragon"; });
  refused([](IfcObject& o) { o.key.clear(); });
  refused([](IfcObject& o) { o.storey = "cellar"; });
  refused([](IfcObject& o) { o.global_id = "short"; });
  EXPECT_THROW(edit.move("nobody", object.box), pcl::BadArgumentException);
  EXPECT_THROW(edit.setProperties("nobody", {}), pcl::BadArgumentException);
  EXPECT_TRUE(edit.part21().empty());
  hoist::IfcNewModel yards;
  yards.length_unit = 0.9144;
  EXPECT_THROW((void)hoist::newIfcModel(yards), pcl::BadArgumentException);
}

TEST(IfcEdit, ClassesBecomeEntities)
{
  EXPECT_EQ(hoist::ifcEntityOfClass("slab"), "IfcSlab");
  EXPECT_EQ(hoist::ifcEntityOfClass("concrete slab"), "IfcSlab");
  EXPECT_EQ(hoist::ifcEntityOfClass("office chair"), "IfcFurniture");
  EXPECT_EQ(hoist::ifcEntityOfClass("safety cone"), "IfcBuildingElementProxy");
  EXPECT_EQ(hoist::ifcEntityOfClass(""), "IfcBuildingElementProxy");
}

} // namespace
