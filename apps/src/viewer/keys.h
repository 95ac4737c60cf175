#pragma once

#include "viewer/layers.h"

#include <optional>
#include <string>

namespace hoist {

/** \brief What a key of the viewer's own does. */
enum class KeyAction {
  next,
  previous,
  first,
  last,
  next_cuboid,
  close_card,
  labels,
  export_points,
  save_settings,
  toggle_mode,
  next_parameter,
  lower,
  raise,
  reset_parameters,
  next_layout,
  hide_text,
  toggle_help,
  save_camera,
  restore_camera
};

/** \brief The action of a key, none for keys that stay pcl_viewer's.
 *  \param symbol as X names it, e.g. "n", "F7", "Page_Down" */
std::optional<KeyAction> actionOf(const std::string& symbol, bool ctrl, bool alt);

/** \brief The layer that a key switches. */
std::optional<Layer> layerOf(const std::string& symbol);

/** \brief The keys of the layers, a line each. */
std::string layerKeysText();

/** \brief All other keys, the viewer's and pcl_viewer's, a line each. */
std::string keysText();

} // namespace hoist
