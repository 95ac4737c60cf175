#pragma once

// Arguments by number, with a clear word where a file has something else there.

#include <hoist/data/ifc/part21.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hoist {
namespace ifc {

/** \brief A parsed instance. */
class Entity {
public:
  /** \throws LoadError if there is no such instance, or it is complex */
  Entity(const Part21File& file, std::uint64_t id);

  const Part21Instance&
  instance() const
  {
    return *instance_;
  }

  std::uint64_t
  id() const
  {
    return instance_->id;
  }

  /** \brief In upper case. */
  std::string_view
  name() const
  {
    return file_->entity(*instance_);
  }

  const std::vector<Part21Value>&
  arguments() const
  {
    return arguments_;
  }

  /** \brief Argument \a i; one that says nothing where the instance has fewer. */
  const Part21Value& at(std::size_t i) const;

  // Each throws LoadError where the argument is something else. Those that return an
  // optional accept $ (and *).

  double number(std::size_t i) const; ///< also of a typed value with one number
  std::optional<double> numberIf(std::size_t i) const;
  std::uint64_t reference(std::size_t i) const;
  std::optional<std::uint64_t> referenceIf(std::size_t i) const;
  std::vector<std::uint64_t> references(std::size_t i) const; ///< a list; $ is none
  std::vector<double> numbers(std::size_t i) const;           ///< a list
  std::string text(std::size_t i) const;                      ///< "" for $

  /** \brief The instance that argument \a i refers to. */
  Entity
  follow(std::size_t i) const
  {
    return {*file_, reference(i)};
  }

  /** \brief Argument \a i refers to an instance of this name.
   *  \throws LoadError */
  Entity follow(std::size_t i, std::string_view entity) const;

  /** \brief Says what is wrong with argument \a i. */
  [[noreturn]] void fail(std::size_t i, const std::string& expected) const;

private:
  const Part21File* file_;
  const Part21Instance* instance_;
  std::vector<Part21Value> arguments_;
};

/** \brief IfcCartesianPoint of two or three coordinates, in units of the model.
 *  \throws LoadError */
Eigen::Vector3d point(const Entity& entity);

/** \brief IfcDirection, of length 1.
 *  \throws LoadError */
Eigen::Vector3d direction(const Entity& entity);

/** \brief IfcAxis2Placement3D or 2D as a frame (IfcBuildAxes), in units of the model.
 *  \throws LoadError */
Eigen::Isometry3d axisPlacement(const Entity& entity);

/** \brief IfcCartesianTransformationOperator of any kind.
 *  \throws LoadError */
Eigen::Affine3d transformation(const Entity& entity);

/** \brief The name of an entity as the schema spells it, e.g. "IfcWall" of "IFCWALL";
 * as it is if it is none of an element's. */
std::string spelling(std::string_view entity);

/** \brief Whether instances of this entity (in upper case) are elements: things, not
 *  holes or annotations. */
bool isElement(std::string_view entity);

} // namespace ifc
} // namespace hoist
