#pragma once

#include <hoist/data/export.h>
#include <hoist/data/load_error.h>

#include <Eigen/Core>

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief A thing that somebody claims to have found: what an evaluation compares with
 *  an AnnotatedObject. What is not said is empty or NaN. */
struct Prediction {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); ///< camera frame [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();   ///< full side lengths [m], > 0
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity(); ///< columns: the box's axes
  double score = 1;
  std::string object_class;
  bool is_cuboid = true; ///< in the list of cuboids, not in that of other objects

  Eigen::Vector3d center_sigma =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< [m]
  Eigen::Vector3d size_sigma =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< [m]
  double rotation_sigma = std::numeric_limits<double>::quiet_NaN();        ///< [rad]
  std::array<std::string, 3> dimension_source; ///< "measured", "partial", ...

  std::optional<std::array<int, 3>> rgb; ///< dominant colour
  std::string material;
  std::optional<bool> fullness;
  std::optional<double> weight; ///< [kg]
  double weight_sigma = std::numeric_limits<double>::quiet_NaN();
};

/** \brief What was found in one frame. */
struct PredictedFrame {
  std::string scene; ///< the field of that name; "" if there is none
  std::vector<Prediction> predictions;
  std::vector<std::string> skipped; ///< entries that are no box, with place and reason
};

/** \brief Reads results: a FrameResult's JSON, or any with the lists `cuboids` or
 *  `objects` of center, size and rotation, or an array of such.
 *
 * An entry that is wrong (a side <= 0, axes that are not orthonormal, a score that is
 * no number) is left out and told in PredictedFrame::skipped.
 * \throws LoadError if the file cannot be read or is none of that */
HOIST_DATA_EXPORT std::vector<PredictedFrame>
loadPredictions(const std::filesystem::path& file);

/** \brief The same of a text; \a name of the file, for messages.
 *  \throws LoadError */
HOIST_DATA_EXPORT std::vector<PredictedFrame>
predictionsFromJson(const std::string& text, const std::string& name = "JSON");

} // namespace hoist
