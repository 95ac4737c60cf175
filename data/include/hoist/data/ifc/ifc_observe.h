#pragma once

#include <hoist/data/export.h>
#include <hoist/data/ifc/ifc_edit.h>
#include <hoist/data/ifc/ifc_model.h>
#include <hoist/data/oriented_box.h>

#include <Eigen/Core>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief Property sets that are written; the names that start with "Pset_" belong to
 *  the standard. The page docs/ifc.md lists what is in them. */
constexpr const char* ifc_recognition_set = "Hoist_Recognition";
constexpr const char* ifc_attribute_set = "Hoist_Attributes";
constexpr const char* ifc_deviation_set = "Hoist_Deviation";

/** \brief A thing that was seen, or that was looked for and is not there. What is not
 *  known is empty or NaN. */
struct IfcObservation {
  std::string key;       ///< as IfcObject::key
  std::string global_id; ///< of the element it is, if that is known
  bool missing = false;  ///< it is not where \a box says any more
  OrientedBox box;       ///< in the world [m]

  Eigen::Vector3d center_sigma =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< [m]
  Eigen::Vector3d size_sigma =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); ///< [m]
  double rotation_sigma = std::numeric_limits<double>::quiet_NaN();        ///< [rad]
  double score = std::numeric_limits<double>::quiet_NaN();

  std::string name;
  std::string object_class;
  std::string material;
  std::optional<std::array<int, 3>> rgb;
  std::string color_name;
  std::optional<bool> fullness;
  std::optional<double> weight; ///< [kg]
  double weight_sigma = std::numeric_limits<double>::quiet_NaN();

  std::string frame; ///< the file or scene it was seen in
  std::string time;  ///< when, in words, e.g. "12.4 s" or an ISO time
  std::string tool;  ///< what saw it, e.g. "hoist 0.1.0"
};

/** \brief How observations become changes. */
struct IfcObserveSettings {
  /// Elements that others modelled are moved to where they were seen; else that they
  /// deviate is recorded.
  bool move_others = false;
  double min_overlap = 0.25; ///< intersection over union of what is the same thing
  double distance = 0.02;    ///< [m] an element may be off, or three sigma if more
  double angle = 2;          ///< [degrees] likewise
  std::string storey;        ///< for new things; "" for the one they stand on
};

/** \brief What became of an observation. */
struct IfcOutcome {
  std::string key;
  std::string global_id;
  /// "added", "moved", "resized", "changed", "unchanged", "deviates", "as modelled",
  /// "missing", "unknown" (missing, but not in the model either), "merged" (seen in
  /// another observation too)
  std::string outcome;
  std::string detail; ///< e.g. "by 0.120 m, 3.0 degrees"
};

/** \brief Brings a model up to date with what was seen.
 *
 * Observations that overlap, or have the same key or GlobalId, are one thing: the one
 * with the higher score stands for it, of equal ones the later. A thing is the element
 * that its GlobalId or its key says, or else the one whose box it overlaps most, each
 * element being one thing at most; what is none of the model is added. Elements with a
 * set Hoist_Recognition are our own: they are moved and changed. Others get a set
 * Hoist_Deviation if they are not where they were modelled.
 *
 * The same observations a second time change nothing.
 *
 * \param model that \a edit was made of
 * \return one for every observation, in their order
 * \throws what IfcEdit::put() throws */
HOIST_DATA_EXPORT std::vector<IfcOutcome>
observeIfc(IfcEdit& edit,
           const IfcModel& model,
           const std::vector<IfcObservation>& observations,
           const IfcObserveSettings& settings = {});

} // namespace hoist
