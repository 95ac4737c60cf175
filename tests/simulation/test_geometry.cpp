// Shapes, rays and truth against geometry that is known.
#include "simulated.h"

#include <hoist/simulation/mesh.h>
#include <hoist/simulation/random.h>
#include <samples/raycast.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hoist {
namespace test {
namespace {

using simulation::boxMesh;
using simulation::Mesh;

// The volume that closed triangles enclose, outside on the left of their order.
double
volume(const Mesh& mesh)
{
  double sum = 0;
  for (const Mesh::Triangle& t : mesh.triangles)
    sum += mesh.vertices[t.corners[0]].dot(
               mesh.vertices[t.corners[1]].cross(mesh.vertices[t.corners[2]])) /
           6;
  return sum;
}

// The normals at a loft's open ends are those of the one band there.
TEST(Loft, EndsLookOutOfTheOnlyBandThere)
{
  for (const double top : {0.5, 0.3}) {
    simulation::Ring low, high;
    low.half_x = low.half_y = 0.5;
    high.half_x = high.half_y = top;
    high.z = 1;
    const simulation::Mesh mesh = simulation::loftMesh({low, high}, 16);
    // outwards and upwards, as a cone of this slope looks
    const double up = (0.5 - top) / std::hypot(1.0, 0.5 - top);
    ASSERT_FALSE(mesh.normals.empty());
    for (const Eigen::Vector3f& normal : mesh.normals)
      EXPECT_NEAR(normal.z(), up, 1e-6);
  }
}

TEST(Random, SineAgreesWithTheLibrarys)
{
  for (int i = -4000; i <= 4000; ++i) {
    const double turns = i / 1234.0;
    EXPECT_NEAR(simulation::sineOfTurns(turns), std::sin(turns * 2 * M_PI), 1e-9);
    EXPECT_NEAR(simulation::cosineOfTurns(turns), std::cos(turns * 2 * M_PI), 1e-9);
  }
}

TEST(BoxMesh, ClosedAndOfItsSize)
{
  const Eigen::Vector3d size(1.2, 0.5, 0.3);
  EXPECT_NEAR(volume(boxMesh(size)), size.prod(), 1e-12);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    simulation::BoxWear wear;
    wear.bevel = 0.02;
    wear.chipping = 1;
    wear.seed = seed;
    const Mesh worn = boxMesh(size, wear);
    // bevels and chips take a little, and nothing from the sides' planes
    EXPECT_LT(volume(worn), size.prod());
    EXPECT_GT(volume(worn), 0.95 * size.prod());
    EXPECT_TRUE(worn.bounds().sizes().isApprox(size, 1e-12));
    for (const Mesh::Triangle& t : worn.triangles) {
      if (t.face == Mesh::no_face)
        continue;
      const int axis = t.face / 2;
      for (const std::uint32_t corner : t.corners)
        EXPECT_NEAR(worn.vertices[corner][axis],
                    (t.face % 2 == 0 ? 0.5 : -0.5) * size[axis],
                    1e-12);
    }
  }
}

TEST(RoundMeshes, VolumesAreThoseOfTheirSolids)
{
  // inscribed polyhedra of many sides: a little less than the round solid
  const double ball = volume(simulation::ellipsoidMesh({0.3, 0.2, 0.1}, 64));
  EXPECT_NEAR(ball, 4.0 / 3 * M_PI * 0.3 * 0.2 * 0.1, 0.02 * ball);
  const double bar = volume(simulation::tubeMesh({{0, 0, 0}, {0, 1, 2}}, {0.1}, 64));
  EXPECT_NEAR(bar, M_PI * 0.01 * std::sqrt(5.0), 0.01 * bar);
}

TEST(Lens, ProjectUndoesRay)
{
  Intrinsics camera;
  camera.fx = camera.fy = 525;
  camera.cx = 319.5;
  camera.cy = 239.5;
  const simulation::Lens lens(camera, {{-0.1, 0.02, 0.001, -0.002, 0.0}});
  for (const double u : {0.0, 100.5, 320.0, 639.0})
    for (const double v : {0.0, 77.25, 479.0}) {
      const Eigen::Vector2d pixel = lens.project(2.5 * lens.ray(u, v));
      EXPECT_NEAR(pixel.x(), u, 1e-6);
      EXPECT_NEAR(pixel.y(), v, 1e-6);
    }
}

const char* const boxes = R"(
sensor: {kind: ideal, width: 320, height: 240, fx: 300}
camera: {distance: [2, 4], elevation: [15, 70]}
area: [2.5, 2.5]
things:
  - {kind: box, count: 6, wear: 0, size: [[0.2, 0.9], [0.2, 0.6], [0.1, 0.8]], stacked: 0.4, touching: 0.4}
)";

// The things of a scene as the other ray caster, which knows no triangles, has them.
samples::Scene
analytic(const simulation::Scene& scene, std::vector<int>& things)
{
  samples::Scene out;
  const Eigen::Isometry3d to_camera = scene.sensor_to_world.inverse();
  for (std::size_t i = 0; i < scene.things.size(); ++i) {
    const simulation::Thing& thing = scene.things[i];
    if (!thing.is_cuboid)
      continue;
    samples::Box box;
    box.center = to_camera * thing.center();
    box.axes = to_camera.linear() * thing.axes();
    box.size = thing.box_size;
    out.boxes.push_back(box);
    things.push_back(static_cast<int>(i));
  }
  samples::Patch ground; // things.front()
  ground.center = to_camera * Eigen::Vector3d::Zero();
  ground.axes = to_camera.linear();
  ground.half_size = {150, 150};
  out.patches.push_back(ground);
  things.push_back(0);
  return out;
}

TEST(Render, DepthIsThatOfAnalyticBoxes)
{
  for (int number = 0; number < 4; ++number) {
    const simulation::Scene scene = sceneOf(boxes, 3, number);
    const simulation::RayCaster caster(scene);
    const simulation::Lens lens(scene.sensor.camera, scene.sensor.distortion);
    const cv::Size size(scene.sensor.width, scene.sensor.height);
    const simulation::Layer layer = simulation::layerOf(
        simulation::castPixels(caster, lens, size, scene.sensor_to_world),
        lens,
        scene.sensor_to_world);
    std::vector<int> things;
    const samples::Scene truth = analytic(scene, things);
    int differing = 0;
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) {
        const samples::Hit hit =
            samples::cast(truth, Eigen::Vector3d::Zero(), lens.ray(u, v));
        const int thing =
            hit.object < 0 ? -1 : things[static_cast<std::size_t>(hit.object)];
        if (thing != layer.thing(v, u) || (thing > 0 && hit.face != layer.face(v, u))) {
          ++differing; // single precision decides on the very edge
          continue;
        }
        if (thing >= 0) {
          // planes through corners that were turned in double
          EXPECT_NEAR(layer.depth(v, u), hit.distance, 1e-9 * hit.distance);
        }
      }
    EXPECT_LE(differing, 30) << "of " << size.area() << " pixels";
  }
}

TEST(Truth, BoxesHoldTheirMasksAndMasksTheirBoxes)
{
  const char* const things = R"(
sensor: {kind: ideal, width: 320, height: 240, fx: 300}
camera: {distance: [2, 4], elevation: [15, 70]}
area: [3, 3]
things:
  - {kind: [safety cone, hard hat, gas container, chair, plant, safety gloves], count: 5, tipped: 0.3}
  - {kind: [block, carton, slab], count: 3, size: [0.6, 0.5, 0.4], timbers: 0.5}
)";
  int clear = 0;
  for (int number = 0; number < 4; ++number) {
    const simulation::Scene scene = sceneOf(things, 5, number);
    const simulation::Frame frame = simulation::simulate(scene);
    for (const AnnotatedObject& object : frame.truth.objects) {
      SCOPED_TRACE(object.object_class + " of frame " + std::to_string(number));
      const Eigen::Matrix3d to_box = object.rotation.transpose();
      Eigen::AlignedBox2d seen;
      for (int v = 0; v < frame.instances.rows; ++v)
        for (int u = 0; u < frame.instances.cols; ++u) {
          if (frame.instances(v, u) != object.label)
            continue;
          seen.extend(Eigen::Vector2d(u, v));
          const Eigen::Vector3d p =
              frame.exact.depth(v, u) * scene.sensor.camera.ray(u, v);
          const Eigen::Vector3d inside = to_box * (p - object.center);
          ASSERT_TRUE(
              (inside.cwiseAbs().array() <= object.size.array() / 2 + 1e-6).all())
              << inside.transpose();
        }
      const std::array<double, 4>& box = *object.box_2d;
      EXPECT_EQ(seen.min().x(), box[0]);
      EXPECT_EQ(seen.min().y(), box[1]);
      EXPECT_EQ(seen.max().x() - seen.min().x() + 1, box[2]);
      EXPECT_EQ(seen.max().y() - seen.min().y() + 1, box[3]);
      if (!object.is_cuboid || object.difficult || *object.visible_fraction < 1)
        continue;
      // nothing hides it: its mask ends where its corners lie, but for the bevel
      Eigen::AlignedBox2d corners;
      for (int corner = 0; corner < 8; ++corner) {
        Eigen::Vector3d p = object.size / 2;
        for (int i = 0; i < 3; ++i)
          p[i] *= corner >> i & 1 ? 1 : -1;
        corners.extend(
            scene.sensor.camera.project(object.center + object.rotation * p));
      }
      if (!Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(319, 239))
               .contains(corners))
        continue;
      ++clear;
      const double slack =
          1 + 0.03 * 300 / object.center.z(); // 3 cm of bevel and chips
      EXPECT_LT((seen.min() - corners.min()).cwiseAbs().maxCoeff(), slack);
      EXPECT_LT((seen.max() - corners.max()).cwiseAbs().maxCoeff(), slack);
    }
  }
  EXPECT_GE(clear, 2);
}

TEST(Truth, VisibleFractionIsTheShareThatIsNotHidden)
{
  // two plates of one size square to the camera, the nearer hides half of the other
  const simulation::Scene scene = sceneOf(R"(
sensor: {kind: ideal, width: 320, height: 240, fx: 300}
camera: {eye: [0, 0, 50], target: [0, 1, 50]}
things:
  - {kind: box, name: far, size: [2, 0.1, 1], at: [0, 4.05], heading: 0, lift: 49.5, wear: 0}
  - {kind: box, name: near, size: [1, 0.1, 2], at: [0.5, 2.05], heading: 0, lift: 49, wear: 0}
)");
  const simulation::Frame frame = simulation::simulate(scene);
  ASSERT_EQ(frame.truth.objects.size(), 2U);
  const AnnotatedObject& far = frame.truth.objects[0];
  const AnnotatedObject& near = frame.truth.objects[1];
  // near spans x/z 0 ... 0.5 at its front, far -0.25 ... 0.25: the right half is
  // hidden; a column of pixels is 1/150 of it
  EXPECT_NEAR(*far.visible_fraction, 0.5, 0.01);
  EXPECT_DOUBLE_EQ(*near.visible_fraction, 1);
  EXPECT_EQ(*far.faces_visible, 1);
  EXPECT_TRUE((*far.observed_faces)[3]); // -y looks at the camera
}

} // namespace
} // namespace test
} // namespace hoist
