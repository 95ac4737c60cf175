#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/segmentation/extract_line_segments.h>

#include <pcl/pcl_base.h>

#include <vector>

namespace hoist {

/** \brief Line segments of a frame, in the image and in space (paper 4.2.2, Table 2).
 *
 * The indices are the edge pixels, as EdgePixels gives them, and must be set. They go
 * through the probabilistic Hough transform; every segment of the image is then lifted
 * through the pixel index. Two lifts:
 *  - LineLift::robust (default): pieces of one edge are joined, the segment is refined
 *    to its pixels and a line is fitted to all the depth along it (liftRobust);
 *  - LineLift::endpoints: the paper's, the points of the two end pixels, nothing
 * joined.
 *
 * Neighbours come from the whole cloud, not from the indices alone.
 */
template <typename PointT>
class LineSegmentExtraction : public pcl::PCLBase<PointT> {
  using Base = pcl::PCLBase<PointT>;
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;
  using Base::use_indices_;

public:
  using Ptr = pcl::shared_ptr<LineSegmentExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const LineSegmentExtraction<PointT>>;
  using typename Base::PointCloudConstPtr;

  /** \brief The frame, organized. Forgets the images of the frame before. */
  void
  setInputCloud(const PointCloudConstPtr& cloud) override
  {
    Base::setInputCloud(cloud);
    images_.reset();
  }

  /** \brief Shares the frame's buffers instead of converting the cloud again; set them
   *  after the cloud they were made from. */
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

  /** \brief How segments become 3D; default LineLift::robust. */
  void
  setLift(LineLift lift)
  {
    parameters_.lift = lift;
  }

  LineLift
  getLift() const
  {
    return parameters_.lift;
  }

  /** \brief The transform's numbers, in pixels and radians.
   *  \throw pcl::BadArgumentException if one is out of its range */
  void setHough(const HoughParameters& parameters);

  const HoughParameters&
  getHough() const
  {
    return parameters_.hough;
  }

  /** \brief LineLift::endpoints: how far from an end pixel without a point one is
   *  looked for [px]; default 0, the paper's.
   *  \throw pcl::BadArgumentException below 0 */
  void setEndSearchRadius(int radius);

  int
  getEndSearchRadius() const
  {
    return parameters_.end_search_radius;
  }

  /** \brief LineLift::robust: width of the strip of surface on each side of a segment
   *  that the line is fitted to [px]; default 4, >= 2.
   *  \throw pcl::BadArgumentException below 2 */
  void setStripWidth(int width);

  int
  getStripWidth() const
  {
    return parameters_.strip_width;
  }

  /** \brief Shortest segment that is reported [m]; default 0, finite and >= 0.
   *  \throw pcl::BadArgumentException outside that range */
  void setMinLength(double length);

  double
  getMinLength() const
  {
    return parameters_.min_length;
  }

  /** \brief The depth noise that LineLift::robust expects; default Kinect. */
  void
  setSensorModel(const SensorModel& sensor)
  {
    parameters_.sensor = sensor;
  }

  const SensorModel&
  getSensorModel() const
  {
    return parameters_.sensor;
  }

  /** \brief Finds the segments.
   *  \param segments cleared, then filled
   *  \return false, with a PCL_ERROR, without an organized input, without indices, with
   *          indices outside the cloud or with images of another size */
  bool segment(std::vector<LineSegment>& segments);

  /** \brief Of the last call: "edge pixels", "image segments", "line segments", and why
   *  segments of the image were not lifted. */
  const Diagnostics&
  getDiagnostics() const
  {
    return diagnostics_;
  }

private:
  FrameImages::ConstPtr images_;
  FrameImages::Ptr own_images_;
  cv::Mat1b mask_;
  LineExtractionParameters parameters_;
  Diagnostics diagnostics_;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/segmentation/impl/line_segment_extraction.hpp>
#endif
