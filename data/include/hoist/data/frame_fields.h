#pragma once

#include <hoist/data/export.h>
#include <hoist/data/load_frame.h>

#include <cstddef>
#include <string>
#include <vector>

namespace hoist {

/** \brief A field of a file that is neither a coordinate nor packed colour, e.g.
 *  "curvature" or "label". */
struct FrameField {
  std::string name;
  std::vector<float> values; ///< by index of the frame's cloud
};

/** \brief The further fields of a frame, for those who show them; nothing else of hoist
 *  needs them.
 *
 * Fields of one number per point of any type, in the order of the file, at most \a most
 * of them; padding ("_") is none. Only PCD files that are organized have them: where
 * loadFrame() rebuilds the grid, and in other formats, there are none. Reads only the
 * header of a file without any.
 * \throws LoadError as loadFrame()
 */
HOIST_DATA_EXPORT std::vector<FrameField>
loadFrameFields(const std::string& file,
                std::size_t most = 16,
                const LoadOptions& options = {});

} // namespace hoist
