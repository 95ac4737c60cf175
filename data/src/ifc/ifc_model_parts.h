#pragma once

#include <hoist/data/ifc/ifc_model.h>

#include "ifc_units.h"

#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hoist {
namespace ifc {

/// Properties and quantities that are a weight, the best first.
constexpr const char* weight_names[] = {"GrossWeight", "NetWeight", "Weight", "Mass"};

} // namespace ifc

/** \brief What an IfcModel keeps, and how it is read: in the order of the functions. */
struct IfcModel::Parts {
  struct SetWeights {
    std::string name;
    bool quantities = false;
    std::array<std::optional<double>, std::size(ifc::weight_names)> weights; ///< [kg]
  };

  explicit Parts(Part21File part21) : file(std::move(part21)) {}

  void readRelations();
  void readPlacement(std::uint64_t first);
  void readPlacements();
  void readSpatial();
  void readStoreys();
  void readElements();
  const SetWeights& weightsOf(std::uint64_t set);
  void setWeight(IfcElement& element);
  std::vector<std::uint64_t> setIds(std::uint64_t id) const;
  std::string materialOf(std::uint64_t id) const;
  std::vector<IfcPropertySet> sets(std::uint64_t id) const;
  std::uint64_t relatingOf(const char* relation, std::uint64_t id) const;
  Eigen::Isometry3d inMetres(std::uint64_t placement) const;

  Part21File file;
  IfcSchema schema = IfcSchema::ifc4;
  ifc::Units units;
  std::vector<std::uint32_t> references;
  std::vector<IfcSpatialNode> spatial;
  std::vector<int> storeys; ///< of each of them; -1 for none
  std::unordered_map<std::uint64_t, int> spatial_by_id;
  std::vector<IfcElement> elements;
  std::unordered_map<std::string, std::size_t> by_global_id;
  std::unordered_map<std::uint64_t, Eigen::Isometry3d> placements;
  /// Of every relation: instance of the model -> numbers of the relations of it.
  std::map<std::string, std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>>
      related;
  /// What a relation says of its objects, by its number; 0 if that is no instance. A
  /// list of ten thousand objects must not be parsed for each of them.
  std::unordered_map<std::uint32_t, std::uint64_t> relating;
  std::unordered_map<std::uint64_t, SetWeights> weights; ///< by id of the set
};

} // namespace hoist
