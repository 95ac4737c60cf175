#pragma once

#include <hoist/segmentation/export.h>

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <pcl/types.h>

#include <array>
#include <vector>

namespace hoist {

/** \brief A straight run of edge pixels in the image; (u, v) = (column, row) [px]. */
struct PixelSegment {
  std::array<Eigen::Vector2f, 2> pixels;

  /// [px]
  float
  length() const
  {
    return (pixels[1] - pixels[0]).norm();
  }
};

/** \brief What the probabilistic Hough transform may be asked.
 *
 * The paper names none of these numbers. */
struct HoughParameters {
  double rho = 1.0;                    ///< distance step of the accumulator [px], > 0
  double theta = 0.004363323129985824; ///< angle step, 0.25 degrees [rad], > 0
  int threshold = 20;                  ///< votes a line needs, >= 1
  double min_length = 20.0;            ///< shortest segment [px], >= 0
  double max_gap = 10.0;               ///< longest hole within one segment [px], >= 0

  /** \brief Every number in its range. */
  bool
  valid() const
  {
    return rho > 0 && theta > 0 && threshold >= 1 && min_length >= 0 && max_gap >= 0;
  }
};

/** \brief Straight segments of an edge mask by the probabilistic Hough transform
 * (paper 4.2.2; Matas, Galambos, Kittler, CVIU 2000).
 *
 * OpenCV's transform visits the edge pixels in random order; its generator has a fixed
 * seed, so the same mask gives the same segments. The mask is cropped to its edge
 * pixels first: where the object lies in the image does not matter.
 *
 * \param mask height x width, non-zero on edge pixels
 * \param segments cleared, then filled; both ends of each are edge pixels
 * \throw std::invalid_argument if \a parameters are not valid
 */
HOIST_SEGMENTATION_EXPORT void houghSegments(const cv::Mat1b& mask,
                                             const HoughParameters& parameters,
                                             std::vector<PixelSegment>& segments);

/** \brief When two segments are pieces of one edge. */
struct MergeParameters {
  double max_angle = 0.05; ///< between the directions [rad], > 0
  double max_offset = 2.0; ///< of the shorter one's ends from the longer one [px], >= 0
  double max_gap = 5.0;    ///< between their ends along the longer one [px], >= 0
};

/** \brief Joins segments that lie on each other or continue each other.
 *
 * Longer segments swallow shorter ones: the longer one keeps its line and is extended
 * to the projections of the shorter one's ends, until nothing changes. This is not part
 * of the paper, whose mode leaves it out.
 *
 * \param segments replaced by the joined ones, longest first. Quadratic in their number
 */
HOIST_SEGMENTATION_EXPORT void mergeSegments(std::vector<PixelSegment>& segments,
                                             const MergeParameters& parameters = {});

/** \brief The edge pixels that a segment runs along.
 *
 * One step at a time along the segment's longer image axis, the edge pixels within
 * \a radius across it are taken.
 *
 * \param mask height x width, non-zero on edge pixels
 * \param radius [px], >= 0
 * \param indices cleared, then filled with v * width + u, ordered along the segment
 */
HOIST_SEGMENTATION_EXPORT void collectSupport(const cv::Mat1b& mask,
                                              const PixelSegment& segment,
                                              int radius,
                                              pcl::Indices& indices);

/** \brief Moves a segment onto the least squares line of its support.
 *
 * Total least squares over the pixels; the ends are the projections of the old ends.
 *
 * \param width the image's width, which turns indices into pixels
 * \return false, and \a segment is unchanged, with fewer than 3 supporting pixels
 */
HOIST_SEGMENTATION_EXPORT bool
refineSegment(const pcl::Indices& support, int width, PixelSegment& segment);

} // namespace hoist
