#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace hoist {
namespace simulation {

/** \brief Reads the files of a ZIP archive: stored or deflated, without encryption. */
class ZipArchive {
public:
  /** \throws LoadError if it is no archive */
  explicit ZipArchive(const std::string& file);

  bool
  has(const std::string& name) const
  {
    return entries_.count(name) != 0;
  }

  /** \brief The bytes of a file.
   *  \throws LoadError if it is not there or damaged */
  std::string read(const std::string& name) const;

private:
  struct Entry {
    std::uint32_t offset, packed, size;
    std::uint16_t method;
  };

  std::uint32_t number(std::size_t at, int bytes) const;

  std::string file_;
  std::string bytes_;
  std::map<std::string, Entry> entries_;
};

} // namespace simulation
} // namespace hoist
