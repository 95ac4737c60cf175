#include "evaluate/scenes.h"

#include "failures.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

namespace hoist {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t names_shown = 5;

// The path without ".json", and without what `hoist batch` keeps of the frame's name.
std::string
keyOf(const fs::path& path)
{
  std::string key = path.generic_string();
  for (const char* const ending : {".json", ".pcd", ".pts", ".ply", ".xyz", ".asc"}) {
    const std::string end = ending;
    if (key.size() > end.size() &&
        key.compare(key.size() - end.size(), end.size(), end) == 0)
      key.resize(key.size() - end.size());
  }
  return key;
}

std::string
nameOf(const std::string& key)
{
  const std::size_t slash = key.rfind('/');
  return slash == std::string::npos ? key : key.substr(slash + 1);
}

// Key -> file of all JSON files in a folder.
std::map<std::string, fs::path>
filesIn(const std::string& folder)
{
  std::map<std::string, fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (it->path().extension() == ".json" && it->is_regular_file())
      files.emplace(keyOf(it->path().lexically_relative(folder)), it->path());
  if (error)
    throw UsageError(folder + ": cannot be read: " + error.message());
  return files;
}

std::string
someOf(const std::vector<std::string>& names)
{
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < names_shown; ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > names_shown ? text + ", ..." : text;
}

std::string
counted(std::size_t n, const std::string& what)
{
  return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
}

std::vector<std::pair<std::string, FrameAnnotation>>
loadTruths(const std::string& path, std::vector<std::string>& notes)
{
  std::vector<std::pair<std::string, FrameAnnotation>> truths;
  if (!fs::is_directory(path)) {
    truths.emplace_back(nameOf(keyOf(path)), loadAnnotation(path));
    return truths;
  }
  std::vector<std::string> others;
  for (const auto& [key, file] : filesIn(path))
    try {
      truths.emplace_back(key, loadAnnotation(file));
    }
    catch (const LoadError& error) {
      // settings, reports, camera files: not all JSON is an annotation
      if (error.reason().rfind("no annotation", 0) != 0)
        throw;
      others.push_back(key + ".json");
    }
  if (truths.empty())
    throw UsageError("no annotation in " + path);
  if (!others.empty())
    notes.push_back(counted(others.size(), "file") +
                    " of the truth left out, no annotation: " + someOf(others));
  std::sort(truths.begin(), truths.end(), [](const auto& a, const auto& b) {
    return naturallyLess(a.first, b.first);
  });
  return truths;
}

// What was found, by the key of the truth that it belongs to.
class Results {
public:
  explicit Results(const std::string& path) : path_(path)
  {
    if (!fs::is_directory(path)) {
      for (PredictedFrame& frame : loadPredictions(path))
        frames_.push_back(std::move(frame));
      return;
    }
    folder_ = true;
    files_ = filesIn(path);
    for (const auto& [key, file] : files_)
      by_name_[nameOf(key)].push_back(key);
  }

  /** \brief Whether one frame is all there is. */
  bool
  single() const
  {
    return !folder_ && frames_.size() == 1;
  }

  /** \param alone no other annotation has its name
   *  \return nothing if there is none */
  std::optional<PredictedFrame>
  find(const std::string& key, bool alone)
  {
    return folder_ ? findFile(key, alone) : findFrame(key);
  }

  /** \brief What belongs to no annotation. */
  std::vector<std::string>
  unused() const
  {
    std::vector<std::string> names;
    for (const auto& [key, file] : files_)
      if (used_.count(key) == 0)
        names.push_back(key);
    for (const PredictedFrame& frame : frames_)
      if (!folder_ && !single() && used_.count(frame.scene) == 0)
        names.push_back(frame.scene);
    return names;
  }

  /** \brief The name of the only frame. */
  std::string
  onlyName() const
  {
    return frames_.front().scene.empty() ? nameOf(keyOf(path_)) : frames_.front().scene;
  }

private:
  std::optional<PredictedFrame>
  findFile(const std::string& key, bool alone)
  {
    auto found = files_.find(key);
    if (found == files_.end()) {
      const auto named = by_name_.find(nameOf(key));
      if (named == by_name_.end())
        return std::nullopt;
      if (named->second.size() > 1)
        throw UsageError("several results are named " + nameOf(key) + ": " +
                         someOf(named->second) + " in " + path_);
      if (!alone)
        throw UsageError("several annotations are named " + nameOf(key) +
                         ", one result: it must lie in the same folders in " + path_);
      found = files_.find(named->second.front());
    }
    std::vector<PredictedFrame> frames;
    used_[found->first] = true;
    try {
      frames = loadPredictions(found->second);
    }
    catch (const LoadError& error) {
      // what a batch wrote of a frame that it could not read
      if (error.reason().rfind("no results", 0) == 0)
        return std::nullopt;
      throw;
    }
    if (frames.size() != 1)
      throw LoadError(found->second.string(),
                      "",
                      "expected the results of one frame, found " +
                          std::to_string(frames.size()));
    return std::move(frames.front());
  }

  std::optional<PredictedFrame>
  findFrame(const std::string& key)
  {
    std::optional<PredictedFrame> found;
    for (const PredictedFrame& frame : frames_)
      if (single() || frame.scene == key || frame.scene == nameOf(key)) {
        if (found)
          throw UsageError("several results are named " + frame.scene + " in " + path_);
        found = frame;
        used_[frame.scene] = true;
      }
    return found;
  }

  std::string path_;
  bool folder_ = false;
  std::vector<PredictedFrame> frames_;
  std::map<std::string, fs::path> files_;
  std::map<std::string, std::vector<std::string>> by_name_;
  std::map<std::string, bool> used_;
};

bool
wanted(bool is_cuboid, const std::string& of)
{
  return of == "all" || is_cuboid == (of == "cuboids");
}

EvaluatedScene
sceneOf(const std::string& key,
        const FrameAnnotation& truth,
        const std::optional<PredictedFrame>& found,
        const EvaluateSettings& settings)
{
  EvaluatedScene scene;
  scene.name = key;
  for (const AnnotatedObject& object : truth.objects)
    if (wanted(object.is_cuboid, settings.of))
      scene.truths.push_back(object);
  if (found)
    for (const Prediction& prediction : found->predictions)
      if (wanted(prediction.is_cuboid, settings.of) &&
          prediction.score >= settings.min_score)
        scene.predictions.push_back(prediction);
  std::stable_sort(
      scene.predictions.begin(),
      scene.predictions.end(),
      [](const Prediction& a, const Prediction& b) { return a.score > b.score; });
  return scene;
}

// Where one frame was given, its own annotation alone.
void
keepOnly(std::vector<std::pair<std::string, FrameAnnotation>>& truths,
         const std::string& name,
         const EvaluateSettings& settings)
{
  if (truths.size() == 1)
    return;
  std::vector<std::pair<std::string, FrameAnnotation>> kept;
  for (auto& truth : truths)
    if (truth.first == name || nameOf(truth.first) == name)
      kept.push_back(std::move(truth));
  if (kept.size() != 1)
    throw UsageError((kept.empty() ? "no annotation" : "several annotations") +
                     std::string(" named ") + name + " in " + settings.truth + " for " +
                     settings.results);
  truths = std::move(kept);
}

} // namespace

bool
naturallyLess(const std::string& a, const std::string& b)
{
  const auto digit = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  };
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (digit(a[i]) && digit(b[k])) {
      // leading zeros do not count, then the longer number is larger
      while (i < a.size() && a[i] == '0')
        ++i;
      while (k < b.size() && b[k] == '0')
        ++k;
      std::size_t m = i, n = k;
      while (m < a.size() && digit(a[m]))
        ++m;
      while (n < b.size() && digit(b[n]))
        ++n;
      if (m - i != n - k)
        return m - i < n - k;
      const int order = a.compare(i, m - i, b, k, n - k);
      if (order != 0)
        return order < 0;
      i = m;
      k = n;
    }
    else {
      if (a[i] != b[k])
        return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[k]);
      ++i;
      ++k;
    }
  }
  if (a.size() - i != b.size() - k)
    return a.size() - i < b.size() - k;
  return a < b; // "a01" and "a1"
}

EvaluatedScenes
loadScenes(const EvaluateSettings& settings)
{
  EvaluatedScenes out;
  auto truths = loadTruths(settings.truth, out.notes);
  Results results(settings.results);
  if (results.single())
    keepOnly(truths, results.onlyName(), settings);
  std::map<std::string, int> names;
  for (const auto& [key, truth] : truths)
    ++names[nameOf(key)];

  std::vector<std::string> missing;
  for (const auto& [key, truth] : truths) {
    const auto found = results.find(key, names[nameOf(key)] == 1);
    if (!found)
      missing.push_back(key);
    else
      for (const std::string& reason : found->skipped)
        out.notes.push_back("prediction left out: " + reason);
    out.scenes.push_back(sceneOf(key, truth, found, settings));
  }
  if (missing.size() == truths.size())
    throw UsageError("no results in " + settings.results + " for any annotation of " +
                     settings.truth + " (" + someOf(missing) + ")");
  if (!missing.empty())
    out.notes.push_back(
        counted(missing.size(), "scene") +
        " without results, counted as nothing found: " + someOf(missing));
  const std::vector<std::string> unused = results.unused();
  if (!unused.empty())
    out.notes.push_back(counted(unused.size(), "result") +
                        " without annotation, not used: " + someOf(unused));
  return out;
}

} // namespace hoist
