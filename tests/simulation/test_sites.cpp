// How things are placed, and what happens to them between two visits.
#include "simulated.h"

#include <hoist/simulation/suites.h>

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace hoist {
namespace test {
namespace {

using simulation::Scene;
using simulation::Thing;

TEST(Site, CuboidsDoNotRunThroughEachOther)
{
  for (const char* name : {"crane-tof", "table-kinect"}) {
    const simulation::Suite& suite = *simulation::findSuite(name);
    const auto description = simulation::parseDescription(suite.yaml, name);
    for (int number = 0; number < 30; ++number) {
      const Scene scene = simulation::makeScene(description, 7, number);
      for (std::size_t i = 0; i < scene.things.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const Thing &a = scene.things[i], &b = scene.things[j];
          if (!a.is_cuboid || !b.is_cuboid)
            continue;
          // separating axes of two boxes; touching is no overlap
          const Eigen::Vector3d way = b.center() - a.center();
          double gap = -1e9;
          const auto test = [&](const Eigen::Vector3d& axis) {
            if (axis.norm() < 1e-9)
              return;
            const Eigen::Vector3d n = axis.normalized();
            const auto reach = [&](const Thing& t) {
              return (t.axes().transpose() * n).cwiseAbs().dot(t.box_size / 2);
            };
            gap = std::max(gap, std::abs(way.dot(n)) - reach(a) - reach(b));
          };
          for (int k = 0; k < 3; ++k) {
            test(a.axes().col(k));
            test(b.axes().col(k));
            for (int l = 0; l < 3; ++l)
              test(a.axes().col(k).cross(b.axes().col(l)));
          }
          EXPECT_GT(gap, -1e-6)
              << name << " " << number << ": " << a.name << " and " << b.name;
        }
    }
  }
}

TEST(Site, ThingsStandOnSomething)
{
  const simulation::Suite& suite = *simulation::findSuite("crane-tof");
  const auto description = simulation::parseDescription(suite.yaml, "x");
  int stacked = 0;
  for (int number = 0; number < 20; ++number) {
    const Scene scene = simulation::makeScene(description, 11, number);
    std::map<std::string, const Thing*> named;
    for (const Thing& thing : scene.things)
      EXPECT_TRUE(named.emplace(thing.name, &thing).second) << thing.name;
    for (const Thing& thing : scene.things) {
      if (!thing.annotated)
        continue;
      double low = 1e9;
      for (const Eigen::Vector3d& vertex : thing.mesh->vertices)
        low = std::min(low, (thing.pose * vertex).z());
      double expected = 0;
      if (!thing.supported_by.empty()) {
        ++stacked;
        const Thing& below = *named.at(thing.supported_by);
        expected = below.center().z() +
                   (below.axes().row(2).cwiseAbs() * below.box_size / 2).value();
      }
      // on top of what it names; else on the ground or on timbers of 0.1 m
      EXPECT_TRUE(std::abs(low - expected) < 1e-6 ||
                  (thing.supported_by.empty() && std::abs(low - 0.1) < 1e-6))
          << thing.name << " at " << low << ", not " << expected;
    }
  }
  EXPECT_GT(stacked, 3);
}

TEST(Scene, DependsOnSeedAndNumberOnly)
{
  const simulation::Suite& suite = *simulation::findSuite("worksite-train");
  const auto description = simulation::parseDescription(suite.yaml, "x");
  const Scene a = simulation::makeScene(description, 5, 3);
  const Scene b = simulation::makeScene(description, 5, 3);
  const Scene c = simulation::makeScene(description, 6, 3);
  const Scene d = simulation::makeScene(description, 5, 4);
  ASSERT_EQ(a.things.size(), b.things.size());
  for (std::size_t i = 0; i < a.things.size(); ++i) {
    EXPECT_EQ(a.things[i].pose.matrix(), b.things[i].pose.matrix());
    EXPECT_EQ(a.things[i].mesh->vertices.size(), b.things[i].mesh->vertices.size());
  }
  EXPECT_EQ(a.sensor_to_world.matrix(), b.sensor_to_world.matrix());
  EXPECT_NE(a.sensor_to_world.matrix(), c.sensor_to_world.matrix());
  EXPECT_NE(a.sensor_to_world.matrix(), d.sensor_to_world.matrix());
}

TEST(Visits, StatusSaysWhatDiffers)
{
  const simulation::Suite& suite = *simulation::findSuite("site-revisit");
  const auto description = simulation::parseDescription(suite.yaml, "x");
  const int frames = description.frames_per_visit;
  std::map<ObjectStatus, int> seen;
  for (int site = 0; site < 6; ++site) {
    std::size_t added = 0;
    const int first = site * 2 * frames;
    const Scene before = simulation::makeScene(description, suite.seed, first);
    const Scene after = simulation::makeScene(description, suite.seed, first + frames);
    const Scene later =
        simulation::makeScene(description, suite.seed, first + frames + 9);
    EXPECT_EQ(before.visit, 1);
    EXPECT_EQ(after.visit, 2);
    EXPECT_EQ(after.index, 0);
    EXPECT_EQ(later.index, 9);
    EXPECT_EQ(before.sequence, after.sequence);
    std::map<int, Thing> old;
    for (const Thing& thing : before.things)
      if (thing.annotated)
        old[thing.label] = thing;
    std::set<int> now;
    for (const Thing& thing : after.things) {
      if (!thing.annotated)
        continue;
      now.insert(thing.label);
      ASSERT_TRUE(thing.status.has_value());
      ++seen[*thing.status];
      added += *thing.status == ObjectStatus::added ? 1 : 0;
      const auto was = old.find(thing.label);
      switch (*thing.status) {
      case ObjectStatus::added:
        EXPECT_EQ(was, old.end());
        break;
      case ObjectStatus::moved:
        ASSERT_NE(was, old.end());
        EXPECT_EQ(thing.previous->matrix(), was->second.pose.matrix());
        EXPECT_GT((thing.center() - was->second.center()).norm(), 0.1);
        break;
      case ObjectStatus::unchanged:
        ASSERT_NE(was, old.end());
        EXPECT_EQ(thing.pose.matrix(), was->second.pose.matrix());
        break;
      case ObjectStatus::removed:
        ADD_FAILURE() << thing.name << " is there";
        break;
      }
    }
    for (const Thing& thing : after.removed) {
      ++seen[ObjectStatus::removed];
      EXPECT_EQ(now.count(thing.label), 0U);
      EXPECT_EQ(old.count(thing.label), 1U);
    }
    EXPECT_EQ(old.size() + added - after.removed.size(), now.size());
    ASSERT_EQ(after.things.size(), later.things.size());
    for (std::size_t i = 0; i < after.things.size(); ++i)
      EXPECT_EQ(after.things[i].label, later.things[i].label);
  }
  EXPECT_GT(seen[ObjectStatus::added], 0);
  EXPECT_GT(seen[ObjectStatus::removed], 0);
  EXPECT_GT(seen[ObjectStatus::moved], 0);
  EXPECT_GT(seen[ObjectStatus::unchanged], 10);
}

TEST(Visits, NoTwoThingsShareAName)
{
  // one named by the description, and enough coming and going that numbers could meet
  const auto description = simulation::parseDescription(
      "visits: {count: 4, frames: 1, new: 0.6, moved: 0.2, removed: 0.5}\n"
      "area: [12, 12]\n"
      "things:\n"
      "  - {kind: block, name: first, count: 4, size: [0.5, 0.4, 0.3], timbers: 0.5}\n"
      "  - {kind: carton, count: 6}\n",
      "x");
  std::size_t removed = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (int visit = 0; visit < 4; ++visit) {
      const Scene scene = simulation::makeScene(description, seed, visit);
      removed += scene.removed.size();
      std::set<std::string> names;
      for (const Thing& thing : scene.things)
        EXPECT_TRUE(names.insert(thing.name).second)
            << thing.name << ", seed " << seed << ", visit " << visit + 1;
      for (const Thing& thing : scene.removed)
        EXPECT_TRUE(names.insert(thing.name).second)
            << thing.name << " was removed, seed " << seed << ", visit " << visit + 1;
    }
  EXPECT_GT(removed, 50U);
}

TEST(Classes, FullnessIsWhatProtrudes)
{
  for (const char* kind : {"bucket", "recycle bin"})
    for (std::uint64_t seed = 0; seed < 30; ++seed)
      for (const bool full : {false, true}) {
        simulation::ThingRequest request;
        request.kind = kind;
        request.full = full;
        simulation::Random random(seed);
        const Thing thing = simulation::makeThing(request, random);
        ASSERT_EQ(thing.full, full);
        EXPECT_TRUE(thing.annotated);
        EXPECT_FALSE(thing.substance.empty());
        const double top = thing.box_center.z() + thing.box_size.z() / 2;
        const double most = thing.mesh->bounds().max().z();
        if (full) {
          EXPECT_GT(most, top + 0.02) << kind << " " << seed;
        }
        else if (std::string(kind) == "recycle bin") { // a bucket's bail may stand up
          EXPECT_LT(most, top + 1e-6) << kind << " " << seed;
        }
      }
}

TEST(Classes, SizesAreThoseOfRealThings)
{
  // the longest side of what can be bought [m]
  const std::map<std::string, std::pair<double, double>> sizes = {
      {"safety cone", {0.25, 1.1}},
      {"hard hat", {0.24, 0.42}},
      {"bucket", {0.2, 0.65}},
      {"recycle bin", {0.25, 1.25}},
      {"safety gloves", {0.2, 0.4}},
      {"gas container", {0.25, 1.6}},
      {"chair", {0.6, 1.2}},
      {"plant", {0.2, 2.0}}};
  for (const auto& [kind, range] : sizes)
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      simulation::ThingRequest request;
      request.kind = kind;
      simulation::Random random(seed);
      const Thing thing = simulation::makeThing(request, random);
      EXPECT_GE(thing.box_size.maxCoeff(), range.first) << kind << " " << seed;
      EXPECT_LE(thing.box_size.maxCoeff(), range.second) << kind << " " << seed;
      EXPECT_GT(thing.weight(), 0) << kind;
    }
}

} // namespace
} // namespace test
} // namespace hoist
