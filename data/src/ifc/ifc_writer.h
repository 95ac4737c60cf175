#pragma once

#include <hoist/data/ifc/ifc_edit.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace hoist {
namespace ifc {

using Id = std::uint64_t; ///< 0 for none
using Arguments = std::vector<std::string>;

/** \brief Writes instances so that what others refer to is not changed. */
class Writer {
public:
  explicit Writer(const IfcModel& model);

  const IfcModel&
  model() const
  {
    return *model_;
  }

  Part21Edit&
  edit()
  {
    return edit_;
  }

  /** \brief Makes an instance say \a arguments.
   *  \param existing the instance that should, if it may be changed: it is if it has
   *  this name and at most one other instance refers to it. 0: a new one
   *  \return its id: \a existing if that could be used */
  Id write(Id existing, std::string_view entity, const Arguments& arguments);

  /** \brief An instance that says \a arguments and that anybody may refer to: one that
   *  is there, or a new one. */
  Id shared(std::string_view entity, const Arguments& arguments);

  /** \brief The instance that an argument refers to; 0 for none. */
  Id reference(Id id, std::size_t argument) const;

  /** \brief The instances of a list of references. */
  std::vector<Id> references(Id id, std::size_t argument) const;

  /** \brief A number argument; NaN if it is none. */
  double number(Id id, std::size_t argument) const;

  /** \brief How many instances refer to it. */
  std::uint32_t references(Id id) const;

  /** \brief Relations that say something of an object, of the file and of this edit. */
  std::vector<Id> relations(std::string_view relation, Id object) const;

  /** \brief Appends a relation of one object.
   *  \param relating what is said of it */
  Id relate(std::string_view relation, Id object, Id relating, const std::string& guid);

  /** \brief Takes an object out of a relation of several, so that it can get its own.
   */
  void unrelate(Id relation, Id object);

  /** \brief The owner history of what is written here. */
  Id ownerHistory();

  /** \brief IfcAxis2Placement3D and what it is made of, in units of the model.
   *  \param existing one that nobody else uses, or 0 */
  Id axisPlacement(Id existing, const Eigen::Isometry3d& pose);

  // As they stand in a file.
  std::string globalId(const std::string& key) const; ///< of a key, quoted
  static std::string list(const std::vector<Id>& ids);
  static std::string text(std::string_view text); ///< "" becomes $
  static std::string ref(Id id);                  ///< 0 becomes $

private:
  const IfcModel* model_;
  Part21Edit edit_;
  Id owner_history_ = 0;
  std::map<std::string, std::unordered_map<std::string, Id>> by_text_;
  std::unordered_map<Id, std::uint32_t> more_references_;
  std::map<std::string, std::unordered_map<Id, std::vector<Id>>> added_relations_;
  std::map<std::pair<std::string, Id>, std::vector<Id>> removed_relations_;
};

} // namespace ifc
} // namespace hoist
