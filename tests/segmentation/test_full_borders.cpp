// Why a face ends: the outlines of a carton whose surroundings are known.
#include "test_full_prepared.h"

#include <gtest/gtest.h>

namespace hoist {
namespace {

using test::cartonBeforeWall;
using test::coveredCarton;
using test::Prepared;

struct Count {
  int right = 0, all = 0;
};

// Outline elements of box 0, sorted by what truly lies beyond their pixel side.
std::map<BorderKind, Count>
outlineOf(const Prepared& p, const samples::Scene& scene)
{
  std::map<BorderKind, Count> counts;
  const samples::Patch& ground =
      scene.patches.empty() ? samples::Patch{} : scene.patches.front();
  std::vector<int> objects;
  for (int f = 0; f < static_cast<int>(p.faces.size()); ++f)
    objects.push_back(p.shows(f).first);
  for (const BorderElement& e : p.borders.elements) {
    if (objects[e.face] != 0)
      continue;
    const Eigen::Vector3d point = e.point.cast<double>();
    const double pixel = point.z() / scene.camera.fx;
    // the pixel on the other side
    const Eigen::Vector2d q = scene.camera.project(point);
    const Eigen::Vector2d out =
        scene.camera.project(point + 0.01 * e.outward.cast<double>()) - q;
    Eigen::Vector2d step(0, 0);
    const double fu = e.pixel.x() - std::floor(e.pixel.x());
    const int k = fu > 0.25 && fu < 0.75 ? 0 : 1; // which side of the pixel it is
    step[k] = out[k] > 0 ? 0.5 : -0.5;
    const int u = static_cast<int>(std::lround(e.pixel.x() + step.x()));
    const int v = static_cast<int>(std::lround(e.pixel.y() + step.y()));
    BorderKind truth = BorderKind::open;
    if (u < 0 || v < 0 || u >= scene.width || v >= scene.height)
      truth = BorderKind::cut;
    else if (p.frame.object(v, u) < 0)
      truth = BorderKind::open;
    else if (p.frame.object(v, u) == 0)
      truth = BorderKind::crease; // another face of the box
    else if (p.frame.object(v, u) < static_cast<int>(scene.boxes.size()))
      truth = BorderKind::occluded;
    else {
      // on the ground it is a crease, above it a jump; in between: nobody's business
      const double height = std::abs(ground.axes.col(2).dot(point - ground.center));
      if (height > 1.5 * pixel && height < 10 * pixel)
        continue;
      truth = height < pixel ? BorderKind::crease : BorderKind::jump;
    }
    ++counts[truth].all;
    counts[truth].right += e.kind == truth ? 1 : 0;
  }
  return counts;
}

TEST(FaceBorders, SayWhyAFaceEnds)
{
  using K = BorderKind;
  const auto expect = [](const samples::Scene& scene, std::vector<K> kinds) {
    auto counts = outlineOf(Prepared(scene), scene);
    for (const K kind : kinds) {
      // A pixel beside a crease the two planes differ by their slopes, which on a frame
      // without noise is more than the noise: there some creases pass for steps.
      const double share = kind == K::crease ? 0.85 : 1;
      EXPECT_GT(counts[kind].all, 50) << static_cast<int>(kind);
      EXPECT_GE(counts[kind].right, share * counts[kind].all) << static_cast<int>(kind);
    }
    counts = outlineOf(Prepared(scene, 1, 1), scene);
    for (const K kind : kinds)
      EXPECT_GE(counts[kind].right, 0.9 * counts[kind].all) << static_cast<int>(kind);
  };
  expect(cartonBeforeWall(), {K::crease, K::jump});
  expect(coveredCarton(), {K::crease, K::jump, K::occluded});

  samples::Scene afloat = cartonBeforeWall();
  afloat.patches.clear();
  expect(afloat, {K::crease, K::open});

  samples::Scene cut = cartonBeforeWall();
  cut.camera.cx -= 330; // moves the carton over the left side of the image
  expect(cut, {K::crease, K::jump, K::cut});
}

TEST(FaceBorders, AreLaidOutFaceByFace)
{
  const Prepared p(coveredCarton());
  ASSERT_EQ(p.borders.first.size(), p.faces.size() + 1);
  EXPECT_EQ(p.borders.first.front(), 0);
  EXPECT_EQ(p.borders.first.back(), static_cast<int>(p.borders.elements.size()));
  for (int f = 0; f < static_cast<int>(p.faces.size()); ++f)
    for (int i = p.borders.first[f]; i < p.borders.first[f + 1]; ++i) {
      const BorderElement& e = p.borders.elements[i];
      ASSERT_EQ(e.face, f);
      const PlanarFace& face = p.faces[f];
      // on the plane, and outwards within it
      ASSERT_NEAR(face.normal.dot(e.point.cast<double>()) + face.offset, 0, 1e-5);
      ASSERT_NEAR(face.normal.dot(e.outward.cast<double>()), 0, 1e-4);
      ASSERT_NEAR(e.outward.norm(), 1, 1e-5);
    }
}

TEST(FaceBorders, AMaskCutsAsTheImageDoes)
{
  const samples::Scene scene = cartonBeforeWall();
  Prepared p(scene);
  cv::Mat1b mask(scene.height, scene.width, static_cast<unsigned char>(255));
  mask.colRange(0, scene.width / 2).setTo(0);
  for (int v = 0; v < scene.height; ++v)
    for (int u = 0; u < scene.width / 2; ++u)
      p.labels(v, u) = 0;
  findFaceBorders(p.labels,
                  p.frame.images.inverse_depth,
                  mask,
                  scene.camera,
                  p.sensor,
                  p.faces,
                  p.borders);
  int at_mask = 0;
  for (const BorderElement& e : p.borders.elements)
    if (e.pixel.x() < scene.width / 2.0F) {
      EXPECT_EQ(e.kind, BorderKind::cut);
      ++at_mask;
    }
  EXPECT_EQ(at_mask, scene.height); // every row of an endless scene is cut once
}

} // namespace
} // namespace hoist
