#pragma once

#include <hoist/data/pts_stream.h>

#include <cstddef>
#include <string>
#include <vector>

namespace hoist {
namespace detail {

/** \brief What a column means. */
enum class Column { x, y, z, red, green, blue, alpha, u, v, scalar, skip };

/** \brief A file's layout. */
struct Layout {
  std::vector<Column> columns;
  std::vector<std::string> names; ///< of the fields; scalars use theirs
  std::size_t header_lines = 0;   ///< lines before the first record
};

/** \brief Finds the layout from the first lines, or takes the caller's field list.
 *
 * \param begin, end whole lines from the file's start
 * \param report dialect, fields, declared and unit_colors are set
 * \throws LoadError
 */
Layout findLayout(const std::string& file,
                  const char* begin,
                  const char* end,
                  const PTSOptions& options,
                  PTSReport& report);

} // namespace detail
} // namespace hoist
