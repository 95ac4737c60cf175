#pragma once

#include <hoist/data/export.h>
#include <hoist/data/ifc/ifc_model.h>
#include <hoist/data/ifc/part21_edit.h>
#include <hoist/data/oriented_box.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hoist {

/** \brief A thing to be written into a model. */
struct IfcObject {
  /// What it is called for ever: its GlobalId follows from it and from the project's,
  /// so that the same key is the same thing at every update.
  std::string key;
  std::string global_id; ///< if it is set, this and not that of the key
  std::string name;
  std::string entity = "IfcBuildingElementProxy"; ///< one of ifcEntities()
  std::string object_type;               ///< the class, in words: "safety cone"
  OrientedBox box;                       ///< in the world [m]
  std::optional<std::array<int, 3>> rgb; ///< 0 ... 255, sRGB
  std::string material;
  std::optional<double> weight;              ///< [kg]
  std::vector<IfcPropertySet> property_sets; ///< their ids do not count
  std::string storey; ///< name or GlobalId of where it is; "" for the one it stands on
};

/** \brief Entities that things are written as. IfcFurniture becomes
 * IfcFurnishingElement in IFC2x3, which does not have it. */
HOIST_DATA_EXPORT const std::vector<std::string>& ifcEntities();

/** \brief The entity of a class of things: "slab", "column", "beam", "wall", "plate"
 * and "footing" are themselves, tables, chairs and their like furniture, all else is an
 *  IfcBuildingElementProxy. */
HOIST_DATA_EXPORT std::string ifcEntityOfClass(std::string_view object_class);

/** \brief What one call did to a thing. */
struct IfcChange {
  std::string action; ///< "added", "moved", "resized", "changed", "unchanged"
  std::string global_id;
  std::string entity;
  std::string name;
  std::string detail; ///< e.g. "by 0.120 m"; "" for none
};

/** \brief Changes to a model that touch nothing else.
 *
 * What is written is compared with what is there, so that a second edit with the same
 * things changes no byte. Instances that others refer to are never changed: the thing
 * gets its own.
 */
class HOIST_DATA_EXPORT IfcEdit {
public:
  /** \param model must outlive the edit */
  explicit IfcEdit(const IfcModel& model);
  IfcEdit(IfcEdit&&) noexcept;
  ~IfcEdit();

  /** \brief The GlobalId that \a key has in this model. */
  std::string globalIdOf(std::string_view key) const;

  /** \brief Adds a thing, or brings it up to date if its GlobalId is in the model: name
   *  and class, place, size, colour, material, weight, property sets. What the object
   *  does not say (no colour, no material, a set it does not name) stays.
   *  \return its GlobalId
   *  \throws pcl::BadArgumentException for a box that is none, an unknown entity or
   *  storey, or a model where nothing can be put
   *  \throws LoadError if the model is broken where it is needed */
  std::string put(const IfcObject& object);

  /** \brief Moves an element as it is so that its box comes to lie on another as well
   * as it can: centre on centre, axes turned as little as possible, size unchanged.
   *  \return false, and nothing done, if the element has no box or lies on a grid
   *  \throws pcl::BadArgumentException if there is no such element */
  bool move(std::string_view global_id, const OrientedBox& box);

  /** \brief Adds or replaces a property set of an element.
   *  \throws pcl::BadArgumentException if there is no such element */
  void setProperties(std::string_view global_id, const IfcPropertySet& set);

  /** \brief What every put(), move() and setProperties() did, one a thing, in order. */
  const std::vector<IfcChange>& changes() const;

  /** \brief The changes as bytes. */
  const Part21Edit& part21() const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/** \brief How a new model is made. */
struct IfcNewModel {
  IfcSchema schema = IfcSchema::ifc4;
  std::string name = "model"; ///< of the project; its GlobalId follows from it
  std::string site = "site";
  std::string building = "building";
  std::string storey = "ground";
  double length_unit = 1; ///< metres per unit: 1, 0.1, 0.01, 0.001, 0.0254 or 0.3048
  Eigen::Isometry3d site_pose = Eigen::Isometry3d::Identity(); ///< in the world [m]
  std::int64_t time = 0; ///< seconds since 1970: header and owner history
};

/** \brief A valid model without things: project, site, building and storey.
 *  \throws pcl::BadArgumentException for another length unit */
HOIST_DATA_EXPORT std::string newIfcModel(const IfcNewModel& settings = {});

/** \brief A model of these things, as one text: newIfcModel() and IfcEdit::put().
 *  \throws pcl::BadArgumentException as they do */
HOIST_DATA_EXPORT std::string ifcModelOf(const std::vector<IfcObject>& objects,
                                         const IfcNewModel& settings = {});

/** \brief Writes ifcModelOf() so that readers see the old file or the new one.
 *  \throws pcl::IOException, pcl::BadArgumentException */
HOIST_DATA_EXPORT void saveIfcModel(const std::filesystem::path& path,
                                    const std::vector<IfcObject>& objects,
                                    const IfcNewModel& settings = {});

} // namespace hoist
