// The rules and figures of `hoist evaluate`, against hand-made cases and an oracle that
// does the same in the slowest way.
#include "evaluate/calibration.h"
#include "evaluate/chart.h"
#include "evaluate/detection.h"
#include "evaluate/evaluation.h"
#include "evaluate/quantiles.h"
#include "evaluate/scenes.h"
#include "support/cuboid_compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace {

using hoist::AnnotatedObject;
using hoist::Detection;
using hoist::detectionOf;
using hoist::EvaluatedScene;
using hoist::EvaluateSettings;
using hoist::Evaluation;
using hoist::Prediction;
using hoist::ScoredVerdict;
using hoist::Verdict;

AnnotatedObject
unitTruth(double x, bool difficult = false)
{
  AnnotatedObject truth;
  truth.center = Eigen::Vector3d(x, 0, 0);
  truth.size.setOnes();
  truth.difficult = difficult;
  return truth;
}

Prediction
unitPrediction(double x, double score)
{
  Prediction prediction;
  prediction.center = Eigen::Vector3d(x, 0, 0);
  prediction.size.setOnes();
  prediction.score = score;
  return prediction;
}

std::vector<Verdict>
verdictsOf(const EvaluatedScene& scene, const EvaluateSettings& settings = {})
{
  std::vector<Verdict> out;
  for (const hoist::Match& match :
       matchScene(scene, overlapsOf(scene), settings.ious.front(), settings))
    out.push_back(match.verdict);
  return out;
}

TEST(Matching, OneHitPerThingAndDifficultOnesDoNotCount)
{
  EvaluatedScene scene;
  scene.truths = {unitTruth(0), unitTruth(5), unitTruth(10, true)};
  // exact, a second on the same, on the difficult one, on nothing, too far off
  scene.predictions = {unitPrediction(0, 0.9),
                       unitPrediction(0.05, 0.8),
                       unitPrediction(10.1, 0.7),
                       unitPrediction(20, 0.6),
                       unitPrediction(5.6, 0.5)};
  EXPECT_EQ(verdictsOf(scene),
            (std::vector<Verdict>{Verdict::hit,
                                  Verdict::wrong,
                                  Verdict::ignored,
                                  Verdict::wrong,
                                  Verdict::wrong}));
  // several on something difficult are all ignored
  scene.predictions = {unitPrediction(10, 0.9), unitPrediction(10.1, 0.8)};
  EXPECT_EQ(verdictsOf(scene),
            (std::vector<Verdict>{Verdict::ignored, Verdict::ignored}));
  // a small box inside of a large difficult one: IoU 0.125, but wholly inside
  scene.predictions = {unitPrediction(10, 0.9)};
  scene.predictions[0].size.setConstant(0.5);
  EXPECT_EQ(verdictsOf(scene), std::vector<Verdict>{Verdict::ignored});
  scene.truths[2].difficult = false;
  EXPECT_EQ(verdictsOf(scene), std::vector<Verdict>{Verdict::wrong});
}

TEST(Matching, TheLargestOverlapIsTakenAndClassesMustAgree)
{
  EvaluatedScene scene;
  scene.truths = {unitTruth(0), unitTruth(0.2)};
  scene.predictions = {unitPrediction(0.15, 0.9), unitPrediction(0.05, 0.8)};
  auto matches = matchScene(scene, overlapsOf(scene), 0.5, {});
  EXPECT_EQ(matches[0].truth, 1);
  EXPECT_EQ(matches[1].truth, 0);

  scene.truths[0].object_class = "bucket";
  scene.truths[1].object_class = "cone";
  scene.predictions[0].object_class = "bucket";
  scene.predictions[1].object_class = "chair";
  matches = matchScene(scene, overlapsOf(scene), 0.5, {});
  EXPECT_EQ(matches[0].truth, 0); // although the cone is nearer
  EXPECT_EQ(matches[1].verdict, Verdict::wrong);
  scene.predictions[1].object_class.clear(); // who names no class may hit any
  EXPECT_EQ(matchScene(scene, overlapsOf(scene), 0.5, {})[1].truth, 1);
}

TEST(Detection, HandMadeCurve)
{
  // hit wrong hit, of 4: precisions 1, 1/2, 2/3 at recalls 1/4, 1/4, 1/2
  const Detection d = detectionOf({{0.9, true}, {0.8, false}, {0.7, true}}, 4);
  EXPECT_EQ(d.all.hits, 2u);
  EXPECT_EQ(d.all.wrong, 1u);
  EXPECT_EQ(d.all.missed, 2u);
  EXPECT_DOUBLE_EQ(d.all.precision(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(d.all.recall(), 0.5);
  // recalls 0, 0.1, 0.2: 1; 0.3, 0.4, 0.5: 2/3; the rest is not reached
  EXPECT_NEAR(*d.average_precision, (3 + 3 * 2.0 / 3) / 11, 1e-12);
  EXPECT_EQ(d.best_score, 0.7); // F1 4/7 there, 2/5 at 0.9
}

TEST(Detection, NothingToFindAndNothingFound)
{
  const Detection none = detectionOf({}, 0);
  EXPECT_FALSE(none.average_precision || none.best_score);
  EXPECT_EQ(none.all.f1(), 0);
  const Detection wrong = detectionOf({{1, false}}, 0);
  EXPECT_FALSE(wrong.average_precision);
  EXPECT_EQ(wrong.all.wrong, 1u);
  const Detection missed = detectionOf({}, 3);
  EXPECT_EQ(*missed.average_precision, 0);
  EXPECT_EQ(missed.all.missed, 3u);
  const Detection all = detectionOf({{0.5, true}, {0.5, true}}, 2);
  EXPECT_DOUBLE_EQ(*all.average_precision, 1);
  EXPECT_DOUBLE_EQ(all.best.f1(), 1);
}

// A threshold cannot lie between predictions of the same score.
TEST(Detection, TheBestThresholdLiesBetweenDifferentScores)
{
  const Detection d =
      detectionOf({{0.9, true}, {0.5, true}, {0.5, false}, {0.5, false}}, 2);
  EXPECT_EQ(d.best_score, 0.9);
  EXPECT_DOUBLE_EQ(d.best.f1(), 2.0 / 3);
}

// ------------------------------------------------------------------- random scenes

double
uniform(std::mt19937& random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Eigen::Matrix3d
randomRotation(std::mt19937& random, double angle)
{
  const Eigen::Vector3d axis(
      uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0.1, 1));
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

std::vector<EvaluatedScene>
randomScenes(std::mt19937& random, int n)
{
  std::vector<EvaluatedScene> scenes;
  for (int s = 0; s < n; ++s) {
    EvaluatedScene scene;
    scene.name = "scene" + std::to_string(s);
    for (std::size_t j = random() % 5; j > 0; --j) {
      AnnotatedObject truth;
      truth.center = Eigen::Vector3d(uniform(random, -0.5, 0.5),
                                     uniform(random, -0.5, 0.5),
                                     uniform(random, 1, 3));
      truth.size = Eigen::Vector3d(uniform(random, 0.1, 0.4),
                                   uniform(random, 0.1, 0.4),
                                   uniform(random, 0.1, 0.4));
      truth.rotation = randomRotation(random, uniform(random, 0, 3));
      truth.difficult = random() % 4 == 0;
      truth.object_class = random() % 2 == 0 ? "slab" : "beam";
      truth.visible_fraction = uniform(random, 0, 1);
      scene.truths.push_back(truth);
      for (std::size_t k = random() % 3; k > 0; --k) {
        Prediction p;
        const double off = uniform(random, 0, 0.06);
        p.center = truth.center + off * Eigen::Vector3d(uniform(random, -1, 1),
                                                        uniform(random, -1, 1),
                                                        uniform(random, -1, 1));
        p.size = truth.size * uniform(random, 0.85, 1.15);
        p.rotation = truth.rotation * randomRotation(random, uniform(random, 0, 0.2));
        p.score = std::round(uniform(random, 0, 1) * 40) / 40; // some are equal
        scene.predictions.push_back(p);
      }
    }
    for (std::size_t k = random() % 2; k > 0; --k) {
      Prediction p = unitPrediction(uniform(random, -1, 1), uniform(random, 0, 0.7));
      p.size.setConstant(0.2);
      scene.predictions.push_back(p);
    }
    std::stable_sort(scene.predictions.begin(),
                     scene.predictions.end(),
                     [](const auto& a, const auto& b) { return a.score > b.score; });
    scenes.push_back(scene);
  }
  return scenes;
}

template <typename Box>
hoist::Cuboid
cuboidOf(const Box& box)
{
  hoist::Cuboid cuboid;
  cuboid.center = box.center;
  cuboid.size = box.size;
  cuboid.axes = box.rotation;
  return cuboid;
}

// The rules once more, with the overlap of the tests and one loop per sentence.
std::vector<std::vector<Verdict>>
oracle(const std::vector<EvaluatedScene>& scenes, double iou)
{
  std::vector<std::vector<Verdict>> out;
  for (const EvaluatedScene& scene : scenes) {
    out.emplace_back();
    std::set<std::size_t> taken;
    for (const Prediction& p : scene.predictions) {
      const hoist::Cuboid box = cuboidOf(p);
      double best = -1;
      std::size_t which = 0;
      for (std::size_t j = 0; j < scene.truths.size(); ++j) {
        const double shared = hoist::test::iou(box, cuboidOf(scene.truths[j]));
        if (!scene.truths[j].difficult && taken.count(j) == 0 && shared >= iou &&
            shared > best) {
          best = shared;
          which = j;
        }
      }
      if (best >= 0) {
        taken.insert(which);
        out.back().push_back(Verdict::hit);
        continue;
      }
      Verdict verdict = Verdict::wrong;
      for (const AnnotatedObject& truth : scene.truths)
        if (truth.difficult) {
          const hoist::Cuboid other = cuboidOf(truth);
          if (hoist::test::iou(box, other) >= std::min(iou, 0.25) ||
              hoist::test::intersectionVolume(box, other) >= 0.5 * box.volume())
            verdict = Verdict::ignored;
        }
      out.back().push_back(verdict);
    }
  }
  return out;
}

// Precision at each of the eleven recalls by trying every threshold between different
// scores.
double
apByThresholds(const std::vector<ScoredVerdict>& verdicts, std::size_t truths)
{
  double sum = 0;
  for (int i = 0; i <= 10; ++i) {
    double best = 0;
    for (const ScoredVerdict& threshold : verdicts) {
      double hits = 0, all = 0;
      for (const ScoredVerdict& v : verdicts)
        if (v.score >= threshold.score) {
          ++all;
          hits += v.hit ? 1 : 0;
        }
      if (10 * hits >= i * static_cast<double>(truths))
        best = std::max(best, hits / all);
    }
    sum += best;
  }
  return sum / 11;
}

TEST(Evaluation, AgreesWithTheOracleOnRandomScenes)
{
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    const auto scenes = randomScenes(random, 10);
    EvaluateSettings settings;
    settings.ious = {0.5, 0.25, 0.75};
    const Evaluation evaluation = hoist::evaluateScenes(scenes, settings);
    for (std::size_t level = 0; level < settings.ious.size(); ++level) {
      const auto expected = oracle(scenes, settings.ious[level]);
      std::size_t hits = 0, wrong = 0, ignored = 0, truths = 0;
      for (std::size_t s = 0; s < scenes.size(); ++s) {
        for (const AnnotatedObject& truth : scenes[s].truths)
          truths += truth.difficult ? 0 : 1;
        for (std::size_t i = 0; i < scenes[s].predictions.size(); ++i) {
          EXPECT_EQ(evaluation.matches[level][s][i].verdict, expected[s][i]);
          hits += expected[s][i] == Verdict::hit ? 1 : 0;
          wrong += expected[s][i] == Verdict::wrong ? 1 : 0;
          ignored += expected[s][i] == Verdict::ignored ? 1 : 0;
        }
      }
      const hoist::Level& figures = evaluation.overall.levels[level];
      EXPECT_EQ(figures.detection.all.hits, hits);
      EXPECT_EQ(figures.detection.all.wrong, wrong);
      EXPECT_EQ(figures.detection.all.missed, truths - hits);
      EXPECT_EQ(figures.ignored, ignored);
      // classes share out the things, and what no class is known of is left
      std::size_t in_classes = 0;
      for (const hoist::Group& group : evaluation.classes) {
        in_classes += group.levels[level].detection.all.hits;
        EXPECT_FALSE(group.precise);
      }
      EXPECT_EQ(in_classes, hits);
    }
  }
}

TEST(Evaluation, AveragePrecisionIsThatOfAllThresholds)
{
  std::mt19937 random(6);
  for (int round = 0; round < 200; ++round) {
    std::vector<ScoredVerdict> verdicts;
    for (std::size_t i = random() % 30; i > 0; --i)
      // all scores differ: the order of equal ones is a matter of convention
      verdicts.push_back({uniform(random, 0, 1), random() % 3 != 0});
    std::size_t hits = 0;
    for (const ScoredVerdict& v : verdicts)
      hits += v.hit ? 1 : 0;
    const std::size_t truths = hits + random() % 5;
    const Detection d = detectionOf(verdicts, truths);
    if (truths == 0)
      EXPECT_FALSE(d.average_precision);
    else
      EXPECT_NEAR(*d.average_precision, apByThresholds(verdicts, truths), 1e-12);
  }
}

TEST(Evaluation, ErrorsAreThoseOfTheTests)
{
  std::mt19937 random(7);
  const auto scenes = randomScenes(random, 60);
  const Evaluation evaluation = hoist::evaluateScenes(scenes, {});
  ASSERT_GT(evaluation.hits.size(), 30u);
  for (const hoist::Hit& hit : evaluation.hits) {
    const auto errors =
        hoist::test::compare(cuboidOf(scenes[hit.scene].predictions[hit.prediction]),
                             cuboidOf(scenes[hit.scene].truths[hit.truth]));
    EXPECT_NEAR(hit.errors.center.norm(), errors.center, 1e-9);
    EXPECT_NEAR(hit.errors.rotation, errors.rotation, 1e-9);
    EXPECT_LT((hit.errors.size - errors.size).norm(), 1e-9);
    EXPECT_GE(hit.iou, 0.5);
  }
}

TEST(Evaluation, BreakdownsShareOutEverything)
{
  std::mt19937 random(8);
  const auto scenes = randomScenes(random, 40);
  const Evaluation evaluation = hoist::evaluateScenes(scenes, {});
  const hoist::Counts& all = evaluation.overall.levels[0].detection.all;
  ASSERT_EQ(evaluation.breakdowns.size(), 2u); // no face is annotated
  for (const hoist::Breakdown& breakdown : evaluation.breakdowns) {
    hoist::Counts sum;
    std::size_t errors = 0;
    for (const hoist::Breakdown::Bin& bin : breakdown.bins) {
      EXPECT_LT(bin.from, bin.to);
      sum.hits += bin.counts.hits;
      sum.missed += bin.counts.missed;
      sum.wrong += bin.counts.wrong;
      errors += bin.errors.center.n;
    }
    EXPECT_EQ(sum.hits, all.hits) << breakdown.quantity;
    EXPECT_EQ(sum.missed, all.missed) << breakdown.quantity;
    EXPECT_EQ(sum.wrong, breakdown.precise ? all.wrong : 0) << breakdown.quantity;
    EXPECT_EQ(errors, evaluation.hits.size());
  }
}

TEST(Evaluation, ClassesHaveTheirOwnPrecision)
{
  EvaluatedScene scene;
  scene.truths = {unitTruth(0), unitTruth(5), unitTruth(10)};
  scene.truths[0].object_class = scene.truths[1].object_class = "bucket";
  scene.truths[2].object_class = "cone";
  scene.predictions = {
      unitPrediction(0, 0.9), unitPrediction(5, 0.8), unitPrediction(10, 0.7)};
  scene.predictions[0].object_class = "bucket";
  scene.predictions[1].object_class = "cone"; // a bucket taken for a cone
  scene.predictions[2].object_class = "cone";
  const Evaluation e = hoist::evaluateScenes({scene}, {});
  ASSERT_EQ(e.classes.size(), 2u);
  const hoist::Counts& bucket = e.classes[0].levels[0].detection.all;
  const hoist::Counts& cone = e.classes[1].levels[0].detection.all;
  EXPECT_TRUE(e.classes[0].precise && e.classes[1].precise);
  EXPECT_EQ(bucket.hits, 1u);
  EXPECT_EQ(bucket.wrong, 0u);
  EXPECT_EQ(bucket.missed, 1u);
  EXPECT_EQ(cone.hits, 1u);
  EXPECT_EQ(cone.wrong, 1u);
  // bucket: recalls 0 to 0.5 at precision 1; cone: all recalls at 1/2
  EXPECT_NEAR(*e.mean_ap, (6.0 / 11 + 0.5) / 2, 1e-12);
}

TEST(Evaluation, AttributesOfHits)
{
  EvaluatedScene scene;
  for (int i = 0; i < 4; ++i) {
    scene.truths.push_back(unitTruth(5 * i));
    scene.truths[i].base_rgb = {100, 100, 100};
    scene.truths[i].weight = 10;
    scene.predictions.push_back(unitPrediction(5 * i, 0.9));
  }
  scene.truths[0].material = scene.truths[1].material = "wood";
  scene.truths[0].fullness = true;
  scene.predictions[0].fullness = false;
  scene.predictions[0].rgb = {125, 75, 100}; // 25 of 255 is within 10 %
  scene.predictions[1].rgb = {126, 100, 100};
  scene.predictions[2].rgb = {100, 100, 100};
  scene.predictions[0].material = "wood";
  scene.predictions[0].weight = 12;
  scene.predictions.push_back(unitPrediction(40, 0.9)); // a wrong one does not count
  scene.predictions.back().rgb = {100, 100, 100};
  const Evaluation e = hoist::evaluateScenes({scene}, {});
  const hoist::Attributes& a = e.overall.attributes;
  EXPECT_EQ(a.color.truths, 4u);
  EXPECT_EQ(a.color.said, 3u);
  EXPECT_EQ(a.color.right, 2u);
  EXPECT_EQ(a.material.truths, 2u);
  EXPECT_EQ(a.material.right, 1u);
  EXPECT_EQ(a.fullness.truths, 1u);
  EXPECT_EQ(a.fullness.right, 0u);
  ASSERT_EQ(a.weight.size(), 1u);
  EXPECT_NEAR(a.weight[0], 0.2, 1e-12);
}

// ---------------------------------------------------------------------- calibration

TEST(Calibration, ScoresThatAreProbabilitiesHaveNoError)
{
  std::mt19937 random(9);
  std::vector<ScoredVerdict> honest, boastful;
  for (int i = 0; i < 40000; ++i) {
    const double p = uniform(random, 0, 1);
    const bool hit = uniform(random, 0, 1) < p;
    honest.push_back({p, hit});
    boastful.push_back({std::sqrt(p), hit});
  }
  const auto good = hoist::scoreCalibration(honest);
  EXPECT_EQ(good.n, 40000u);
  // a bin of 4000 has a standard deviation of at most 0.008
  EXPECT_LT(good.ece, 0.015);
  EXPECT_NEAR(good.brier, 1.0 / 6, 0.01); // the mean of p (1 - p)
  // mean of sqrt(p) - p is 1/6
  EXPECT_NEAR(hoist::scoreCalibration(boastful).ece, 1.0 / 6, 0.02);
}

TEST(Calibration, EdgesOfTheBins)
{
  const auto c = hoist::scoreCalibration(
      {{0, false}, {0.1, true}, {1, true}, {1.0001, true}, {-0.1, false}});
  EXPECT_EQ(c.bins[0].n, 1u);
  EXPECT_EQ(c.bins[1].n, 1u);
  EXPECT_EQ(c.bins[9].n, 1u);
  EXPECT_EQ(c.out_of_range, 2u);
  EXPECT_NEAR(c.ece, 0.9 / 3, 1e-12);
  EXPECT_EQ(hoist::scoreCalibration({}).n, 0u);
}

TEST(Calibration, NormalErrorsAreWithinTheirSigmas)
{
  std::mt19937 random(10);
  std::normal_distribution<double> normal;
  std::vector<double> ratios, twice;
  for (int i = 0; i < 20000; ++i) {
    ratios.push_back(normal(random));
    twice.push_back(2 * ratios.back());
  }
  const auto good = hoist::sigmaCalibration("x", ratios);
  // five standard deviations of a share of 20000
  EXPECT_NEAR(good.within_1, 0.6827, 0.017);
  EXPECT_NEAR(good.within_2, 0.9545, 0.008);
  EXPECT_NEAR(good.rms, 1, 0.03);
  EXPECT_NEAR(good.factor, 1, 0.03);
  const auto small = hoist::sigmaCalibration("x", twice); // sigmas half as large
  EXPECT_NEAR(small.rms, 2, 0.06);
  EXPECT_NEAR(small.factor, 2, 0.06);
}

TEST(Calibration, SidesAreComparedAlongTheirOwnAxes)
{
  // found with other names of the axes: its third side is the truth's first
  EvaluatedScene scene;
  AnnotatedObject truth = unitTruth(0);
  truth.size = Eigen::Vector3d(1, 2, 3);
  scene.truths = {truth};
  Prediction p = unitPrediction(0, 1);
  p.size = Eigen::Vector3d(2, 3, 1.1);
  p.rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  p.size_sigma = Eigen::Vector3d(0.5, NAN, 0.05);
  p.dimension_source = {"measured", "partial", "measured"};
  scene.predictions = {p};
  const Evaluation e = hoist::evaluateScenes({scene}, {});
  ASSERT_EQ(e.sigmas.size(), 1u);
  EXPECT_EQ(e.sigmas[0].quantity, "side");
  ASSERT_EQ(e.sigmas[0].n, 2u); // no sigma, no ratio
  EXPECT_NEAR(e.sigmas[0].sorted[0], 0, 1e-9);
  EXPECT_NEAR(e.sigmas[0].sorted[1], 2, 1e-9); // 0.1 of 0.05
}

TEST(Quantiles, AreLinearBetweenRanks)
{
  EXPECT_DOUBLE_EQ(hoist::quantile({1, 2, 4}, 0.5), 2);
  EXPECT_DOUBLE_EQ(hoist::quantile({1, 2, 4}, 0.75), 3);
  EXPECT_DOUBLE_EQ(hoist::quantile({7}, 0.9), 7);
  EXPECT_TRUE(std::isnan(hoist::quantile({}, 0.5)));
  EXPECT_DOUBLE_EQ(hoist::summaryOf({4, 1, 2}).median, 2);
  EXPECT_DOUBLE_EQ(hoist::summaryOf({4, 1, 2}).max, 4);
}

TEST(NaturalOrder, IsAnOrderAndCountsDigits)
{
  std::vector<std::string> names = {"b",
                                    "a10",
                                    "a2",
                                    "a02",
                                    "",
                                    "a",
                                    "a2b",
                                    "test1/7",
                                    "test1/10",
                                    "a100000000000000000000"};
  std::sort(names.begin(), names.end(), hoist::naturallyLess);
  EXPECT_EQ(names,
            (std::vector<std::string>{"",
                                      "a",
                                      "a02",
                                      "a2",
                                      "a2b",
                                      "a10",
                                      "a100000000000000000000",
                                      "b",
                                      "test1/7",
                                      "test1/10"}));
  for (const std::string& a : names)
    for (const std::string& b : names)
      EXPECT_EQ(hoist::naturallyLess(a, b) + hoist::naturallyLess(b, a) + (a == b), 1);
}

TEST(Chart, DrawsWhatIsNotFiniteOrFarAwayToo)
{
  hoist::Chart chart("title", "x", "y");
  chart.setRangeX(0, 0); // is no range
  chart.setRangeY(-1, NAN);
  const cv::Mat3b empty = chart.draw();
  chart.addLine({{0, 0}, {NAN, 1}, {1e300, -1e300}, {0.5, INFINITY}},
                hoist::chartColor(0),
                std::string(300, 'x'));
  chart.addDots({}, hoist::chartColor(7), "");
  const cv::Mat3b full = chart.draw();
  ASSERT_EQ(full.size(), empty.size());
  EXPECT_GT(cv::norm(full, empty), 0);
}

} // namespace
