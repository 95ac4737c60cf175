#include "ifc_profile.h"

namespace hoist {
namespace ifc {
namespace {

Points
rectangle(double x, double y)
{
  return {
      {-x / 2, -y / 2, 0}, {x / 2, -y / 2, 0}, {x / 2, y / 2, 0}, {-x / 2, y / 2, 0}};
}

Points
curve(const Part21File& file, const Entity& entity, int depth)
{
  const std::string_view name = entity.name();
  Points out;
  if (name == "IFCPOLYLINE") {
    for (const std::uint64_t id : entity.references(0))
      out.push_back(point(Entity(file, id)));
    return out;
  }
  if (name == "IFCINDEXEDPOLYCURVE") // an arc is taken by its three points
    return pointList(entity.follow(0));
  if (name == "IFCCOMPOSITECURVE" && depth < 4) {
    for (const std::uint64_t id : entity.references(0)) {
      const Points more = curve(file, Entity(file, id).follow(2), depth + 1);
      out.insert(out.end(), more.begin(), more.end());
    }
    return out;
  }
  throw NotSimple("an outline of " + std::string(name));
}

Points
profile(const Part21File& file, const Entity& entity, int depth)
{
  const std::string_view name = entity.name();
  if (name == "IFCARBITRARYCLOSEDPROFILEDEF" ||
      name == "IFCARBITRARYPROFILEDEFWITHVOIDS")
    return curve(file, entity.follow(2), 0);
  if (name == "IFCDERIVEDPROFILEDEF" && depth < 4) {
    Points out = profile(file, entity.follow(2), depth + 1);
    const Eigen::Affine3d turned = transformation(entity.follow(3));
    for (Eigen::Vector3d& p : out)
      p = turned * p;
    return out;
  }
  Points out;
  if (name == "IFCRECTANGLEPROFILEDEF" || name == "IFCROUNDEDRECTANGLEPROFILEDEF" ||
      name == "IFCRECTANGLEHOLLOWPROFILEDEF" || name == "IFCISHAPEPROFILEDEF")
    out = rectangle(positive(entity, 3), positive(entity, 4));
  else if (name == "IFCTSHAPEPROFILEDEF" || name == "IFCUSHAPEPROFILEDEF" ||
           name == "IFCCSHAPEPROFILEDEF")
    out = rectangle(positive(entity, 4), positive(entity, 3)); // depth goes first
  else if (name == "IFCLSHAPEPROFILEDEF")
    out = rectangle(entity.numberIf(4).value_or(positive(entity, 3)),
                    positive(entity, 3));
  else if (name == "IFCCIRCLEPROFILEDEF" || name == "IFCCIRCLEHOLLOWPROFILEDEF")
    out = rectangle(2 * positive(entity, 3), 2 * positive(entity, 3));
  else if (name == "IFCELLIPSEPROFILEDEF")
    out = rectangle(2 * positive(entity, 3), 2 * positive(entity, 4));
  else
    throw NotSimple("an extruded " + std::string(name));
  if (entity.referenceIf(2)) {
    const Eigen::Isometry3d pose = axisPlacement(entity.follow(2));
    for (Eigen::Vector3d& p : out)
      p = pose * p;
  }
  return out;
}

} // namespace

double
positive(const Entity& entity, std::size_t i)
{
  const double value = entity.number(i);
  if (!(value > 0))
    entity.fail(i, "a length above 0");
  return value;
}

Points
pointList(const Entity& entity)
{
  Points out;
  if (!entity.at(0).is(Part21Value::Kind::list))
    entity.fail(0, "a list of points");
  for (const Part21Value& row : entity.at(0).items) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    if (row.items.size() < 2 || row.items.size() > 3)
      entity.fail(0, "points of two or three numbers");
    for (std::size_t i = 0; i < row.items.size(); ++i) {
      if (!row.items[i].isNumber())
        entity.fail(0, "points of two or three numbers");
      p[static_cast<Eigen::Index>(i)] = row.items[i].number;
    }
    out.push_back(p);
  }
  return out;
}

Points
profilePoints(const Part21File& file, const Entity& entity)
{
  return profile(file, entity, 0);
}

} // namespace ifc
} // namespace hoist
