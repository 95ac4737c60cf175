#pragma once

#include <hoist/data/intrinsics.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/export.h>

#include <opencv2/core.hpp>

namespace hoist {

/** \brief How much better a cylinder along an edge of the box explains what is measured
 *  around two of its visible faces than the box does.
 *
 * A can that is seen under an angle has two flat enough facets at a right angle. Its
 * surface bulges out between them, so both models are fitted to all points around the
 * two faces, in the plane across the edge they share: the corner, and a circle.
 *
 * \return cost of the corner over cost of the circle (sums of squared distances,
 * limited at 2.5 sigma), the highest of the pairs of visible faces; above 1 the circle
 *         is better. 0 where fewer than two faces are seen. */
HOIST_SEGMENTATION_EXPORT double cuboidRoundness(const CuboidHypothesis& hypothesis,
                                                 const cv::Mat1f& inverse_depth,
                                                 const Intrinsics& camera,
                                                 const SensorModel& sensor);

} // namespace hoist
