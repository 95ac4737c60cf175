#include "ifc_edit_parts.h"

#include <hoist/data/ifc/ifc_guid.h>

#include <pcl/exceptions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hoist {
namespace {

using ifc::Id;
using ifc::Writer;

/// Less than this is no change: it is what rounding to nine decimals may do. Metres
/// (and as many per metre from the origin), and the sine of an angle.
constexpr double same_length = 2e-8;
constexpr double same_share = 1e-12;
constexpr double same_axes = 1e-9;

/// One way to name a box's axes and how far it is from another box.
struct Naming {
  Eigen::Matrix3d axes; ///< of the first box, in the order and sense of the second
  Eigen::Vector3d size;
  double turn; ///< Frobenius norm of the difference of the axes
};

Naming
nearestNaming(const OrientedBox& box, const OrientedBox& other)
{
  Naming best;
  best.turn = std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix3d& naming : axisNamings()) {
    const Eigen::Matrix3d axes = box.axes * naming;
    const double turn = (axes - other.axes).norm();
    if (turn < best.turn)
      best = {axes, naming.cwiseAbs().transpose() * box.size, turn};
  }
  return best;
}

bool
isSameBox(const OrientedBox& a, const OrientedBox& b)
{
  const double length = same_length + same_share * b.center.norm();
  const Naming naming = nearestNaming(a, b);
  return naming.turn < same_axes && (naming.size - b.size).norm() < length &&
         (a.center - b.center).norm() < length;
}

// The same box with its third axis upward, and the first along the longer of the
// others.
OrientedBox
upright(const OrientedBox& box)
{
  const double up = box.axes.row(2).cwiseAbs().maxCoeff();
  OrientedBox out = box;
  for (const Eigen::Matrix3d& naming : axisNamings()) {
    const Eigen::Matrix3d axes = box.axes * naming;
    const Eigen::Vector3d size = naming.cwiseAbs().transpose() * box.size;
    if (axes(2, 2) < up - 1e-9 || size.x() < size.y() - 1e-12)
      continue;
    // of the two that are left, the one whose first axis points to +x (or +y)
    if (axes(0, 0) < -1e-12 || (std::abs(axes(0, 0)) <= 1e-12 && axes(1, 0) < 0))
      continue;
    out.axes = axes;
    out.size = size;
    break;
  }
  return out;
}

std::string
metres(double value)
{
  return "by " + part21Real(value, 3) + " m";
}

void
check(const OrientedBox& box)
{
  if (!box.center.allFinite() || !box.size.allFinite() || !(box.size.minCoeff() > 0) ||
      !(box.axes.transpose() * box.axes).isIdentity(1e-6))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "a box wants sides above 0 and axes that are perpendicular");
}

} // namespace

std::string
ifcEntityOfClass(std::string_view object_class)
{
  struct Word {
    const char* name;
    const char* entity;
  };
  static constexpr Word words[] = {{"slab", "IfcSlab"},
                                   {"column", "IfcColumn"},
                                   {"beam", "IfcBeam"},
                                   {"wall", "IfcWall"},
                                   {"plate", "IfcPlate"},
                                   {"footing", "IfcFooting"},
                                   {"table", "IfcFurniture"},
                                   {"desk", "IfcFurniture"},
                                   {"chair", "IfcFurniture"},
                                   {"bench", "IfcFurniture"},
                                   {"shelf", "IfcFurniture"},
                                   {"cabinet", "IfcFurniture"}};
  // the last word says what it is: "concrete slab", "office chair"
  const std::size_t space = object_class.rfind(' ');
  const std::string_view last =
      space == std::string_view::npos ? object_class : object_class.substr(space + 1);
  for (const Word& word : words)
    if (last == word.name)
      return word.entity;
  return "IfcBuildingElementProxy";
}

const IfcSpatialNode&
IfcEdit::Parts::containerOf(const IfcObject& object) const
{
  const std::vector<IfcSpatialNode>& nodes = writer.model().spatial();
  const IfcSpatialNode* best = nullptr;
  if (!object.storey.empty()) {
    for (const IfcSpatialNode& node : nodes)
      if (node.entity != "IFCPROJECT" &&
          (node.name == object.storey || node.global_id == object.storey))
        return node;
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        writer.model().file().name()
                            << ": has no storey \"" << object.storey << '"');
  }
  // The highest storey below its middle; where all are above, the lowest.
  const double height = object.box.center.z();
  const auto level = [](const IfcSpatialNode& node) {
    return node.pose.translation().z();
  };
  for (const IfcSpatialNode& node : nodes) {
    if (node.entity != "IFCBUILDINGSTOREY")
      continue;
    const bool below = level(node) <= height;
    if (best == nullptr) {
      best = &node;
      continue;
    }
    const bool best_below = level(*best) <= height;
    if (below != best_below
            ? below
            : (below ? level(node) > level(*best) : level(node) < level(*best)))
      best = &node;
  }
  for (const char* const entity : {"IFCBUILDING", "IFCSITE"})
    for (const IfcSpatialNode& node : nodes)
      if (best == nullptr && node.entity == entity)
        best = &node;
  if (best == nullptr)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        writer.model().file().name()
                            << ": has no storey, building or site to put things into");
  return *best;
}

void
IfcEdit::Parts::contain(const IfcSpatialNode& container, Id element)
{
  contained[container.id].push_back(element);
}

void
IfcEdit::Parts::writeContained()
{
  const char* const relation = "IFCRELCONTAINEDINSPATIALSTRUCTURE";
  for (const auto& [container, elements] : contained) {
    Id& existing = containments[container]; // also of an earlier call
    if (existing == 0)
      for (const std::uint32_t number : writer.model().file().ofType(relation)) {
        const Id id = writer.model().file().instances()[number].id;
        if (writer.reference(id, 5) == container) {
          existing = id;
          break;
        }
      }
    if (existing != 0) {
      // the bytes that are there stay, the new ones go before the ")"
      std::string list = writer.edit().get(existing, 4);
      const bool is_empty = writer.references(existing, 4).empty();
      list.pop_back();
      for (const Id id : elements)
        list += (is_empty && id == elements.front() ? "" : ",") + Writer::ref(id);
      writer.edit().set(existing, 4, list + ')');
      continue;
    }
    std::string global_id;
    for (const IfcSpatialNode& node : writer.model().spatial())
      if (node.id == container)
        global_id = node.global_id;
    existing = writer.edit().append(relation,
                                    {writer.globalId(global_id + "/contained"),
                                     Writer::ref(writer.ownerHistory()),
                                     "$",
                                     "$",
                                     Writer::list(elements),
                                     Writer::ref(container)});
  }
  contained.clear();
}

IfcEdit::IfcEdit(const IfcModel& model) : parts_(std::make_unique<Parts>(model)) {}
IfcEdit::IfcEdit(IfcEdit&&) noexcept = default;
IfcEdit::~IfcEdit() = default;

std::string
IfcEdit::globalIdOf(std::string_view key) const
{
  return ifcGuidOf(parts_->writer.model().spatial().front().global_id, key);
}

std::string
IfcEdit::put(const IfcObject& object)
{
  check(object.box);
  if (object.key.empty() && object.global_id.empty())
    PCL_THROW_EXCEPTION(pcl::BadArgumentException, "a thing wants a key or a GlobalId");
  if (!object.global_id.empty() && !fromIfcGuid(object.global_id))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        '"' << object.global_id << "\" is no GlobalId");
  Parts& parts = *parts_;
  Part21Edit& edit = parts.writer.edit();
  const std::string global_id =
      object.global_id.empty() ? globalIdOf(object.key) : object.global_id;
  const double unit = parts.writer.model().lengthUnit();
  const std::size_t before = edit.touched();
  IfcChange change{"unchanged", global_id, object.entity, object.name, ""};

  Id id = parts.find(global_id);
  std::optional<OrientedBox> old;
  if (const auto known = parts.boxes.find(global_id); known != parts.boxes.end())
    old = known->second;
  else if (const IfcElement* element = parts.writer.model().find(global_id))
    old = element->box;
  if (id == 0) {
    id = parts.add(object, global_id);
    change.action = "added";
    change.detail = "to " + parts.containerOf(object).name; // where add() has put it
  }
  else {
    edit.set(id, 2, Writer::text(object.name));
    edit.set(id, 4, Writer::text(object.object_type));
  }
  if (!old || !isSameBox(*old, object.box)) {
    const OrientedBox box = upright(object.box);
    Eigen::Isometry3d world = Eigen::Isometry3d::Identity();
    world.linear() = box.axes;
    world.translation() = (box.center - box.axes.col(2) * (box.size.z() / 2)) / unit;
    parts.place(id, world);
    parts.shape(id, box.size / unit);
    parts.boxes[global_id] = object.box;
    if (old && change.action != "added") {
      const Naming naming = nearestNaming(*old, object.box);
      const double resized = (naming.size - object.box.size).cwiseAbs().maxCoeff();
      const double moved = (old->center - object.box.center).norm();
      change.action =
          moved > same_length || naming.turn > same_axes ? "moved" : "resized";
      change.detail = metres(change.action == "moved" ? moved : resized);
    }
  }
  if (object.rgb)
    parts.color(id, *object.rgb);
  if (!object.material.empty())
    parts.material(id, global_id, object.material);
  const OrientedBox box = upright(object.box);
  IfcPropertySet quantities;
  quantities.name = "Hoist_Quantities";
  quantities.quantities = true;
  quantities.properties = {{"Length", "IFCQUANTITYLENGTH", box.size.x()},
                           {"Width", "IFCQUANTITYLENGTH", box.size.y()},
                           {"Height", "IFCQUANTITYLENGTH", box.size.z()}};
  if (object.weight)
    quantities.properties.push_back(
        {"GrossWeight", "IFCQUANTITYWEIGHT", *object.weight});
  parts.properties(id, global_id, quantities);
  for (const IfcPropertySet& set : object.property_sets)
    parts.properties(id, global_id, set);
  if (change.action == "unchanged" && edit.touched() != before)
    change.action = "changed";
  parts.changes.push_back(std::move(change));
  return global_id;
}

bool
IfcEdit::move(std::string_view global_id, const OrientedBox& box)
{
  check(box);
  Parts& parts = *parts_;
  const IfcModel& model = parts.writer.model();
  const IfcElement* const element = model.find(global_id);
  if (element == nullptr)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        model.file().name() << ": has no element " << global_id);
  const Id placement = parts.writer.reference(element->id, 5);
  if (!element->box || placement == 0)
    return false;
  IfcChange change{"unchanged", element->global_id, element->entity, element->name, ""};
  const auto known = parts.boxes.find(element->global_id);
  const OrientedBox old = known == parts.boxes.end() ? *element->box : known->second;
  const Naming naming = nearestNaming(old, box);
  const double distance = (box.center - old.center).norm();
  if (distance > same_length + same_share * box.center.norm() ||
      naming.turn > same_axes) {
    const auto placed = parts.placed.find(placement);
    Eigen::Isometry3d world =
        placed == parts.placed.end() ? model.placement(placement) : placed->second;
    // what takes the old box to the new one takes the element there
    const Eigen::Matrix3d turn = box.axes * naming.axes.transpose();
    const double unit = model.lengthUnit();
    world.translation() =
        turn * (world.translation() - old.center / unit) + box.center / unit;
    world.linear() = turn * world.linear();
    parts.place(element->id, world);
    parts.boxes[element->global_id] = {box.center, old.size, turn * old.axes};
    change.action = "moved";
    change.detail = metres(distance);
  }
  parts.changes.push_back(std::move(change));
  return true;
}

void
IfcEdit::setProperties(std::string_view global_id, const IfcPropertySet& set)
{
  Parts& parts = *parts_;
  const std::string guid(global_id);
  const Id id = parts.find(guid);
  if (id == 0)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        parts.writer.model().file().name()
                            << ": has no element " << guid);
  const std::size_t before = parts.writer.edit().touched();
  parts.properties(id, guid, set);
  const IfcElement* const element = parts.writer.model().find(guid);
  IfcChange change{parts.writer.edit().touched() != before ? "changed" : "unchanged",
                   guid,
                   element == nullptr ? "" : element->entity,
                   element == nullptr ? "" : element->name,
                   set.name};
  parts.changes.push_back(std::move(change));
}

const std::vector<IfcChange>&
IfcEdit::changes() const
{
  return parts_->changes;
}

const Part21Edit&
IfcEdit::part21() const
{
  parts_->writeContained();
  return parts_->writer.edit();
}

} // namespace hoist
