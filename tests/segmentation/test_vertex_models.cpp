// Vertex models I and II against boxes whose edges are known.
#include <hoist/segmentation/cuboid_lines.h>
#include <hoist/segmentation/endpoint_clustering.h>
#include <hoist/segmentation/vertex_models.h>

#include <support/cuboid_compare.h>

#include <pcl/exceptions.h>

#include <gtest/gtest.h>

#include <random>

namespace hoist {
namespace {

LineSegment
segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  LineSegment s;
  s.points = {a, b};
  for (int k = 0; k < 2; ++k)
    s.pixels[k] = (500 * s.points[k].head<2>() / s.points[k].z()).cast<float>();
  const Eigen::Vector2f run = (s.pixels[1] - s.pixels[0]).cwiseAbs();
  s.indices.resize(static_cast<std::size_t>(run.maxCoeff()) + 2);
  for (std::size_t i = 0; i < s.indices.size(); ++i)
    s.indices[i] = static_cast<int>(i);
  return s;
}

Cuboid
randomBox(std::mt19937& random)
{
  std::uniform_real_distribution<double> side(0.1, 0.6), at(-0.5, 0.5);
  Cuboid box;
  box.center = Eigen::Vector3d(at(random), at(random), 2.5 + at(random));
  // not Eigen's UnitRandom: it draws from rand(), so a test alone would differ from the
  // same test after others
  std::normal_distribution<double> normal;
  Eigen::Quaterniond turn;
  for (double& x : turn.coeffs())
    x = normal(random);
  box.axes = turn.normalized().toRotationMatrix();
  box.size = Eigen::Vector3d(side(random), side(random), side(random));
  return box;
}

// The edges numbered by Cuboid::edges(), with the ends swapped now and then.
std::vector<LineSegment>
edgesOf(const Cuboid& box, const std::vector<int>& which)
{
  const auto corners = box.corners();
  std::vector<LineSegment> out;
  for (const int e : which) {
    const auto& [a, b] = Cuboid::edges()[e];
    out.push_back(e % 2 == 0 ? segment(corners.col(a), corners.col(b))
                             : segment(corners.col(b), corners.col(a)));
  }
  return out;
}

std::vector<Cuboid>
findIn(const std::vector<LineSegment>& segments,
       Diagnostics& diagnostics,
       const VertexModels& models = {})
{
  EndpointClustering clustering;
  clustering.setDistanceThreshold(0.01);
  std::vector<Vertex> vertices;
  clustering.cluster(segments, vertices);
  std::vector<Cuboid> cuboids;
  models.find(segments, vertices, cuboids, diagnostics);
  return cuboids;
}

void
expectBox(const Cuboid& found, const Cuboid& truth)
{
  const test::CuboidErrors errors = test::compare(found, truth);
  EXPECT_LT(errors.center, 1e-12);
  EXPECT_LT(errors.maxSize(), 1e-12);
  EXPECT_LT(errors.rotation, 1e-7);
  EXPECT_NEAR(found.axes.determinant(), 1, 1e-12);
}

TEST(VertexModels, ModelOneIsTheBoxOfItsThreeEdges)
{
  std::mt19937 random(1);
  for (int seed = 0; seed < 50; ++seed) {
    const Cuboid box = randomBox(random);
    Diagnostics diagnostics;
    // corner 0 has the edges 0, 4 and 8
    const auto found = findIn(edgesOf(box, {0, 4, 8}), diagnostics);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].model, CuboidModel::vertex_one);
    EXPECT_EQ(found[0].segments, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(found[0].vertices, (std::vector<int>{0}));
    expectBox(found[0], box);
  }
}

TEST(VertexModels, ModelTwoIsTheBoxOfItsThreeEdges)
{
  std::mt19937 random(2);
  for (int seed = 0; seed < 50; ++seed) {
    const Cuboid box = randomBox(random);
    Diagnostics diagnostics;
    // edge 0 joins corners 0 and 1; edge 4 leaves corner 0, edge 9 corner 1
    const auto found = findIn(edgesOf(box, {0, 4, 9}), diagnostics);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].model, CuboidModel::vertex_two);
    EXPECT_EQ(found[0].vertices.size(), 2U);
    expectBox(found[0], box);
  }
}

TEST(VertexModels, AllTwelveEdgesGiveTheSameBoxManyTimes)
{
  std::mt19937 random(3);
  const Cuboid box = randomBox(random);
  Diagnostics diagnostics;
  auto found =
      findIn(edgesOf(box, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), diagnostics);
  // 8 corners; 12 edges, each with 2 * 2 neighbours, half of the pairs parallel
  EXPECT_EQ(found.size(), 8U + 12U * 2U);
  for (const Cuboid& cuboid : found) {
    expectBox(cuboid, box);
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(cuboid.dimension_source[i], DimensionSource::measured);
  }
  const std::size_t all = found.size();
  EXPECT_EQ(keepBestOfEachBox(found), all - 1);
  EXPECT_EQ(found.size(), 1U);
}

// What the doc promises for degrees above 3: every triple.
TEST(VertexModels, AnExtraSegmentAtTheVertexDoesNotHideTheBox)
{
  std::mt19937 random(4);
  const Cuboid box = randomBox(random);
  auto segments = edgesOf(box, {0, 4, 8});
  const Eigen::Vector3d corner = box.corners().col(0);
  segments.insert(segments.begin(),
                  segment(corner, corner + box.axes * Eigen::Vector3d(0.2, 0.2, 0.2)));
  Diagnostics diagnostics;
  const auto found = findIn(segments, diagnostics);
  ASSERT_EQ(found.size(), 1U);
  expectBox(found[0], box);
  EXPECT_EQ(diagnostics.counts["hypotheses"], 4U); // 4 choose 3
  EXPECT_EQ(diagnostics.rejected["model I: not perpendicular"], 3U);
}

// Equation (3): a cosine of 0.05 is 2.866 degrees.
TEST(VertexModels, TheToleranceIsTheCosineOfEquationThree)
{
  for (const double lean : {0.0, 2.5, 2.8, 2.95, 10.0}) {
    const double a = lean * M_PI / 180;
    const Eigen::Vector3d o(0, 0, 2);
    const std::vector<LineSegment> segments = {
        segment(o, o + Eigen::Vector3d(0.3, 0, 0)),
        segment(o, o + 0.2 * Eigen::Vector3d(std::sin(a), std::cos(a), 0)),
        segment(o, o + Eigen::Vector3d(0, 0, 0.4))};
    Diagnostics diagnostics;
    EXPECT_EQ(findIn(segments, diagnostics).size(), std::sin(a) <= 0.05 ? 1U : 0U)
        << lean;
  }
}

// Raw: |Delta i . Delta j| in square metres, so short segments at 45 degrees pass
// (0.2 * 0.2 * 0.707 = 0.028) and long ones at 88 degrees do not (2 * 2 * 0.035 =
// 0.14).
TEST(VertexModels, RawDeltaDependsOnTheLengths)
{
  const auto found = [](double length, double degrees, bool normalized) {
    const double a = degrees * M_PI / 180;
    const Eigen::Vector3d o(0, 0, 5);
    Diagnostics diagnostics;
    VertexModels models;
    models.setNormalized(normalized);
    return findIn(
               {segment(o, o + length * Eigen::Vector3d(1, 0, 0)),
                segment(o, o + length * Eigen::Vector3d(std::cos(a), std::sin(a), 0)),
                segment(o, o + length * Eigen::Vector3d(0, 0, 1))},
               diagnostics,
               models)
        .size();
  };
  EXPECT_EQ(found(0.2, 45, false), 1U);
  EXPECT_EQ(found(0.2, 45, true), 0U);
  EXPECT_EQ(found(2.0, 88, false), 0U);
  EXPECT_EQ(found(2.0, 88, true), 1U);
}

TEST(VertexModels, ParallelSegmentsAtBothEndsAreNoModel)
{
  std::mt19937 random(5);
  Diagnostics diagnostics;
  // a face's U: edges 4 and 5 are parallel
  EXPECT_TRUE(findIn(edgesOf(randomBox(random), {0, 4, 5}), diagnostics).empty());
  EXPECT_GT(diagnostics.rejected["model II: not perpendicular"], 0U);
}

TEST(VertexModels, VerticesOfVeryManySegmentsAreCountedAndLeftOut)
{
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d o(0, 0, 2);
  std::vector<LineSegment> segments;
  for (int i = 0; i < 80; ++i)
    segments.push_back(
        segment(o,
                o + Eigen::Vector3d(normal(random), normal(random), normal(random))
                        .normalized()));
  VertexModels models;
  EXPECT_EQ(models.getMaxDegree(), 64);
  Diagnostics diagnostics;
  EXPECT_TRUE(findIn(segments, diagnostics, models).empty());
  EXPECT_EQ(diagnostics.rejected["vertex of too many segments"], 1U);
  models.setMaxDegree(80);
  Diagnostics again;
  EXPECT_FALSE(findIn(segments, again, models).empty());
}

TEST(VertexModels, EdgesSeenFromCornerToCornerScoreBest)
{
  std::mt19937 random(8);
  const Cuboid box = randomBox(random);
  // edge 2 closes the far end of edge 8
  auto segments = edgesOf(box, {0, 4, 8, 5, 9, 2});
  // half of edge 8 only: another corner triple with a wrong size
  const auto corners = box.corners();
  segments.push_back(segment(corners.col(0), 0.5 * (corners.col(0) + corners.col(4))));
  Diagnostics diagnostics;
  auto found = findIn(segments, diagnostics);
  ASSERT_GT(found.size(), 1U);
  keepBestOfEachBox(found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(found[0].score, 0);
  EXPECT_LE(found[0].score, 1);
  expectBox(found[0], box);
}

TEST(VertexModels, ObservedFacesFaceTheCamera)
{
  std::mt19937 random(10);
  for (int seed = 0; seed < 30; ++seed) {
    const Cuboid box = randomBox(random);
    for (const auto& which : {std::vector<int>{0, 4, 8}, std::vector<int>{0, 4, 9}}) {
      Diagnostics diagnostics;
      const auto found = findIn(edgesOf(box, which), diagnostics);
      ASSERT_EQ(found.size(), 1U);
      const Cuboid& c = found[0];
      for (int f = 0; f < 6; ++f) {
        if (!c.observed_faces[f])
          continue;
        const Eigen::Vector3d normal = c.axes.col(f / 2) * (f % 2 == 0 ? 1 : -1);
        const Eigen::Vector3d at = c.center + normal * c.size[f / 2] / 2;
        EXPECT_LT(normal.dot(at), 0);
        // and two of the three edges lie in it
        int in_face = 0;
        for (const LineSegment& s : edgesOf(box, which))
          in_face += std::abs(normal.dot(s.points[0] - at)) < 1e-9 &&
                             std::abs(normal.dot(s.points[1] - at)) < 1e-9
                         ? 1
                         : 0;
        EXPECT_EQ(in_face, 2);
      }
    }
  }
}

TEST(VertexModels, RejectsNumbersOutOfRange)
{
  VertexModels models;
  EXPECT_THROW(models.setTolerance(-1), pcl::BadArgumentException);
  EXPECT_THROW(models.setMaxDegree(2), pcl::BadArgumentException);
  EXPECT_EQ(models.getTolerance(), 0.05);
  EXPECT_TRUE(models.getNormalized());
}

TEST(KeepBestOfEachBox, KeepsNeighbours)
{
  Cuboid a;
  a.center = {0, 0, 1};
  a.size = {0.2, 0.2, 0.2};
  a.score = 0.5;
  Cuboid beside = a, within = a;
  beside.center.x() += 0.2;
  within.center.x() += 0.05;
  within.score = 0.9;
  std::vector<Cuboid> cuboids = {a, beside, within};
  EXPECT_EQ(keepBestOfEachBox(cuboids), 1U);
  ASSERT_EQ(cuboids.size(), 2U);
  EXPECT_EQ(cuboids[0].score, 0.9);
  EXPECT_EQ(cuboids[1].center, beside.center);
}

TEST(AttachLines, NamesWhatLiesOnTheBoxAndNothingElse)
{
  std::mt19937 random(12);
  const Cuboid box = randomBox(random);
  auto segments = edgesOf(box, {0, 4, 8, 11});
  const auto corners = box.corners();
  // half an edge supports; a face's diagonal and an edge moved away do not
  segments.push_back(segment(corners.col(0), 0.5 * (corners.col(0) + corners.col(1))));
  segments.push_back(segment(corners.col(0), corners.col(3)));
  const Eigen::Vector3d away = 0.03 * box.axes.col(1);
  segments.push_back(segment(corners.col(2) + away, corners.col(3) + away));
  std::vector<Vertex> vertices(2);
  vertices[0].point = corners.col(5) + Eigen::Vector3d(0.005, 0, 0);
  vertices[1].point = box.center;
  std::vector<Cuboid> cuboids = {box};
  cuboids[0].segments = {99};
  attachLines(segments, vertices, 0.01, cuboids);
  EXPECT_EQ(cuboids[0].segments, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(cuboids[0].vertices, (std::vector<int>{0}));
}

} // namespace
} // namespace hoist
