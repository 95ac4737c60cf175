#include "viewer/scene_loader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace hoist {

SceneLoader::SceneLoader(std::vector<std::string> files,
                         SceneFiles beside,
                         const RecognizeSettings& settings)
: files_(std::move(files))
, beside_(std::move(beside))
, settings_(settings)
, thread_([this] { work(); })
{
}

SceneLoader::~SceneLoader()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool
SceneLoader::stop(std::chrono::milliseconds patience)
{
  std::unique_lock<std::mutex> lock(mutex_);
  stop_ = true;
  changed_.notify_all();
  return changed_.wait_for(lock, patience, [this] { return stopped_; });
}

void
SceneLoader::want(std::size_t index)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    index_ = index;
  }
  changed_.notify_all();
}

void
SceneLoader::setSettings(const RecognizeSettings& settings)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    settings_ = settings;
    ++revision_;
  }
  changed_.notify_all();
}

Scene::ConstPtr
SceneLoader::wanted() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = entries_.find(index_);
  return found != entries_.end() && found->second.revision == revision_
             ? found->second.scene
             : nullptr;
}

std::string
SceneLoader::activity() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return activity_;
}

// The one that is looked at, the two that most likely come next, the one before.
std::vector<std::size_t>
SceneLoader::wantedOrder() const
{
  std::vector<std::size_t> order = {index_};
  for (const std::size_t i : {index_ + 1, index_ + 2})
    if (i < files_.size())
      order.push_back(i);
  if (index_ > 0)
    order.push_back(index_ - 1);
  return order;
}

bool
SceneLoader::nextJob(std::size_t& index) const
{
  for (const std::size_t i : wantedOrder()) {
    const auto found = entries_.find(i);
    if (found == entries_.end() || found->second.revision != revision_) {
      index = i;
      return true;
    }
  }
  return false;
}

// Out of the map, for the caller to give back without the lock.
std::vector<Scene::ConstPtr>
SceneLoader::takeUnwanted()
{
  const std::vector<std::size_t> order = wantedOrder();
  std::vector<Scene::ConstPtr> unwanted;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    if (std::count(order.begin(), order.end(), entry->first) != 0) {
      ++entry;
      continue;
    }
    unwanted.push_back(std::move(entry->second.scene));
    entry = entries_.erase(entry);
  }
  return unwanted;
}

void
SceneLoader::work()
{
  std::unique_ptr<Recognizer> recognizer;
  std::size_t recognizer_revision = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    std::size_t index = 0;
    if (!nextJob(index)) {
      activity_.clear();
      changed_.wait(lock);
      continue;
    }
    // the old ones go first, so that there are never more than the capacity
    std::vector<Scene::ConstPtr> old = takeUnwanted();
    const auto known = entries_.find(index);
    Scene::ConstPtr before = known == entries_.end() ? nullptr : known->second.scene;
    const std::size_t revision = revision_;
    const RecognizeSettings settings = settings_;
    activity_ = (before ? "recognising " : "loading ") +
                std::filesystem::path(files_[index]).filename().string();
    lock.unlock();
    old.clear();
    if (recognizer_revision != revision) {
      recognizer = std::make_unique<Recognizer>(settings);
      recognizer_revision = revision;
    }
    Scene::ConstPtr scene = makeScene(files_[index], beside_, *recognizer, before);
    before = nullptr;
    lock.lock();
    Entry& entry = entries_[index];
    entry.revision = revision;
    entry.scene.swap(scene);
    lock.unlock();
    scene = nullptr; // the one before
    lock.lock();
  }
  stopped_ = true;
  changed_.notify_all();
}

} // namespace hoist
