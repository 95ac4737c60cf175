// What a user may ask of the full mode: sizes, a catalogue, single faces, a support.
#include "test_full_prepared.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hoist {
namespace {

using samples::View;

// A camera that looks straight down on a box: of the box its top alone is seen.
struct Overhead {
  samples::Scene scene;
  Cuboid truth;
  Eigen::Vector4d ground; // in the camera frame

  Overhead(const Eigen::Vector3d& size, double degrees, bool with_ground)
  {
    const double eye = 1.5;
    View view = View::lookAt({0, -1e-6, eye}, {0, 0, 0});
    const double a = degrees * test::degree;
    // near the middle of the image its sides hide behind its top
    scene.boxes.push_back(
        view.box({0.01, 0.02, 0}, {std::cos(a), std::sin(a)}, size, {}, {}));
    if (with_ground)
      scene.patches.push_back(view.ground({3, 3}, {}, {}));
    scene.has_support = with_ground;
    truth = test::toCuboid(scene.boxes[0]);
    const Eigen::Isometry3d camera = view.sensor_to_world.inverse();
    const Eigen::Vector3d up = camera.linear() * Eigen::Vector3d::UnitZ();
    ground << up, -up.dot(camera.translation());
  }
};

const DimensionSource&
sourceOfShortest(const Cuboid& c)
{
  int axis = 0;
  c.size.minCoeff(&axis);
  return c.dimension_source[axis];
}

class SingleFaces : public testing::TestWithParam<int> {
protected:
  Eigen::Vector3d size_{0.32, 0.23, 0.11 + 0.03 * GetParam()};
  double degrees_ = 11.0 + 23.0 * GetParam();
};

TEST_P(SingleFaces, ATopOnTheGroundIsAWholeBox)
{
  const Overhead one(size_, degrees_, true);
  const FrameImages images = test::exactFrame(one.scene).images;
  EXPECT_TRUE(test::segment(images).empty()); // not asked for
  FullModeParameters parameters;
  parameters.single_faces = true;
  const auto found = test::segment(images, parameters);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].model, CuboidModel::face);
  EXPECT_EQ(sourceOfShortest(found[0]), DimensionSource::support);
  const auto e = test::compare(found[0], one.truth);
  EXPECT_LT(e.center, 1e-3);
  EXPECT_LT(e.maxSize(), 1e-3);
  EXPECT_LT(e.rotation, 0.2 * test::degree);
}

TEST_P(SingleFaces, WithoutASupportTheThirdSideIsUnknown)
{
  const Overhead one(size_, degrees_, false);
  const FrameImages images = test::exactFrame(one.scene).images;
  FullModeParameters parameters;
  parameters.single_faces = true;
  const auto found = test::segment(images, parameters);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(sourceOfShortest(found[0]), DimensionSource::unknown);
  EXPECT_TRUE(std::isnan(found[0].size_sigma[2]));
  EXPECT_NEAR(found[0].size[0], size_[0], 1e-3);
  EXPECT_NEAR(found[0].size[1], size_[1], 1e-3);
  EXPECT_LT(found[0].size[2], 0.01); // means nothing, and looks like it
}

TEST_P(SingleFaces, AGivenPlaneTellsTheHeight)
{
  const Overhead one(size_, degrees_, false);
  const FrameImages images = test::exactFrame(one.scene).images;
  for (const double scale : {1.0, -2.0}) { // the plane of either sign and length
    FullModeParameters parameters;
    parameters.single_faces = true;
    parameters.support_plane = scale * one.ground;
    const auto found = test::segment(images, parameters);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(sourceOfShortest(found[0]), DimensionSource::support);
    EXPECT_LT(test::compare(found[0], one.truth).maxSize(), 1e-3);
    EXPECT_LT(test::compare(found[0], one.truth).center, 1e-3);
  }
}

TEST_P(SingleFaces, ACatalogueTellsTheHeight)
{
  const Overhead one(size_, degrees_, false);
  const FrameImages images = test::exactFrame(one.scene).images;
  FullModeParameters parameters;
  parameters.single_faces = true;
  const Eigen::Vector3d other = size_ + Eigen::Vector3d(0.05, 0.05, 0);
  parameters.known = {other, {size_[2], size_[0], size_[1]}};
  const auto found = test::segment(images, parameters);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(sourceOfShortest(found[0]), DimensionSource::catalogue);
  EXPECT_LT(test::compare(found[0], one.truth).maxSize(), 1e-3);
  EXPECT_LT(test::compare(found[0], one.truth).center, 1e-3);
  // half of the tolerance's width over the root of three
  int axis = 0;
  found[0].size.minCoeff(&axis);
  EXPECT_NEAR(found[0].size_sigma[axis], parameters.tolerance / std::sqrt(3.0), 1e-3);

  parameters.known = {other};
  EXPECT_TRUE(test::segment(images, parameters).empty());
}

INSTANTIATE_TEST_SUITE_P(Turned, SingleFaces, testing::Range(0, 4));

TEST(FullModeSizes, ADiscIsNoSingleFace)
{
  samples::Scene scene;
  const View view = View::lookAt({0, -1e-6, 1.5}, {0, 0, 0});
  scene.cylinders.push_back(view.cylinder({0, 0, 0}, 0.15, 0.2, {}));
  scene.patches.push_back(view.ground({3, 3}, {}, {}));
  FullModeParameters parameters;
  parameters.single_faces = true;
  const FrameImages images = test::exactFrame(scene).images;
  EXPECT_TRUE(test::segment(images, parameters).empty());
}

// A box that two faces are seen of is not reported again for each of them.
TEST(FullModeSizes, SingleFacesAddNothingToWhatIsSeenBetter)
{
  FullModeParameters parameters;
  parameters.single_faces = true;
  samples::RandomBoxOptions options;
  options.min_face_px = 1500;
  options.max_distance = 2;
  options.on_ground = true;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const samples::Scene scene = samples::randomBoxScene(seed, options);
    const FrameImages images = test::exactFrame(scene).images;
    const auto found = test::segment(images, parameters);
    ASSERT_EQ(found.size(), 1U) << "seed " << seed;
    EXPECT_NE(found[0].model, CuboidModel::face);
  }
}

class SizesOnTables : public testing::TestWithParam<int> {
protected:
  void
  SetUp() override
  {
    samples::RandomTableOptions options;
    test::renderedFrame(
        samples::randomTableScene(static_cast<std::uint64_t>(GetParam()), 6, options),
        images_);
    all_ = test::segment(images_);
    ASSERT_GE(all_.size(), 2U);
  }

  FrameImages images_;
  std::vector<Cuboid> all_;
};

// Both ends of every side are known.
bool
whole(const Cuboid& c)
{
  return std::none_of(
      c.dimension_source.begin(), c.dimension_source.end(), [](DimensionSource s) {
        return s == DimensionSource::partial || s == DimensionSource::unknown;
      });
}

Eigen::Vector3d
descending(Eigen::Vector3d size)
{
  std::sort(size.data(), size.data() + 3, std::greater<>());
  return size;
}

TEST_P(SizesOnTables, RangesKeepWhatFitsThem)
{
  for (const Cuboid& wanted : all_) {
    FullModeParameters parameters;
    const Eigen::Vector3d size = descending(wanted.size);
    constexpr double margin = 1e-3; // less competition may lead to another refinement
    for (int k = 0; k < 3; ++k)
      parameters.ranges[k] = {size[k] - margin, size[k] + margin};
    const auto found = test::segment(images_, parameters);
    double best = 0;
    for (const Cuboid& c : found) {
      best = std::max(best, test::iou(c, wanted));
      if (!whole(c))
        continue; // may be longer than it is known to be
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(descending(c.size)[k], parameters.ranges[k].min);
        EXPECT_LE(descending(c.size)[k], parameters.ranges[k].max);
      }
    }
    EXPECT_GT(best, 0.95);
  }
  FullModeParameters none;
  none.ranges[2].min = 1.5; // a shortest side of 1.5 m: nothing on a table
  EXPECT_TRUE(test::segment(images_, none).empty());
}

TEST_P(SizesOnTables, ACatalogueKeepsWhatIsInIt)
{
  for (const Cuboid& wanted : all_) {
    FullModeParameters parameters;
    parameters.known = {{wanted.size[1], wanted.size[2], wanted.size[0]}};
    const auto found = test::segment(images_, parameters);
    double best = 0;
    for (const Cuboid& c : found) {
      best = std::max(best, test::iou(c, wanted));
      if (whole(c)) {
        EXPECT_LT((descending(c.size) - descending(wanted.size)).cwiseAbs().maxCoeff(),
                  parameters.tolerance);
      }
    }
    EXPECT_GT(best, 0.9);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SizesOnTables, testing::Values(3, 5, 8));

// A second box hides one end of the first: the catalogue knows how far it goes on.
TEST(FullModeSizes, ACatalogueCompletesAHiddenSide)
{
  samples::Scene scene;
  const View view = View::lookAt({0, -1.3, 0.8}, {0, 0, 0.1});
  const Eigen::Vector3d size(0.4, 0.2, 0.15);
  scene.boxes.push_back(view.box({0, 0, 0}, {0.97, 0.24}, size, {}, {}));
  // before its right end, higher and wider than it
  scene.boxes.push_back(view.box({0.2, -0.25, 0}, {1, 0}, {0.22, 0.08, 0.3}, {}, {}));
  scene.patches.push_back(view.ground({3, 3}, {}, {}));
  const FrameImages images = test::exactFrame(scene).images;
  const Cuboid truth = test::toCuboid(scene.boxes[0]);

  const auto without = test::segment(images);
  for (const Cuboid& c : without) // else the scene tests nothing
    ASSERT_FALSE(test::iou(c, truth) > 0.9 && whole(c));

  FullModeParameters parameters;
  parameters.known = {{0.22, 0.08, 0.3}, size};
  const auto found = test::segment(images, parameters);
  const auto it = std::find_if(found.begin(), found.end(), [&](const Cuboid& c) {
    return test::iou(c, truth) > 0.9;
  });
  ASSERT_NE(it, found.end());
  EXPECT_NE(std::count(it->dimension_source.begin(),
                       it->dimension_source.end(),
                       DimensionSource::catalogue),
            0);
  EXPECT_LT(test::compare(*it, truth).center, 3e-3);
  EXPECT_LT(test::compare(*it, truth).maxSize(), 3e-3);
}

// The law of the rejection itself, on hypotheses.
TEST(BoxSizes, HiddenSidesMayBeLongerUnknownOnesAnything)
{
  CuboidHypothesis h;
  h.upper = {0.4, 0.3, 0.2};
  h.ends.fill(EndSource::seen);
  BoxSizes sizes;
  EXPECT_EQ(sizeRejection(h, sizes, 0), nullptr);
  sizes.ranges[0] = {0.5, 0.6}; // the longest side
  EXPECT_STREQ(sizeRejection(h, sizes, 0), "side length outside the limits");
  EXPECT_EQ(sizeRejection(h, sizes, 0.11), nullptr);
  for (const int f : {2, 3}) { // 0.3 may in truth be 0.55
    CuboidHypothesis open = h;
    open.ends[f] = EndSource::bound;
    EXPECT_EQ(sizeRejection(open, sizes, 0), nullptr);
  }
  sizes.ranges[0] = {0.2, 0.25}; // 0.4 is too long already, however long it is
  h.ends[0] = EndSource::bound;
  EXPECT_STREQ(sizeRejection(h, sizes, 0), "side length outside the limits");
  h.ends[0] = EndSource::unknown;
  h.ends[2] = EndSource::seen;
  EXPECT_STREQ(sizeRejection(h, sizes, 0), "side length outside the limits");
  sizes.ranges[0] = {0.25, 0.35}; // 0.3 is the longest, if the unknown one is short
  EXPECT_EQ(sizeRejection(h, sizes, 0), nullptr);
  sizes.known = {{0.3, 0.25, 0.2}};
  EXPECT_EQ(sizeRejection(h, sizes, 0), nullptr);
  sizes.known = {{0.3, 0.25, 0.23}};
  EXPECT_STREQ(sizeRejection(h, sizes, 0), "not a known size");
  EXPECT_EQ(sizeRejection(h, sizes, 0.03), nullptr);
}

TEST(BoxSizes, NonsenseIsNotValid)
{
  EXPECT_TRUE(FullModeParameters().valid());
  const auto bad = [](const auto& change) {
    FullModeParameters p;
    change(p);
    return !p.valid();
  };
  EXPECT_TRUE(bad([](auto& p) { p.min_side = 0; }));
  EXPECT_TRUE(bad([](auto& p) { p.max_side = 0.001; }));
  EXPECT_TRUE(bad([](auto& p) { p.tolerance = 0; }));
  EXPECT_TRUE(bad([](auto& p) { p.tolerance = NAN; }));
  EXPECT_TRUE(bad([](auto& p) { p.ranges[1] = {0.3, 0.2}; }));
  EXPECT_TRUE(bad([](auto& p) { p.ranges[1].min = -1; }));
  EXPECT_TRUE(bad([](auto& p) { p.ranges[1].max = NAN; }));
  EXPECT_TRUE(bad([](auto& p) { p.known = {{0.1, 0.2, 0}}; }));
  EXPECT_TRUE(bad([](auto& p) { p.min_score = 1.1; }));
  EXPECT_TRUE(bad([](auto& p) { p.max_cuboids = -1; }));
  EXPECT_TRUE(bad([](auto& p) { p.support_plane = Eigen::Vector4d(0, 0, 0, 1); }));
}

} // namespace
} // namespace hoist
