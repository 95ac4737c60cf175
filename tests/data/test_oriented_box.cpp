// Overlap and errors of boxes: analytic cases, points thrown at random, laws.
#include "support/cuboid_compare.h"

#include <hoist/data/oriented_box.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using hoist::boxErrors;
using hoist::intersectionOverUnion;
using hoist::intersectionVolume;
using hoist::ObjectSymmetry;
using hoist::OrientedBox;

using Random = std::mt19937;

double
uniform(Random& random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Matrix3d
randomRotation(Random& random)
{
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

OrientedBox
randomBox(Random& random)
{
  return {Vector3d(uniform(random, -0.1, 0.1),
                   uniform(random, -0.1, 0.1),
                   uniform(random, -0.1, 0.1)),
          Vector3d(uniform(random, 0.05, 0.35),
                   uniform(random, 0.05, 0.35),
                   uniform(random, 0.05, 0.35)),
          randomRotation(random)};
}

OrientedBox
moved(const OrientedBox& box, const Eigen::Isometry3d& motion, double scale = 1)
{
  return {motion * (scale * box.center), scale * box.size, motion.linear() * box.axes};
}

Matrix3d
aboutZ(double degrees)
{
  return Eigen::AngleAxisd(degrees * M_PI / 180, Vector3d::UnitZ()).toRotationMatrix();
}

hoist::Cuboid
cuboidOf(const OrientedBox& box)
{
  hoist::Cuboid cuboid;
  cuboid.center = box.center;
  cuboid.size = box.size;
  cuboid.axes = box.axes;
  return cuboid;
}

struct Case {
  const char* name;
  OrientedBox a, b;
  double iou;
};

std::vector<Case>
analyticCases()
{
  const Matrix3d one = Matrix3d::Identity();
  const OrientedBox unit({0, 0, 0}, {1, 1, 1}, one);
  const double octagon =
      2 * std::sqrt(2.0) - 2; // a unit square and itself at 45 degrees
  return {
      {"identical", unit, unit, 1},
      {"half shift", unit, {{0.5, 0, 0}, {1, 1, 1}, one}, 1.0 / 3},
      {"touching", unit, {{1, 0, 0}, {1, 1, 1}, one}, 0},
      {"touching at an edge", unit, {{1, 1, 0}, {1, 1, 1}, one}, 0},
      {"apart", unit, {{3, 0, 0}, {1, 1, 1}, one}, 0},
      {"apart, within reach", unit, {{1.2, 0, 0}, {1, 1, 1}, one}, 0},
      {"inside", unit, {{0.1, 0, 0}, {0.5, 0.5, 0.5}, one}, 0.125},
      {"inside, one common face", unit, {{0.25, 0, 0}, {0.5, 1, 1}, one}, 0.5},
      {"a corner", unit, {{0.5, 0.5, 0.5}, {1, 1, 1}, one}, 0.125 / 1.875},
      {"45 degrees", unit, {{0, 0, 0}, {1, 1, 1}, aboutZ(45)}, octagon / (2 - octagon)},
      {"90 degrees, sides swapped",
       {{0, 0, 0}, {1, 2, 3}, one},
       {{0, 0, 0}, {2, 1, 3}, aboutZ(90)},
       1},
      {"a cross of bars",
       {{0, 0, 0}, {0.1, 4, 0.1}, one},
       {{0, 0, 0}, {4, 0.1, 0.1}, one},
       0.001 / (0.08 - 0.001)},
  };
}

TEST(BoxOverlap, AnalyticCasesInAnyPoseAndScale)
{
  Random random(1);
  for (const Case& c : analyticCases())
    for (int k = 0; k < 30; ++k) {
      Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
      double scale = 1;
      if (k > 0) {
        motion.linear() = randomRotation(random);
        motion.translation() = Vector3d(
            uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3));
        scale = std::pow(10, uniform(random, -2, 2));
      }
      const OrientedBox a = moved(c.a, motion, scale), b = moved(c.b, motion, scale);
      // what a tolerance of 1e-9 of the sides can add up to
      EXPECT_NEAR(intersectionOverUnion(a, b), c.iou, 1e-8) << c.name << ' ' << k;
      EXPECT_NEAR(intersectionOverUnion(b, a), c.iou, 1e-8) << c.name << ' ' << k;
    }
}

// Points are thrown at random: the share of a's that fall into b.
TEST(BoxOverlap, AgreesWithPointsThrownAtRandom)
{
  Random random(2);
  constexpr int throws = 20000;
  for (int pair = 0; pair < 60; ++pair) {
    const OrientedBox a = randomBox(random), b = randomBox(random);
    int inside = 0;
    for (int i = 0; i < throws; ++i) {
      const Vector3d local(uniform(random, -0.5, 0.5),
                           uniform(random, -0.5, 0.5),
                           uniform(random, -0.5, 0.5));
      const Vector3d p = a.center + a.axes * local.cwiseProduct(a.size);
      const Vector3d q = b.axes.transpose() * (p - b.center);
      inside += (q.cwiseAbs() - b.size / 2).maxCoeff() <= 0 ? 1 : 0;
    }
    const double share = static_cast<double>(inside) / throws;
    const double exact = intersectionVolume(a, b) / a.volume();
    // five standard deviations of a binomial count, at least that of one hit
    const double sigma =
        std::sqrt(std::max(exact * (1 - exact), 1.0 / throws) / throws);
    EXPECT_NEAR(share, exact, 5 * sigma) << pair;
  }
}

TEST(BoxOverlap, AgreesWithTheOracleOfTheTests)
{
  Random random(3);
  for (int pair = 0; pair < 500; ++pair) {
    const OrientedBox a = randomBox(random), b = randomBox(random);
    EXPECT_NEAR(
        intersectionOverUnion(a, b), hoist::test::iou(cuboidOf(a), cuboidOf(b)), 1e-9);
  }
}

TEST(BoxOverlap, Laws)
{
  Random random(4);
  for (int pair = 0; pair < 300; ++pair) {
    const OrientedBox a = randomBox(random);
    OrientedBox b = randomBox(random);
    const double iou = intersectionOverUnion(a, b);
    EXPECT_GE(iou, 0);
    EXPECT_LE(iou, 1);
    EXPECT_NEAR(iou, intersectionOverUnion(b, a), 1e-9);
    EXPECT_NEAR(intersectionOverUnion(a, a), 1, 1e-9);
    // another name for the same axes is no other box
    for (const Matrix3d& naming : hoist::axisNamings()) {
      const OrientedBox named(
          b.center, (naming.transpose() * b.size).cwiseAbs(), b.axes * naming);
      EXPECT_NEAR(intersectionOverUnion(a, named), iou, 1e-9);
    }
    // what grows shares no less
    const double before = intersectionVolume(a, b);
    b.size *= 1.1;
    EXPECT_GE(intersectionVolume(a, b), before - 1e-12);
  }
}

// Faces that are nearly common: turned or moved by what rounding makes, and by more.
TEST(BoxOverlap, NearlyCommonFacesCountOnce)
{
  const OrientedBox a({0.3, -0.2, 1.5}, {0.4, 0.3, 0.2}, aboutZ(17));
  for (double step = 1e-16; step < 1e-5; step *= 3) {
    OrientedBox b = a;
    b.center.x() += step;
    b.axes = b.axes * aboutZ(step);
    // the volume changes by less than step times surface, 0.52 m^2 of 0.024 m^3
    EXPECT_NEAR(intersectionOverUnion(a, b), 1, 1e-8 + 50 * step) << step;
  }
}

TEST(BoxOverlap, LeftHandedAxesNameTheSameBox)
{
  const Matrix3d axes = aboutZ(30);
  Matrix3d mirrored = axes;
  mirrored.col(1) *= -1;
  const OrientedBox a({0, 0, 2}, {0.3, 0.2, 0.1}, axes),
      b({0, 0, 2}, {0.3, 0.2, 0.1}, mirrored);
  EXPECT_GT(b.axes.determinant(), 0);
  EXPECT_NEAR(intersectionOverUnion(a, b), 1, 1e-9);
}

TEST(BoxErrors, AreKnownUnderEveryNaming)
{
  const OrientedBox truth({0, 0, 1}, {0.1, 0.2, 0.3}, aboutZ(10));
  ASSERT_EQ(hoist::axisNamings().size(), 24u);
  for (const Matrix3d& naming : hoist::axisNamings()) {
    const Vector3d size = truth.size + Vector3d(0.001, -0.002, 0.003);
    const OrientedBox found(Vector3d(0.002, 0, 1.003),
                            (naming.transpose() * size).cwiseAbs(),
                            aboutZ(12) * naming);
    const hoist::BoxErrors errors = boxErrors(found, truth);
    EXPECT_LT((errors.center - Vector3d(0.002, 0, 0.003)).norm(), 1e-12);
    EXPECT_LT((errors.size - Vector3d(0.001, -0.002, 0.003)).norm(), 1e-12);
    EXPECT_NEAR(errors.rotation, 2 * M_PI / 180, 1e-12);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(found.size[errors.axis[i]], size[i], 1e-12);
  }
}

// No turn takes a box further from itself than 62.8 degrees: that of the cube's group.
TEST(BoxErrors, RotationIsTheSmallestOfAll)
{
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const OrientedBox a = randomBox(random), b = randomBox(random);
    const double rotation = boxErrors(a, b).rotation;
    EXPECT_LE(rotation, 62.8 * M_PI / 180);
    EXPECT_NEAR(rotation, boxErrors(b, a).rotation, 1e-9);
    double least = M_PI;
    for (const Matrix3d& naming : hoist::axisNamings()) {
      const Eigen::AngleAxisd turn(
          Matrix3d(b.axes.transpose() * a.axes * naming)); // in [0, pi]
      least = std::min(least, turn.angle());
    }
    EXPECT_NEAR(rotation, least, 1e-7); // acos near 1 keeps half of the digits
  }
}

TEST(BoxErrors, ATurnAboutTheAxisOfSymmetryIsNoError)
{
  Random random(6);
  const std::array<ObjectSymmetry, 3> kinds = {
      ObjectSymmetry::axis0, ObjectSymmetry::axis1, ObjectSymmetry::axis2};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 50; ++i) {
      Vector3d size(0.3, 0.3, 0.3);
      size[k] = 0.45; // a bucket: round, higher than wide
      const OrientedBox truth(Vector3d(0, 0, 2), size, randomRotation(random));
      const Matrix3d turn = Eigen::AngleAxisd(uniform(random, -3, 3), Vector3d::Unit(k))
                                .toRotationMatrix();
      const Matrix3d tilt =
          Eigen::AngleAxisd(0.05, Vector3d::Unit((k + 1) % 3)).toRotationMatrix();
      const auto& naming = hoist::axisNamings()[static_cast<std::size_t>(i % 24)];
      const OrientedBox found(truth.center,
                              (naming.transpose() * size).cwiseAbs(),
                              truth.axes * tilt * turn * naming);
      const hoist::BoxErrors errors = boxErrors(found, truth, kinds[k]);
      EXPECT_NEAR(errors.rotation, 0.05, 1e-9);
      EXPECT_LT(errors.size.norm(), 1e-9);
      EXPECT_NEAR(found.size[errors.axis[k]], 0.45, 1e-12);
    }
}

} // namespace
