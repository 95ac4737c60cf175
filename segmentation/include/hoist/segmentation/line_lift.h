#pragma once

#include <hoist/data/frame_images.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/export.h>
#include <hoist/segmentation/line_segment.h>
#include <hoist/segmentation/line_segments.h>

namespace hoist {

/** \brief How a segment of the image becomes a segment in space. */
enum class LineLift {
  endpoints, ///< the points of the two end pixels, nothing else (paper 4.2.2)
  robust     ///< a line fitted to the surface along the whole segment
};

/** \brief What became of one segment. */
enum class LiftStatus {
  lifted,
  no_depth,     ///< an end (endpoints) or the whole run (robust) has no measured point
  no_camera,    ///< robust needs valid intrinsics
  not_straight, ///< robust: too few of the points agree with one line
  degenerate    ///< both ends are the same point
};

/** \brief The reason as it appears in Diagnostics; "" for lifted. */
HOIST_SEGMENTATION_EXPORT const char* toString(LiftStatus status);

/** \brief The paper's lift: each end is the point at its pixel (paper, Table 2).
 *
 * \param segment ends are rounded to pixels and must lie in the image
 * \param search_radius with 0 the end's own pixel must have a point, as in the paper;
 *        with r > 0 the nearest pixel with a point within r is taken, and of equally
 *        near ones the point nearest to the camera [px]
 * \param line pixels, points and sigma (0) are set where the status is lifted; indices
 *        are left alone
 */
HOIST_SEGMENTATION_EXPORT LiftStatus liftEndpoints(const FrameImages& images,
                                                   const PixelSegment& segment,
                                                   int search_radius,
                                                   LineSegment& line);

/** \brief The robust lift: the line in space from all the depth along the segment.
 *
 * A line in space has an inverse depth that is linear along its image, and a plane has
 * one that is linear in both directions. So on each side of the segment a strip of
 * \a strip pixels is fitted, q = a + b t + c s (t along, s across), by iterated
 * reweighting (Tukey's biweight) from a resistant line, without random draws, with the
 * sensor's sigma as the scale. Then one of three:
 *  - crease: the sides tilt differently (3 sigma) and meet within 2 px of both ends.
 *    The segment moves onto the line where they meet;
 *  - colour edge: the sides agree on the segment (s = 0) within 3 sigma: their mean;
 *  - occlusion edge: otherwise; the nearer side alone counts.
 * The ends are the rays of the end pixels cut with that line.
 *
 * \param segment ends in the image, refined to the support before (refineSegment)
 * \param sensor gives sigma at every depth
 * \param strip width of each side's strip [px], >= 2
 * \param line pixels, points and sigma are set where the status is lifted; indices are
 *        left alone
 */
HOIST_SEGMENTATION_EXPORT LiftStatus liftRobust(const FrameImages& images,
                                                const PixelSegment& segment,
                                                const SensorModel& sensor,
                                                int strip,
                                                LineSegment& line);

} // namespace hoist
