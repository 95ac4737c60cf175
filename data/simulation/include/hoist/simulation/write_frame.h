#pragma once

#include <hoist/simulation/simulate.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief What is written of a frame, beside NAME.json with its truth and
 *  NAME.instances.png with the labels of its pixels. */
enum class FrameFormat {
  pcd,    ///< NAME.pcd: organized, compressed
  pts,    ///< NAME.pts: Bumblebee, as the stereo camera's own software
  compact ///< NAME.jpg and NAME.depth.png (16 bits, 0.25 mm a unit)
};

/** \brief The files that writeFrame() makes, the truth last. */
std::vector<std::filesystem::path> frameFiles(const std::filesystem::path& stem,
                                              const std::vector<FrameFormat>& formats);

/** \brief Writes a frame; names start with \a stem. The truth comes last, so that a
 * frame with a truth is complete. \return the bytes written \throws pcl::IOException if
 * a file cannot be written */
std::uint64_t writeFrame(const Frame& frame,
                         const std::filesystem::path& stem,
                         const std::vector<FrameFormat>& formats);

} // namespace simulation
} // namespace hoist
