// Files that are broken or mean harm: a clear error and nothing else.
#include <hoist/data/ifc/ifc_edit.h>

#include <gtest/gtest.h>

#include <pcl/exceptions.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

namespace {

using hoist::IfcModel;
using hoist::LoadError;
using hoist::Part21File;

std::string
smallModel()
{
  hoist::IfcObject object;
  object.key = "k";
  object.name = "it's \u00e4";
  object.box.size = Eigen::Vector3d(0.4, 0.3, 0.2);
  object.rgb = {200, 100, 50};
  object.material = "wood";
  object.weight = 12.5;
  return hoist::ifcModelOf({object});
}

struct Broken {
  const char* name;
  const char* cut; ///< this text of a good model ...
  const char* put; ///< ... becomes this
  const char* says;
};

void
PrintTo(const Broken& broken, std::ostream* out)
{
  *out << broken.name;
}

const std::string deep(100, '(');
const std::string deep_list = "#1=IFCPERSON(" + deep;
const std::string many_digits = "#1" + std::string(300, '0') + "=IFCPERSON(";

const Broken broken_files[] = {
    {"NoMagic", "ISO-10303-21;\nH", "ISO-1\nH", "ISO-10303-21"},
    {"NoHeader", "HEADER;", "HEAD;", "HEADER"},
    {"UnknownSchema", "'IFC4'", "'IFC9'", "expected the schema IFC2X3 or IFC4"},
    {"NoSchema", "FILE_SCHEMA", "FILE_OTHER", "FILE_SCHEMA"},
    {"TwoDataSections",
     "ENDSEC;\nEND-ISO",
     "ENDSEC;\nDATA;\nENDSEC;\nEND-ISO",
     "several DATA"},
    {"Anchor", "DATA;", "ANCHOR;\nENDSEC;\nDATA;", "edition 3"},
    {"Signed", "END-ISO-10303-21;", "END-ISO-10303-21;\nSIGNATURE;", "signed"},
    {"NoEnd", "END-ISO-10303-21;", "", "END-ISO-10303-21"},
    {"DuplicateId", "#2=", "#1=", "a second time"},
    {"Dangling", "(#1,#2,$)", "(#1,#222222,$)", "#222222, which is not there"},
    {"NoId", "#1=", "#=", "digits of an id"},
    {"HugeId", "#1=IFCPERSON(", many_digits.c_str(), "2^62"},
    {"NoEquals", "#1=", "#1 ", "behind the id"},
    {"NoName", "#1=IFCPERSON(", "#1=(", "name of an entity"},
    {"NoBracket", "#1=IFCPERSON(", "#1=IFCPERSON", "\"(\""},
    {"NoSemicolon", "$);\n#2=", "$)\n#2=", "\";\""},
    {"OpenText", "'hoist',$,$,$,$,$,$,$);\n#2", "'hoist,$,$,$,$,$,$,$);\n#2", ""},
    {"OpenComment", "#1=", "/* #1=", "comment"},
    {"Deep", "#1=IFCPERSON(", deep_list.c_str(), "nested deeper"},
    {"Binary", "#1=", "\x01\x80#1=", "byte 0x01"},
    {"NoProject", "IFCPROJECT", "IFCPROJEKT", "IFCPROJECT"},
    {"PlacementCycle",
     "#35=IFCLOCALPLACEMENT($,",
     "#35=IFCLOCALPLACEMENT(#39,",
     "relative to itself"},
    {"PlacementOfItself",
     "#35=IFCLOCALPLACEMENT($,",
     "#35=IFCLOCALPLACEMENT(#35,",
     "relative to itself"},
    {"SpatialCycle", "#30,(#36)", "#40,(#36)", "inside of itself"},
    {"PointOfText",
     "IFCCARTESIANPOINT((0.,0.,0.))",
     "IFCCARTESIANPOINT('0')",
     "list of numbers"},
    {"PlacementWithoutPoint",
     "#34=IFCAXIS2PLACEMENT3D(#31",
     "#34=IFCAXIS2PLACEMENT3D(#30",
     "IFCCARTESIANPOINT"},
    {"UnitOfNothing", ".LENGTHUNIT.,$", ".LENGTHUNIT.,.HALF.", "prefix"},
    {"NumberTooLarge", "((0.,0.,0.))", "((1.E999,0.,0.))", "number"},
};

class BrokenModels : public testing::TestWithParam<Broken> {};

TEST_P(BrokenModels, EndInAnErrorThatSaysWhereAndWhy)
{
  std::string bytes = smallModel();
  const std::size_t at = bytes.find(GetParam().cut);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, std::string(GetParam().cut).size(), GetParam().put);
  try {
    const IfcModel model(Part21File::parse(bytes, "m.ifc"));
    ADD_FAILURE() << "was read";
  }
  catch (const LoadError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.rfind("m.ifc:", 0), 0u) << what;
    EXPECT_NE(what.find(GetParam().says), std::string::npos) << what;
    EXPECT_LT(what.size(), 400u);
    for (const char c : what)
      EXPECT_GE(static_cast<unsigned char>(c), 32) << "control characters in " << what;
  }
}

INSTANTIATE_TEST_SUITE_P(All,
                         BrokenModels,
                         testing::ValuesIn(broken_files),
                         [](const auto& test) { return std::string(test.param.name); });

// A model or an error, and what is put into a model can be read again.
bool
survives(const std::string& bytes)
{
  try {
    const IfcModel model(Part21File::parse(bytes, "m.ifc"));
    hoist::IfcObject object;
    object.key = "another";
    object.box.size = Eigen::Vector3d(1, 2, 3);
    object.rgb = {1, 2, 3};
    hoist::IfcEdit edit(model);
    try {
      edit.put(object);
      object.key = "k"; // it is there already: changed, wherever its parts lead
      edit.put(object);
    }
    catch (const pcl::BadArgumentException&) {
      return true;
    }
    (void)Part21File::parse(edit.part21().bytes(), "written.ifc").countReferences();
    return true;
  }
  catch (const LoadError& error) {
    EXPECT_FALSE(error.reason().empty());
    return false;
  }
}

TEST(HostileModels, TruncatedAtEveryByte)
{
  const std::string bytes = smallModel();
  ASSERT_TRUE(survives(bytes));
  // the last ";" is the last byte that counts
  for (std::size_t n = 0; n < bytes.rfind(';') + 1; ++n)
    EXPECT_FALSE(survives(bytes.substr(0, n))) << n;
}

TEST(HostileModels, RandomMutations)
{
  // Seeded, so that a failure comes back.
  std::mt19937 random(20261123);
  const std::string good = smallModel();
  const std::size_t data = good.find("DATA;");
  int read = 0, refused = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string bytes = good;
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
      const std::size_t at = data + random() % (bytes.size() - data);
      switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.insert(at, std::to_string(random() % 100));
        break;
      case 2:
        bytes.erase(at, 1 + random() % 12);
        break;
      case 3: { // another instance for an instance
        const std::size_t mark = bytes.find('#', at);
        if (mark != std::string::npos)
          bytes.replace(mark, 2, "#" + std::to_string(random() % 60));
        break;
      }
      case 4: // an argument for nothing
        if (const std::size_t comma = bytes.find(',', at); comma != std::string::npos)
          bytes.insert(comma, ",$");
        break;
      default: // a digit for a digit: keeps more files readable
        if (bytes[at] >= '0' && bytes[at] <= '9')
          bytes[at] = static_cast<char>('0' + random() % 10);
      }
    }
    ++(survives(bytes) ? read : refused);
  }
  EXPECT_GT(read, 300); // both happen, or the test tests nothing
  EXPECT_GT(refused, 300);
}

TEST(HostileModels, ShapesWithinShapes)
{
  // Each map shows the next one ten times: ten to the twentieth boxes, or one refusal.
  std::string bytes = smallModel();
  std::string more;
  const int first = 100000;
  for (int i = 0; i < 20; ++i) {
    const auto id = [&](int level, int k) {
      return "#" + std::to_string(first + 20 * level + k);
    };
    std::string items;
    for (int k = 0; k < 10; ++k) {
      more += id(i, k) + "=IFCMAPPEDITEM(" + id(i, 10) + "," + id(i, 11) + ");\n";
      items += (k == 0 ? "" : ",") + id(i + 1, k);
    }
    more += id(i, 11) + "=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#6,$,$);\n";
    more += id(i, 10) + "=IFCREPRESENTATIONMAP(#8," + id(i, 12) + ");\n";
    more += id(i, 12) + "=IFCSHAPEREPRESENTATION(#10,'Body','MappedRepresentation',(" +
            items + "));\n";
  }
  for (int k = 0; k < 10; ++k)
    more += "#" + std::to_string(first + 400 + k) + "=IFCBOUNDINGBOX(#6,1.,1.,1.);\n";
  more += "#200000=IFCPRODUCTDEFINITIONSHAPE($,$,(#" + std::to_string(first + 12) +
          "));\n#200001=IFCSLAB('0000000000000000000000',$,$,$,$,$,#200000,$,$);\n";
  bytes.insert(bytes.rfind("ENDSEC;"), more);
  const IfcModel model(Part21File::parse(bytes, "m.ifc"));
  ASSERT_EQ(model.elements().size(), 2u);
  EXPECT_FALSE(model.elements()[1].box);
  EXPECT_FALSE(model.elements()[1].box_source.empty());
}

} // namespace
