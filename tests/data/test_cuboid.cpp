// Cuboids: canonical naming, and the comparison that all other tests rely on.
#include <hoist/data/cuboid.h>

#include <support/cuboid_compare.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <random>

namespace {

using hoist::canonicalize;
using hoist::Cuboid;
using hoist::test::compare;
using hoist::test::cubeRotations;
using hoist::test::iou;
using hoist::test::renamed;

Cuboid
randomCuboid(unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(0.05, 1.0), place(-1, 1);
  Cuboid c;
  c.axes = Eigen::Quaterniond(
               place(random), place(random), place(random), place(random) + 1.1)
               .normalized()
               .toRotationMatrix();
  c.size = {side(random), side(random), side(random)};
  // every fourth: two or three sides of the same length, or noise within their sigma
  if (seed % 4 == 1)
    c.size[1] = c.size[0];
  if (seed % 4 == 2)
    c.size[1] = c.size[2] = c.size[0];
  if (seed % 4 == 3) {
    c.size_sigma = Eigen::Vector3d::Constant(0.01);
    c.size[1] = c.size[0] + 0.003;
    c.size[2] = c.size[0] + 0.02;
  }
  c.center = {place(random), place(random), 2 + place(random)};
  c.dimension_source = {hoist::DimensionSource::measured,
                        hoist::DimensionSource::partial,
                        hoist::DimensionSource::support};
  c.observed_faces = {true, false, false, true, true, false};
  return c;
}

// The corners as a set: sorted columns.
std::vector<std::array<double, 3>>
cornerSet(const Cuboid& c)
{
  std::vector<std::array<double, 3>> set;
  const auto corners = c.corners();
  for (int k = 0; k < 8; ++k)
    set.push_back({corners(0, k), corners(1, k), corners(2, k)});
  std::sort(set.begin(), set.end());
  return set;
}

// Outward normals of the observed faces, each with its dimension's source.
std::vector<std::array<double, 4>>
faceSet(const Cuboid& c)
{
  std::vector<std::array<double, 4>> set;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d n = (i % 2 == 0 ? 1.0 : -1.0) * c.axes.col(i / 2);
    if (c.observed_faces[i])
      set.push_back(
          {n.x(), n.y(), n.z(), static_cast<double>(c.dimension_source[i / 2])});
  }
  std::sort(set.begin(), set.end());
  return set;
}

class Canonical : public testing::TestWithParam<unsigned> {};

TEST_P(Canonical, EveryNamingGivesTheSameBox)
{
  const Cuboid box = randomCuboid(GetParam());
  Cuboid reference = box;
  canonicalize(reference);
  for (const Eigen::Matrix3d& m : cubeRotations())
    for (const bool mirrored : {false, true}) {
      Cuboid c = renamed(box, m);
      // left-handed input, as an eigenvector solver gives it
      if (mirrored) {
        c.axes.col(1) *= -1;
        std::swap(c.observed_faces[2], c.observed_faces[3]);
      }
      canonicalize(c);
      EXPECT_LT((c.axes - reference.axes).norm(), 1e-9);
      EXPECT_LT((c.size - reference.size).norm(), 1e-12);
      EXPECT_EQ(c.observed_faces, reference.observed_faces);
      EXPECT_EQ(c.dimension_source, reference.dimension_source);
    }
}

TEST_P(Canonical, IsTheSameBoxInTheConvention)
{
  const Cuboid box = randomCuboid(GetParam());
  Cuboid c = box;
  canonicalize(c);
  EXPECT_NEAR(c.axes.determinant(), 1.0, 1e-9);
  const double slack =
      std::isfinite(c.size_sigma[0]) ? 0.0142 : 1e-9; // hypot(.01, .01)
  EXPECT_GE(c.size[0], c.size[1] - slack);
  EXPECT_GE(c.size[1], c.size[2] - slack);
  const auto before = cornerSet(box), after = cornerSet(c);
  for (int k = 0; k < 8; ++k)
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(before[k][i], after[k][i], 1e-9);
  const auto faces = faceSet(box), faces_after = faceSet(c);
  ASSERT_EQ(faces.size(), faces_after.size());
  for (std::size_t k = 0; k < faces.size(); ++k)
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(faces[k][i], faces_after[k][i], 1e-9);
  Cuboid again = c;
  canonicalize(again);
  EXPECT_EQ(again.axes, c.axes);
  EXPECT_EQ(again.size, c.size);
  EXPECT_EQ(again.observed_faces, c.observed_faces);
}

TEST_P(Canonical, NoiseDoesNotFlipTheAxes)
{
  // The same box seen twice with an error well below its sigmas: the axes must agree
  // up to that error, unless the first view was on the edge of a tie, which the seeds
  // with distinct sides are checked not to be.
  Cuboid a = randomCuboid(4 * GetParam()); // distinct sides
  a.size = {0.6, 0.4, 0.2};
  a.size_sigma = Eigen::Vector3d::Constant(0.01);
  Cuboid b = a;
  b.size += Eigen::Vector3d(0.002, -0.003, 0.001);
  b.axes = Eigen::AngleAxisd(1e-4, Eigen::Vector3d(1, 2, 2).normalized()) * b.axes;
  canonicalize(a);
  canonicalize(b);
  EXPECT_LT((a.axes - b.axes).norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Canonical, testing::Range(1u, 41u));

TEST(Canonical, TiesDoNotDependOnNaming)
{
  // Axis-aligned and half-turned boxes with equal sides, a chain of sides in which each
  // is like the next but the first not like the last, and an up along the camera's x.
  const Eigen::Matrix3d half_turned =
      Eigen::AngleAxisd(EIGEN_PI / 4, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d tilted =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX()) * half_turned;
  for (const Eigen::Matrix3d& axes :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), half_turned, tilted})
    for (const Eigen::Vector3d& size : {Eigen::Vector3d(0.3, 0.3, 0.3),
                                        Eigen::Vector3d(0.3, 0.2, 0.3),
                                        Eigen::Vector3d(0.30, 0.31, 0.32)})
      for (const Eigen::Vector3d& up :
           {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(1, 0, 0)}) {
        Cuboid box;
        box.axes = axes;
        box.size = size;
        box.size_sigma = Eigen::Vector3d::Constant(0.01);
        Cuboid reference = box;
        canonicalize(reference, up);
        for (const Eigen::Matrix3d& m : cubeRotations()) {
          Cuboid c = renamed(box, m);
          canonicalize(c, up);
          EXPECT_LT((c.axes - reference.axes).norm(), 1e-9)
              << axes << "\nsize " << size.transpose() << " up " << up.transpose();
          EXPECT_LT((c.size - reference.size).norm(), 1e-12);
        }
      }
}

TEST(Canonical, UpDecidesWhichEndIsTheTop)
{
  Cuboid c;
  c.size = {0.6, 0.4, 0.2};
  c.axes = Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  canonicalize(c); // height along y: it points up, along -y
  EXPECT_NEAR(c.axes(1, 2), -1.0, 1e-12);
  canonicalize(c, {0, 1, 0}); // and down when down is up
  EXPECT_NEAR(c.axes(1, 2), 1.0, 1e-12);
}

TEST(Compare, IsBlindToNaming)
{
  const Cuboid box = randomCuboid(8);
  ASSERT_EQ(cubeRotations().size(), 24u);
  for (const Eigen::Matrix3d& m : cubeRotations()) {
    const auto errors = compare(renamed(box, m), box);
    EXPECT_LT(errors.center + errors.rotation + errors.maxSize(), 1e-12);
    EXPECT_NEAR(iou(renamed(box, m), box), 1.0, 1e-12);
  }
}

TEST(Compare, SeesKnownErrors)
{
  const Cuboid box = randomCuboid(4);
  Cuboid other = box;
  other.center += Eigen::Vector3d(0.03, 0, 0.04);
  other.size[1] += 0.01;
  other.axes = Eigen::AngleAxisd(0.02, Eigen::Vector3d(0, 0.6, 0.8)) * other.axes;
  const auto errors = compare(renamed(other, cubeRotations()[7]), box);
  EXPECT_NEAR(errors.center, 0.05, 1e-12);
  EXPECT_NEAR(errors.rotation, 0.02, 1e-9);
  EXPECT_NEAR(errors.size[1], 0.01, 1e-12);
  EXPECT_NEAR(errors.size[0], 0.0, 1e-12);
}

TEST(Compare, IouOfKnownOverlaps)
{
  Cuboid a;
  a.size = {2, 2, 2};
  Cuboid b = a;
  b.center.x() = 1; // half of each: 4 / 12
  EXPECT_NEAR(iou(a, b), 1.0 / 3, 1e-12);
  b.center.x() = 2; // they touch
  EXPECT_NEAR(iou(a, b), 0.0, 1e-12);
  b.center.x() = 5;
  EXPECT_EQ(iou(a, b), 0.0);
  b = a;
  b.size = {1, 1, 1}; // inside
  EXPECT_NEAR(iou(a, b), 1.0 / 8, 1e-12);
  // turned by 45 degrees: a regular octagon of area 8 (sqrt 2 - 1)
  b = a;
  b.axes = Eigen::AngleAxisd(EIGEN_PI / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double shared = 2 * 8 * (std::sqrt(2.0) - 1);
  EXPECT_NEAR(iou(a, b), shared / (16 - shared), 1e-9);
}

TEST(Compare, IouAgreesWithCounting)
{
  // Monte Carlo as an oracle: 200000 points, standard error about 0.002
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  for (unsigned seed = 4; seed < 40; seed += 4) {
    const Cuboid a = randomCuboid(seed);
    Cuboid b = randomCuboid(seed + 100);
    b.center = a.center + Eigen::Vector3d(0.05, -0.05, 0.03);
    int inside = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d p =
          a.center + a.axes * a.size.cwiseProduct(Eigen::Vector3d(
                                  unit(random), unit(random), unit(random)));
      const Eigen::Vector3d q = b.axes.transpose() * (p - b.center);
      inside += (q.cwiseAbs().array() <= b.size.array() / 2).all() ? 1 : 0;
    }
    EXPECT_NEAR(hoist::test::intersectionVolume(a, b) / a.volume(),
                static_cast<double>(inside) / n,
                0.006);
  }
}

} // namespace
