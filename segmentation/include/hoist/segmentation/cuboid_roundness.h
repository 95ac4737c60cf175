#pragma once

#include <hoist/data/intrinsics.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/cuboid_hypotheses.h>
#include <hoist/segmentation/export.h>

#include <opencv2/core.hpp>

namespace hoist {

/** \brief How much better a cylinder along an edge of the box explains what is measured
 *  around its visible faces than the box does.
 *
 * A can that is seen under an angle has two flat enough facets at a right angle. Its
 * surface bulges out between them, so both models are fitted to all points around a
 * pair of visible faces, in the plane across the edge they share: the corner, and a
 * circle. A face without a visible neighbour along an axis is compared with a circle
 * alone: a line against an arc.
 *
 * \param hypothesis the box, camera frame [m]
 * \param inverse_depth height x width [1/m], 0 where nothing was measured
 * \param camera of that image
 * \param sensor its sigmaZ sets where a point counts as explained (2.5 sigma and half a
 *        pixel)
 * \return cost of the box over cost of the circle (sums of squared distances, each
 *         limited where a point is not explained), the highest of all pairs and single
 *         faces; above 1 the circle is better. 0 where the box is not seen or has fewer
 *         than 50 points. */
HOIST_SEGMENTATION_EXPORT double cuboidRoundness(const CuboidHypothesis& hypothesis,
                                                 const cv::Mat1f& inverse_depth,
                                                 const Intrinsics& camera,
                                                 const SensorModel& sensor);

} // namespace hoist
