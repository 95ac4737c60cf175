#pragma once

#include <hoist/data/export.h>
#include <hoist/data/load_error.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace hoist {

/** \brief One argument of an instance. It points into the file's bytes. */
struct Part21Value {
  enum class Kind {
    unset,       ///< $
    derived,     ///< *
    integer,     ///< 12
    real,        ///< 1.5E-3
    text,        ///< 'it''s'
    binary,      ///< "0F"
    enumeration, ///< .METRE.
    reference,   ///< #12
    list,        ///< (..., ...)
    typed        ///< IFCLABEL('a'): word() is its name, items its arguments
  };

  Kind kind = Kind::unset;
  std::string_view raw;           ///< its bytes in the file, without spaces around
  double number = 0;              ///< of integers and reals
  std::uint64_t id = 0;           ///< of references
  std::vector<Part21Value> items; ///< of lists and typed values

  bool
  is(Kind wanted) const
  {
    return kind == wanted;
  }

  bool
  isNumber() const
  {
    return kind == Kind::integer || kind == Kind::real;
  }

  /** \brief Of an enumeration what stands between the dots, of a typed value its name;
   *  else empty. */
  HOIST_DATA_EXPORT std::string_view word() const;

  /** \brief Of a text its characters as UTF-8 (see decodePart21()); else empty. */
  HOIST_DATA_EXPORT std::string text() const;
};

/** \brief A name with arguments: an instance, a part of a complex one, or a line of the
 *  header. */
struct Part21Record {
  std::string_view name; ///< in upper case
  std::vector<Part21Value> arguments;
};

/** \brief Where an instance stands in the file: bytes [begin, end). */
struct Part21Instance {
  std::uint64_t id = 0;
  std::size_t begin = 0;  ///< of "#"
  std::size_t body = 0;   ///< of the first byte behind "=" that is no space
  std::size_t end = 0;    ///< behind ";"
  std::uint32_t name = 0; ///< number of its entity
};

/** \brief A lossless index of a STEP file (ISO 10303-21), the clear text that IFC
 * models are exchanged in.
 *
 * The bytes are kept as they are; of every instance it is known where it stands, and
 * its arguments are parsed when they are asked for. One header and one DATA section,
 * as IFC has it; what is more is refused. Copies share the bytes.
 *
 * Every error is a LoadError whose position() is the line, and whose reason() says what
 * was expected there and at which byte.
 */
class HOIST_DATA_EXPORT Part21File {
public:
  /** \brief Reads a file. Its first bytes are looked at before the rest is read.
   *  \param max_bytes larger files are refused
   *  \throws LoadError */
  static Part21File read(const std::filesystem::path& path,
                         std::uintmax_t max_bytes = std::uintmax_t(4) << 30);

  /** \brief The same of bytes; \a name of the file, for messages.
   *  \throws LoadError */
  static Part21File parse(std::string bytes, const std::string& name = "STEP file");

  /** \brief All bytes of the file. */
  const std::string&
  bytes() const
  {
    return *bytes_;
  }

  /** \brief The file as it was named by the caller. */
  const std::string&
  name() const
  {
    return name_;
  }

  /** \brief The lines of the header, in order. */
  const std::vector<Part21Record>&
  header() const
  {
    return header_;
  }

  /** \brief All instances, in the order of the file. */
  const std::vector<Part21Instance>&
  instances() const
  {
    return instances_;
  }

  /** \brief Offset of the ENDSEC that ends the instances. */
  std::size_t
  dataEnd() const
  {
    return data_end_;
  }

  /** \brief The largest id; 0 if there is no instance. */
  std::uint64_t maxId() const;

  /** \brief The instance with that id; nullptr if there is none. */
  const Part21Instance* find(std::uint64_t id) const;

  /** \brief The name in upper case, e.g. "IFCWALL"; "" for a complex instance. */
  std::string_view entity(const Part21Instance& instance) const;

  /** \brief Numbers (in instances()) of all that have this name, in upper case. Parts
   * of complex instances are not among them. */
  const std::vector<std::uint32_t>& ofType(std::string_view entity) const;

  /** \brief The parts of an instance: one, or several of a complex one.
   *  \throws LoadError */
  std::vector<Part21Record> records(const Part21Instance& instance) const;

  /** \brief The arguments of an instance that is not complex.
   *  \throws LoadError */
  std::vector<Part21Value> arguments(const Part21Instance& instance) const;

  /** \brief How often each instance is referred to, in the order of instances().
   *  \throws LoadError if something refers to an instance that is not there */
  std::vector<std::uint32_t> countReferences() const;

  /** \brief Says what is wrong at a byte of the file.
   *  \throws LoadError always */
  [[noreturn]] void fail(std::size_t offset, const std::string& reason) const;

private:
  Part21File() = default;

  void index();
  void indexIds();

  std::shared_ptr<const std::string> bytes_;
  std::string name_;
  std::vector<Part21Record> header_;
  std::vector<Part21Instance> instances_;
  std::size_t data_end_ = 0;
  std::vector<std::string> names_; ///< upper case; number 0 is "", complex instances
  std::vector<std::vector<std::uint32_t>> by_name_;
  std::unordered_map<std::string, std::uint32_t> name_numbers_;
  /// Numbers of instances by id, or, where ids are dense, at the place of their id.
  std::vector<std::uint32_t> by_id_;
  bool dense_ = false;
};

/** \brief A text of a STEP file as UTF-8: resolves '' \\ \S\ \X\ \X2\ \X4\, and takes
 *  bytes that are no UTF-8 for Latin-1. What is no complete escape stays as it is.
 *  \param quoted with the quotes around it */
HOIST_DATA_EXPORT std::string decodePart21(std::string_view quoted);

/** \brief UTF-8 as a text of a STEP file, with its quotes. Only printable ASCII comes
 *  out; bytes that are no UTF-8 are taken for Latin-1. */
HOIST_DATA_EXPORT std::string encodePart21(std::string_view text);

} // namespace hoist
