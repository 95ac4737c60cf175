#pragma once

#include <hoist/recognition/color.h>
#include <hoist/recognition/cuboid_feature_extraction.h>
#include <hoist/recognition/lifting.h>
#include <hoist/recognition/surface.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>
#include <pcl/type_traits.h>

#include <algorithm>
#include <cmath>

namespace hoist {

template <typename PointT>
bool
CuboidFeatureExtraction<PointT>::setMaterial(const std::string& name)
{
  if (!name.empty() && findMaterial(name) == nullptr)
    return false;
  material_ = name;
  return true;
}

template <typename PointT>
bool
CuboidFeatureExtraction<PointT>::validIndices() const
{
  const auto valid = [this](pcl::index_t i) {
    return i >= 0 && static_cast<std::size_t>(i) < input_->size();
  };
  return std::all_of(indices_->begin(), indices_->end(), valid) &&
         std::all_of(cuboids_.begin(), cuboids_.end(), [&](const Cuboid& cuboid) {
           return std::all_of(cuboid.indices.begin(), cuboid.indices.end(), valid);
         });
}

template <typename PointT>
pcl::Indices
CuboidFeatureExtraction<PointT>::pixelsOf(const Cuboid& cuboid,
                                          const std::vector<bool>& given) const
{
  pcl::Indices pixels;
  if (!cuboid.indices.empty()) {
    for (const pcl::index_t i : cuboid.indices)
      if (given[i])
        pixels.push_back(i);
    return pixels;
  }
  for (const pcl::index_t i : *indices_) {
    const PointT& p = (*input_)[i];
    if (pcl::isXYZFinite(p) &&
        distanceToSurface(cuboid, {p.x, p.y, p.z}) <= surface_tolerance_)
      pixels.push_back(i);
  }
  return pixels;
}

template <typename PointT>
double
CuboidFeatureExtraction<PointT>::lightnessOfInputsWhite() const
{
  std::vector<cv::Vec3b> colors;
  if constexpr (pcl::traits::has_color<PointT>::value) {
    // a quantile needs no more than some 10^4 points
    const std::size_t step = input_->size() / 20000 + 1;
    for (std::size_t i = 0; i < input_->size(); i += step) {
      const PointT& p = (*input_)[i];
      colors.emplace_back(p.b, p.g, p.r);
    }
  }
  return lightnessOfWhite(colors);
}

template <typename PointT>
bool
CuboidFeatureExtraction<PointT>::compute(std::vector<CuboidFeatures>& features)
{
  features.clear();
  if (!input_ || !initCompute()) {
    PCL_ERROR("[hoist::%s::compute] No input cloud.\n", getClassName().c_str());
    return false;
  }
  if (!validIndices() || !(surface_tolerance_ > 0)) {
    PCL_ERROR("[hoist::%s::compute] %s.\n",
              getClassName().c_str(),
              surface_tolerance_ > 0 ? "An index is out of range"
                                     : "The surface tolerance is not positive");
    deinitCompute();
    return false;
  }
  std::vector<bool> given(input_->size(), false);
  for (const pcl::index_t i : *indices_)
    given[i] = true;
  const Material* material = material_.empty() ? nullptr : findMaterial(material_);

  std::vector<cv::Vec3b> colors;
  const double white = lightnessOfInputsWhite();
  for (const Cuboid& cuboid : cuboids_) {
    CuboidFeatures feature;
    if constexpr (pcl::traits::has_color<PointT>::value) {
      colors.clear();
      for (const pcl::index_t i : pixelsOf(cuboid, given)) {
        const PointT& p = (*input_)[i];
        colors.emplace_back(p.b, p.g, p.r);
      }
      Color color;
      if (dominantColor(colors, color)) {
        feature.rgb = color.rgb;
        feature.lab = color.lab;
        feature.color_name = colorName(color.lab, white);
      }
    }

    feature.orientation = Eigen::Quaterniond(cuboid.axes);
    if (feature.orientation.w() < 0)
      feature.orientation.coeffs() *= -1.0;

    const LiftPose lift =
        up_.norm() > 0 ? upwardFace(cuboid, up_) : cameraFacingFace(cuboid);
    feature.lift_point = lift.point;
    feature.lift_normal = lift.normal;
    feature.lift_face_observed = lift.observed;

    if (material != nullptr) {
      const Weight weight = estimateWeight(cuboid, *material);
      feature.material = material_;
      feature.weight = weight.value;
      feature.weight_sigma = weight.sigma;
    }
    features.push_back(feature);
  }
  deinitCompute();
  return true;
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistCuboidFeatureExtraction(T)                                \
  template class HOIST_RECOGNITION_EXPORT hoist::CuboidFeatureExtraction<T>;
