#pragma once

// The laws that every filter keeps, written once and run on every filter and point
// type.
//
// A subject says how to make a filter:
//   struct Subject {
//     using Point = ...; using Filter = hoist::Something<Point>;
//     static void configure(Filter& filter); // settings under which it has work to do
//   };

#include "filters/contract_frame.h"

#include <pcl/common/point_tests.h>
#include <pcl/exceptions.h>
#include <pcl/filters/filter_indices.h>
#include <pcl/point_cloud.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace hoist {
namespace test {

inline std::set<pcl::index_t>
setOf(const pcl::Indices& indices)
{
  return {indices.begin(), indices.end()};
}

/// For filters that select pixels (hoist::FrameFilterIndices).
template <typename Subject>
class SelectionContract : public ::testing::Test {
protected:
  using Filter = typename Subject::Filter;
  using Cloud = pcl::PointCloud<typename Subject::Point>;

  SelectionContract() { Subject::configure(filter_); }

  // Kept and removed must be the given indices, in their order, without overlap.
  void
  expectPartition(const pcl::Indices& given)
  {
    filter_.filter(kept_);
    removed_ = *filter_.getRemovedIndices();
    pcl::Indices merged;
    std::size_t k = 0, r = 0;
    for (const auto index : given) {
      if (k < kept_.size() && kept_[k] == index)
        ++k;
      else if (r < removed_.size() && removed_[r] == index)
        ++r;
      else
        FAIL() << "index " << index << " is neither kept nor removed, or out of order";
    }
    EXPECT_EQ(k, kept_.size());
    EXPECT_EQ(r, removed_.size());
  }

  typename Cloud::Ptr frame_ = contractFrame<typename Subject::Point>();
  Filter filter_{true};
  pcl::Indices kept_, removed_;
};
TYPED_TEST_SUITE_P(SelectionContract);

TYPED_TEST_P(SelectionContract, PartitionsTheFrame)
{
  this->filter_.setInputCloud(this->frame_);
  pcl::Indices all(this->frame_->size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<pcl::index_t>(i);
  this->expectPartition(all);
  // the frame gives every filter something to do, else the laws say nothing
  EXPECT_FALSE(this->kept_.empty());
  EXPECT_LT(this->kept_.size(), this->frame_->size() - 40);
  for (const auto index : this->kept_)
    EXPECT_TRUE(pcl::isXYZFinite((*this->frame_)[index]));
}

TYPED_TEST_P(SelectionContract, RespectsUserIndices)
{
  this->filter_.setInputCloud(this->frame_);
  pcl::Indices whole;
  this->filter_.filter(whole);
  auto given = pcl::make_shared<pcl::Indices>();
  for (pcl::index_t i = static_cast<pcl::index_t>(this->frame_->size()) - 1; i >= 0;
       i -= 2)
    given->push_back(i); // in an order of the caller's
  const pcl::Indices copy = *given;
  this->filter_.setIndices(given);
  this->expectPartition(copy);
  EXPECT_EQ(copy, *given) << "the caller's vector was changed";
  // the choice of a pixel does not depend on which others are asked for
  const auto chosen = setOf(whole);
  for (const auto index : copy)
    EXPECT_EQ(chosen.count(index), setOf(this->kept_).count(index));
}

TYPED_TEST_P(SelectionContract, NegativeSwapsKeptAndRemovedOfFinitePoints)
{
  this->filter_.setInputCloud(this->frame_);
  pcl::Indices kept;
  this->filter_.filter(kept);
  const pcl::Indices removed = *this->filter_.getRemovedIndices();
  this->filter_.setNegative(true);
  pcl::Indices negative;
  this->filter_.filter(negative);
  pcl::Indices expected;
  for (const auto index : removed)
    if (pcl::isXYZFinite((*this->frame_)[index]))
      expected.push_back(index);
  EXPECT_EQ(negative, expected);
  for (const auto index : kept)
    EXPECT_EQ(setOf(*this->filter_.getRemovedIndices()).count(index), 1U);
}

TYPED_TEST_P(SelectionContract, KeepOrganizedKeepsTheGrid)
{
  using Point = typename TypeParam::Point;
  typename TypeParam::Filter filter; // without removed indices
  TypeParam::configure(filter);
  filter.setInputCloud(this->frame_);
  filter.setKeepOrganized(true);
  pcl::Indices kept;
  filter.filter(kept);
  pcl::PointCloud<Point> output;
  filter.filter(output);
  ASSERT_EQ(output.width, this->frame_->width);
  ASSERT_EQ(output.height, this->frame_->height);
  EXPECT_FALSE(output.is_dense);
  EXPECT_EQ(output.header.frame_id, this->frame_->header.frame_id);
  EXPECT_EQ(output.sensor_origin_, this->frame_->sensor_origin_);
  const auto chosen = setOf(kept);
  for (std::size_t i = 0; i < output.size(); ++i) {
    const bool is_kept = chosen.count(static_cast<pcl::index_t>(i)) != 0;
    ASSERT_EQ(pcl::isXYZFinite(output[i]), is_kept) << "at " << i;
    if (is_kept) {
      EXPECT_EQ(output[i].z, (*this->frame_)[i].z);
    }
  }
  EXPECT_TRUE(filter.getRemovedIndices()->empty()) << "they were not asked for";
  filter.setUserFilterValue(7.0F);
  filter.filter(output);
  for (std::size_t i = 0; i < output.size(); ++i)
    if (chosen.count(static_cast<pcl::index_t>(i)) == 0) {
      ASSERT_EQ(output[i].x, 7.0F);
    }
}

TYPED_TEST_P(SelectionContract, WithoutTheGridOnlyTheKeptPointsRemain)
{
  using Point = typename TypeParam::Point;
  this->filter_.setInputCloud(this->frame_);
  pcl::Indices kept;
  this->filter_.filter(kept);
  pcl::PointCloud<Point> output;
  this->filter_.filter(output);
  ASSERT_EQ(output.size(), kept.size());
  EXPECT_EQ(output.height, 1U);
  EXPECT_TRUE(output.is_dense);
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(output[i].x, (*this->frame_)[kept[i]].x);
}

TYPED_TEST_P(SelectionContract, InPlaceEqualsOutOfPlace)
{
  using Point = typename TypeParam::Point;
  for (const bool organized : {false, true}) {
    this->filter_.setKeepOrganized(organized);
    this->filter_.setInputCloud(this->frame_);
    pcl::PointCloud<Point> expected;
    this->filter_.filter(expected);
    auto cloud = pcl::make_shared<pcl::PointCloud<Point>>(*this->frame_);
    this->filter_.setInputCloud(cloud);
    this->filter_.filter(*cloud);
    EXPECT_TRUE(sameClouds(expected, *cloud));
  }
}

TYPED_TEST_P(SelectionContract, SecondCallEqualsTheFirst)
{
  this->filter_.setInputCloud(this->frame_);
  pcl::Indices first;
  this->filter_.filter(first);
  const pcl::Indices removed = *this->filter_.getRemovedIndices();
  pcl::Indices second = {1, 2, 3}; // old content must not survive
  this->filter_.filter(second);
  EXPECT_EQ(first, second);
  EXPECT_EQ(removed, *this->filter_.getRemovedIndices());
  // nor does another frame in between leave anything behind
  auto other = pcl::make_shared<typename TestFixture::Cloud>(*this->frame_);
  for (auto& p : *other)
    p.z += 0.1F;
  this->filter_.setInputCloud(other);
  this->filter_.filter(second);
  this->filter_.setInputCloud(this->frame_);
  this->filter_.filter(second);
  EXPECT_EQ(first, second);
}

TYPED_TEST_P(SelectionContract, ThroughTheBaseClass)
{
  using Point = typename TypeParam::Point;
  this->filter_.setInputCloud(this->frame_);
  pcl::Indices expected, indices;
  this->filter_.filter(expected);
  pcl::FilterIndices<Point>& base = this->filter_;
  base.filter(indices);
  EXPECT_EQ(expected, indices);
}

TYPED_TEST_P(SelectionContract, EmptyAllNaNAndOnePointClouds)
{
  using Point = typename TypeParam::Point;
  auto cloud = pcl::make_shared<pcl::PointCloud<Point>>();
  pcl::Indices kept = {5};
  pcl::PointCloud<Point> output = *this->frame_;
  this->filter_.setInputCloud(cloud);
  this->filter_.filter(kept);
  this->filter_.filter(output);
  EXPECT_TRUE(kept.empty());
  EXPECT_TRUE(output.empty());

  *cloud = *this->frame_;
  for (auto& p : *cloud)
    p.x = p.y = p.z = not_a_number;
  this->filter_.setInputCloud(cloud);
  for (const bool negative : {false, true}) {
    this->filter_.setNegative(negative);
    this->filter_.filter(kept);
    EXPECT_TRUE(kept.empty());
    EXPECT_EQ(this->filter_.getRemovedIndices()->size(), cloud->size());
  }
  this->filter_.setNegative(false);

  // a column of two is the smallest organized cloud; one point is none
  auto two = pcl::make_shared<pcl::PointCloud<Point>>(1, 2, (*this->frame_)[1]);
  this->filter_.setInputCloud(two);
  this->filter_.setNegative(true);
  this->expectPartition({0, 1});
  auto one = pcl::make_shared<pcl::PointCloud<Point>>(1, 1, (*this->frame_)[1]);
  this->filter_.setInputCloud(one);
  kept = {5};
  output = *this->frame_;
  EXPECT_THROW(this->filter_.filter(kept), pcl::UnorganizedPointCloudException);
  EXPECT_THROW(this->filter_.filter(output), pcl::UnorganizedPointCloudException);
  EXPECT_TRUE(kept.empty());
  EXPECT_TRUE(output.empty());
}

TYPED_TEST_P(SelectionContract, BadIndicesThrowAndClearTheOutput)
{
  using Point = typename TypeParam::Point;
  this->filter_.setInputCloud(this->frame_);
  for (const pcl::index_t bad : {-1, static_cast<pcl::index_t>(this->frame_->size())}) {
    this->filter_.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{0, bad}));
    pcl::Indices kept = {5};
    pcl::PointCloud<Point> output = *this->frame_;
    EXPECT_THROW(this->filter_.filter(kept), pcl::BadArgumentException);
    EXPECT_THROW(this->filter_.filter(output), pcl::BadArgumentException);
    EXPECT_TRUE(kept.empty());
    EXPECT_TRUE(output.empty());
  }
}

TYPED_TEST_P(SelectionContract, NoInputClearsTheOutputs)
{
  using Point = typename TypeParam::Point;
  pcl::Indices kept = {5};
  pcl::PointCloud<Point> output = *this->frame_;
  this->filter_.filter(kept);
  this->filter_.filter(output);
  EXPECT_TRUE(kept.empty());
  EXPECT_TRUE(output.empty());
  EXPECT_EQ(output.width, 0U);
}

REGISTER_TYPED_TEST_SUITE_P(SelectionContract,
                            PartitionsTheFrame,
                            RespectsUserIndices,
                            NegativeSwapsKeptAndRemovedOfFinitePoints,
                            KeepOrganizedKeepsTheGrid,
                            WithoutTheGridOnlyTheKeptPointsRemain,
                            InPlaceEqualsOutOfPlace,
                            SecondCallEqualsTheFirst,
                            ThroughTheBaseClass,
                            EmptyAllNaNAndOnePointClouds,
                            BadIndicesThrowAndClearTheOutput,
                            NoInputClearsTheOutputs);

/// For filters that make points (pcl::Filter).
template <typename Subject>
class PointFilterContract : public ::testing::Test {
protected:
  using Filter = typename Subject::Filter;
  using Cloud = pcl::PointCloud<typename Subject::Point>;

  PointFilterContract() { Subject::configure(filter_); }

  typename Cloud::Ptr frame_ = contractFrame<typename Subject::Point>();
  Filter filter_;
};
TYPED_TEST_SUITE_P(PointFilterContract);

TYPED_TEST_P(PointFilterContract, InPlaceAndSecondCallEqualTheFirst)
{
  using Point = typename TypeParam::Point;
  this->filter_.setInputCloud(this->frame_);
  pcl::PointCloud<Point> first, second = *this->frame_;
  this->filter_.filter(first);
  this->filter_.filter(second);
  EXPECT_TRUE(sameClouds(first, second));
  ASSERT_EQ(first.width, this->frame_->width);
  ASSERT_EQ(first.height, this->frame_->height);
  EXPECT_EQ(first.header.frame_id, this->frame_->header.frame_id);
  EXPECT_EQ(first.sensor_origin_, this->frame_->sensor_origin_);
  auto cloud = pcl::make_shared<pcl::PointCloud<Point>>(*this->frame_);
  this->filter_.setInputCloud(cloud);
  this->filter_.filter(*cloud);
  EXPECT_TRUE(sameClouds(first, *cloud));
}

TYPED_TEST_P(PointFilterContract, EmptyAllNaNAndOnePointClouds)
{
  using Point = typename TypeParam::Point;
  auto cloud = pcl::make_shared<pcl::PointCloud<Point>>();
  pcl::PointCloud<Point> output = *this->frame_;
  this->filter_.setInputCloud(cloud);
  this->filter_.filter(output);
  EXPECT_TRUE(output.empty());

  *cloud = *this->frame_;
  for (auto& p : *cloud)
    p.x = p.y = p.z = not_a_number;
  this->filter_.setInputCloud(cloud);
  this->filter_.filter(output);
  ASSERT_EQ(output.size(), cloud->size());
  for (const auto& p : output)
    EXPECT_FALSE(pcl::isXYZFinite(p));

  auto one = pcl::make_shared<pcl::PointCloud<Point>>(1, 1, (*this->frame_)[1]);
  this->filter_.setInputCloud(one);
  this->filter_.filter(output);
  const auto found = std::count_if(output.begin(), output.end(), [&](const Point& p) {
    return p.x == (*one)[0].x && p.z == (*one)[0].z;
  });
  EXPECT_EQ(found, 1);
}

TYPED_TEST_P(PointFilterContract, BadIndicesThrowAndClearTheOutput)
{
  using Point = typename TypeParam::Point;
  this->filter_.setInputCloud(this->frame_);
  for (const pcl::index_t bad : {-1, static_cast<pcl::index_t>(this->frame_->size())}) {
    this->filter_.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{0, bad}));
    pcl::PointCloud<Point> output = *this->frame_;
    EXPECT_THROW(this->filter_.filter(output), pcl::BadArgumentException);
    EXPECT_TRUE(output.empty());
  }
}

TYPED_TEST_P(PointFilterContract, NoInputClearsTheOutput)
{
  pcl::PointCloud<typename TypeParam::Point> output = *this->frame_;
  this->filter_.filter(output);
  EXPECT_TRUE(output.empty());
  EXPECT_EQ(output.width, 0U);
}

REGISTER_TYPED_TEST_SUITE_P(PointFilterContract,
                            InPlaceAndSecondCallEqualTheFirst,
                            EmptyAllNaNAndOnePointClouds,
                            BadIndicesThrowAndClearTheOutput,
                            NoInputClearsTheOutput);

} // namespace test
} // namespace hoist
