// Verification, refinement and selection of boxes on scenes whose answer is known.
#include "test_full_prepared.h"

#include <hoist/segmentation/cuboid_selection.h>

#include <gtest/gtest.h>

namespace hoist {
namespace {

using test::cartonBeforeWall;
using test::coveredCarton;
using test::hypothesis;
using test::Prepared;

Cuboid
cuboid(const CuboidHypothesis& h)
{
  Cuboid c;
  c.center = h.center();
  c.axes = h.axes;
  c.size = h.size();
  return c;
}

TEST(CuboidVerification, TheTrueBoxScoresHighAndWrongOnesDoNot)
{
  const samples::Scene scene = cartonBeforeWall();
  const Prepared p(scene);
  const CuboidHypothesis truth = hypothesis(scene.boxes[0]);
  const CuboidEvidence evidence = p.verify(truth, p.sensor);
  const double score = evidence.score;
  const double supported = evidence.supported() * evidence.stride * evidence.stride;
  EXPECT_GT(score, 0.95);
  const Eigen::Vector3d up = scene.patches[0].axes.col(2);
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      SCOPED_TRACE(testing::Message() << "axis " << axis << " side " << side);
      const double step = side * truth.size()[axis];
      const auto end = [&](CuboidHypothesis h, double t) {
        (side > 0 ? h.upper : h.lower)[axis] += t * step;
        return h;
      };
      // Below ground nothing is seen: a longer box is no worse there.
      const bool ground = truth.axes.col(axis).dot(up) * side < -0.99;
      const double longer = p.verify(end(truth, 0.2), p.sensor).score;
      EXPECT_LT(longer, ground ? score + 1e-9 : score - 0.3);
      const bool visible = p.verify(truth, p.sensor).visible[2 * axis + (side + 1) / 2];
      // A visible face moved inwards is covered by the true one, which says little;
      // that the box explains fewer pixels is what selection sees.
      const CuboidEvidence shorter = p.verify(end(truth, -0.2), p.sensor);
      EXPECT_LT(shorter.score, visible ? score : 0.1);
      EXPECT_LT(shorter.supported() * shorter.stride * shorter.stride,
                0.95 * supported);
      CuboidHypothesis shifted = truth;
      shifted.upper[axis] += 0.5 * step;
      shifted.lower[axis] += 0.5 * step;
      EXPECT_LT(p.verify(shifted, p.sensor).score, 0.1);
    }
  // afloat before the true one, and behind it
  for (const double t : {-0.15, 0.15}) {
    CuboidHypothesis moved = truth;
    const Eigen::Vector3d shift =
        t * (truth.axes.transpose() * truth.center().normalized());
    moved.lower += shift;
    moved.upper += shift;
    EXPECT_LT(p.verify(moved, p.sensor).score, 0.01) << t;
  }
}

TEST(CuboidVerification, CountsWhatTheFrameSays)
{
  const samples::Scene scene = cartonBeforeWall();
  const Prepared p(scene);
  CuboidHypothesis h = hypothesis(scene.boxes[0]);
  const CuboidEvidence truth = p.verify(h, p.sensor);
  int visible = 0;
  for (int f = 0; f < 6; ++f) {
    visible += truth.visible[f] ? 1 : 0;
    const FaceEvidence& e = truth.faces[f];
    if (!truth.visible[f]) {
      EXPECT_EQ(e.support + e.occluded + e.contradiction + e.missing, 0);
      continue;
    }
    EXPECT_GT(e.support, 50);
    EXPECT_EQ(e.contradiction + e.occluded + e.missing, 0);
    EXPECT_DOUBLE_EQ(e.flat, 1);
  }
  EXPECT_EQ(visible, 3);
  EXPECT_DOUBLE_EQ(truth.outline, 1);
  EXPECT_EQ(static_cast<int>(truth.support.size()), truth.supported());
  for (const int index : truth.support)
    EXPECT_EQ(p.frame.object(index / scene.width, index % scene.width), 0);

  // moved towards the camera the sensor sees through it, moved away it is covered
  const Eigen::Vector3d ray = h.axes.transpose() * h.center().normalized();
  for (const double t : {-0.2, 0.2}) {
    CuboidHypothesis moved = h;
    moved.lower += t * ray;
    moved.upper += t * ray;
    const CuboidEvidence e = p.verify(moved, p.sensor);
    int against = 0, covered = 0, all = 0;
    for (const FaceEvidence& f : e.faces) {
      against += f.contradiction;
      covered += f.occluded;
      all += f.support + f.occluded + f.contradiction + f.missing;
    }
    EXPECT_GT(t < 0 ? against : covered, 0.9 * all) << t;
  }
}

TEST(CuboidVerification, WhatCoversABoxIsNotHeldAgainstIt)
{
  const samples::Scene scene = coveredCarton();
  const Prepared p(scene);
  const CuboidHypothesis truth = hypothesis(scene.boxes[0]);
  const CuboidEvidence e = p.verify(truth, p.sensor);
  int occluded = 0, all = 0;
  for (const FaceEvidence& f : e.faces) {
    occluded += f.occluded;
    all += f.support + f.occluded + f.contradiction + f.missing;
  }
  EXPECT_GT(occluded, 0.1 * all);
  const double alone = Prepared(cartonBeforeWall()).verify(truth, p.sensor).score;
  EXPECT_GT(e.score, 0.97 * alone);
}

TEST(CuboidVerification, BehindTheCameraIsNothing)
{
  const samples::Scene scene = cartonBeforeWall();
  const Prepared p(scene);
  CuboidHypothesis h = hypothesis(scene.boxes[0]);
  const Eigen::Vector3d back = h.axes.transpose() * Eigen::Vector3d(0, 0, -3);
  h.lower += back;
  h.upper += back;
  const CuboidEvidence e = p.verify(h, p.sensor);
  EXPECT_EQ(e.score, 0);
  EXPECT_TRUE(e.support.empty());
}

CuboidHypothesis
perturbed(const CuboidHypothesis& truth,
          double shift,
          double angle,
          samples::Random& random)
{
  CuboidHypothesis h = truth;
  const auto direction = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal())
        .normalized();
  };
  const Eigen::Vector3d center = h.center();
  h.axes = Eigen::AngleAxisd(angle, direction()).toRotationMatrix() * h.axes;
  const Eigen::Vector3d middle = h.axes.transpose() * (center + shift * direction());
  const Eigen::Vector3d half =
      truth.size() / 2 + shift / 2 * Eigen::Vector3d(direction());
  h.lower = middle - half;
  h.upper = middle + half;
  return h;
}

// One fit reaches as far as its gates: some sigma and a pixel and a half. Hypotheses
// start there. From farther off it takes a coarse model of the sensor first.
TEST(CuboidRefinement, ComesBackToTheTruth)
{
  const samples::Scene scene = cartonBeforeWall();
  const Prepared p(scene);
  const CuboidHypothesis truth = hypothesis(scene.boxes[0]);
  struct Start {
    double shift, angle, scale;
  };
  for (const Start& start :
       {Start{0.002, 0.3 * test::degree, 1}, Start{0.005, 0.75 * test::degree, 5}}) {
    samples::Random random(1);
    for (int k = 0; k < 20; ++k) {
      SCOPED_TRACE(testing::Message() << start.shift << " m, start " << k);
      CuboidHypothesis h = perturbed(truth, start.shift, start.angle, random);
      CuboidCovariance c;
      SensorModel rough;
      for (rough.scale = start.scale; rough.scale > 0.5; rough.scale /= 2)
        for (int pass = 0; pass < 2; ++pass)
          ASSERT_TRUE(p.refine(h, rough, c));
      ASSERT_TRUE(p.refine(h, p.sensor, c));
      const auto e = test::compare(cuboid(h), cuboid(truth));
      EXPECT_LT(e.center, 1e-4);
      EXPECT_LT(e.maxSize(), 1e-4);
      EXPECT_LT(e.rotation, 0.01 * test::degree);
    }
  }
}

TEST(CuboidRefinement, SigmaFollowsTheNoise)
{
  const samples::Scene scene = cartonBeforeWall();
  const Prepared p(scene);
  const CuboidHypothesis truth = hypothesis(scene.boxes[0]);
  CuboidCovariance sigma[2];
  for (int k = 0; k < 2; ++k) {
    SensorModel model;
    model.scale = k + 1;
    CuboidHypothesis h = truth;
    ASSERT_TRUE(p.refine(h, model, sigma[k]));
  }
  // turns come from depth alone; outlines are off by a share of a pixel besides
  const double turn = sigma[1].rotation / sigma[0].rotation;
  EXPECT_GT(turn, 1.7);
  EXPECT_LT(turn, 2.05);
  const double center = sigma[1].center.norm() / sigma[0].center.norm();
  EXPECT_GT(center, 1.02);
  EXPECT_LT(center, 2.05);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(sigma[1].size[i], 1.02 * sigma[0].size[i]);
    EXPECT_LT(sigma[1].size[i], 2.05 * sigma[0].size[i]);
  }
}

// Independent noise spreads less than the correlated noise that sigma speaks of.
TEST(CuboidRefinement, SigmaCoversTheSpread)
{
  const samples::Scene scene = cartonBeforeWall();
  const CuboidHypothesis truth = hypothesis(scene.boxes[0]);
  double center = 0, size = 0, turn = 0;
  constexpr int n = 12;
  for (int seed = 1; seed <= n; ++seed) {
    const Prepared p(scene, 1, seed);
    CuboidHypothesis h = truth;
    CuboidCovariance c;
    ASSERT_TRUE(p.refine(h, p.sensor, c));
    const auto e = test::compare(cuboid(h), cuboid(truth));
    center += e.center * e.center / c.center.squaredNorm() / n;
    size += e.size.squaredNorm() / c.size.squaredNorm() / n;
    turn += e.rotation * e.rotation / (c.rotation * c.rotation) / n;
  }
  for (const double square : {center, size, turn}) {
    EXPECT_LT(std::sqrt(square), 1);
    EXPECT_GT(std::sqrt(square), 0.05); // and does not exaggerate without bounds
  }
}

TEST(CuboidRefinement, RefusesWithoutEvidence)
{
  const samples::Scene scene = cartonBeforeWall();
  const Prepared p(scene);
  CuboidHypothesis h = hypothesis(scene.boxes[0]);
  const Eigen::Vector3d up = h.axes.transpose() * Eigen::Vector3d(0, -0.5, 0);
  h.lower += up;
  h.upper += up;
  const CuboidHypothesis before = h;
  CuboidCovariance c;
  EXPECT_FALSE(p.refine(h, p.sensor, c));
  EXPECT_EQ(h.lower, before.lower); // as it was
  EXPECT_EQ(h.axes, before.axes);
}

CuboidCandidate
candidate(double left, double width, double score, int pixels)
{
  CuboidCandidate c;
  c.hypothesis.lower = {left, 0, 1};
  c.hypothesis.upper = {left + width, 1, 2};
  c.evidence.score = score;
  c.evidence.trust = 1;
  c.evidence.faces[0].support = pixels;
  return c;
}

TEST(CuboidSelection, TakesTheSetThatExplainsTheMost)
{
  std::vector<int> chosen;
  const auto select = [&](std::vector<CuboidCandidate> candidates) {
    selectCuboids(candidates, chosen);
    for (std::size_t i = 0; i < candidates.size(); ++i) // the losers are told why
      EXPECT_EQ(candidates[i].rejected == nullptr,
                std::count(chosen.begin(), chosen.end(), static_cast<int>(i)) == 1);
  };
  // the whole against two halves
  select({candidate(0, 2, 0.9, 1000),
          candidate(0, 1, 0.95, 600),
          candidate(1, 1, 0.98, 600)});
  // the halves explain 1158 together, but each exchange alone is a loss
  EXPECT_EQ(chosen, (std::vector<int>{0}));
  select({candidate(0, 2, 0.9, 500),
          candidate(0, 1, 0.95, 600),
          candidate(1, 1, 0.98, 600)});
  EXPECT_EQ(chosen, (std::vector<int>{2, 1})); // best score first
  // what was rejected before does not stand in the way of another
  CuboidCandidate bad = candidate(0, 1, 0.9, 900);
  bad.rejected = "score below the minimum";
  select({bad, candidate(0.1, 1, 0.6, 100)});
  EXPECT_EQ(chosen, (std::vector<int>{1}));
  // too much alike
  select({candidate(0, 1, 0.7, 900), candidate(0.1, 1, 0.9, 900)});
  EXPECT_EQ(chosen, (std::vector<int>{1}));
  // neighbours that touch do not exclude each other
  select({candidate(0, 1, 0.7, 900), candidate(0.9, 1, 0.9, 900)});
  EXPECT_EQ(chosen.size(), 2U);
  select({});
  EXPECT_TRUE(chosen.empty());
}

} // namespace
} // namespace hoist
