#pragma once

#include <hoist/simulation/description.h>

#include <string>
#include <vector>

namespace hoist {
namespace simulation {

/** \brief A benchmark set that is defined by a description and seeds only. */
struct Suite {
  std::string name;
  std::string what;   ///< in one line
  int frames;         ///< of the whole set
  std::uint64_t seed; ///< of the set; no two sets share one
  std::string format; ///< "pcd", "pts" or "compact": what fits it best
  std::string yaml;   ///< its description
};

const std::vector<Suite>& suites();

/** \brief The suite of that name; nullptr if there is none. */
const Suite* findSuite(const std::string& name);

} // namespace simulation
} // namespace hoist
