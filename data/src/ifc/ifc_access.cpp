#include "ifc_access.h"

#include <cmath>

namespace hoist {
namespace ifc {
namespace {

const Part21Instance&
findOrFail(const Part21File& file, std::uint64_t id)
{
  const Part21Instance* const instance = file.find(id);
  if (instance == nullptr)
    throw LoadError(file.name(),
                    "",
                    "expected an instance #" + std::to_string(id) + ", found none");
  return *instance;
}

std::string
shortened(std::string_view raw)
{
  std::string out(raw.substr(0, 40));
  for (char& c : out)
    if (c < 32 || c == 127)
      c = '?';
  return raw.size() > 40 ? out + "..." : out;
}

// A direction if it is given, else what the schema says.
Eigen::Vector3d
directionOr(const Entity& entity, std::size_t i, const Eigen::Vector3d& otherwise)
{
  return entity.referenceIf(i) ? direction(entity.follow(i, "IFCDIRECTION"))
                               : otherwise;
}

// The part of v across a unit vector, of length 1; some vector across it if there is
// none.
Eigen::Vector3d
across(const Eigen::Vector3d& axis, const Eigen::Vector3d& v)
{
  const Eigen::Vector3d part = v - v.dot(axis) * axis;
  if (part.norm() > 1e-9)
    return part.normalized();
  return axis.unitOrthogonal();
}

} // namespace

Entity::Entity(const Part21File& file, std::uint64_t id)
: file_(&file), instance_(&findOrFail(file, id)), arguments_(file.arguments(*instance_))
{
}

const Part21Value&
Entity::at(std::size_t i) const
{
  static const Part21Value nothing;
  return i < arguments_.size() ? arguments_[i] : nothing;
}

void
Entity::fail(std::size_t i, const std::string& expected) const
{
  file_->fail(instance_->begin,
              "#" + std::to_string(instance_->id) + "=" + std::string(name()) +
                  ": expected " + expected + " as argument " + std::to_string(i + 1) +
                  ", found " +
                  (i < arguments_.size() ? shortened(arguments_[i].raw) : "none"));
}

std::optional<double>
Entity::numberIf(std::size_t i) const
{
  using Kind = Part21Value::Kind;
  const Part21Value* value = &at(i);
  if (value->is(Kind::unset) || value->is(Kind::derived))
    return std::nullopt;
  if (value->is(Kind::typed) && value->items.size() == 1)
    value = &value->items.front();
  if (!value->isNumber())
    fail(i, "a number");
  return value->number;
}

double
Entity::number(std::size_t i) const
{
  const auto value = numberIf(i);
  if (!value)
    fail(i, "a number");
  return *value;
}

std::optional<std::uint64_t>
Entity::referenceIf(std::size_t i) const
{
  const Part21Value& value = at(i);
  if (value.is(Part21Value::Kind::unset) || value.is(Part21Value::Kind::derived))
    return std::nullopt;
  if (!value.is(Part21Value::Kind::reference))
    fail(i, "an instance");
  return value.id;
}

std::uint64_t
Entity::reference(std::size_t i) const
{
  const auto id = referenceIf(i);
  if (!id)
    fail(i, "an instance");
  return *id;
}

std::vector<std::uint64_t>
Entity::references(std::size_t i) const
{
  const Part21Value& value = at(i);
  std::vector<std::uint64_t> out;
  if (value.is(Part21Value::Kind::unset))
    return out;
  if (!value.is(Part21Value::Kind::list))
    fail(i, "a list of instances");
  for (const Part21Value& item : value.items) {
    if (!item.is(Part21Value::Kind::reference))
      fail(i, "a list of instances");
    out.push_back(item.id);
  }
  return out;
}

std::vector<double>
Entity::numbers(std::size_t i) const
{
  std::vector<double> out;
  if (!at(i).is(Part21Value::Kind::list))
    fail(i, "a list of numbers");
  for (const Part21Value& item : at(i).items) {
    if (!item.isNumber())
      fail(i, "a list of numbers");
    out.push_back(item.number);
  }
  return out;
}

std::string
Entity::text(std::size_t i) const
{
  const Part21Value& value = at(i);
  if (value.is(Part21Value::Kind::unset) || value.is(Part21Value::Kind::derived))
    return "";
  if (!value.is(Part21Value::Kind::text))
    fail(i, "a text");
  return value.text();
}

Entity
Entity::follow(std::size_t i, std::string_view entity) const
{
  Entity out = follow(i);
  if (out.name() != entity)
    fail(i,
         "an " + std::string(entity) + " (it is an " + std::string(out.name()) + ")");
  return out;
}

Eigen::Vector3d
point(const Entity& entity)
{
  const std::vector<double> numbers = entity.numbers(0);
  if (numbers.empty() || numbers.size() > 3)
    entity.fail(0, "one to three coordinates");
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = numbers[i];
  return out;
}

Eigen::Vector3d
direction(const Entity& entity)
{
  const Eigen::Vector3d out = point(entity);
  const double length = out.norm();
  if (!(length > 0) || !std::isfinite(length))
    entity.fail(0, "a direction that is not 0");
  return out / length;
}

Eigen::Isometry3d
axisPlacement(const Entity& entity)
{
  const bool flat = entity.name() == "IFCAXIS2PLACEMENT2D";
  if (!flat && entity.name() != "IFCAXIS2PLACEMENT3D")
    entity.fail(0, "an IFCAXIS2PLACEMENT3D or 2D around it");
  Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  if (!flat)
    z = directionOr(entity, 1, z);
  const Eigen::Vector3d x =
      across(z, directionOr(entity, flat ? 1 : 2, Eigen::Vector3d::UnitX()));
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << x, z.cross(x), z;
  out.translation() = point(entity.follow(0, "IFCCARTESIANPOINT"));
  return out;
}

Eigen::Affine3d
transformation(const Entity& entity)
{
  const std::string_view name = entity.name();
  const bool flat = name.substr(0, 34) == "IFCCARTESIANTRANSFORMATIONOPERATOR" &&
                    name.substr(34, 2) == "2D";
  const bool uneven = name.size() > 36 && name.substr(name.size() - 10) == "NONUNIFORM";
  if (name.substr(0, 34) != "IFCCARTESIANTRANSFORMATIONOPERATOR")
    entity.fail(0, "an IFCCARTESIANTRANSFORMATIONOPERATOR around it");
  // arguments: Axis1, Axis2, LocalOrigin, Scale; 3D: Axis3; non-uniform: more scales
  const Eigen::Vector3d z = flat ? Eigen::Vector3d::UnitZ()
                                 : directionOr(entity, 4, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d x = across(z, directionOr(entity, 0, Eigen::Vector3d::UnitX()));
  Eigen::Vector3d y = z.cross(x);
  if (directionOr(entity, 1, y).dot(y) < 0)
    y = -y; // a mirror
  const double scale = entity.numberIf(3).value_or(1);
  Eigen::Vector3d scales = Eigen::Vector3d::Constant(scale);
  if (uneven) {
    scales.y() = entity.numberIf(flat ? 4 : 5).value_or(scale);
    scales.z() = flat ? scale : entity.numberIf(6).value_or(scale);
  }
  if (!(scales.minCoeff() > 0) || !scales.allFinite())
    entity.fail(3, "scales above 0");
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  out.linear() << x * scales.x(), y * scales.y(), z * scales.z();
  out.translation() = point(entity.follow(2, "IFCCARTESIANPOINT"));
  return out;
}

} // namespace ifc
} // namespace hoist
