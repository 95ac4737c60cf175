// What a model says: units, tree, places, boxes, materials, weights.
#include "data/ifc/ifc_things.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace {

using hoist::IfcElement;
using hoist::IfcModel;
using hoist::OrientedBox;
using hoist::test::cornerDistance;
using hoist::test::exportedModel;
using hoist::test::modelOf;

constexpr double tenth_of_a_millimetre = 1e-4;

TEST(IfcModel, OfAnotherProgram)
{
  const IfcModel model = modelOf(exportedModel());
  EXPECT_EQ(model.schema(), hoist::IfcSchema::ifc2x3);
  EXPECT_DOUBLE_EQ(model.lengthUnit(), 0.001);
  EXPECT_DOUBLE_EQ(model.massUnit(), 1);
  ASSERT_EQ(model.spatial().size(), 5u);
  EXPECT_EQ(model.spatial()[0].entity, "IFCPROJECT");
  ASSERT_EQ(model.elements().size(), 3u);

  const IfcElement& column = model.elements()[0];
  EXPECT_EQ(column.entity, "IfcColumn");
  EXPECT_EQ(column.name, "Column 1");
  EXPECT_EQ(column.storey, "Level 1");
  EXPECT_EQ(column.tag, "669490");
  EXPECT_EQ(column.material, "Concrete, gray");
  EXPECT_EQ(column.weight, 864);
  EXPECT_EQ(column.weight_source, "BaseQuantities.GrossWeight");
  // The storey's x axis points along the world's y: (1, 2) m in it is (-2, 1) m, from
  // the site at (5, -2, 0.1) m. 0.3 m along its x axis, 0.4 m along its y axis.
  OrientedBox expected;
  expected.center = Eigen::Vector3d(5 - 2, -2 + 1, 0.1 + 1.5);
  expected.size = Eigen::Vector3d(0.4, 0.3, 3);
  ASSERT_TRUE(column.box) << column.box_source;
  EXPECT_LT(cornerDistance(*column.box, expected), 1e-9);

  const IfcElement& wall = model.elements()[1];
  EXPECT_EQ(wall.entity, "IfcWallStandardCase");
  EXPECT_EQ(wall.storey, "Level 2");
  EXPECT_FALSE(wall.weight);
  ASSERT_TRUE(wall.box);
  expected.center = Eigen::Vector3d(5, -2, 0.1 + 3.14 + 1.25);
  expected.size = Eigen::Vector3d(4, 0.2, 2.5);
  EXPECT_LT(cornerDistance(*wall.box, expected), 1e-9);

  const auto sets = model.propertySets(column.id);
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].name, "Pset_ColumnCommon");
  ASSERT_NE(sets[0].find("Reference"), nullptr);
  EXPECT_EQ(std::get<std::string>(sets[0].find("Reference")->value), "300x400");
  EXPECT_EQ(model.find(wall.global_id), &wall);
  EXPECT_EQ(model.find("nothing"), nullptr);
}

// The box of a slab whose body is this item, in a model in metres.
std::optional<OrientedBox>
boxOf(const std::string& item, std::string* source = nullptr)
{
  std::string bytes = hoist::newIfcModel();
  bytes.insert(bytes.rfind("ENDSEC;"),
               item + "#901=IFCSHAPEREPRESENTATION(#10,'Body','x',(#900));\n"
                      "#902=IFCPRODUCTDEFINITIONSHAPE($,$,(#901));\n"
                      "#903=IFCSLAB('0000000000000000000000',$,$,$,$,$,#902,$,$);\n");
  const IfcModel model = modelOf(bytes);
  if (source != nullptr)
    *source = model.elements().at(0).box_source;
  return model.elements().at(0).box;
}

OrientedBox
box(double x, double y, double z, double length, double width, double height)
{
  OrientedBox out;
  out.center = Eigen::Vector3d(x, y, z);
  out.size = Eigen::Vector3d(length, width, height);
  return out;
}

void
expectBox(const std::string& item, const OrientedBox& expected)
{
  std::string source;
  const auto found = boxOf(item, &source);
  ASSERT_TRUE(found) << source << "\n" << item;
  EXPECT_LT(cornerDistance(*found, expected), 1e-9) << source;
}

TEST(IfcGeometry, SimpleShapes)
{
  expectBox("#900=IFCBOUNDINGBOX(#6,1.,2.,3.);\n", box(0.5, 1, 1.5, 1, 2, 3));
  expectBox("#800=IFCBLOCK(#8,1.,2.,3.);\n#900=IFCCSGSOLID(#800);\n",
            box(0.5, 1, 1.5, 1, 2, 3));
  // no position, an extrusion downward, a profile off the middle
  expectBox("#800=IFCCARTESIANPOINT((3.,4.));\n#801=IFCAXIS2PLACEMENT2D(#800,$);\n"
            "#802=IFCRECTANGLEPROFILEDEF(.AREA.,$,#801,2.,1.);\n"
            "#803=IFCDIRECTION((0.,0.,-1.));\n"
            "#900=IFCEXTRUDEDAREASOLID(#802,$,#803,0.5);\n",
            box(3, 4, -0.25, 2, 1, 0.5));
  // a round profile: the box around it
  expectBox("#802=IFCCIRCLEPROFILEDEF(.AREA.,$,$,0.25);\n"
            "#900=IFCEXTRUDEDAREASOLID(#802,$,#7,2.);\n",
            box(0, 0, 1, 0.5, 0.5, 2));
  // the first operand of a clipping
  expectBox("#800=IFCBOUNDINGBOX(#6,1.,2.,3.);\n"
            "#900=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#800,#800);\n",
            box(0.5, 1, 1.5, 1, 2, 3));
  // mapped twice, once as it is and once moved: the box around both
  expectBox("#800=IFCBOUNDINGBOX(#6,1.,1.,1.);\n"
            "#801=IFCSHAPEREPRESENTATION(#10,'Body','x',(#800,#810));\n"
            "#802=IFCREPRESENTATIONMAP(#8,#801);\n"
            "#803=IFCCARTESIANPOINT((2.,0.,0.));\n"
            "#804=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#803,$,$);\n"
            "#810=IFCBOUNDINGBOX(#6,1.,2.,1.);\n"
            "#900=IFCMAPPEDITEM(#802,#804);\n",
            box(2.5, 1, 0.5, 1, 2, 1));
  // scaled by axis
  expectBox("#800=IFCBOUNDINGBOX(#6,1.,1.,1.);\n"
            "#801=IFCSHAPEREPRESENTATION(#10,'Body','x',(#800));\n"
            "#802=IFCREPRESENTATIONMAP(#8,#801);\n"
            "#804=IFCCARTESIANTRANSFORMATIONOPERATOR3DNONUNIFORM($,$,#6,2.,$,3.,4.);\n"
            "#900=IFCMAPPEDITEM(#802,#804);\n",
            box(1, 1.5, 2, 2, 3, 4));
}

TEST(IfcGeometry, TurnedOutlinesAndCorners)
{
  // A rectangle of 2 x 1 turned by 45 degrees in its plane, as an outline, as a brep's
  // corners and as a face set: its own axes are found, not the box around it.
  OrientedBox expected = box(0, 0, 0.5, 2, 1, 1);
  expected.axes =
      Eigen::AngleAxisd(std::atan(1.), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::string points, flat, list, loop;
  int id = 700;
  for (const double z : {0., 1.})
    for (const auto& [x, y] :
         {std::pair<double, double>{-1, -0.5}, {1, -0.5}, {1, 0.5}, {-1, 0.5}}) {
      const Eigen::Vector3d p = expected.axes * Eigen::Vector3d(x, y, 0);
      const std::string xy =
          '(' + hoist::part21Real(p.x(), 12) + ',' + hoist::part21Real(p.y(), 12);
      points += "#" + std::to_string(id) + "=IFCCARTESIANPOINT(" + xy + ',' +
                hoist::part21Real(z) + "));\n";
      if (z == 0)
        flat += "#" + std::to_string(id + 50) + "=IFCCARTESIANPOINT(" + xy + "));\n";
      list += (list.empty() ? "" : ",") + xy + ',' + hoist::part21Real(z) + ')';
      loop += (loop.empty() ? "#" : ",#") + std::to_string(id);
      ++id;
    }
  expectBox(flat + "#800=IFCPOLYLINE((#750,#751,#752,#753,#750));\n"
                   "#801=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#800);\n"
                   "#900=IFCEXTRUDEDAREASOLID(#801,#8,#7,1.);\n",
            expected);
  expectBox(points + "#800=IFCPOLYLOOP((" + loop +
                "));\n#801=IFCFACEOUTERBOUND(#800,.T.);\n#802=IFCFACE((#801));\n"
                "#803=IFCCLOSEDSHELL((#802));\n#900=IFCFACETEDBREP(#803);\n",
            expected);
  expectBox("#800=IFCCARTESIANPOINTLIST3D((" + list +
                "));\n#900=IFCTRIANGULATEDFACESET(#800,$,$,((1,2,3)),$);\n",
            expected);
}

TEST(IfcGeometry, WhatIsNotSimpleSaysWhatItIs)
{
  std::string source;
  EXPECT_FALSE(boxOf("#900=IFCREVOLVEDAREASOLID($,$,$,$);\n", &source));
  EXPECT_EQ(source, "IFCREVOLVEDAREASOLID");
  EXPECT_FALSE(boxOf("#900=IFCBOUNDINGBOX(#6,1.,-2.,3.);\n", &source));
  EXPECT_NE(source.find("length above 0"), std::string::npos) << source;
  EXPECT_FALSE(boxOf("#900=IFCMAPPEDITEM(#901,$);\n", &source));
  EXPECT_NE(source.find("IFCREPRESENTATIONMAP"), std::string::npos) << source;
}

TEST(IfcModel, UnitsThatAreConverted)
{
  for (const double unit : {1., 0.1, 0.01, 0.001, 0.0254, 0.3048})
    for (const hoist::IfcSchema schema :
         {hoist::IfcSchema::ifc2x3, hoist::IfcSchema::ifc4}) {
      hoist::IfcNewModel settings;
      settings.length_unit = unit;
      settings.schema = schema;
      const IfcModel model = modelOf(hoist::newIfcModel(settings));
      EXPECT_DOUBLE_EQ(model.lengthUnit(), unit);
      EXPECT_EQ(model.schema(), schema);
    }
}

TEST(IfcModel, ManyElements)
{
  // 4,000 things are some 60,000 instances; their boxes come back.
  std::mt19937 random(3);
  std::vector<hoist::IfcObject> objects;
  for (int i = 0; i < 4000; ++i)
    objects.push_back(
        hoist::test::thing(std::to_string(i), hoist::test::randomBox(random)));
  const std::string bytes = hoist::ifcModelOf(objects);
  const auto start = std::chrono::steady_clock::now();
  const IfcModel model = modelOf(bytes);
  RecordProperty("model_ms",
                 static_cast<int>(std::chrono::duration<double, std::milli>(
                                      std::chrono::steady_clock::now() - start)
                                      .count()));
  RecordProperty("instances", static_cast<int>(model.file().instances().size()));
  EXPECT_GT(model.file().instances().size(), 40000u);
  ASSERT_EQ(model.elements().size(), objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    ASSERT_TRUE(model.elements()[i].box);
    ASSERT_LT(cornerDistance(*model.elements()[i].box, objects[i].box),
              tenth_of_a_millimetre);
  }
}

} // namespace
