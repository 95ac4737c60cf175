#pragma once

#include "recognizer.h"
#include "viewer/detections.h"

#include <hoist/data/annotation.h>
#include <hoist/data/frame_fields.h>
#include <hoist/segmentation/full_mode.h>
#include <hoist/segmentation/line_segment.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief All that the viewer shows of one file. Not changed once it is made, so that
 *  threads share it. */
struct Scene {
  using ConstPtr = std::shared_ptr<const Scene>;

  std::string file;
  std::string error;                  ///< why there is nothing to show; "" if there is
  std::vector<std::string> warnings;  ///< of the reader and about files beside it
  std::shared_ptr<const Frame> frame; ///< null where the file cannot be read
  /// What the file tells of its points beyond place and colour, with the frame.
  std::shared_ptr<const std::vector<FrameField>> fields;

  FrameResult result; ///< empty where the frame cannot be segmented
  double time = 0;    ///< of the recognition [ms]
  cv::Mat1b edges;    ///< EdgeKind flags
  std::vector<LineSegment> segments;
  std::vector<Vertex> vertices;
  std::vector<CuboidVerdict> rejected; ///< those with a reason, the nearest first
  std::vector<Detection> detections;
  std::optional<FrameAnnotation> truth;

  bool
  hasFrame() const
  {
    return frame != nullptr;
  }

  /** \brief Sensor to the space that is shown: the world where the file says where the
   *  sensor was, else the sensor's own. */
  Eigen::Isometry3d
  pose() const
  {
    return frame ? frame->loaded.pose : Eigen::Isometry3d::Identity();
  }
};

/** \brief The cuboids that were found. */
std::vector<Cuboid> cuboidsOf(const Scene& scene);

/** \brief The rejections worth showing: of all that were thought of the nearest to a
 *  cuboid, at most 25. */
std::vector<CuboidVerdict> shownRejections(const Scene& scene);

/** \brief The boxes of all things of an annotation. */
std::vector<Cuboid> trueCuboids(const FrameAnnotation& annotation);

/** \brief Where a scene's other files are. */
struct SceneFiles {
  std::string detections; ///< a file for all scenes or a folder; "" for those beside
  std::string truth;      ///< a folder or a file, "" for those beside
};

/** \brief The truth of a cloud: the file or DIR/<stem>.json if one is given; else
 *  <stem>.json beside it if that says it is an annotation, ../truth/<stem>.json or
 *  ../gt/<stem>.json, the first that there is; "" if none. */
std::string findTruth(const std::string& cloud, const std::string& given);

/** \brief The boxes for a cloud: likewise, <stem>.detections.json beside it. */
std::string findDetections(const std::string& cloud, const std::string& given);

/** \brief Loads a file and what lies beside it and recognises it. Never throws for what
 *  is wrong with a file: the scene tells.
 *  \param before the same file's scene with other settings, or null; its frame is used
 *         again */
Scene::ConstPtr makeScene(const std::string& file,
                          const SceneFiles& files,
                          Recognizer& recognizer,
                          const Scene::ConstPtr& before);

} // namespace hoist
