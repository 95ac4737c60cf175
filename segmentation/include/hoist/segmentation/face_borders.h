#pragma once

#include <hoist/segmentation/planar_faces.h>

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <vector>

namespace hoist {

/** \brief Why a face ends where it ends. */
enum class BorderKind : unsigned char {
  crease,   ///< another surface meets it there: a physical edge
  jump,     ///< what lies behind is farther: the face's own outline
  open,     ///< nothing was measured beyond: most likely its outline
  occluded, ///< something nearer covers the rest: not an edge of this face
  cut       ///< the image or the mask ends
};

/** \brief One pixel side on the outline of a face. */
struct BorderElement {
  Eigen::Vector2f pixel;   ///< middle of the pixel's side (u, v) [px]
  Eigen::Vector3f point;   ///< the same on the face's plane, camera frame [m]
  Eigen::Vector3f outward; ///< unit direction out of the face, in its plane
  BorderKind kind;
  short face;      ///< whose outline it is
  short neighbour; ///< number of the face beyond, -1 where none
};

/** \brief Outline of every face, face by face: those of face i are
 *  elements[first[i]] .. elements[first[i + 1] - 1]. */
struct FaceBorders {
  std::vector<BorderElement> elements;
  std::vector<int> first; ///< #faces + 1

  /// A pixel's side on an outline, before its place in space is known.
  struct Side {
    int u, v;
    unsigned char direction; // left, right, up, down
    BorderKind kind;
    short face, neighbour;
  };
  std::vector<Side> sides;  ///< scratch: in the order of the image
  std::vector<int> next;    ///< scratch: #faces
  std::vector<short> marks; ///< scratch: pixels of a row to look at
};

/** \brief Walks the label image once and says for every pixel side on a face's outline
 *  why the face ends there.
 *
 * Runs without measurement are crossed, so that the shadow a depth sensor casts beside
 * a near object is told from an outline.
 *
 * \param labels height x width, number of the face + 1, 0 where none and where
 *        nothing was measured
 * \param inverse_depth same size [1/m], 0 where not measured
 */
HOIST_SEGMENTATION_EXPORT void findFaceBorders(const cv::Mat1s& labels,
                                               const cv::Mat1f& inverse_depth,
                                               const cv::Mat1b& mask,
                                               const Intrinsics& camera,
                                               const SensorModel& sensor,
                                               const std::vector<PlanarFace>& faces,
                                               FaceBorders& borders);

} // namespace hoist
