#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/recognition/object_detector.h>
#include <hoist/recognition/yolox.h>

#include <string>
#include <vector>

namespace hoist {

/** \brief Detects with a single-stage network of the user in the format of YOLOX; see
 *  YoloxNetwork for the model and docs/detection.md for what comes out.
 *
 * \code
 * hoist::YoloxDetector<pcl::PointXYZRGBA> detector(
 *     "yolox_nano.onnx", hoist::loadClassNames("coco_classes.txt"));
 * detector.setInputCloud(cloud); // organized, with colour
 * std::vector<hoist::Detection> detections;
 * detector.detect(detections);
 * \endcode
 */
template <typename PointT>
class YoloxDetector : public ObjectDetector<PointT> {
public:
  using Ptr = pcl::shared_ptr<YoloxDetector<PointT>>;
  using ConstPtr = pcl::shared_ptr<const YoloxDetector<PointT>>;

  using pcl::PCLBase<PointT>::initCompute;
  using pcl::PCLBase<PointT>::deinitCompute;

  /** \throws LoadError if the model is none of that format; see YoloxNetwork */
  YoloxDetector(const std::string& model, const std::vector<std::string>& class_names)
  : network_(model, class_names)
  {
  }

  /** \brief Least score of a detection, in [0, 1] (default 0.3). */
  void
  setScoreThreshold(double threshold)
  {
    score_threshold_ = threshold;
  }

  double
  getScoreThreshold() const
  {
    return score_threshold_;
  }

  /** \brief Of two boxes of one class with more intersection over union than this only
   *  the better stays, in [0, 1] (default 0.45, as YOLOX's own demonstration). */
  void
  setOverlapThreshold(double threshold)
  {
    overlap_threshold_ = threshold;
  }

  double
  getOverlapThreshold() const
  {
    return overlap_threshold_;
  }

  /** \copydoc ObjectDetector::detect
   *  \throws LoadError if the model fails on the image */
  bool detect(std::vector<Detection>& detections) override;

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;

private:
  YoloxNetwork network_;
  FrameImages images_;
  double score_threshold_ = 0.3;
  double overlap_threshold_ = 0.45;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/recognition/impl/yolox_detector.hpp>
#endif
