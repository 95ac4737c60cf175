#pragma once

#include <hoist/data/export.h>
#include <hoist/data/ifc/part21.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hoist {

/** \brief Bytes [begin, end) of a file and what stands there instead. */
struct Part21Replacement {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text;
};

/** \brief The bytes after replacements that are in order and do not overlap. */
HOIST_DATA_EXPORT std::string
applyReplacements(std::string_view bytes,
                  const std::vector<Part21Replacement>& replacements);

/** \brief A number as Part 21 writes it: with a decimal point, no more than \a decimals
 *  of them, no zeros at the end; "-0." is "0.".
 *  \throws pcl::BadArgumentException if it is not finite */
HOIST_DATA_EXPORT std::string part21Real(double value, int decimals = 9);

/** \brief "#12". */
HOIST_DATA_EXPORT std::string part21Reference(std::uint64_t id);

/** \brief Changes to a STEP file that touch nothing else: arguments of instances are
 *  replaced where they stand, new instances go before the ENDSEC. */
class HOIST_DATA_EXPORT Part21Edit {
public:
  /** \param file must outlive the edit */
  explicit Part21Edit(const Part21File& file);

  const Part21File&
  file() const
  {
    return *file_;
  }

  /** \brief Adds an instance behind all others.
   *  \param entity in upper case
   *  \param arguments as they stand in the file
   *  \return its id
   *  \throws pcl::BadArgumentException if there is no id left */
  std::uint64_t append(std::string_view entity, std::vector<std::string> arguments);

  /** \brief Replaces an argument.
   *  \throws LoadError if the instance is not there or has fewer arguments */
  void set(std::uint64_t id, std::size_t argument, std::string text);

  /** \brief The text of an argument as it is now; "" where the instance has fewer.
   *  \throws LoadError if the instance is not there */
  std::string get(std::uint64_t id, std::size_t argument) const;

  /** \brief The name of an instance, old or new; "" if there is none or it is complex.
   */
  std::string_view entity(std::uint64_t id) const;

  /** \brief Whether the instance was appended. */
  bool
  isNew(std::uint64_t id) const
  {
    return added_.count(id) != 0;
  }

  /** \brief How often something was appended or replaced by something else. */
  std::size_t
  touched() const
  {
    return touched_;
  }

  /** \brief Whether the bytes would change. */
  bool empty() const;

  /** \brief What changes, in the order of the file. */
  std::vector<Part21Replacement> replacements() const;

  /** \brief The bytes of the changed file. */
  std::string bytes() const;

  /** \brief Changed instances before ("-") and after ("+"), new ones ("+"), one a line.
   */
  std::string diff() const;

private:
  struct Added {
    std::string entity;
    std::vector<std::string> arguments;
  };

  std::uint64_t freeId();
  static std::string textOf(std::uint64_t id, const Added& added);

  const Part21File* file_;
  std::uint64_t next_id_ = 1;
  bool ids_in_gaps_ = false;
  std::size_t touched_ = 0;
  /// Of instances of the file: argument -> its new text and where it stands.
  std::map<std::uint64_t, std::map<std::size_t, Part21Replacement>> changed_;
  std::map<std::uint64_t, Added> added_;
  std::vector<std::uint64_t> order_; ///< of what was added
};

} // namespace hoist
