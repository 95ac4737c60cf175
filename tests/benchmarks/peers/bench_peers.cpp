// Accuracy and time of hoist's full mode and of PCL-only pipelines, on the same frames
// in one process: boxes and milliseconds as JSON, to be scored by peers.py.

#include "peer.h"

#include <hoist/data/load_frame.h>
#include <hoist/segmentation/cuboid_segmentation.h>

#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include <opencv2/core.hpp>

#include <pcl/console/print.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using hoist::LoadedFrame;
using peers::Box;

struct Pipeline {
  std::string name;
  std::function<std::vector<Box>(const LoadedFrame&)> run;
};

/** \brief Processor time of all threads of this process [ms]: other work on the machine
 *  counts little, and a pipeline that started threads would gain nothing. */
double
processorTime()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) +
         1e-6 * static_cast<double>(time.tv_nsec);
}

Pipeline
hoistPipeline(const std::string& name, bool report_lines)
{
  using Segmentation = hoist::CuboidSegmentation<pcl::PointXYZRGB>;
  const auto segmentation = std::make_shared<Segmentation>();
  segmentation->setReportLines(report_lines);
  return {name, [segmentation](const LoadedFrame& frame) {
            std::vector<hoist::Cuboid> cuboids;
            segmentation->setInputCloud(frame.cloud);
            segmentation->segment(cuboids);
            std::vector<Box> boxes;
            for (const auto& cuboid : cuboids)
              boxes.push_back({cuboid.center.cast<float>(),
                               cuboid.axes.cast<float>(),
                               cuboid.size.cast<float>(),
                               static_cast<float>(cuboid.score)});
            return boxes;
          }};
}

std::vector<Pipeline>
allPipelines()
{
  const auto camera = [](const LoadedFrame& frame) {
    const auto& k = frame.intrinsics;
    return peers::Camera{static_cast<float>(k.fx),
                         static_cast<float>(k.fy),
                         static_cast<float>(k.cx),
                         static_cast<float>(k.cy)};
  };
  return {{"tutorial",
           [](const LoadedFrame& frame) { return peers::tutorialBoxes(frame.cloud); }},
          {"ransac",
           [camera](const LoadedFrame& frame) {
             return peers::ransacBoxes(frame.cloud, camera(frame));
           }},
          {"multi_plane",
           [camera](const LoadedFrame& frame) {
             return peers::multiPlaneBoxes(frame.cloud, camera(frame));
           }},
          hoistPipeline("hoist", false),
          hoistPipeline("hoist_lines", true)};
}

nlohmann::json
toJson(const std::string& scene, const std::vector<Box>& boxes)
{
  auto cuboids = nlohmann::json::array();
  for (const Box& box : boxes) {
    auto rotation = nlohmann::json::array();
    for (int row = 0; row < 3; ++row)
      rotation.push_back({box.axes(row, 0), box.axes(row, 1), box.axes(row, 2)});
    cuboids.push_back({{"center", {box.center[0], box.center[1], box.center[2]}},
                       {"size", {box.size[0], box.size[1], box.size[2]}},
                       {"rotation", rotation},
                       {"score", box.score}});
  }
  return {{"scene", scene}, {"cuboids", cuboids}};
}

void
write(const std::filesystem::path& file, const nlohmann::json& content)
{
  std::ofstream stream(file);
  stream << content.dump(1) << '\n';
  if (!stream)
    throw std::runtime_error("cannot write " + file.string());
}

void
measure(const std::vector<std::string>& files,
        const std::vector<Pipeline>& pipelines,
        int rounds,
        const std::filesystem::path& out)
{
  nlohmann::json times;
  bool warm = false;
  for (const std::string& file : files) {
    const std::string scene = std::filesystem::path(file).stem().string();
    const LoadedFrame frame = hoist::loadFrame(file);
    for (; !warm; warm = true) // libraries loaded, buffers made
      for (const Pipeline& pipeline : pipelines)
        pipeline.run(frame);
    std::vector<std::vector<double>> taken(pipelines.size());
    for (int round = 0; round < rounds; ++round)
      for (std::size_t k = 0; k < pipelines.size(); ++k) { // in turns
        const double start = processorTime();
        const std::vector<Box> boxes = pipelines[k].run(frame);
        taken[k].push_back(processorTime() - start);
        if (round == 0)
          write(out / pipelines[k].name / (scene + ".json"), toJson(scene, boxes));
      }
    for (std::size_t k = 0; k < pipelines.size(); ++k) {
      auto middle = taken[k].begin() + static_cast<long>(taken[k].size() / 2);
      std::nth_element(taken[k].begin(), middle, taken[k].end());
      times[pipelines[k].name][scene] = *middle;
    }
  }
  write(out / "times.json", times);
}

} // namespace

int
main(int argc, char** argv)
{
  CLI::App app("Boxes and times of hoist and of PCL-only pipelines");
  std::filesystem::path out;
  std::vector<std::string> files;
  std::vector<std::string> only;
  int rounds = 3;
  app.add_option("OUT",
                 out,
                 "folder for PIPELINE/SCENE.json and times.json, milliseconds of "
                 "processor time, the median over the rounds")
      ->required();
  app.add_option("FILE", files, "organized frames")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--rounds", rounds, "times that every frame is run")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--only", only, "names of the pipelines to run");
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);
    // PCL says when RANSAC finds no further plane: here that is how a search ends
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    std::vector<Pipeline> pipelines;
    for (Pipeline& pipeline : allPipelines())
      if (only.empty() || std::count(only.begin(), only.end(), pipeline.name) > 0)
        pipelines.push_back(pipeline);
    for (const Pipeline& pipeline : pipelines)
      std::filesystem::create_directories(out / pipeline.name);
    measure(files, pipelines, rounds, out);
  }
  catch (const std::exception& error) {
    std::cerr << "bench_peers: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
