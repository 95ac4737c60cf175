#include "ifc_access.h"
#include "ifc_model_parts.h"

#include <cstddef>
#include <set>

namespace hoist {
namespace {

using ifc::Entity;

/// A relation and which of its arguments say what is related.
struct Relation {
  const char* name;
  std::size_t objects;  ///< list of what it is said of
  std::size_t relating; ///< what is said
};

constexpr Relation relations[] = {{"IFCRELDEFINESBYPROPERTIES", 4, 5},
                                  {"IFCRELDEFINESBYTYPE", 4, 5},
                                  {"IFCRELASSOCIATESMATERIAL", 4, 5},
                                  {"IFCRELCONTAINEDINSPATIALSTRUCTURE", 4, 5},
                                  {"IFCRELAGGREGATES", 5, 4}};

} // namespace

void
IfcModel::Parts::readRelations()
{
  for (const Relation& relation : relations) {
    auto& of = related[relation.name];
    for (const std::uint32_t number : file.ofType(relation.name)) {
      const Entity entity(file, file.instances()[number].id);
      for (const std::uint64_t id : entity.references(relation.objects))
        of[id].push_back(number);
      const Part21Value& said = entity.at(relation.relating);
      relating[number] = said.is(Part21Value::Kind::reference) ? said.id : 0;
    }
  }
}

// What a relation relates the instance to; 0 for nothing.
std::uint64_t
IfcModel::Parts::relatingOf(const char* relation, std::uint64_t id) const
{
  const auto& of = related.at(relation);
  const auto found = of.find(id);
  return found == of.end() ? 0 : relating.at(found->second.front());
}

// Of one IfcLocalPlacement and of those that it is relative to.
void
IfcModel::Parts::readPlacement(std::uint64_t first)
{
  std::vector<std::uint64_t> chain;
  std::set<std::uint64_t> seen;
  std::uint64_t id = first;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (;;) {
    const auto known = placements.find(id);
    if (known != placements.end()) {
      pose = known->second;
      break;
    }
    const Entity entity(file, id);
    if (entity.name() != "IFCLOCALPLACEMENT")
      break; // of a grid: taken as the world's frame
    if (!seen.insert(id).second)
      file.fail(entity.instance().begin,
                "expected a placement that is not relative to itself: #" +
                    std::to_string(id));
    chain.push_back(id);
    const auto next = entity.referenceIf(0);
    if (!next)
      break;
    id = *next;
  }
  for (auto here = chain.rbegin(); here != chain.rend(); ++here) {
    pose = pose * ifc::axisPlacement(Entity(file, *here).follow(1));
    placements.emplace(*here, pose);
  }
}

void
IfcModel::Parts::readPlacements()
{
  for (const std::uint32_t number : file.ofType("IFCLOCALPLACEMENT"))
    readPlacement(file.instances()[number].id);
}

Eigen::Isometry3d
IfcModel::Parts::inMetres(std::uint64_t placement) const
{
  const auto found = placements.find(placement);
  if (found == placements.end())
    return Eigen::Isometry3d::Identity();
  Eigen::Isometry3d out = found->second;
  out.translation() *= units.length;
  return out;
}

void
IfcModel::Parts::readSpatial()
{
  const auto add = [&](const Entity& entity) {
    IfcSpatialNode node;
    node.id = entity.id();
    node.entity = std::string(entity.name());
    node.global_id = entity.text(0);
    node.name = entity.text(2);
    if (entity.name() != "IFCPROJECT")
      node.placement = entity.referenceIf(5).value_or(0);
    node.pose = inMetres(node.placement);
    spatial_by_id.emplace(node.id, static_cast<int>(spatial.size()));
    spatial.push_back(std::move(node));
  };
  const auto& projects = file.ofType("IFCPROJECT");
  if (projects.empty())
    throw LoadError(file.name(), "", "expected an IFCPROJECT, found none");
  const Entity project(file, file.instances()[projects.front()].id);
  units = ifc::unitsOf(file, project);
  add(project);
  for (const char* const name :
       {"IFCSITE", "IFCBUILDING", "IFCBUILDINGSTOREY", "IFCSPACE"})
    for (const std::uint32_t number : file.ofType(name))
      add(Entity(file, file.instances()[number].id));
  for (IfcSpatialNode& node : spatial) {
    const auto parent = spatial_by_id.find(relatingOf("IFCRELAGGREGATES", node.id));
    if (parent != spatial_by_id.end())
      node.parent = parent->second;
  }
  readStoreys();
}

// The storey that each node is or lies in; each way up is gone once.
void
IfcModel::Parts::readStoreys()
{
  constexpr int unknown = -2, open = -3;
  storeys.assign(spatial.size(), unknown);
  std::vector<int> way;
  for (int first = 0; first < static_cast<int>(spatial.size()); ++first) {
    int storey = -1;
    for (int up = first; up >= 0; up = spatial[up].parent) {
      if (storeys[up] == open)
        file.fail(file.find(spatial[up].id)->begin,
                  "expected a spatial tree, found #" + std::to_string(spatial[up].id) +
                      " inside of itself");
      if (storeys[up] != unknown) {
        storey = storeys[up];
        break;
      }
      storeys[up] = open;
      way.push_back(up);
    }
    for (; !way.empty(); way.pop_back()) {
      if (spatial[way.back()].entity == "IFCBUILDINGSTOREY")
        storey = way.back();
      storeys[way.back()] = storey;
    }
  }
}

} // namespace hoist
