#include "ifc/seen_in.h"

#include "failures.h"

#include <hoist/data/annotation.h>
#include <hoist/data/result_io.h>

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace hoist {
namespace {

Eigen::Isometry3d
poseOr(const std::string& file, bool known, const Eigen::Isometry3d& pose, bool camera)
{
  if (known)
    return pose;
  if (!camera)
    throw FileError(file + ": does not say where the camera was; --camera-frame takes "
                           "its frame for the world's");
  return Eigen::Isometry3d::Identity();
}

// Standard deviations along the camera's axes, along the world's.
Eigen::Vector3d
turned(const Eigen::Vector3d& sigma, const Eigen::Isometry3d& pose)
{
  const Eigen::Vector3d variance = sigma.cwiseAbs2();
  return (pose.linear().cwiseAbs2() * variance).cwiseSqrt();
}

OrientedBox
inWorld(const OrientedBox& box, const Eigen::Isometry3d& pose)
{
  OrientedBox out = box;
  out.center = pose * box.center;
  out.axes = pose.linear() * box.axes;
  return out;
}

std::vector<IfcObservation>
ofResult(const FrameResult& result, const std::string& file, bool camera_frame)
{
  const Eigen::Isometry3d pose =
      poseOr(file, result.pose_known, result.pose, camera_frame);
  std::vector<IfcObservation> out;
  for (const RecognizedCuboid& item : result.cuboids) {
    const std::size_t number = out.size() + 1;
    IfcObservation seen;
    seen.key = fmt::format("{}/{}", result.scene, number);
    seen.name = fmt::format("{} {}", result.scene, number);
    seen.object_class = "cuboid";
    seen.box = inWorld(OrientedBox(item.cuboid), pose);
    seen.center_sigma = turned(item.cuboid.center_sigma, pose);
    seen.size_sigma = item.cuboid.size_sigma;
    seen.rotation_sigma = item.cuboid.rotation_sigma;
    seen.score = item.cuboid.score;
    const CuboidFeatures& features = item.features;
    seen.rgb = {features.rgb[0], features.rgb[1], features.rgb[2]};
    seen.color_name = features.color_name;
    seen.material = features.material;
    if (features.weight > 0) {
      seen.weight = features.weight;
      seen.weight_sigma = features.weight_sigma;
    }
    seen.frame = result.scene;
    out.push_back(std::move(seen));
  }
  return out;
}

IfcObservation
ofObject(const AnnotatedObject& object,
         const FrameAnnotation& frame,
         std::size_t number,
         const Eigen::Isometry3d& pose)
{
  IfcObservation seen;
  const bool follows = !frame.sequence.empty() && object.label > 0;
  const std::string name = follows ? frame.sequence : frame.scene;
  const std::size_t n = follows ? static_cast<std::size_t>(object.label) : number;
  seen.key = fmt::format("{}/{}", name, n);
  seen.name =
      fmt::format("{} {}", object.object_class.empty() ? name : object.object_class, n);
  seen.global_id = object.global_id;
  seen.object_class = object.object_class;
  seen.box = inWorld(OrientedBox(object), pose);
  seen.material = object.material;
  seen.rgb = object.base_rgb;
  seen.fullness = object.fullness;
  seen.weight = object.weight;
  seen.frame = frame.scene;
  if (frame.time)
    seen.time = fmt::format("{:.3f} s", *frame.time);
  return seen;
}

std::vector<IfcObservation>
ofAnnotation(const FrameAnnotation& frame, const std::string& file, bool camera_frame)
{
  const Eigen::Isometry3d pose =
      poseOr(file,
             frame.pose.has_value(),
             frame.pose.value_or(Eigen::Isometry3d::Identity()),
             camera_frame);
  std::vector<IfcObservation> out;
  for (const AnnotatedObject& object : frame.objects)
    out.push_back(ofObject(object, frame, out.size() + 1, pose));
  for (const AnnotatedObject& object : frame.removed) {
    out.push_back(ofObject(object, frame, out.size() + 1, pose));
    out.back().missing = true;
  }
  return out;
}

} // namespace

std::vector<IfcObservation>
seenIn(const std::string& file, bool camera_frame)
{
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in && text.empty())
    throw FileError(file + ": cannot be read");
  std::vector<IfcObservation> out =
      text.find("\"hoist annotation\"") != std::string::npos
          ? ofAnnotation(annotationFromJson(text, file), file, camera_frame)
          : ofResult(fromJson(text, file), file, camera_frame);
  for (IfcObservation& seen : out)
    seen.tool = "hoist " HOIST_VERSION;
  return out;
}

} // namespace hoist
