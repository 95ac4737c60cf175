#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/filters/edge_detector.h>
#include <hoist/filters/export.h>
#include <hoist/filters/frame_filter_indices.h>

#include <cstdint>
#include <vector>

namespace hoist {

/** \brief Keeps the edge pixels of a frame, and says of which kind each is.
 *
 * Colour edges by the improved Canny of the crane paper (4.2.1), see \ref Canny;
 * occlusion and crease edges from the depth, see \ref DepthEdges; contours at
 * silhouettes are moved to the near side, see \ref EdgeDetector.
 *
 * The condition of this filter is "is an edge pixel of a wanted kind"; everything else
 * is as \ref FrameFilterIndices says. Edges are found in the whole frame; user indices
 * choose among them.
 *
 * \code
 * hoist::EdgePixels<pcl::PointXYZRGB> edges;
 * edges.setInputCloud(cloud);
 * edges.setKinds(hoist::EDGE_OCCLUSION | hoist::EDGE_CREASE);
 * pcl::Indices indices;
 * edges.filter(indices); // edges.getEdgeKinds()[i] is the kind of indices[i]
 * \endcode
 */
template <typename PointT>
class EdgePixels : public FrameFilterIndices<PointT> {
public:
  using Base = FrameFilterIndices<PointT>;
  using Ptr = pcl::shared_ptr<EdgePixels<PointT>>;
  using ConstPtr = pcl::shared_ptr<const EdgePixels<PointT>>;

  /** \param extract_removed_indices keep the indices of removed points too */
  explicit EdgePixels(bool extract_removed_indices = false)
  : Base(extract_removed_indices)
  {
    filter_name_ = "EdgePixels";
  }

  /** \brief Wanted kinds, an or of EdgeKind flags; default EDGE_ALL.
   *  \throws pcl::BadArgumentException if none or an unknown one is given */
  void setKinds(int kinds);

  int
  getKinds() const
  {
    return parameters_.kinds;
  }

  /** \brief Fixed Canny thresholds: gradient magnitudes (Sobel 3 x 3, 8 bit grey),
   *  0 < low <= high; switches the automatic ones off.
   *  \throws pcl::BadArgumentException otherwise */
  void setCannyThresholds(double low, double high);

  /** \brief Choose the Canny thresholds from the image (default: true). */
  void
  setAutomaticThresholds(bool automatic)
  {
    parameters_.canny.auto_threshold = automatic;
  }

  bool
  getAutomaticThresholds() const
  {
    return parameters_.canny.auto_threshold;
  }

  /** \brief Multiplies both Canny thresholds, > 0; default 1. The knob of the paper's
   *  circular process.
   *  \throws pcl::BadArgumentException otherwise */
  void setThresholdScale(double scale);

  double
  getThresholdScale() const
  {
    return parameters_.canny.threshold_scale;
  }

  /** \brief Remove clustered contour points that are texture (default: true). */
  void
  setTextureRemoval(bool remove)
  {
    parameters_.canny.remove_texture = remove;
  }

  bool
  getTextureRemoval() const
  {
    return parameters_.canny.remove_texture;
  }

  /** \brief The sensor's noise, which all depth thresholds follow; default Kinect. */
  void
  setSensorModel(const SensorModel& sensor)
  {
    parameters_.depth.sensor = sensor;
  }

  const SensorModel&
  getSensorModel() const
  {
    return parameters_.depth.sensor;
  }

  /** \brief How far contours move to the near side [px], 0 ... 16; default 3, 0 = off.
   *  \throws pcl::BadArgumentException otherwise */
  void setNearSideRadius(int radius);

  int
  getNearSideRadius() const
  {
    return parameters_.near_side_radius;
  }

  /** \brief All settings at once, for the ones without a setter of their own. */
  void
  setParameters(const EdgeParameters& parameters)
  {
    parameters_ = parameters;
  }

  const EdgeParameters&
  getParameters() const
  {
    return parameters_;
  }

  /** \brief Image buffers of the input cloud, shared with other stages of a pipeline.
   *
   * Without them (default, or a null pointer) the filter makes its own at each call.
   * They must be those of the input cloud; a different size throws
   * pcl::BadArgumentException in filter().
   */
  void
  setFrameImages(const FrameImages::ConstPtr& images)
  {
    images_ = images;
  }

  FrameImages::ConstPtr
  getFrameImages() const
  {
    return images_;
  }

  /** \brief EdgeKind flags of the indices (points) that the last filter() returned, in
   *  their order; EDGE_NONE for all under negative. */
  const std::vector<std::uint8_t>&
  getEdgeKinds() const
  {
    return kinds_;
  }

  /** \brief EdgeKind flags of all pixels of the last frame, height x width. */
  const cv::Mat1b&
  getKindImage() const
  {
    return labels_;
  }

  /** \brief The detector, for thresholds and contours of the last frame. */
  const EdgeDetector&
  getDetector() const
  {
    return detector_;
  }

protected:
  using Base::filter_name_;
  using Base::input_;

  void prepare() override;

  bool
  selects(pcl::index_t index) const override
  {
    return labels_.data[index] != EDGE_NONE;
  }

  void
  kept(pcl::index_t index) override
  {
    kinds_.push_back(labels_.data[index]);
  }

  void
  clear() override
  {
    kinds_.clear();
    if (!labels_.empty())
      labels_.setTo(0);
  }

private:
  EdgeParameters parameters_;
  FrameImages::ConstPtr images_;
  FrameImages own_images_;
  EdgeDetector detector_;
  cv::Mat1b labels_;
  std::vector<std::uint8_t> kinds_;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/filters/impl/edge_pixels.hpp>
#endif
