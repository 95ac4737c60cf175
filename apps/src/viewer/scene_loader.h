#pragma once

#include "viewer/scene.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace hoist {

/** \brief Makes scenes in a thread of its own: the wanted one first, then those around
 *  it, so that a step to them needs no waiting. Keeps few of them.
 *
 * Only that thread makes scenes; nobody changes one that is made, so a scene is shared
 * with whoever asked for it and lives as long as anybody holds it. All else of this
 * class that both threads use is behind one mutex, which is never held while a file is
 * read, a frame recognised or the memory of one given back. */
class SceneLoader {
public:
  SceneLoader(std::vector<std::string> files,
              SceneFiles beside,
              const RecognizeSettings& settings);

  /** \brief Waits for the file that is being worked on, however long. */
  ~SceneLoader();
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  /** \brief From now on this file and those around it are wanted. */
  void want(std::size_t index);

  /** \brief Every scene is to be made again with these settings. */
  void setSettings(const RecognizeSettings& settings);

  /** \brief The wanted file's scene with the present settings, or null as long as it is
   *  not ready. */
  Scene::ConstPtr wanted() const;

  /** \brief What the thread does right now, for people; "" if nothing. */
  std::string activity() const;

  /** \brief Begins no other file.
   *  \return whether the one that was being worked on is done within \a patience */
  bool stop(std::chrono::milliseconds patience);

  /** \brief How many scenes it keeps at most. */
  static constexpr std::size_t capacity = 4;

private:
  struct Entry {
    Scene::ConstPtr scene;
    std::size_t revision = 0; ///< of the settings
  };

  void work();
  std::vector<Scene::ConstPtr> takeUnwanted();
  bool nextJob(std::size_t& index) const;
  std::vector<std::size_t> wantedOrder() const;

  const std::vector<std::string> files_;
  const SceneFiles beside_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  RecognizeSettings settings_;
  std::size_t revision_ = 1;
  std::size_t index_ = 0;
  std::map<std::size_t, Entry> entries_;
  std::string activity_;
  bool stop_ = false;
  bool stopped_ = false; ///< the thread is done

  std::thread thread_; ///< last: it uses all the others
};

} // namespace hoist
