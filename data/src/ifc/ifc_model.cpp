#include <hoist/data/ifc/ifc_model.h>

#include "ifc_access.h"
#include "ifc_geometry.h"
#include "ifc_model_parts.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace hoist {
namespace {

using ifc::Entity;
using ifc::weight_names;

IfcSchema
schemaOf(const Part21File& file)
{
  for (const Part21Record& line : file.header()) {
    if (line.name != "FILE_SCHEMA")
      continue;
    std::string word;
    if (!line.arguments.empty() && line.arguments[0].items.size() == 1)
      word = line.arguments[0].items[0].text();
    if (word.rfind("IFC2X3", 0) == 0)
      return IfcSchema::ifc2x3;
    if (word == "IFC4" || word.rfind("IFC4_", 0) == 0)
      return IfcSchema::ifc4;
    const auto offset =
        static_cast<std::size_t>(line.name.data() - file.bytes().data());
    file.fail(offset, "expected the schema IFC2X3 or IFC4, found \"" + word + '"');
  }
  throw LoadError(
      file.name(), "", "expected a line FILE_SCHEMA in the header, found none");
}

} // namespace

// Of its own sets, then of those of its type.
std::vector<std::uint64_t>
IfcModel::Parts::setIds(std::uint64_t id) const
{
  std::vector<std::uint64_t> out;
  const auto& of = related.at("IFCRELDEFINESBYPROPERTIES");
  if (const auto found = of.find(id); found != of.end())
    for (const std::uint32_t number : found->second)
      out.push_back(relating.at(number));
  const std::uint64_t type = relatingOf("IFCRELDEFINESBYTYPE", id);
  if (type != 0) {
    const std::vector<std::uint64_t> more = Entity(file, type).references(5);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

std::vector<IfcPropertySet>
IfcModel::Parts::sets(std::uint64_t id) const
{
  std::vector<IfcPropertySet> out;
  for (const std::uint64_t set : setIds(id))
    if (auto one = ifc::readPropertySet(file, set, units))
      out.push_back(std::move(*one));
  return out;
}

// The names of all materials that what is associated leads to: layers, lists and so on.
std::string
IfcModel::Parts::materialOf(std::uint64_t id) const
{
  std::uint64_t first = relatingOf("IFCRELASSOCIATESMATERIAL", id);
  if (first == 0)
    first =
        relatingOf("IFCRELASSOCIATESMATERIAL", relatingOf("IFCRELDEFINESBYTYPE", id));
  std::vector<std::string> names;
  std::set<std::uint64_t> seen;
  std::vector<std::uint64_t> open;
  if (first != 0)
    open.push_back(first);
  while (!open.empty() && seen.size() < 1000) {
    const std::uint64_t next = open.back();
    open.pop_back();
    const Part21Instance* const instance = file.find(next);
    if (instance == nullptr || !seen.insert(next).second ||
        file.entity(*instance).substr(0, 11) != "IFCMATERIAL")
      continue;
    const Entity entity(file, next);
    if (entity.name() == "IFCMATERIAL") {
      const std::string name = entity.text(0);
      if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
      continue;
    }
    std::vector<std::uint64_t> more;
    for (const Part21Value& argument : entity.arguments()) {
      if (argument.is(Part21Value::Kind::reference))
        more.push_back(argument.id);
      for (const Part21Value& item : argument.items)
        if (item.is(Part21Value::Kind::reference))
          more.push_back(item.id);
    }
    open.insert(open.end(), more.rbegin(), more.rend()); // in the file's order
  }
  std::string out;
  for (const std::string& name : names)
    out += (out.empty() ? "" : ", ") + name;
  return out;
}

// What a set says of weights. Sets that many elements share are read once.
const IfcModel::Parts::SetWeights&
IfcModel::Parts::weightsOf(std::uint64_t set)
{
  const auto [entry, is_first] = weights.try_emplace(set);
  SetWeights& out = entry->second;
  const auto read = is_first ? ifc::readPropertySet(file, set, units)
                             : std::optional<IfcPropertySet>();
  if (!read)
    return out;
  out.name = read->name;
  out.quantities = read->quantities;
  for (std::size_t i = 0; i < std::size(weight_names); ++i) {
    const IfcProperty* const property = read->find(weight_names[i]);
    if (property == nullptr ||
        (read->quantities && property->type != "IFCQUANTITYWEIGHT"))
      continue;
    double weight = 0;
    if (const auto* real = std::get_if<double>(&property->value))
      weight = *real;
    else if (const auto* whole = std::get_if<std::int64_t>(&property->value))
      weight = static_cast<double>(*whole);
    if (weight > 0)
      out.weights[i] = weight;
  }
  return out;
}

// The first that says something: quantities before properties, gross before net.
void
IfcModel::Parts::setWeight(IfcElement& element)
{
  std::vector<const SetWeights*> all;
  for (const std::uint64_t set : setIds(element.id))
    all.push_back(&weightsOf(set));
  for (const bool quantities : {true, false})
    for (std::size_t i = 0; i < std::size(weight_names); ++i)
      for (const SetWeights* const set : all)
        if (set->quantities == quantities && set->weights[i]) {
          element.weight = set->weights[i];
          element.weight_source = set->name + '.' + weight_names[i];
          return;
        }
}

void
IfcModel::Parts::readElements()
{
  struct Shape {
    std::optional<OrientedBox> box;
    std::string source;
  };
  ifc::ShapeCache shapes;
  std::unordered_map<std::uint64_t, Shape> boxes; // shapes may be shared
  std::vector<char> wanted;
  for (const Part21Instance& instance : file.instances()) {
    // the entity of a number is the same throughout: looked up once
    if (instance.name >= wanted.size())
      wanted.resize(instance.name + 1, 2);
    if (wanted[instance.name] == 2)
      wanted[instance.name] = ifc::isElement(file.entity(instance)) ? 1 : 0;
    if (wanted[instance.name] == 0)
      continue;
    const Entity entity(file, instance.id);
    IfcElement out;
    out.id = instance.id;
    out.entity = ifc::spelling(entity.name());
    out.global_id = entity.text(0);
    out.name = entity.text(2);
    out.object_type = entity.text(4);
    if (entity.at(7).is(Part21Value::Kind::text))
      out.tag = entity.text(7);
    // parts of an assembly are where the assembly is
    std::uint64_t whole = instance.id;
    std::uint64_t place = 0;
    for (int depth = 0; whole != 0 && place == 0; ++depth) {
      if (depth > 100)
        file.fail(instance.begin,
                  "expected an element that is no part of itself: #" +
                      std::to_string(instance.id));
      place = relatingOf("IFCRELCONTAINEDINSPATIALSTRUCTURE", whole);
      whole = relatingOf("IFCRELAGGREGATES", whole);
      if (place == 0 && spatial_by_id.count(whole) != 0)
        place = whole;
    }
    if (const auto found = spatial_by_id.find(place); found != spatial_by_id.end())
      out.container = found->second;
    if (out.container >= 0 && storeys[out.container] >= 0)
      out.storey = spatial[storeys[out.container]].name;
    out.material = materialOf(instance.id);
    setWeight(out);

    const auto shape = entity.referenceIf(6);
    const auto placement = entity.referenceIf(5);
    out.box_source = "no shape";
    if (placement && placements.count(*placement) == 0)
      out.box_source = "placed on a grid";
    else if (shape) {
      const auto [entry, is_first] = boxes.try_emplace(*shape);
      if (is_first)
        entry->second.box = ifc::shapeBox(file, *shape, shapes, entry->second.source);
      out.box = entry->second.box;
      out.box_source = entry->second.source;
    }
    if (out.box) {
      const Eigen::Isometry3d pose =
          placement ? placements.at(*placement) : Eigen::Isometry3d::Identity();
      out.box->center = pose * out.box->center * units.length;
      out.box->axes = pose.linear() * out.box->axes;
      out.box->size *= units.length;
    }
    by_global_id.emplace(out.global_id, elements.size());
    elements.push_back(std::move(out));
  }
}

const char*
toString(IfcSchema schema)
{
  return schema == IfcSchema::ifc2x3 ? "IFC2X3" : "IFC4";
}

const IfcProperty*
IfcPropertySet::find(std::string_view property) const
{
  for (const IfcProperty& one : properties)
    if (one.name == property)
      return &one;
  return nullptr;
}

IfcModel::IfcModel(Part21File file) : parts_(std::make_unique<Parts>(std::move(file)))
{
  parts_->schema = schemaOf(parts_->file);
  parts_->references = parts_->file.countReferences();
  parts_->readRelations();
  parts_->readPlacements();
  parts_->readSpatial();
  parts_->readElements();
}

IfcModel::IfcModel(IfcModel&&) noexcept = default;
IfcModel& IfcModel::operator=(IfcModel&&) noexcept = default;
IfcModel::~IfcModel() = default;

IfcModel
IfcModel::load(const std::filesystem::path& path)
{
  return IfcModel(Part21File::read(path));
}

const Part21File&
IfcModel::file() const
{
  return parts_->file;
}

IfcSchema
IfcModel::schema() const
{
  return parts_->schema;
}

double
IfcModel::lengthUnit() const
{
  return parts_->units.length;
}

double
IfcModel::massUnit() const
{
  return parts_->units.mass;
}

const std::vector<IfcSpatialNode>&
IfcModel::spatial() const
{
  return parts_->spatial;
}

const std::vector<IfcElement>&
IfcModel::elements() const
{
  return parts_->elements;
}

const IfcElement*
IfcModel::find(std::string_view global_id) const
{
  const auto found = parts_->by_global_id.find(std::string(global_id));
  return found == parts_->by_global_id.end() ? nullptr
                                             : &parts_->elements[found->second];
}

std::vector<IfcPropertySet>
IfcModel::propertySets(std::uint64_t id) const
{
  return parts_->sets(id);
}

Eigen::Isometry3d
IfcModel::placement(std::uint64_t id) const
{
  const auto found = parts_->placements.find(id);
  return found == parts_->placements.end() ? Eigen::Isometry3d::Identity()
                                           : found->second;
}

const std::vector<std::uint32_t>&
IfcModel::references() const
{
  return parts_->references;
}

std::vector<std::uint32_t>
IfcModel::relationsOf(std::string_view relation, std::uint64_t id) const
{
  const auto of = parts_->related.find(std::string(relation));
  if (of == parts_->related.end())
    return {};
  const auto found = of->second.find(id);
  return found == of->second.end() ? std::vector<std::uint32_t>() : found->second;
}

} // namespace hoist
