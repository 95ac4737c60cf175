#pragma once

#include <hoist/segmentation/face_borders.h>

#include <array>
#include <vector>

namespace hoist {
namespace detail {

/** \brief Where a face ends along a direction. */
struct FaceEnd {
  double value = 0;  ///< coordinate along the direction [m]
  bool seen = false; ///< false: the face is covered there, value is only a bound
  int contact = -1;  ///< the face that rises in front of it there, if that ends it
  int votes = 0;
  double pixel = 0; ///< what a pixel is worth along the direction [m]
};

/** \brief Finds the ends of faces where their outlines pile up along a direction, a
 * vote in one dimension: the Hough transform of a line of known direction. */
class FaceEnds {
public:
  FaceEnds(const std::vector<PlanarFace>& faces,
           const FaceBorders& borders,
           const Intrinsics& camera)
  : faces_(faces), borders_(borders), camera_(camera)
  {
  }

  /// The end of a face along unit vector d. Sigma: noise of the sensor there [m].
  FaceEnd find(int face, const Eigen::Vector3d& d, double sigma);

  /// The outermost end of two coplanar faces, the second of them -1 where there is
  /// none.
  FaceEnd find(const std::array<int, 2>& group, const Eigen::Vector3d& d, double sigma);

  /// Answers are kept, as pairs of faces with their coplanar partners ask again and
  /// again; this drops them.
  void
  forget()
  {
    known_.clear();
  }

private:
  struct Known {
    int face;
    Eigen::Vector3d direction;
    double sigma;
    FaceEnd end;
  };

  FaceEnd measure(int face, const Eigen::Vector3d& d, double sigma);
  int contactAt(int face, const Eigen::Vector3f& d, float value, float window) const;

  const std::vector<PlanarFace>& faces_;
  const FaceBorders& borders_;
  const Intrinsics& camera_;
  std::vector<float> votes_;
  std::vector<Known> known_;
};

} // namespace detail
} // namespace hoist
