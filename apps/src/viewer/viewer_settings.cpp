#include "viewer/viewer_settings.h"

#include "failures.h"
#include "validators.h"
#include "yaml_settings.h"

#include <array>
#include <charconv>

namespace hoist {
namespace {

struct LayerWord {
  const char* word;
  Layer layer;
};

// In the order of Layer.
constexpr std::array<LayerWord, layer_count> layer_words = {
    {{"cloud", Layer::cloud},
     {"colour-edges", Layer::color_edges},
     {"occlusion-edges", Layer::occlusion_edges},
     {"crease-edges", Layer::crease_edges},
     {"segments", Layer::segments},
     {"vertices", Layer::vertices},
     {"cuboids", Layer::cuboids},
     {"faces", Layer::faces},
     {"uncertainty", Layer::uncertainty},
     {"rejected", Layer::rejected},
     {"detections", Layer::detections},
     {"truth", Layer::truth}}};

// "1600x720"
cv::Size
parseSize(const std::string& text)
{
  cv::Size size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  bool good = width.ec == std::errc() && width.ptr < end && *width.ptr == 'x';
  if (good) {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    good = height.ec == std::errc() && height.ptr == end;
  }
  constexpr int least = 200, most = 8192;
  if (!good || size.width < least || size.height < least || size.width > most ||
      size.height > most)
    throw CLI::ValidationError(
        "--size",
        "'" + text + "' is not WIDTHxHEIGHT of 200 to 8192 px, e.g. 1600x720");
  return size;
}

void
addView(CLI::App& program, ViewerSettings& s)
{
  const char* const group = "The view";
  std::vector<std::string> words;
  std::string list;
  for (const LayerWord& word : layer_words) {
    words.emplace_back(word.word);
    list += (list.empty() ? "" : ", ") + words.back();
  }
  program
      .add_option("--layers",
                  s.layers,
                  "Show exactly these at the start, comma separated: " + list)
      ->delimiter(',')
      ->check(CLI::IsMember(words))
      ->configurable(false)
      ->type_name("LIST")
      ->group(group);
  program
      .add_option("--camera", s.camera, "Look from here: a .cam file, as pcl_viewer's")
      ->check(CLI::ExistingFile)
      ->configurable(false)
      ->type_name("FILE")
      ->group(group);
  program
      .add_option_function<std::string>(
          "--size",
          [&s](const std::string& text) { s.size = parseSize(text); },
          "Of the window or picture [px]")
      ->configurable(false)
      ->type_name("WxH")
      ->default_str("1600x720")
      ->group(group);
  program
      .add_option(
          "--detections",
          s.beside.detections,
          "Detector's boxes: a JSON file, or a folder with <stem>.json; else "
          "<stem>.detections.json beside the cloud, else the boxes of the truth")
      ->check(CLI::ExistingPath)
      ->configurable(false)
      ->type_name("PATH")
      ->group(group);
  program
      .add_option(
          "--truth",
          s.beside.truth,
          "Ground truth: a JSON file, or a folder with <stem>.json; else beside "
          "the cloud or in ../truth or ../gt")
      ->check(CLI::ExistingPath)
      ->configurable(false)
      ->type_name("PATH")
      ->group(group);
}

void
addOutput(CLI::App& program, ViewerSettings& s)
{
  program
      .add_option("-o,--output",
                  s.output,
                  "Folder for what keys save: points, settings, camera")
      ->configurable(false)
      ->type_name("DIR")
      ->capture_default_str();
  program
      .add_option("-c,--config",
                  s.recognize.config,
                  "YAML file of settings, as for hoist recognize")
      ->check(CLI::ExistingFile)
      ->configurable(false)
      ->type_name("FILE");
  program
      .add_flag("-v,--verbose",
                s.verbose,
                "Say how long every step took until it was on the screen")
      ->configurable(false);
  program
      .add_option("--screenshot",
                  s.screenshot,
                  "Write a picture instead of opening a window; needs no display")
      ->configurable(false)
      ->type_name("PNG");
  program
      .add_option("--frames",
                  s.frames,
                  "With --screenshot: pictures of the first N files; if N > 1 their "
                  "names end in -1, -2, ...")
      ->check(integerIn(1, 1000000))
      ->configurable(false)
      ->type_name("N")
      ->capture_default_str();
}

} // namespace

void
addViewerOptions(CLI::App& program, ViewerSettings& s)
{
  program
      .add_option("INPUT",
                  s.inputs,
                  "PCD, PTS or PLY files of organized clouds, or folders of them")
      ->required()
      ->configurable(false)
      ->type_name("");
  addOutput(program, s);
  addView(program, s);
  addMethodOptions(program, s.recognize);
}

void
completeViewerSettings(CLI::App& program, ViewerSettings& settings)
{
  if (!settings.recognize.config.empty())
    applyYaml(program, settings.recognize.config);
  checkMethod(settings.recognize);
  if (settings.frames > 1 && settings.screenshot.empty())
    throw UsageError("--frames goes with --screenshot");
}

LayerSet
layersOf(const ViewerSettings& settings)
{
  LayerSet layers;
  if (settings.layers.empty())
    return layers;
  for (const LayerWord& word : layer_words) {
    bool named = false;
    for (const std::string& name : settings.layers)
      named = named || name == word.word;
    layers.set(word.layer, named);
  }
  return layers;
}

} // namespace hoist
