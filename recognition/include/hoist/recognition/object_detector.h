#pragma once

#include <hoist/recognition/detection.h>

#include <pcl/memory.h>
#include <pcl/pcl_base.h>

// PCL has no PCLBase for our own point types; with this the user needs no more.
#include <pcl/impl/pcl_base.hpp>

#include <vector>

namespace hoist {

/** \brief Finds things of known classes in the image of an organized coloured cloud. */
template <typename PointT>
class ObjectDetector : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<ObjectDetector<PointT>>;
  using ConstPtr = pcl::shared_ptr<const ObjectDetector<PointT>>;

  /** \brief Detects in the whole image; with setIndices, Detection::indices holds only
   *  those among them, and a detection without any is left out.
   *  \param detections the answer, best score first; cleared first
   *  \return false with a PCL_ERROR if the input is unusable: not set, not organized,
   *  without colour, or indices out of it */
  virtual bool detect(std::vector<Detection>& detections) = 0;
};

} // namespace hoist
