#pragma once

#include <hoist/simulation/ray_caster.h>
#include <hoist/simulation/render.h>
#include <hoist/simulation/scene.h>

#include <opencv2/core.hpp>

namespace hoist {
namespace simulation {

/** \brief Standard deviation of a depth [m].
 *
 * kinect: Nguyen, Izadi, Lovell, "Modeling Kinect Sensor Noise", 3DIMPVT 2012:
 * 0.0012 + 0.0019 (z - 0.4)^2 + (0.0001 / sqrt z) (t / (pi/2 - t))^2; tof: constant +
 * quadratic z^2, before what dark and slanted surfaces add. Times sensor.noise; 0 for
 * the other kinds.
 * \param z [m] \param cosine of the angle t between ray and normal
 */
double sigmaZ(const Sensor& sensor, double z, double cosine);

/** \brief The depth image [m] of a kinect, tof or ideal sensor; NaN where it measures
 *  nothing.
 *
 * kinect: edges wander by sensor.lateral; where something near shuts off the view of
 * the projector, at jumps of depth, at grazing angles, on black and on mirrors depth is
 * lost in blotches; the rest gets noise that neighbours partly share, added to the
 * disparity and rounded with it to steps, so that its whole standard deviation is
 * sigmaZ. tof: pixels across a jump mix both depths; independent noise, more on dark
 * and on slanted surfaces.
 */
cv::Mat1f measureDepth(const RayCaster& caster,
                       const Scene& scene,
                       const Layer& layer,
                       const Lens& lens);

/** \brief Matches a stereo pair with cv::StereoSGBM.
 *
 * \param reference grey picture of the right eye \param other of the left eye
 * \return depth in the right eye's frame [m]; NaN where nothing matches
 */
cv::Mat1f
matchStereo(const Sensor& sensor, const cv::Mat1b& reference, const cv::Mat1b& other);

} // namespace simulation
} // namespace hoist
