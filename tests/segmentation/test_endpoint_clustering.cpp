// Vertices against the comparison of all pairs (paper 4.2.3).
#include <hoist/segmentation/endpoint_clustering.h>

#include <pcl/exceptions.h>
#include <pcl/search/brute_force.h>

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>
#include <set>

namespace hoist {
namespace {

LineSegment
segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  LineSegment s;
  s.points = {a, b};
  return s;
}

using EndSet = std::set<std::pair<int, int>>;

std::set<EndSet>
asSets(const std::vector<Vertex>& vertices)
{
  std::set<EndSet> sets;
  for (const Vertex& vertex : vertices) {
    EndSet ends;
    for (const SegmentEnd& end : vertex.ends)
      ends.emplace(end.segment, end.end);
    sets.insert(ends);
  }
  return sets;
}

// The definition: components of "distance of ends of two segments <= D", all pairs.
std::set<EndSet>
bruteForce(const std::vector<LineSegment>& segments, double distance)
{
  const int n = 2 * static_cast<int>(segments.size());
  std::vector<int> label(n);
  for (int i = 0; i < n; ++i)
    label[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
        if (i / 2 != k / 2 && label[i] > label[k] &&
            (segments[i / 2].points[i % 2] - segments[k / 2].points[k % 2]).norm() <=
                distance) {
          label[i] = label[k];
          changed = true;
        }
  }
  std::map<int, EndSet> groups;
  for (int i = 0; i < n; ++i)
    groups[label[i]].emplace(i / 2, i % 2);
  std::set<EndSet> sets;
  for (const auto& [unused, ends] : groups)
    if (ends.begin()->first != ends.rbegin()->first)
      sets.insert(ends);
  return sets;
}

class ClusteringOracle : public testing::TestWithParam<int> {};

TEST_P(ClusteringOracle, EqualsAllPairs)
{
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  std::uniform_real_distribution<double> at(-0.4, 0.4);
  std::uniform_int_distribution<int> grid(-13, 13);
  std::vector<LineSegment> segments;
  for (int i = 0; i < 150; ++i) {
    // half of the ends on a grid of D, where pairs lie at exactly the threshold
    const auto end = [&]() -> Eigen::Vector3d {
      if (i % 2 == 0)
        return {0.03 * grid(random), 0.03 * grid(random), 1.5};
      return {at(random), at(random), 1.5 + 0.1 * at(random)};
    };
    segments.push_back(segment(end(), end()));
  }
  EndpointClustering clustering;
  for (const double distance : {0.0, 0.01, 0.03, 0.06}) {
    clustering.setDistanceThreshold(distance);
    std::vector<Vertex> vertices;
    clustering.cluster(segments, vertices);
    EXPECT_EQ(asSets(vertices), bruteForce(segments, distance)) << "D = " << distance;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClusteringOracle, testing::Range(0, 25));

TEST(EndpointClustering, TheThresholdBelongsToTheCluster)
{
  const double d = 0.03;
  const std::vector<LineSegment> at = {segment({0, 0, 1}, {-1, 0, 1}),
                                       segment({d, 0, 1}, {1, 1, 1})};
  EndpointClustering clustering;
  EXPECT_EQ(clustering.getDistanceThreshold(), d);
  std::vector<Vertex> vertices;
  clustering.cluster(at, vertices);
  EXPECT_EQ(vertices.size(), 1U);
  const std::vector<LineSegment> beyond = {
      segment({0, 0, 1}, {-1, 0, 1}),
      segment({std::nextafter(d, 1.0), 0, 1}, {1, 1, 1})};
  clustering.cluster(beyond, vertices);
  EXPECT_TRUE(vertices.empty());
}

TEST(EndpointClustering, EndsOfOneSegmentMeetOnlyThroughOthers)
{
  const std::vector<LineSegment> alone = {segment({0, 0, 1}, {0.02, 0, 1})};
  EndpointClustering clustering;
  std::vector<Vertex> vertices;
  clustering.cluster(alone, vertices);
  EXPECT_TRUE(vertices.empty());
  const std::vector<LineSegment> bridged = {segment({0, 0, 1}, {0.02, 0, 1}),
                                            segment({0.01, 0, 1}, {1, 0, 1})};
  clustering.cluster(bridged, vertices);
  ASSERT_EQ(vertices.size(), 1U);
  EXPECT_EQ(vertices[0].ends.size(), 3U);
  EXPECT_EQ(vertices[0].aggregationDegree(), 2);
  EXPECT_LT((vertices[0].point - Eigen::Vector3d(0.01, 0, 1)).norm(), 1e-12);
}

TEST(EndpointClustering, SkipsEndsThatAreNotFinite)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<LineSegment> segments = {segment({0, 0, 1}, {nan, 0, 1}),
                                             segment({0, 0.01, 1}, {1, 1, nan})};
  std::vector<Vertex> vertices;
  EndpointClustering().cluster(segments, vertices);
  ASSERT_EQ(vertices.size(), 1U);
  EXPECT_EQ(vertices[0].ends.size(), 2U);
}

TEST(EndpointClustering, ClearsItsOutput)
{
  std::vector<Vertex> vertices(4);
  EndpointClustering().cluster({}, vertices);
  EXPECT_TRUE(vertices.empty());
}

TEST(EndpointClustering, AnySearchGivesTheSame)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<double> at(-0.3, 0.3);
  std::vector<LineSegment> segments;
  for (int i = 0; i < 100; ++i)
    segments.push_back(
        segment({at(random), at(random), 1}, {at(random), at(random), 1}));
  EndpointClustering tree, brute;
  brute.setSearchMethod(pcl::make_shared<pcl::search::BruteForce<pcl::PointXYZ>>());
  std::vector<Vertex> first, second;
  tree.cluster(segments, first);
  brute.cluster(segments, second);
  EXPECT_EQ(asSets(first), asSets(second));
  EXPECT_FALSE(first.empty());
}

TEST(EndpointClustering, RejectsThresholdsOutOfRange)
{
  EndpointClustering clustering;
  EXPECT_THROW(clustering.setDistanceThreshold(-0.1), pcl::BadArgumentException);
  EXPECT_THROW(clustering.setDistanceThreshold(std::nan("")),
               pcl::BadArgumentException);
  EXPECT_THROW(clustering.setSearchMethod(nullptr), pcl::BadArgumentException);
  EXPECT_EQ(clustering.getDistanceThreshold(), 0.03);
}

} // namespace
} // namespace hoist
