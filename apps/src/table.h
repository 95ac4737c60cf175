#pragma once

#include <hoist/data/result.h>

#include <cstddef>
#include <ostream>
#include <string>

namespace hoist {

/** \brief One line of counts, largest first: "12 too small, 3 not perpendicular"; ""
 *  if there are none. */
std::string reasonsText(const Tally& tally);

/** \brief The table of cuboids, written row by row as frames are done. */
class CuboidTable {
public:
  /** \param scene_width columns for the names of scenes */
  CuboidTable(std::ostream& out, std::size_t scene_width, bool with_weight);

  /** \brief One row per cuboid, or one that says why there is none. The head of the
   *  table comes with the first. */
  void add(const FrameResult& result);

private:
  std::ostream& out_;
  int scene_width_;
  bool with_weight_;
  bool head_done_ = false;
};

} // namespace hoist
