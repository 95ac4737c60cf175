#pragma once

#include "settings.h"

#include <hoist/data/frame_images.h>
#include <hoist/data/load_frame.h>
#include <hoist/data/result.h>

#include <opencv2/core.hpp>

#include <string>

namespace hoist {

/** \brief A loaded frame and its images, converted once. */
struct Frame {
  LoadedFrame loaded;
  FrameImages::Ptr images; ///< without colour where the file has none
};

/** \brief Loads a frame.
 *  \throws LoadError */
Frame openFrame(const std::string& file);

/** \brief The pipeline of `hoist recognize` for one frame after the other; keeps its
 *  buffers. */
class Recognizer {
public:
  explicit Recognizer(const RecognizeSettings& settings);

  /** \brief Finds and describes the cuboids of a frame.
   *  \throws UsageError if the region lies outside the frame, FileError with
   *          the reason if the frame cannot be segmented at all */
  FrameResult recognize(const Frame& frame, const std::string& scene);

  /** \brief The picture of the last result. */
  cv::Mat3b overlay(const Frame& frame, const FrameResult& result) const;

  /** \brief EdgeKind flags of every pixel, as the overlay shows them: in paper mode the
   *  contours that the last frame was recognised by, else those of EdgePixels. */
  cv::Mat1b edgeKinds(const Frame& frame) const;

  /** \brief What the last frame was recognised by. */
  const CuboidSegmentation<pcl::PointXYZRGB>&
  segmentation() const
  {
    return segmentation_;
  }

private:
  pcl::PointCloud<pcl::PointXYZRGB>::ConstPtr balanced(const Frame& frame) const;

  RecognizeSettings settings_;
  CuboidSegmentation<pcl::PointXYZRGB> segmentation_;
};

} // namespace hoist
