#pragma once

#include <hoist/data/ifc/ifc_edit.h>

#include "ifc_writer.h"

#include <Eigen/Geometry>

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace hoist {

/** \brief What an IfcEdit keeps. Ids are 0 for none; lengths in units of the model. */
struct IfcEdit::Parts {
  using Id = ifc::Id;

  explicit Parts(const IfcModel& model) : writer(model) {}

  /** \brief The instance of an element, of the model or of this edit; 0 for none. */
  Id find(const std::string& global_id) const;

  /** \brief The storey, or what there is instead of one, that \a object is put into.
   *  \throws pcl::BadArgumentException if there is none */
  const IfcSpatialNode& containerOf(const IfcObject& object) const;

  /** \brief Adds an element to what its container contains, when all are known. */
  void contain(const IfcSpatialNode& container, Id element);
  void writeContained();

  /** \brief Places an element in the world; its parts and openings go with it. */
  void place(Id element, const Eigen::Isometry3d& world);

  /** \brief The solid of an element that consists of one extruded rectangle of its own;
   *  0 if it does not. */
  Id ownSolid(Id element) const;

  /** \brief Makes an element a box: sides along its axes, its origin in the middle of
   *  the foot. */
  void shape(Id element, const Eigen::Vector3d& size);

  void color(Id element, const std::array<int, 3>& rgb);
  void material(Id element, const std::string& global_id, const std::string& name);
  void properties(Id element, const std::string& global_id, const IfcPropertySet& set);

  Id add(const IfcObject& object, const std::string& global_id);
  Id bodyContext();

  /** \brief Instances whose first argument refers to an instance, by that instance. */
  const std::unordered_map<Id, std::vector<Id>>& firstReferences(const char* entity);

  ifc::Writer writer;
  std::vector<IfcChange> changes;
  std::unordered_map<std::string, Id> added;          ///< by GlobalId
  std::unordered_map<std::string, OrientedBox> boxes; ///< as they are now, by GlobalId
  std::unordered_map<Id, Eigen::Isometry3d> placed;   ///< new placements in the world
  std::map<Id, std::vector<Id>> contained;            ///< container -> new elements
  std::map<Id, Id>
      containments; ///< container -> the relation that says what it contains
  std::map<std::string, std::unordered_map<Id, std::vector<Id>>> first_references;
};

} // namespace hoist
