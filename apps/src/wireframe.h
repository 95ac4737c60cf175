#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief A piece of a cuboid's edge in the picture, seen or hidden all along. */
struct EdgePiece {
  cv::Point2f from, to;
  bool hidden; ///< behind the cuboid itself, another one or what was measured before it
};

/** \brief Cuboids as a camera sees them that stands at the origin. */
class Wireframes {
public:
  /** \param scale pixels of the picture per pixel of the camera */
  Wireframes(std::vector<Cuboid> cuboids, const FrameImages& images, int scale);

  /** \brief The twelve edges of a cuboid, cut where they begin or cease to be seen. */
  std::vector<EdgePiece> edges(std::size_t cuboid) const;

  /** \brief For every pixel of a picture the cuboid seen there, the nearest one; -1 for
   *  none. */
  cv::Mat1i owners(cv::Size picture) const;

private:
  cv::Point2f pixel(const Eigen::Vector3d& p) const;
  bool covered(const Eigen::Vector3d& p) const;
  bool behindMeasured(const Eigen::Vector3d& p) const;

  std::vector<Cuboid> cuboids_;
  Intrinsics camera_;
  cv::Mat1f inverse_depth_;
  int scale_;
};

} // namespace hoist
