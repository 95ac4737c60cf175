// The STEP reader: what is in a file, and that every byte of it is kept.
#include "data/temp_folder.h"

#include <hoist/data/ifc/part21.h>
#include <hoist/data/ifc/part21_edit.h>

#include <gtest/gtest.h>

#include <pcl/exceptions.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

namespace {

using hoist::decodePart21;
using hoist::encodePart21;
using hoist::LoadError;
using hoist::Part21Edit;
using hoist::Part21File;
using hoist::Part21Value;
using Kind = Part21Value::Kind;

std::string
file(const std::string& instances)
{
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
         "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n" +
         instances + "ENDSEC;\nEND-ISO-10303-21;\n";
}

TEST(Part21, EveryKindOfArgument)
{
  const Part21File f = Part21File::parse(file(
      "#7 = IFCTEST ( $ , *,-12,+1.5E-3, 'it''s; (here)' ,\"0FA\",.METRE.,#8,\n"
      "  /* a ; comment ' */ (1.,(2,3),()),IFCLABEL('x'),.5 );\n#8=IFCOTHER();\n"));
  ASSERT_EQ(f.instances().size(), 2u);
  const auto a = f.arguments(*f.find(7));
  ASSERT_EQ(a.size(), 11u);
  const Kind kinds[] = {Kind::unset,
                        Kind::derived,
                        Kind::integer,
                        Kind::real,
                        Kind::text,
                        Kind::binary,
                        Kind::enumeration,
                        Kind::reference,
                        Kind::list,
                        Kind::typed,
                        Kind::real};
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_TRUE(a[i].is(kinds[i])) << i;
  EXPECT_EQ(a[2].number, -12);
  EXPECT_EQ(a[3].number, 1.5e-3);
  EXPECT_EQ(a[4].text(), "it's; (here)");
  EXPECT_EQ(a[6].word(), "METRE");
  EXPECT_EQ(a[7].id, 8u);
  ASSERT_EQ(a[8].items.size(), 3u);
  EXPECT_EQ(a[8].items[1].items[1].number, 3);
  EXPECT_TRUE(a[8].items[2].items.empty());
  EXPECT_EQ(a[9].word(), "IFCLABEL");
  EXPECT_EQ(a[9].items.at(0).text(), "x");
  EXPECT_EQ(a[8].raw, "(1.,(2,3),())");
  EXPECT_EQ(f.entity(*f.find(8)), "IFCOTHER");
  EXPECT_EQ(f.ofType("IFCOTHER").size(), 1u);
  EXPECT_TRUE(f.ofType("IFCNONE").empty());
  EXPECT_EQ(f.header().back().name, "FILE_SCHEMA");
  EXPECT_EQ(f.countReferences(), (std::vector<std::uint32_t>{0, 1}));
}

TEST(Part21, ComplexInstancesCommentsAndLineEnds)
{
  std::string bytes =
      file("#1=(NAMED_UNIT(*)LENGTH_UNIT() /* x */ SI_UNIT(.MILLI.,.METRE.));\n");
  for (std::size_t at = 0; (at = bytes.find('\n', at)) != std::string::npos; at += 2)
    bytes.replace(at, 1, "\r\n");
  const Part21File f = Part21File::parse("\xef\xbb\xbf/* first */ " + bytes + "\x1a");
  const auto parts = f.records(*f.find(1));
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[2].name, "SI_UNIT");
  EXPECT_EQ(parts[2].arguments.at(0).word(), "MILLI");
  EXPECT_EQ(f.entity(*f.find(1)), "");
  EXPECT_THROW((void)f.arguments(*f.find(1)), LoadError);
}

TEST(Part21, TextsThereAndBack)
{
  EXPECT_EQ(decodePart21("'\\X2\\00C4\\X0\\b\\X\\DF'"), "\u00c4b\u00df");
  EXPECT_EQ(decodePart21("'\\S\\D'"), "\u00c4"); // 'D' | 0x80 of Latin-1
  EXPECT_EQ(decodePart21("'\\PA\\x\\\\y''z'"), "x\\y'z");
  EXPECT_EQ(decodePart21("'\\X4\\0001F3D7\\X0\\'"), "\U0001f3d7");
  EXPECT_EQ(decodePart21("'\\X2\\D83CDFD7\\X0\\'"), "\U0001f3d7"); // as UTF-16
  EXPECT_EQ(decodePart21("'\xe4'"), "\u00e4");                     // plain Latin-1
  EXPECT_EQ(decodePart21("'\\X2\\00C'"), "\\X2\\00C");             // cut: as it is
  EXPECT_EQ(encodePart21("\u00c4b'\\"), "'\\X2\\00C4\\X0\\b''\\\\'");
  for (const std::string& text :
       {std::string("M\u00fcnchen \u2014 \u5efa\u7bc9 \U0001f3d7 'q' \\ \t"),
        std::string(),
        std::string("\x7f\x01")}) {
    const std::string encoded = encodePart21(text);
    EXPECT_EQ(decodePart21(encoded), text);
    for (const char c : encoded)
      EXPECT_TRUE(c >= 32 && c < 127);
  }
}

TEST(Part21, Reals)
{
  EXPECT_EQ(hoist::part21Real(0), "0.");
  EXPECT_EQ(hoist::part21Real(-1e-12), "0.");
  EXPECT_EQ(hoist::part21Real(1.5), "1.5");
  EXPECT_EQ(hoist::part21Real(-100), "-100.");
  EXPECT_EQ(hoist::part21Real(1e20), "100000000000000000000.");
  EXPECT_THROW((void)hoist::part21Real(std::nan("")), pcl::BadArgumentException);
}

TEST(Part21, HugeAndSparseIds)
{
  const Part21File f =
      Part21File::parse(file("#4611686018427387903=A(#5);\n#5=B();\n#0=C();\n"));
  EXPECT_EQ(f.maxId(), 4611686018427387903u);
  EXPECT_NE(f.find(4611686018427387903u), nullptr);
  EXPECT_EQ(f.entity(*f.find(5)), "B");
  EXPECT_EQ(f.find(6), nullptr);
  Part21Edit edit(f); // new ids come from the gaps, where every program can hold them
  EXPECT_EQ(edit.append("D", {}), 1u);
  for (int i = 0; i < 3; ++i)
    (void)edit.append("D", {});
  EXPECT_EQ(edit.append("D", {}), 6u); // 5 is taken
  (void)Part21File::parse(edit.bytes());
}

TEST(Part21Edit, KeepsEveryOtherByte)
{
  const std::string bytes = file("#1= IFCA( 'x' ,\t(1.,2. ) /* keep */,$ ) ;\r\n\n"
                                 "  #3=IFCB(#1);\n");
  const Part21File f = Part21File::parse(bytes);
  Part21Edit edit(f);
  EXPECT_TRUE(edit.empty());
  EXPECT_EQ(edit.bytes(), bytes);
  edit.set(1, 2, "#4");
  EXPECT_EQ(edit.append("IFCC", {"1", "$"}), 4u);
  edit.set(4, 1, "'y'");
  std::string expected = bytes;
  expected.replace(expected.find("$ )"), 1, "#4");
  expected.insert(expected.rfind("ENDSEC;"), "#4=IFCC(1,'y');\n");
  EXPECT_EQ(edit.bytes(), expected);
  EXPECT_EQ(edit.get(1, 1), "(1.,2. )");
  EXPECT_NE(edit.diff().find("+#4=IFCC(1,'y');"), std::string::npos);
  edit.set(1, 2, "$"); // back again
  expected.replace(expected.find("#4 )"), 2, "$");
  EXPECT_EQ(edit.bytes(), expected);
  EXPECT_THROW(edit.set(1, 3, "$"), LoadError);
  EXPECT_THROW(edit.set(9, 0, "$"), LoadError);
}

// Small buildings without end: n walls of nine instances each, as exporters write them.
std::string
bigFile(int walls)
{
  std::string out;
  for (int i = 0; i < walls; ++i) {
    const auto id = [&](int k) { return "#" + std::to_string(9 * i + k); };
    out += id(1) + "= IFCCARTESIANPOINT((" + std::to_string(i) + ".25,-3.5E-2,0.));\n";
    out += id(2) + "= IFCAXIS2PLACEMENT3D(" + id(1) + ",$,$);\n";
    out += id(3) + "= IFCLOCALPLACEMENT($," + id(2) + ");\n";
    out += id(4) + "= IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,0.2);\n";
    out += id(5) + "= IFCDIRECTION((0.,0.,1.));\n";
    out += id(6) + "= IFCEXTRUDEDAREASOLID(" + id(4) + ",$," + id(5) + ",2.5);\n";
    out += id(7) + "= IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(" + id(6) + "));\n";
    out += id(8) + "= IFCPRODUCTDEFINITIONSHAPE($,$,(" + id(7) + "));\n";
    out += id(9) + "= IFCWALL('0000000000000000000000',$,'wall; ''" +
           std::to_string(i) + "''',$,$," + id(3) + "," + id(8) + ",$,$);\n";
  }
  return file(out);
}

TEST(Part21, FortyThousandInstances)
{
  // The time itself is for the reader of the log; a loaded machine proves nothing.
  const std::string bytes = bigFile(5000);
  const auto start = std::chrono::steady_clock::now();
  const Part21File f = Part21File::parse(bytes);
  const auto middle = std::chrono::steady_clock::now();
  const auto counts = f.countReferences();
  const auto end = std::chrono::steady_clock::now();
  EXPECT_EQ(f.instances().size(), 45000u);
  EXPECT_EQ(f.ofType("IFCWALL").size(), 5000u);
  EXPECT_EQ(counts[0], 1u);
  const auto ms = [](auto d) {
    return std::chrono::duration<double, std::milli>(d).count();
  };
  RecordProperty("bytes", static_cast<int>(bytes.size()));
  RecordProperty("index_us", static_cast<int>(1000 * ms(middle - start)));
  RecordProperty("references_us", static_cast<int>(1000 * ms(end - middle)));
}

TEST(Part21, ReadsFilesAndSaysWhatOthersAre)
{
  const hoist::test::TempFolder folder;
  const std::string good = bigFile(30);
  EXPECT_EQ(Part21File::read(folder.write("a.ifc", good)).bytes(), good);
  const auto says = [&](const std::string& bytes, const std::string& what) {
    const std::string name = folder.write("b.ifc", bytes);
    try {
      (void)Part21File::read(name);
      ADD_FAILURE() << "was read, but " << what;
    }
    catch (const LoadError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(name, 0), 0u);
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos)
          << error.what();
    }
  };
  says("", "end of the file");
  says("PK\x03\x04" + std::string(100, 'x'), "zip");
  says("<?xml version=\"1.0\"?><ifcXML/>", "XML");
  says(std::string(10000, '\0'), "ISO-10303-21");
  EXPECT_THROW((void)Part21File::read(folder.name("none.ifc")), LoadError);
  EXPECT_THROW((void)Part21File::read(folder.path()), LoadError);
  EXPECT_THROW((void)Part21File::read(folder.name("a.ifc"), 100), LoadError);
}

} // namespace
