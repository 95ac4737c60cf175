#include "settings.h"

#include "failures.h"
#include "validators.h"
#include "yaml_settings.h"

#include <hoist/recognition/weight.h>

#include <filesystem>
#include <map>

namespace hoist {
namespace {

void
addCommon(CLI::App& command, RecognizeSettings& s)
{
  command.add_option("FILE", s.files, "PCD, PTS or PLY files of organized clouds")
      ->required()
      ->check(CLI::ExistingFile)
      ->configurable(false)
      ->type_name("");
  command
      .add_option("-o,--output", s.output, "Folder for the results; made if missing")
      ->type_name("DIR");
  command
      .add_option("--formats",
                  s.formats,
                  "What to write into DIR, comma separated: json, png (overlay), csv, "
                  "pcd (points labelled by cuboid), ply (wireframes)")
      ->delimiter(',')
      ->check(CLI::IsMember({"json", "png", "csv", "pcd", "ply"}))
      ->type_name("LIST")
      ->capture_default_str();
  command
      .add_option("--json",
                  s.json,
                  "Write the results of all files as one JSON text to FILE; - is the "
                  "standard output, without the table")
      ->type_name("FILE");
  command
      .add_option("-c,--config",
                  s.config,
                  "YAML file of settings: the long options below without their dashes")
      ->check(CLI::ExistingFile)
      ->configurable(false)
      ->type_name("FILE");
  command
      .add_option_function<std::vector<std::string>>(
          "--why",
          [&s](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              s.why.push_back(parsePixel(text));
          },
          "Say what was thought at this pixel and why it is in no cuboid; full mode; "
          "may be given more than once")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->configurable(false)
      ->type_name("U,V");
  command.add_flag("-q,--quiet", s.quiet, "No progress")->configurable(false);
}

constexpr const char* what_to_look_for = "What to look for";

void
addSizes(CLI::App& command, FullModeParameters& p)
{
  const auto addRange = [&](const std::string& name, SideRange& range) {
    const std::string option = "--" + name;
    command
        .add_option_function<std::string>(
            option,
            [option, &range](const std::string& text) {
              const std::string meaning =
                  "MIN,MAX: two lengths in metres, 0 <= MIN <= MAX, e.g. 0.2,0.45";
              const auto n = parseNumbers(option, text, 2, meaning);
              if (n[0] < 0 || n[1] < n[0])
                throw CLI::ValidationError(option, "'" + text + "' is not " + meaning);
              range = {n[0], n[1]};
            },
            "What the " + name + " side may measure [m]")
        ->type_name("MIN,MAX")
        ->group(what_to_look_for);
  };
  addRange("longest", p.ranges[0]);
  addRange("middle", p.ranges[1]);
  addRange("shortest", p.ranges[2]);
  command
      .add_option_function<std::vector<std::string>>(
          "--known-size",
          [&p](const std::vector<std::string>& texts) {
            p.known.clear();
            for (const std::string& text : texts) {
              const std::string meaning =
                  "three lengths in metres, each > 0, e.g. 0.4,0.3,0.2";
              const auto n = parseNumbers("--known-size", text, 3, meaning, true);
              for (std::size_t i = 0; i < n.size(); i += 3) {
                p.known.emplace_back(n[i], n[i + 1], n[i + 2]);
                if (p.known.back().minCoeff() <= 0)
                  throw CLI::ValidationError("--known-size",
                                             "'" + text + "' is not " + meaning);
              }
            }
          },
          "Only boxes of this size, whose hidden sides are then known; may be given "
          "more than once")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("L,W,H")
      ->group(what_to_look_for);
  command
      .add_option("--known-tolerance",
                  p.tolerance,
                  "How far a side may be from the known one [m]")
      ->check(numberIn(1e-4, 10))
      ->type_name("M")
      ->capture_default_str()
      ->group(what_to_look_for);
}

void
addMethod(CLI::App& command, RecognizeSettings& s)
{
  const char* const group = what_to_look_for;
  command
      .add_option("--mode",
                  s.mode,
                  "full: from faces and where they end, verified; paper: the published "
                  "method to the letter")
      ->check(CLI::IsMember({"paper", "full"}))
      ->type_name("MODE")
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<std::string>(
          "--sensor",
          [&s](const std::string& text) { s.full.sensor = parseSensor(text); },
          "Depth noise: kinect; stereo:FB[,SIGMA] with focal length times baseline "
          "[px m] and sigma of the disparity [px, 0.2]; constant:SIGMA [m]")
      ->type_name("MODEL")
      ->default_str("kinect")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--roi",
          [&s](const std::string& text) { s.region = parseRegion(text); },
          "Only this part of the frame, e.g. a detector's box: u,v,w,h in pixels")
      ->type_name("BOX")
      ->group(group);
  command.add_option("--min-side", s.full.min_side, "Shortest side of a cuboid [m]")
      ->check(numberIn(0.001, 1000))
      ->type_name("M")
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-side", s.full.max_side, "Longest side of a cuboid [m]")
      ->check(numberIn(0.001, 1000))
      ->type_name("M")
      ->capture_default_str()
      ->group(group);
  addSizes(command, s.full);
  command
      .add_flag("--single-faces",
                s.full.single_faces,
                "Also boxes of which one face alone is seen; any flat rectangle is one")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--support-plane",
          [&s](const std::string& text) {
            const auto n = parseNumbers(
                "--support-plane", text, 4, "four numbers a,b,c,d, e.g. 0,-1,0,1.6");
            s.full.support_plane = Eigen::Vector4d(n[0], n[1], n[2], n[3]);
            if (s.full.support_plane->head<3>().norm() == 0)
              throw CLI::ValidationError(
                  "--support-plane", "'" + text + "' has no normal: a, b and c are 0");
          },
          "What the boxes stand on: a x + b y + c z + d = 0 in the camera frame [m]")
      ->type_name("A,B,C,D")
      ->group(group);
  command.add_option("--min-score", s.full.min_score, "Lowest score of a cuboid")
      ->check(numberIn(0, 1))
      ->type_name("S")
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-cuboids", s.full.max_cuboids, "Keep the best N; 0: all")
      ->check(integerIn(0, 1000000))
      ->type_name("N")
      ->capture_default_str()
      ->group(group);

  std::vector<std::string> names;
  for (const Material& material : materials())
    names.emplace_back(material.name);
  std::string list;
  for (const std::string& name : names)
    list += (list.empty() ? "" : ", ") + name;
  command
      .add_option(
          "--material", s.material, "What they are made of, for the weight: " + list)
      ->check(CLI::IsMember(names))
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--white-balance",
                  s.white_balance,
                  "Before colours are named: white-patch, grey-world or none")
      ->check(CLI::IsMember({"grey-world", "white-patch", "none"}))
      ->type_name("RULE")
      ->capture_default_str()
      ->group(group);
}

// One number of the paper mode.
template <typename Number>
void
addNumber(CLI::App& command,
          const char* group,
          const char* name,
          Number& value,
          const CLI::Validator& range,
          const char* description)
{
  command.add_option(name, value, description)
      ->check(range)
      ->type_name("N")
      ->capture_default_str()
      ->group(group);
}

void
addEdges(CLI::App& command, CannyParameters& c)
{
  const char* const group = "Paper mode: edge pixels (4.2.1)";
  const auto add =
      [&](const char* name, auto& value, const auto& range, const char* text) {
        addNumber(command, group, name, value, range, text);
      };
  add("--canny-blur", c.blur_sigma, numberIn(0, 5), "Blur before the gradient [px]");
  command
      .add_option_function<double>(
          "--canny-high",
          [&c](double high) {
            c.high = high;
            c.auto_threshold = false;
          },
          "Fixed upper threshold, instead of one chosen from the image")
      ->check(numberIn(1e-3, 1e4))
      ->type_name("N")
      ->group(group);
  command
      .add_option_function<double>(
          "--canny-low",
          [&c](double low) {
            c.low = low;
            c.auto_threshold = false;
          },
          "Fixed lower threshold")
      ->check(numberIn(1e-3, 1e4))
      ->type_name("N")
      ->group(group);
  add("--canny-edge-share",
      c.edge_share,
      numberIn(1e-4, 0.9999),
      "Share of the pixels above the chosen upper threshold");
  add("--canny-noise-factor",
      c.noise_factor,
      numberIn(0, 1000),
      "The chosen upper threshold is at least this times the median gradient");
  add("--canny-low-ratio",
      c.low_ratio,
      numberIn(1e-3, 1),
      "Lower threshold as a share of the upper one");
  command
      .add_flag_callback(
          "--keep-texture",
          [&c] { c.remove_texture = false; },
          "Keep clustered contours, which are print rather than edges")
      ->group(group);
  add("--texture-window",
      c.texture_window,
      integerIn(0, 1000),
      "Side of the texture window [px]; 0: width / 40");
  add("--texture-density",
      c.texture_density,
      numberIn(1e-3, 1),
      "Share of contour pixels that makes texture");
  add("--straight-length",
      c.straight_length,
      numberIn(0, 10000),
      "Straight runs this long are edges [px]; 0: width / 32");
}

void
addSchedule(CLI::App& command, PaperModeParameters& p)
{
  const char* const group = "Paper mode: the circular process (Figure 4)";
  const auto add =
      [&](const char* name, auto& value, const auto& range, const char* text) {
        addNumber(command, group, name, value, range, text);
      };
  add("--first-scale",
      p.first_scale,
      numberIn(1e-3, 1000),
      "Both thresholds times this in the first round");
  add("--scale-factor",
      p.scale_factor,
      numberIn(0.01, 0.99),
      "And times this from round to round");
  add("--max-rounds", p.max_rounds, integerIn(1, 1000), "Rounds at most");
  command
      .add_flag_callback(
          "--all-rounds",
          [&p] { p.stop_when_satisfied = false; },
          "Go through all rounds and keep the best cuboid of each box")
      ->group(group);
}

void
addLines(CLI::App& command, PaperModeParameters& p)
{
  const char* const group = "Paper mode: line segments and vertices (4.2.2 to 4.2.4)";
  const auto add =
      [&](const char* name, auto& value, const auto& range, const char* text) {
        addNumber(command, group, name, value, range, text);
      };
  add("--hough-rho", p.hough.rho, numberIn(0.1, 100), "Distance step [px]");
  add("--hough-theta", p.hough.theta, numberIn(1e-3, 1.5), "Angle step [rad]");
  add("--hough-threshold", p.hough.threshold, integerIn(1, 100000), "Votes of a line");
  add("--hough-min-length", p.hough.min_length, numberIn(0, 1e4), "Shortest [px]");
  add("--hough-max-gap", p.hough.max_gap, numberIn(0, 1e4), "Longest hole [px]");
  add("--end-search-radius",
      p.end_search_radius,
      integerIn(0, 100),
      "How far to look for the point of an end without depth [px]");
  add("--min-segment", p.min_length, numberIn(0, 1000), "Shortest segment [m]");
  add("--cluster-distance",
      p.distance_threshold,
      numberIn(0, 1000),
      "D of equation 1: ends this near are one vertex [m]");
  add("--tolerance",
      p.tolerance,
      numberIn(0, 1000),
      "Of equation 3: largest |cosine| of two perpendicular segments");
  command
      .add_flag_callback(
          "--raw-delta",
          [&p] { p.normalized = false; },
          "Equation 3 with vectors in metres, as printed, instead of unit vectors")
      ->group(group);
  add("--max-degree",
      p.max_degree,
      integerIn(3, 1000000),
      "Vertices of more segments are not searched");
}

// Two inputs must not write one file.
void
checkOutputNames(const RecognizeSettings& s)
{
  std::map<std::string, std::string> owners;
  for (const std::string& file : s.files) {
    const std::string stem = std::filesystem::path(file).stem().string();
    const auto [owner, added] = owners.emplace(stem, file);
    if (!added)
      throw UsageError(owner->second + " and " + file + " would both write " +
                       (std::filesystem::path(s.output) / stem).string() + ".*");
  }
}

} // namespace

void
addRecognizeOptions(CLI::App& command, RecognizeSettings& settings)
{
  addCommon(command, settings);
  addMethodOptions(command, settings);
}

void
addMethodOptions(CLI::App& command, RecognizeSettings& settings)
{
  addMethod(command, settings);
  addEdges(command, settings.paper.canny);
  addSchedule(command, settings.paper);
  addLines(command, settings.paper);
}

void
completeSettings(CLI::App& command, RecognizeSettings& settings)
{
  if (!settings.config.empty())
    applyYaml(command, settings.config);
  checkMethod(settings);
  if (!settings.why.empty() && settings.mode != "full")
    throw UsageError("--why explains the full mode only");
  if (!settings.why.empty() && settings.json == "-")
    throw UsageError("--why writes to the standard output, and so does --json -");
  if (!settings.output.empty())
    checkOutputNames(settings);
}

void
checkMethod(const RecognizeSettings& settings)
{
  if (settings.full.min_side > settings.full.max_side)
    throw UsageError("--min-side is larger than --max-side");
  if (settings.paper.canny.low > settings.paper.canny.high)
    throw UsageError("--canny-low is larger than --canny-high");
}

} // namespace hoist
