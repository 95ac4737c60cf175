#pragma once

#include <hoist/data/export.h>
#include <hoist/data/ifc/part21.h>
#include <hoist/data/oriented_box.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hoist {

/** \brief The schemas that are read and written. The additions and corrigenda of IFC4
 *  (IFC4_ADD2 and so on) count as IFC4. */
enum class IfcSchema { ifc2x3, ifc4 };

/** \brief "IFC2X3", "IFC4": the words of FILE_SCHEMA. */
HOIST_DATA_EXPORT const char* toString(IfcSchema schema);

/** \brief One property or quantity. Lengths are in metres and masses in kg, whatever
 * the model's units; all else is as the model has it. */
struct IfcProperty {
  std::string name;
  std::string type; ///< "IFCLABEL", "IFCLENGTHMEASURE", "IFCQUANTITYWEIGHT", ...
  std::variant<std::monostate, bool, std::int64_t, double, std::string> value;
};

/** \brief A property set, or a set of quantities. */
struct IfcPropertySet {
  std::uint64_t id = 0; ///< of its instance
  std::string name;
  bool quantities = false;
  std::vector<IfcProperty> properties;

  /** \brief The property of that name; nullptr if there is none. */
  HOIST_DATA_EXPORT const IfcProperty* find(std::string_view property) const;
};

/** \brief A project, site, building, storey or space. */
struct IfcSpatialNode {
  std::uint64_t id = 0;
  std::string entity; ///< as in the file, e.g. "IFCBUILDINGSTOREY"
  std::string global_id;
  std::string name;
  int parent = -1; ///< number in IfcModel::spatial(); -1 for none
  /// Its frame in the world [m].
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::uint64_t placement = 0; ///< its IfcLocalPlacement; 0 for none
};

/** \brief A thing of the model. */
struct IfcElement {
  std::uint64_t id = 0;
  std::string entity; ///< as the schema spells it, e.g. "IfcColumn"
  std::string global_id;
  std::string name;
  std::string object_type;
  std::string tag;
  int container = -1;   ///< number in IfcModel::spatial() of where it is; -1 for none
  std::string storey;   ///< name of its storey; "" for none
  std::string material; ///< names, joined with ", "; "" for none
  std::optional<double> weight; ///< [kg]
  std::string weight_source;    ///< e.g. "Hoist_Quantities.GrossWeight"

  /// Its box in the world [m], from its geometry.
  std::optional<OrientedBox> box;
  std::string box_source; ///< "extrusion", "brep", ...; or why there is no box
};

/** \brief What a STEP file says as an IFC model.
 *
 * The file is checked when the model is made: the schema is known, every reference
 * leads somewhere, no placement and no part of the spatial tree contains itself.
 */
class HOIST_DATA_EXPORT IfcModel {
public:
  /** \throws LoadError */
  explicit IfcModel(Part21File file);
  IfcModel(IfcModel&&) noexcept;
  IfcModel& operator=(IfcModel&&) noexcept;
  ~IfcModel();

  /** \brief Reads a file (.ifc, not .ifczip or .ifcxml).
   *  \throws LoadError */
  static IfcModel load(const std::filesystem::path& path);

  const Part21File& file() const;
  IfcSchema schema() const;

  /** \brief Metres per unit of length of the model. */
  double lengthUnit() const;

  /** \brief Kilogrammes per unit of mass of the model. */
  double massUnit() const;

  /** \brief The project first, then what it is divided into. */
  const std::vector<IfcSpatialNode>& spatial() const;

  /** \brief All elements, in the order of the file. */
  const std::vector<IfcElement>& elements() const;

  /** \brief The element with that GlobalId; nullptr if there is none. */
  const IfcElement* find(std::string_view global_id) const;

  /** \brief Property sets and quantities of an element or of another instance that has
   *  some; those of its type behind its own.
   *  \throws LoadError */
  std::vector<IfcPropertySet> propertySets(std::uint64_t id) const;

  /** \brief The frame of an IfcLocalPlacement in the world, in units of the model. */
  Eigen::Isometry3d placement(std::uint64_t id) const;

  /** \brief How often each instance is referred to, in the order of the file. */
  const std::vector<std::uint32_t>& references() const;

  /** \brief Instances that relate an object to something: property sets of it,
   * materials of it and so on, as numbers of instances of the file. \param relation
   * name in upper case, e.g. "IFCRELDEFINESBYPROPERTIES" */
  std::vector<std::uint32_t> relationsOf(std::string_view relation,
                                         std::uint64_t id) const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace hoist
