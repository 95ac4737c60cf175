#include "commands.h"
#include "failures.h"

#include <hoist/data/load_frame.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace hoist {
namespace {

void
printFrame(const std::string& file, const LoadedFrame& frame)
{
  const auto& cloud = *frame.cloud;
  std::vector<float> depths;
  for (const auto& p : cloud)
    if (std::isfinite(p.z))
      depths.push_back(p.z);
  std::sort(depths.begin(), depths.end());

  fmt::print("{}\n", file);
  fmt::print("  format      {}\n", frame.format);
  fmt::print("  size        {} x {} pixels\n", cloud.width, cloud.height);
  fmt::print("  measured    {} points, {:.1f} % of the pixels\n",
             depths.size(),
             100.0 * static_cast<double>(depths.size()) /
                 static_cast<double>(std::max<std::size_t>(cloud.size(), 1)));
  if (!depths.empty())
    fmt::print("  depth       {:.3f} to {:.3f} m, median {:.3f} m\n",
               depths.front(),
               depths.back(),
               depths[depths.size() / 2]);
  fmt::print("  colour      {}\n", frame.has_color ? "yes" : "no");
  const Intrinsics& k = frame.intrinsics;
  if (k.valid())
    fmt::print("  camera      fx {:.2f}  fy {:.2f}  cx {:.2f}  cy {:.2f} px, from the "
               "points: rms {:.3f} px, {} of {} agree\n",
               k.fx,
               k.fy,
               k.cx,
               k.cy,
               k.rms,
               k.inliers,
               k.records);
  else
    fmt::print("  camera      not known: too few points\n");
  if (frame.pose_known) {
    const Eigen::Vector3d t = frame.pose.translation();
    const Eigen::Quaterniond q(frame.pose.linear());
    fmt::print(
        "  sensor at   {:.4f} {:.4f} {:.4f} m, turned {:.5f} {:.5f} {:.5f} {:.5f} "
        "(w x y z)\n",
        t.x(),
        t.y(),
        t.z(),
        q.w(),
        q.x(),
        q.y(),
        q.z());
  }
  else
    fmt::print("  sensor at   not known\n");
  for (const std::string& warning : frame.warnings)
    fmt::print("  note        {}\n", warning);
}

int
showFiles(const std::vector<std::string>& files)
{
  bool failed = false;
  for (const std::string& file : files)
    try {
      printFrame(file, loadFrame(file));
    }
    catch (const std::exception& error) {
      fmt::print(stderr, "hoist: {}\n", error.what());
      failed = true;
    }
  return failed ? exit_input : exit_ok;
}

} // namespace

Action
addInfoCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "info", "Tell what is in frames: size, depth, camera, sensor pose");
  auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("FILE", *files, "PCD, PTS or PLY files of organized clouds")
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("");
  return [files] { return showFiles(*files); };
}

} // namespace hoist
