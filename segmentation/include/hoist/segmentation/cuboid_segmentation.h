#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/segmentation/cuboid_lines.h>
#include <hoist/segmentation/full_mode.h>
#include <hoist/segmentation/line_segment.h>
#include <hoist/segmentation/paper_mode.h>

#include <pcl/pcl_base.h>

#include <vector>

namespace hoist {

/** \brief Which method finds the cuboids. */
enum class SegmentationMode {
  paper, ///< the circular process of the paper's Figure 4, to the letter (PaperMode)
  full   ///< from faces and where they end, refined and verified (FullMode)
};

/** \brief All cuboids of a frame, or of a part of it such as a detector's box.
 *
 * Indices restrict the frame to the pixels they name; without indices it is the whole
 * frame. Cuboids are in the camera's frame, metres, best score first; every one names
 * its model, its score and the segments, vertices and pixels that support it.
 */
template <typename PointT>
class CuboidSegmentation : public pcl::PCLBase<PointT> {
  using Base = pcl::PCLBase<PointT>;
  using Base::indices_;
  using Base::input_;
  using Base::use_indices_;

public:
  using Ptr = pcl::shared_ptr<CuboidSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const CuboidSegmentation<PointT>>;
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

  /** \brief Default SegmentationMode::full. */
  void
  setMode(SegmentationMode mode)
  {
    mode_ = mode;
  }

  SegmentationMode
  getMode() const
  {
    return mode_;
  }

  /** \brief The numbers of the paper mode; units and ranges are told there.
   *  \throw pcl::BadArgumentException if one is out of range */
  void setPaperParameters(const PaperModeParameters& parameters);

  const PaperModeParameters&
  getPaperParameters() const
  {
    return paper_parameters_;
  }

  /** \brief The numbers of the full mode; units and ranges are told there.
   *  \throw pcl::BadArgumentException if one is out of range */
  void setFullParameters(const FullModeParameters& parameters);

  const FullModeParameters&
  getFullParameters() const
  {
    return full_parameters_;
  }

  /** \brief The depth noise of the sensor; every threshold of the full mode follows it.
   *  Default Kinect. The paper mode has fixed thresholds. */
  void
  setSensorModel(const SensorModel& sensor)
  {
    full_parameters_.sensor = sensor;
  }

  const SensorModel&
  getSensorModel() const
  {
    return full_parameters_.sensor;
  }

  /** \brief Full mode: also find edge pixels, line segments and vertices, and name
   * those that lie on each cuboid (default true). The cuboids do not depend on it;
   * without it their lists and getSegments() and getVertices() are empty. */
  void
  setReportLines(bool report)
  {
    report_lines_ = report;
  }

  bool
  getReportLines() const
  {
    return report_lines_;
  }

  /** \brief How near to a cuboid's edge a segment of the report must lie [m]; default
   *  0.015, finite and >= 0.
   *  \throw pcl::BadArgumentException outside that range */
  void setLineDistance(double distance);

  double
  getLineDistance() const
  {
    return line_distance_;
  }

  /** \brief Finds the cuboids.
   *  \param cuboids cleared, then filled, best score first. None found is a result;
   *         getDiagnostics tells why
   *  \return false, with a PCL_ERROR, without an organized input, with indices outside
   *          the cloud, with images of another size, in paper mode without colour, in
   *          full mode without valid intrinsics */
  bool segment(std::vector<Cuboid>& cuboids);

  /** \brief The segments that Cuboid::segments counts, of the last call. */
  const std::vector<LineSegment>&
  getSegments() const
  {
    return result_.segments;
  }

  /** \brief The vertices that Cuboid::vertices counts, of the last call. */
  const std::vector<Vertex>&
  getVertices() const
  {
    return result_.vertices;
  }

  /** \brief Edge pixels of the last call, sorted indices into the cloud. */
  const pcl::Indices&
  getEdgePixels() const
  {
    return edge_pixels_;
  }

  /** \brief Counts of every stage and reasons of rejection, of the last call. */
  const Diagnostics&
  getDiagnostics() const
  {
    return diagnostics_;
  }

  /** \brief Full mode: every box that the last call thought of, with the reason why it
   *  is not reported; empty in paper mode. Ask before the frame's images change. */
  std::vector<CuboidVerdict>
  getVerdicts() const
  {
    return explained_ ? full_.verdicts(*explained_) : std::vector<CuboidVerdict>();
  }

  /** \brief Those of them that cover pixel (u, v). */
  std::vector<CuboidVerdict>
  getVerdictsAt(int u, int v) const
  {
    return explained_ ? full_.verdictsAt(*explained_, u, v)
                      : std::vector<CuboidVerdict>();
  }

  /** \brief Full mode: the flat face at pixel (u, v), nullptr where there is none;
   * valid until the next call of segment(). */
  const PlanarFace*
  getFaceAt(int u, int v) const
  {
    return explained_ ? full_.faceAt(u, v) : nullptr;
  }

private:
  bool segmentImages(const FrameImages& images, const cv::Mat1b& mask);
  void listEdgePixels();

  FrameImages::ConstPtr images_;
  FrameImages::Ptr own_images_;
  FrameImages::ConstPtr explained_; // what the full mode saw last
  cv::Mat1b mask_;
  SegmentationMode mode_ = SegmentationMode::full;
  PaperModeParameters paper_parameters_;
  FullModeParameters full_parameters_;
  PaperMode paper_;
  FullMode full_;
  CuboidLines lines_;
  bool report_lines_ = true;
  double line_distance_ = 0.015;
  PaperModeResult result_;
  pcl::Indices edge_pixels_;
  Diagnostics diagnostics_;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/segmentation/impl/cuboid_segmentation.hpp>
#endif
