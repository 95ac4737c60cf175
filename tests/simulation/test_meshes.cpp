// Meshes of files: what is broken is said, what is good keeps its shape.
#include "simulated.h"

#include "data/temp_folder.h"
#include <hoist/data/load_error.h>
#include <hoist/simulation/mesh_file.h>
#include <hoist/simulation/mesh_library.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

namespace hoist {
namespace test {
namespace {

struct BadObj {
  const char* name;
  std::string text;
  std::string line;
  std::string reason; ///< a part of it
};

void
PrintTo(const BadObj& bad, std::ostream* out)
{
  *out << bad.name;
}

class BrokenMesh : public ::testing::TestWithParam<BadObj> {};

TEST_P(BrokenMesh, SaysLineAndReason)
{
  const TempFolder folder;
  const std::string file = folder.write("bad.obj", GetParam().text);
  try {
    simulation::loadMesh(file);
    FAIL() << "was accepted";
  }
  catch (const LoadError& error) {
    EXPECT_EQ(error.file(), file);
    EXPECT_EQ(error.position(), GetParam().line) << error.what();
    EXPECT_NE(error.reason().find(GetParam().reason), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases,
    BrokenMesh,
    ::testing::Values(
        BadObj{"word", "v 0 0 0\nv 1 zero 0\n", "2", "'zero'"},
        BadObj{"short", "v 0 0\n", "1", "three numbers"},
        BadObj{"infinite", "# ok\nv 0 0 inf\n", "2", "'inf'"},
        BadObj{"index", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "4", "vertex 9"},
        BadObj{"zero", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 0 1 2\n", "5", "vertex 0"},
        BadObj{"edge", "v 0 0 0\nv 1 0 0\nf 1 2\n", "3", "three vertices"},
        BadObj{"letters", "v 0 0 0\nf a b c\n", "2", "by number"},
        BadObj{"empty", "", "", ""},
        BadObj{"points", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "", ""}),
    [](const ::testing::TestParamInfo<BadObj>& one) { return one.param.name; });

TEST(Mesh, OfADescriptionIsScaledAndRendered)
{
  const TempFolder folder;
  folder.write("wedge.obj",
               "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 3\nv 0 1 3\n"
               "f 1 4 3 2\nf 1 2 5\nf 4 6 3\nf 2 3 6 5\nf 1 5 6 4\n");
  const std::string scene = folder.write("scene.yaml",
                                         "things:\n  - {kind: plant, mesh: wedge.obj, "
                                         "size: [0.5, 0.4, 0.3], at: [0, 0]}\n");
  const simulation::Scene made =
      simulation::makeScene(simulation::loadDescription(scene), 1, 0);
  const simulation::Thing& wedge = made.things.back();
  EXPECT_TRUE(wedge.box_size.isApprox(Eigen::Vector3d(0.5, 0.4, 0.3), 1e-9));
  EXPECT_TRUE(wedge.annotated);
  EXPECT_EQ(wedge.mesh->triangles.size(), 8U); // three quads and two triangles
  const simulation::Frame frame = simulation::simulate(made);
  ASSERT_EQ(frame.truth.objects.size(), 1U);
  EXPECT_GT(*frame.truth.objects[0].visible_pixels, 100);
}

TEST(Mesh, ThatIsMissingIsSaid)
{
  const auto description = simulation::parseDescription(
      "things: [{kind: plant, mesh: nowhere.obj}]\n", "scene.yaml");
  EXPECT_THROW(simulation::makeScene(description, 1, 0), LoadError);
}

TEST(Mesh, NamesOfMaterialsSayWhatItIsMadeOf)
{
  EXPECT_EQ(simulation::substanceNamed("RED_OAK.001"), "wood");
  EXPECT_EQ(simulation::substanceNamed("Brushed_Aluminium"), "metal");
  EXPECT_EQ(simulation::substanceNamed("METAL_chrome"), "metal");
  EXPECT_EQ(simulation::substanceNamed("plastico_gris"), "plastic");
  EXPECT_EQ(simulation::substanceNamed("Office_CH_fabric"), "fabric");
  EXPECT_EQ(simulation::substanceNamed("PAINT_white"), ""); // on what, nobody knows
  EXPECT_EQ(simulation::substanceNamed("Material.001"), "");

  const TempFolder folder;
  folder.write("stool.mtl",
               "newmtl Chrome\nKd 0.5 0.5 0.5\nnewmtl Oak\nKd 0.6 0.4 0.2\n");
  const std::string file =
      folder.write("stool.obj",
                   "mtllib stool.mtl\n"
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                   "v 0 0 1\nv 0.1 0 1\nv 0 0.1 1\n"
                   "usemtl Oak\nf 1 2 3 4\nusemtl Chrome\nf 5 6 7\n");
  const simulation::LoadedMesh stool = simulation::loadMesh(file);
  EXPECT_EQ(simulation::substanceOfMost(stool), "wood");
  ASSERT_EQ(stool.substances.size(), stool.materials.size());
  for (const simulation::Mesh::Triangle& t : stool.mesh.triangles)
    EXPECT_EQ(stool.materials[t.material].metal,
              stool.substances[t.material] == "metal");
}

TEST(Library, ShapesHaveTheirSizesAndNoneIsInBothSplits)
{
  if (!std::filesystem::exists("/usr/share/sweethome3d/furniture/Scopia.sh3f"))
    GTEST_SKIP() << "the package sweethome3d-furniture is not installed";
  std::map<std::string, bool> split;
  std::map<std::string, int> train, test;
  for (const simulation::LibraryMesh& mesh : simulation::meshLibrary()) {
    ++(mesh.test ? test : train)[mesh.kind];
    const auto seen = split.emplace(mesh.archive + mesh.model, mesh.test);
    EXPECT_EQ(seen.first->second, mesh.test) << mesh.model;
  }
  EXPECT_GE(train["chair"], 10);
  EXPECT_GE(test["chair"], 5);
  EXPECT_GE(train["plant"], 3);
  EXPECT_GE(test["plant"], 2);
  EXPECT_EQ(train["safety cone"], 0); // there is one only
  int looked_at = 0;
  for (const simulation::LibraryMesh& mesh : simulation::meshLibrary()) {
    if (++looked_at % 7 != 0) // reading them all takes a minute
      continue;
    const auto shape = simulation::libraryShape(mesh);
    EXPECT_TRUE(shape->mesh.bounds().sizes().isApprox(mesh.size, 1e-6)) << mesh.model;
    EXPECT_EQ(shape, simulation::libraryShape(mesh)); // once a process
  }
}

} // namespace
} // namespace test
} // namespace hoist
