#pragma once

#include <filesystem>
#include <vector>

namespace hoist {
namespace samples {

/** \brief Renders sampleScenes() into FOLDER/scenes and FOLDER/truth.
 *
 * Every scene becomes an organized, compressed PCD; those of 320 x 240 a Bumblebee PTS
 * as well.
 * \return the files written
 * \throws std::runtime_error if a file cannot be written
 */
std::vector<std::filesystem::path> writeSamples(const std::filesystem::path& folder);

} // namespace samples
} // namespace hoist
