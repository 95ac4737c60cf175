#include "viewer/keys.h"

#include <fmt/format.h>

#include <cctype>
#include <vector>

namespace hoist {
namespace {

struct Binding {
  KeyAction action;
  std::vector<const char*> symbols;
  const char* shown;
  const char* text;
};

// None of them is pcl_viewer's.
const std::vector<Binding>&
bindings()
{
  static const std::vector<Binding> all = {
      {KeyAction::next, {"n", "space", "Next"}, "n, space", "next file"},
      {KeyAction::previous, {"b", "BackSpace", "Prior"}, "b", "file before"},
      {KeyAction::first, {"Home"}, "Home", "first file"},
      {KeyAction::last, {"End"}, "End", "last file"},
      {KeyAction::next_cuboid, {"k"}, "k", "card of the next cuboid"},
      {KeyAction::close_card, {"Escape"}, "Esc", "close card and help"},
      {KeyAction::export_points, {"v"}, "v", "save the cuboid's points as PCD"},
      {KeyAction::labels, {"d"}, "d", "sizes on, off"},
      {KeyAction::next_layout, {"a"}, "a", "both views, 3D, image"},
      {KeyAction::hide_text, {"i"}, "i", "legend on, off"},
      {KeyAction::toggle_mode, {"m"}, "m", "full mode, paper mode"},
      {KeyAction::next_parameter, {"t"}, "t", "choose a parameter"},
      {KeyAction::lower, {"bracketleft"}, "[", "less of it"},
      {KeyAction::raise, {"bracketright"}, "]", "more of it"},
      {KeyAction::reset_parameters, {"z"}, "z", "parameters as at the start"},
      {KeyAction::save_settings, {"y"}, "y", "save the settings as YAML"},
  };
  return all;
}

} // namespace

std::optional<KeyAction>
actionOf(const std::string& symbol, bool ctrl, bool alt)
{
  std::string name = symbol;
  if (name.size() == 1) // shift and caps lock make no difference, as in pcl_viewer
    name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  if (ctrl && !alt && name == "s")
    return KeyAction::save_camera;
  if (ctrl && !alt && name == "r")
    return KeyAction::restore_camera;
  if (ctrl || alt)
    return {};
  if (name == "h")
    return KeyAction::toggle_help;
  for (const Binding& binding : bindings())
    for (const char* own : binding.symbols)
      if (name == own)
        return binding.action;
  return {};
}

std::optional<Layer>
layerOf(const std::string& symbol)
{
  for (const LayerInfo& info : layerTable())
    if (symbol == info.key)
      return info.layer;
  return {};
}

std::string
layerKeysText()
{
  std::string text;
  for (const LayerInfo& info : layerTable())
    text += fmt::format("{:<12}{}\n", info.key, info.text);
  return text;
}

std::string
keysText()
{
  std::string text;
  for (const Binding& binding : bindings())
    text += fmt::format("{:<12}{}\n", binding.shown, binding.text);
  text += "Shift+click pick a point, card of a cuboid\n"
          "click       in the image: pick a pixel\n"
          "As in pcl_viewer:\n"
          "1-6         colour: one, by x, y, z, rgb, by object\n"
          "7-9 0 ^1-^0 colour: other fields of the file\n"
          "+ -         size of the points\n"
          "r, f        reset the camera, fly to a point\n"
          "Ctrl+s, r   save, restore the camera\n"
          "p w s       points, wireframe, surface\n"
          "j, c        screenshot, print the camera\n"
          "g, u, o     grid, lookup table, projection\n"
          "x, l, h     rubber band, list, this help\n"
          "q           end\n";
  return text;
}

} // namespace hoist
