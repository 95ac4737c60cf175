#include "ifc_geometry.h"

#include "ifc_access.h"
#include "ifc_profile.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace hoist {
namespace ifc {
namespace {

/// Shapes may nest this deep, e.g. mapped items in mapped items.
constexpr int max_nesting = 24;
/// More parts than these are refused: what is mapped a thousand times a thousand times
/// is no shape.
constexpr std::size_t max_parts = 20000;

struct Extent {
  Eigen::Vector3d low, high;
};

Extent
extentOf(const Points& points, const Eigen::Matrix3d& axes)
{
  Extent out{Eigen::Vector3d::Constant(HUGE_VAL), Eigen::Vector3d::Constant(-HUGE_VAL)};
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d local = axes.transpose() * p;
    out.low = out.low.cwiseMin(local);
    out.high = out.high.cwiseMax(local);
  }
  return out;
}

double
volumeOf(const Part& part)
{
  const Extent extent = extentOf(part.points, part.axes);
  return (extent.high - extent.low).prod();
}

// Turns the profile's frame about its normal so that the rectangle around the points is
// smallest: along one of the edges, as that of a polygon always is.
Eigen::Matrix3d
smallestRectangle(const Points& outline)
{
  const auto area = [&](const Eigen::Matrix3d& axes) {
    const Extent extent = extentOf(outline, axes);
    return (extent.high.x() - extent.low.x()) * (extent.high.y() - extent.low.y());
  };
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double best_area = area(best);
  // an outline of thousands of edges is round: its own axes are as good
  if (outline.size() > 500)
    return best;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector3d edge = outline[(i + 1) % outline.size()] - outline[i];
    if (edge.head<2>().norm() < 1e-12)
      continue;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    axes.col(0).head<2>() = edge.head<2>().normalized();
    axes.col(1) = Eigen::Vector3d(-axes(1, 0), axes(0, 0), 0);
    if (const double here = area(axes); here < best_area * (1 - 1e-9)) {
      best_area = here;
      best = axes;
    }
  }
  return best;
}

class Collector {
public:
  Collector(const Part21File& file, ShapeCache& cache) : file_(file), cache_(cache) {}

  void
  item(const Entity& entity, const Eigen::Affine3d& pose, int depth)
  {
    if (depth > max_nesting)
      throw NotSimple("shapes nested deeper than " + std::to_string(max_nesting));
    if (++visited_ > max_parts)
      throw NotSimple("more than " + std::to_string(max_parts) + " parts");
    const std::string_view name = entity.name();
    if (name == "IFCEXTRUDEDAREASOLID" || name == "IFCEXTRUDEDAREASOLIDTAPERED")
      add(extrusion(entity), pose);
    else if (name == "IFCBOUNDINGBOX")
      add(block(Eigen::Isometry3d(
                    Eigen::Translation3d(point(entity.follow(0, "IFCCARTESIANPOINT")))),
                entity,
                "bounding box"),
          pose);
    else if (name == "IFCBLOCK")
      add(block(axisPlacement(entity.follow(0)), entity, "block"), pose);
    else if (name == "IFCCSGSOLID")
      item(entity.follow(0), pose, depth + 1);
    else if (name == "IFCBOOLEANCLIPPINGRESULT" || name == "IFCBOOLEANRESULT") {
      if (entity.at(0).word() != "DIFFERENCE")
        throw NotSimple("a boolean result that is no difference");
      item(entity.follow(1), pose, depth + 1); // not larger than what is cut from
    }
    else if (name == "IFCMAPPEDITEM")
      mapped(entity, pose, depth);
    else if (name == "IFCFACETEDBREP" || name == "IFCFACETEDBREPWITHVOIDS" ||
             name == "IFCFACEBASEDSURFACEMODEL" || name == "IFCSHELLBASEDSURFACEMODEL")
      add(cached(entity, &Collector::faces), pose);
    else if (name == "IFCTRIANGULATEDFACESET" || name == "IFCPOLYGONALFACESET")
      add(cached(entity, &Collector::faceSet), pose);
    else
      throw NotSimple(std::string(name));
  }

  const std::vector<Part>&
  parts() const
  {
    return parts_;
  }

private:
  void
  add(Part part, const Eigen::Affine3d& pose)
  {
    if (part.points.empty())
      throw NotSimple("a shape without points");
    for (Eigen::Vector3d& p : part.points) {
      p = pose * p;
      if (!p.allFinite())
        throw NotSimple("points beyond all numbers");
    }
    Eigen::Matrix3d axes = pose.linear() * part.axes;
    for (int i = 0; i < 3; ++i)
      axes.col(i).normalize();
    // an uneven scale may shear a turned box
    part.axes =
        (axes.transpose() * axes).isIdentity(1e-6) ? axes : Eigen::Matrix3d::Identity();
    parts_.push_back(std::move(part));
  }

  // Of many points only the corners of their box are kept: a shape may be mapped a
  // thousand times. Exact unless parts that are turned against each other are joined.
  Part
  cached(const Entity& entity, Part (Collector::*make)(const Entity&) const)
  {
    const auto known = cache_.find(entity.id());
    if (known != cache_.end())
      return known->second;
    Part part = (this->*make)(entity);
    if (part.points.empty())
      throw NotSimple("a shape without points");
    const Extent extent = extentOf(part.points, part.axes);
    part.points.clear();
    for (int i = 0; i < 8; ++i)
      part.points.emplace_back(part.axes *
                               Eigen::Vector3d((i & 1 ? extent.high : extent.low).x(),
                                               (i & 2 ? extent.high : extent.low).y(),
                                               (i & 4 ? extent.high : extent.low).z()));
    return cache_.emplace(entity.id(), std::move(part)).first->second;
  }

  void
  mapped(const Entity& entity, const Eigen::Affine3d& pose, int depth)
  {
    const Entity map = entity.follow(0, "IFCREPRESENTATIONMAP");
    const Eigen::Affine3d inner = pose * transformation(entity.follow(1)) *
                                  Eigen::Affine3d(axisPlacement(map.follow(0)));
    for (const std::uint64_t id : map.follow(1).references(3))
      item(Entity(file_, id), inner, depth + 1);
  }

  Part
  block(const Eigen::Isometry3d& corner, const Entity& entity, const char* kind) const
  {
    Part out;
    out.kind = kind;
    out.axes = corner.linear();
    const Eigen::Vector3d size(
        positive(entity, 1), positive(entity, 2), positive(entity, 3));
    for (int i = 0; i < 8; ++i)
      out.points.emplace_back(corner * Eigen::Vector3d((i & 1) != 0 ? size.x() : 0,
                                                       (i & 2) != 0 ? size.y() : 0,
                                                       (i & 4) != 0 ? size.z() : 0));
    return out;
  }

  Part
  extrusion(const Entity& entity)
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (entity.referenceIf(1))
      pose = axisPlacement(entity.follow(1));
    const Eigen::Vector3d along =
        positive(entity, 3) * direction(entity.follow(2, "IFCDIRECTION"));
    const Entity swept = entity.follow(0);
    const Points outline = profilePoints(file_, swept);
    Part out;
    out.kind = swept.name() == "IFCRECTANGLEPROFILEDEF" ? "extrusion"
                                                        : "extrusion of an outline";
    out.axes = pose.linear() * smallestRectangle(outline);
    for (const Eigen::Vector3d& p : outline) {
      out.points.push_back(pose * p);
      out.points.push_back(pose * (p + along));
    }
    return out;
  }

  Part
  faceSet(const Entity& entity) const
  {
    Part out;
    out.kind = "face set";
    out.points = pointList(entity.follow(0, "IFCCARTESIANPOINTLIST3D"));
    return aligned(std::move(out));
  }

  // Shells, faces, bounds and loops of points: nothing in them has a frame of its own.
  Part
  faces(const Entity& entity) const
  {
    Part out;
    out.kind = "brep";
    std::set<std::uint64_t> seen;
    std::vector<const Part21Value*> open;
    std::vector<std::uint64_t> next = {entity.id()};
    while (!next.empty()) {
      const Entity here(file_, next.back());
      next.pop_back();
      if (here.name() == "IFCCARTESIANPOINT") {
        out.points.push_back(point(here));
        continue;
      }
      if (here.name() == "IFCADVANCEDFACE" || here.name() == "IFCFACESURFACE")
        throw NotSimple("faces that are curved");
      for (const Part21Value& argument : here.arguments())
        open.push_back(&argument);
      while (!open.empty()) {
        const Part21Value& value = *open.back();
        open.pop_back();
        if (value.is(Part21Value::Kind::reference) && seen.insert(value.id).second)
          next.push_back(value.id);
        for (const Part21Value& item : value.items)
          open.push_back(&item);
      }
    }
    return aligned(std::move(out));
  }

  // If the points are the corners of a box, its axes.
  static Part
  aligned(Part part)
  {
    if (part.points.size() > 64)
      return part;
    const Extent extent = extentOf(part.points, Eigen::Matrix3d::Identity());
    const double tolerance = 1e-6 * (extent.high - extent.low).norm();
    Points corners;
    for (const Eigen::Vector3d& p : part.points)
      if (std::none_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& q) {
            return (p - q).norm() <= tolerance;
          }))
        corners.push_back(p);
    if (corners.size() != 8 || !(tolerance > 0))
      return part;
    // From one corner the three edges are those that are perpendicular to each other
    // and whose ends add up to corners.
    for (int i = 1; i < 8; ++i)
      for (int j = i + 1; j < 8; ++j) {
        const Eigen::Vector3d a = corners[i] - corners[0], b = corners[j] - corners[0];
        if (std::abs(a.dot(b)) > 1e-5 * a.norm() * b.norm())
          continue;
        Eigen::Matrix3d axes;
        axes << a.normalized(), across(a, b), a.cross(b).normalized();
        const Extent turned = extentOf(corners, axes);
        const bool all = std::all_of(
            corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
              const Eigen::Vector3d local = axes.transpose() * corner;
              return (local - turned.low)
                         .cwiseAbs()
                         .cwiseMin((turned.high - local).cwiseAbs())
                         .maxCoeff() <= 10 * tolerance;
            });
        if (all) {
          part.axes = axes;
          return part;
        }
      }
    return part;
  }

  static Eigen::Vector3d
  across(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
  {
    return (b - b.dot(a) / a.squaredNorm() * a).normalized();
  }

  const Part21File& file_;
  ShapeCache& cache_;
  std::vector<Part> parts_;
  std::size_t visited_ = 0;
};

// How much a representation says of the body: the body itself, then boxes, then others.
int
rank(const Entity& representation)
{
  const std::string name = representation.text(1);
  if (name == "Body")
    return 0;
  if (name == "Facetation" || name == "Mesh" || name == "Body-FallBack")
    return 1;
  if (name == "Box")
    return 2;
  return name.empty() ? 3 : 4;
}

OrientedBox
boxOf(const std::vector<Part>& parts)
{
  const auto largest =
      std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return volumeOf(a) < volumeOf(b);
      });
  Eigen::Matrix3d axes = largest->axes;
  if (axes.determinant() < 0)
    axes.col(2) = -axes.col(2);
  Points all;
  for (const Part& part : parts)
    all.insert(all.end(), part.points.begin(), part.points.end());
  const Extent extent = extentOf(all, axes);
  OrientedBox box;
  box.axes = axes;
  box.center = axes * (extent.low + extent.high) / 2;
  box.size = extent.high - extent.low;
  return box;
}

} // namespace

std::optional<OrientedBox>
shapeBox(const Part21File& file,
         std::uint64_t shape,
         ShapeCache& cache,
         std::string& source)
{
  source = "no body";
  std::vector<Entity> representations;
  for (const std::uint64_t id : Entity(file, shape).references(2))
    representations.emplace_back(file, id);
  std::stable_sort(representations.begin(),
                   representations.end(),
                   [](const Entity& a, const Entity& b) { return rank(a) < rank(b); });
  std::string reason;
  for (const Entity& representation : representations) {
    if (rank(representation) > 3)
      break;
    try {
      Collector collector(file, cache);
      for (const std::uint64_t id : representation.references(3))
        collector.item(Entity(file, id), Eigen::Affine3d::Identity(), 0);
      if (collector.parts().empty())
        continue;
      const OrientedBox box = boxOf(collector.parts());
      if (!(box.size.minCoeff() > 0))
        throw NotSimple("a flat shape");
      source = collector.parts().size() == 1
                   ? collector.parts().front().kind
                   : std::to_string(collector.parts().size()) + " parts";
      return box;
    }
    catch (const NotSimple& why) {
      if (reason.empty())
        reason = why.what();
    }
    catch (const LoadError& error) {
      if (reason.empty())
        reason = "line " + error.position() + ": " + error.reason();
    }
  }
  if (!reason.empty())
    source = reason;
  return std::nullopt;
}

} // namespace ifc
} // namespace hoist
