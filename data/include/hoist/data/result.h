#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/intrinsics.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace hoist {

/** \brief Counts by name, in the order in which the names first appeared. */
class Tally {
public:
  /** \param name a string literal: the pointer is kept, the text is not copied */
  void
  add(const char* name, std::size_t n = 1)
  {
    for (auto& entry : entries_)
      if (entry.first == name || std::string(entry.first) == name) {
        entry.second += n;
        return;
      }
    entries_.emplace_back(name, n);
  }

  /** \brief The count of \a name, 0 if it never appeared. */
  std::size_t
  operator[](const std::string& name) const
  {
    for (const auto& entry : entries_)
      if (name == entry.first)
        return entry.second;
    return 0;
  }

  const std::vector<std::pair<const char*, std::size_t>>&
  entries() const
  {
    return entries_;
  }

  void
  clear()
  {
    entries_.clear();
  }

private:
  std::vector<std::pair<const char*, std::size_t>> entries_;
};

/** \brief Why a frame gave what it gave: how many things each stage made and why
 *  candidates were rejected. */
struct Diagnostics {
  Tally counts;   ///< "edge pixels", "line segments", "vertices", "hypotheses", ...
  Tally rejected; ///< reason -> number of candidates

  void
  clear()
  {
    counts.clear();
    rejected.clear();
  }
};

/** \brief The visible and invisible features of a cuboid (paper 4.3). */
struct CuboidFeatures {
  std::array<unsigned char, 3> rgb{}; ///< dominant colour after white balance, sRGB
  std::array<double, 3> lab{};        ///< the same in CIE L*a*b*, D65
  std::string color_name; ///< one of the eleven basic colour terms; "" if none

  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity(); ///< w >= 0

  Eigen::Vector3d lift_point =
      Eigen::Vector3d::Zero(); ///< centre of the gripped face [m]
  Eigen::Vector3d lift_normal = Eigen::Vector3d::Zero(); ///< its outward unit normal
  bool lift_face_observed = false;

  std::string material;    ///< "" if unknown
  double weight = 0;       ///< [kg], 0 if the material is unknown
  double weight_sigma = 0; ///< [kg], from the sizes' sigmas and the density's range
};

/** \brief One recognised thing. */
struct RecognizedCuboid {
  Cuboid cuboid;
  CuboidFeatures features;
};

/** \brief All that is known of one frame. */
struct FrameResult {
  std::string scene; ///< the file's stem
  std::string mode;  ///< "paper" or "full"
  int width = 0;
  int height = 0;
  Intrinsics intrinsics;
  /// Sensor to world (a PCD's VIEWPOINT); identity when not known.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool pose_known = false;
  std::vector<RecognizedCuboid> cuboids;
  Diagnostics diagnostics;
};

} // namespace hoist
