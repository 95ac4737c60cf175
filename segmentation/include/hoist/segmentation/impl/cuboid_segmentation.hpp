#pragma once

#include <hoist/segmentation/cuboid_segmentation.h>
#include <hoist/segmentation/impl/frame_input.hpp>

#include <pcl/exceptions.h>
#include <pcl/impl/pcl_base.hpp>

#include <cmath>

namespace hoist {

template <typename PointT>
void
CuboidSegmentation<PointT>::setPaperParameters(const PaperModeParameters& parameters)
{
  if (!parameters.valid())
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::CuboidSegmentation: a parameter of the paper "
                        "mode is out of range");
  paper_parameters_ = parameters;
}

template <typename PointT>
void
CuboidSegmentation<PointT>::setFullParameters(const FullModeParameters& parameters)
{
  if (!parameters.valid())
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::CuboidSegmentation: a parameter of the full mode is "
                        "out of range");
  full_parameters_ = parameters;
}

template <typename PointT>
void
CuboidSegmentation<PointT>::setLineDistance(double distance)
{
  if (!(distance >= 0) || !std::isfinite(distance))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::CuboidSegmentation: the line distance must be finite "
                        "and >= 0 metres");
  line_distance_ = distance;
}

template <typename PointT>
bool
CuboidSegmentation<PointT>::segment(std::vector<Cuboid>& cuboids)
{
  constexpr const char* name = "CuboidSegmentation";
  cuboids.clear();
  result_.clear();
  edge_pixels_.clear();
  diagnostics_.clear();
  explained_.reset();
  if (!input_) {
    PCL_ERROR("[hoist::%s::segment] No input cloud.\n", name);
    return false;
  }
  const FrameImages::ConstPtr images =
      detail::frameImagesOf(name, *input_, images_, own_images_);
  if (!images)
    return false;
  // whole frames need neither a mask nor PCL's list of all indices
  if (use_indices_ && indices_) {
    if (!detail::maskOf(name, *indices_, images->points.size(), mask_))
      return false;
  }
  else
    mask_.release();
  const bool done = segmentImages(*images, mask_);
  if (done && mode_ == SegmentationMode::full)
    explained_ = images;
  cuboids = result_.cuboids;
  return done;
}

template <typename PointT>
bool
CuboidSegmentation<PointT>::segmentImages(const FrameImages& images,
                                          const cv::Mat1b& mask)
{
  if (mode_ == SegmentationMode::paper) {
    if (!paper_.segment(images, mask, paper_parameters_, result_, diagnostics_)) {
      PCL_ERROR("[hoist::CuboidSegmentation::segment] The paper mode needs colour.\n");
      return false;
    }
    listEdgePixels();
    return true;
  }
  if (!full_.segment(images, mask, full_parameters_, result_.cuboids, diagnostics_)) {
    PCL_ERROR("[hoist::CuboidSegmentation::segment] The full mode needs a pinhole "
              "camera, and none could be recovered from the points.\n");
    result_.clear();
    return false;
  }
  if (report_lines_) {
    lines_.find(images,
                mask,
                full_parameters_.sensor,
                result_.edges,
                result_.segments,
                result_.vertices,
                diagnostics_);
    attachLines(result_.segments, result_.vertices, line_distance_, result_.cuboids);
    listEdgePixels();
  }
  return true;
}

template <typename PointT>
void
CuboidSegmentation<PointT>::listEdgePixels()
{
  for (int v = 0; v < result_.edges.rows; ++v)
    for (int u = 0; u < result_.edges.cols; ++u)
      if (result_.edges(v, u) != 0)
        edge_pixels_.push_back(v * result_.edges.cols + u);
}

} // namespace hoist

#define PCL_INSTANTIATE_HoistCuboidSegmentation(T)                                     \
  template class HOIST_SEGMENTATION_EXPORT hoist::CuboidSegmentation<T>;
