#pragma once

#include <hoist/data/frame_fields.h>
#include <hoist/data/load_frame.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hoist {
namespace detail {

/** \brief What a field means to a frame. */
enum class Role { none, x, y, z, packed_color, red, green, blue, intensity, u, v };

/** \brief A number type in a file: 'F', 'I' or 'U' and its size in bytes. */
struct NumberType {
  char kind = 'F';
  unsigned size = 4;
};

/** \brief A point of a file, converted. */
struct Record {
  float x = 0, y = 0, z = 0;
  std::uint32_t color = 0xff000000u; // a r g b
  std::uint32_t u = 0, v = 0;
};

/** \brief A file's points before they become a frame. */
struct RawCloud {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::vector<Record> records;
  bool has_color = false;
  bool has_pixels = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  std::string format;
  std::vector<std::string> warnings;
};

/** \brief The role of a field by its name. */
Role roleOf(const std::string& name);

/** \brief Stores a number, given as bytes of this machine's order, in a record. */
void assign(Record& record, Role role, NumberType type, const std::uint8_t* bytes);

/** \brief Writes a number read from text as the bytes that a binary file would hold.
 *  \return false if \a text is no number of that type */
bool textToBytes(const char* text, NumberType type, std::uint8_t* bytes);

/** \brief Checks that x, y, z are there once each; says which colour and pixels there
 *  are. Of several sources of colour the first of packed, parts and intensity stays,
 * the others get Role::none. \throws LoadError */
void checkRoles(const std::string& file, std::vector<Role>& roles, RawCloud& cloud);

/** \brief The start of a file, at most \a bytes; also its whole size.
 *  \throws LoadError if it is no readable regular file, or empty */
std::string readHead(const std::string& file, std::size_t bytes, std::uint64_t& size);

/** \throws LoadError */
RawCloud readPcd(const std::string& file, const LoadOptions& options);

/** \brief The fields of loadFrameFields(). \throws LoadError */
std::vector<FrameField>
readPcdFields(const std::string& file, const LoadOptions& options, std::size_t most);

/** \throws LoadError */
RawCloud readPly(const std::string& file, const LoadOptions& options);

/** \brief The grid of a cloud: kept, or rebuilt from pixels or by projection.
 *  \throws LoadError if there is none */
void makeFrame(const std::string& file,
               RawCloud&& raw,
               const LoadOptions& options,
               LoadedFrame& frame);

} // namespace detail
} // namespace hoist
