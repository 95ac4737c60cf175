#pragma once

#include <hoist/simulation/description.h>
#include <hoist/simulation/write_frame.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace hoist {

/** \brief What a run of the simulator is to make. */
struct SimulationRun {
  simulation::Description description;
  std::uint64_t seed = 0;
  int first = 0; ///< number of the first frame
  int count = 1;
  std::filesystem::path folder;
  std::vector<simulation::FrameFormat> formats;
  int threads = 1;
  /// Frames of which all files are in the folder, from the same seed, are left as they
  /// are.
  bool resume = false;
  bool quiet = false;
};

/** \brief What a run has made. */
struct SimulationReport {
  int frames = 0;
  int kept = 0; ///< of frames that were there
  std::uint64_t bytes = 0;
  double seconds = 0;
};

/** \brief Makes the frames in parallel, with progress on stderr. Which thread makes
 * which frame changes nothing. \throws what the first frame that fails throws, after
 * the others in work are done */
SimulationReport runSimulation(const SimulationRun& run);

} // namespace hoist
