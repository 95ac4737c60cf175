#include "viewer/scene.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>

namespace hoist {
namespace {

namespace fs = std::filesystem;

// As many as there are keys for, beside those of every frame: 7 to 9, 0, Ctrl+1 to 0.
constexpr std::size_t most_fields = 14;

std::string
stemOf(const std::string& file)
{
  return fs::path(file).stem().string();
}

// The first that is there.
std::string
firstFile(const std::vector<fs::path>& candidates)
{
  std::error_code error;
  for (const fs::path& path : candidates)
    if (fs::is_regular_file(path, error))
      return path.string();
  return "";
}

std::optional<FrameAnnotation>
readTruth(const std::string& file,
          const std::string& given,
          std::vector<std::string>& warnings)
{
  const std::string path = findTruth(file, given);
  if (path.empty())
    return {};
  try {
    return loadAnnotation(path);
  }
  catch (const std::exception& error) {
    warnings.push_back(std::string("no ground truth: ") + error.what());
    return {};
  }
}

std::vector<Detection>
readDetections(const std::string& file,
               const std::string& given,
               const std::optional<FrameAnnotation>& truth,
               std::vector<std::string>& warnings)
{
  std::vector<Detection> detections;
  const std::string path = findDetections(file, given);
  try {
    if (!path.empty())
      return loadDetections(path);
  }
  catch (const std::exception& error) {
    warnings.emplace_back(error.what());
  }
  if (path.empty() && truth)
    for (const AnnotatedObject& object : truth->objects)
      if (object.box_2d) {
        const auto& [x, y, width, height] = *object.box_2d;
        detections.push_back({{x, y, width, height}, object.object_class, 1.0});
      }
  return detections;
}

// A JSON file beside a cloud may as well be a result of the recognition.
bool
saysItIsTruth(const fs::path& path)
{
  std::ifstream in(path);
  std::string head(4096, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find("\"hoist annotation\"") != std::string::npos;
}

void
recognize(Scene& scene, Recognizer& recognizer)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  scene.result = recognizer.recognize(*scene.frame, stemOf(scene.file));
  const std::chrono::duration<double, std::milli> time = Clock::now() - start;
  scene.time = time.count();
  const auto& segmentation = recognizer.segmentation();
  scene.edges = recognizer.edgeKinds(*scene.frame);
  scene.segments = segmentation.getSegments();
  scene.vertices = segmentation.getVertices();
  for (CuboidVerdict& verdict : segmentation.getVerdicts())
    if (!verdict.rejected.empty())
      scene.rejected.push_back(std::move(verdict));
}

} // namespace

std::string
findTruth(const std::string& cloud, const std::string& given)
{
  const fs::path folder = fs::path(cloud).parent_path();
  const std::string name = stemOf(cloud) + ".json";
  if (!given.empty())
    return firstFile(
        {fs::is_directory(given) ? fs::path(given) / name : fs::path(given)});
  if (saysItIsTruth(folder / name))
    return (folder / name).string();
  return firstFile({folder / ".." / "truth" / name, folder / ".." / "gt" / name});
}

std::string
findDetections(const std::string& cloud, const std::string& given)
{
  const fs::path folder = fs::path(cloud).parent_path();
  const std::string name = stemOf(cloud) + ".detections.json";
  if (!given.empty())
    return firstFile(
        {fs::is_directory(given) ? fs::path(given) / name : fs::path(given)});
  return firstFile({folder / name});
}

std::vector<Cuboid>
cuboidsOf(const Scene& scene)
{
  std::vector<Cuboid> cuboids;
  for (const RecognizedCuboid& recognized : scene.result.cuboids)
    cuboids.push_back(recognized.cuboid);
  return cuboids;
}

std::vector<CuboidVerdict>
shownRejections(const Scene& scene)
{
  constexpr std::size_t most = 25; // more lines hide each other
  const std::size_t n = std::min(most, scene.rejected.size());
  return {scene.rejected.begin(),
          scene.rejected.begin() + static_cast<std::ptrdiff_t>(n)};
}

std::vector<Cuboid>
trueCuboids(const FrameAnnotation& annotation)
{
  std::vector<Cuboid> cuboids;
  for (const AnnotatedObject& object : annotation.objects) {
    Cuboid cuboid;
    cuboid.center = object.center;
    cuboid.size = object.size;
    cuboid.axes = object.rotation;
    cuboids.push_back(cuboid);
  }
  return cuboids;
}

Scene::ConstPtr
makeScene(const std::string& file,
          const SceneFiles& files,
          Recognizer& recognizer,
          const Scene::ConstPtr& before)
{
  const auto scene = std::make_shared<Scene>();
  scene->file = file;
  scene->result.scene = stemOf(file);
  try {
    if (before && before->frame) {
      scene->frame = before->frame;
      scene->fields = before->fields;
    }
    else {
      scene->frame = std::make_shared<Frame>(openFrame(file));
      scene->fields =
          std::make_shared<std::vector<FrameField>>(loadFrameFields(file, most_fields));
    }
    scene->warnings = scene->frame->loaded.warnings;
    scene->truth = readTruth(file, files.truth, scene->warnings);
    scene->detections =
        readDetections(file, files.detections, scene->truth, scene->warnings);
    recognize(*scene, recognizer);
  }
  catch (const std::exception& error) {
    scene->error = error.what();
  }
  return scene;
}

} // namespace hoist
