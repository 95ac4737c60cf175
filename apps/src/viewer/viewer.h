#pragma once

#include "viewer/cloud_layer.h"
#include "viewer/hud.h"
#include "viewer/image_view.h"
#include "viewer/keys.h"
#include "viewer/layers.h"
#include "viewer/live_settings.h"
#include "viewer/scene_layers.h"
#include "viewer/scene_loader.h"
#include "viewer/viewer_settings.h"
#include "viewer/window.h"

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

class StopSignal;

/** \brief The program: what is shown of which file, and what keys and clicks do. */
class Viewer {
public:
  /** \param files to step through, at least one
   *  \param live all must outlive this
   *  \throws FileError without OpenGL or if the camera's file cannot be read */
  Viewer(std::vector<std::string> files,
         const ViewerSettings& settings,
         LiveSettings& live,
         ViewerWindow::Kind kind);

  /** \brief Until the user ends it, or a signal does. */
  void run(const StopSignal& signal);

  /** \brief Ends the thread that loads.
   *  \return false if it is still at a file that takes long; the process may be ended
   *          then, nothing of that file will be needed */
  bool stop();

  /** \brief Pictures of the first files instead.
   *  \return whether all could be read
   *  \throws pcl::IOException if a picture cannot be written */
  bool takeScreenshots();

private:
  // what happens
  bool onKey(const std::string& symbol, bool ctrl, bool alt);
  bool onClick(int x, int y, bool shift);
  void act(KeyAction action);
  bool poll();
  bool takeOver();
  void step(std::size_t index);
  void await();
  void tune(bool changed);

  // what is picked
  void pickPixel(cv::Point pixel, bool card);
  void pickInSpace(int x, int y);
  void pickBox(const SightLine& line);
  void select(int cuboid);
  void selectRejection(int rejection);
  void selectNext();
  void printCard() const;
  void mark(cv::Point pixel);
  void unpick();

  // what is saved
  void exportPoints();
  void saveSettings();
  void saveCamera();
  void restoreCamera();
  void save(const std::string& file, const std::string& bytes);

  // what is shown
  void showScene(const Scene::ConstPtr& scene);
  void showLayers();
  void showWords();
  void draw();
  void placeCamera();
  void arrange();
  ViewCamera firstCamera(const Scene& scene) const;
  HudContent words() const;
  std::vector<HudLine> legend() const;
  std::vector<std::string> cardLines() const;
  std::vector<HudLine> card() const;
  void say(const std::string& text);

  const std::vector<std::string> files_;
  const ViewerSettings& given_;
  LiveSettings& live_;
  ViewerWindow window_;
  SceneLoader loader_;
  CloudLayer cloud_;
  SceneLayers layers_;
  ImageView image_;
  Hud hud_;

  LayerSet shown_;
  std::size_t index_ = 0;
  Scene::ConstPtr scene_;   ///< on the screen
  std::string camera_file_; ///< "" until one is known
  bool camera_placed_ = false;
  bool waiting_ = true;                                    ///< for the wanted scene
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity(); ///< of the scene before
  int selected_ = -1;                                      ///< cuboid
  int selected_rejection_ = -1;                            ///< of shownRejections()
  cv::Point pixel_{-1, -1};
  vtkSmartPointer<vtkProp> marker_;
  bool labels_ = true;
  bool legend_shown_ = true;
  bool help_shown_ = false;
  Layout layout_ = Layout::both;
  std::string message_;
  std::string progress_;
  std::optional<std::chrono::steady_clock::time_point> asked_; ///< for another scene
  bool was_ready_ = false; ///< the thread had made it before it was asked for
  cv::Size drawn_size_;
};

} // namespace hoist
