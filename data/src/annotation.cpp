#include <hoist/data/annotation.h>
#include <hoist/data/atomic_file.h>

#include <pcl/exceptions.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace hoist {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void
refuse(const std::string& what)
{
  throw pcl::BadArgumentException(what, "annotation.cpp", "toJson");
}

Json
number(double value)
{
  if (!std::isfinite(value))
    refuse("a number of the annotation is not finite");
  return value;
}

Json
vectorJson(const Eigen::Vector3d& v)
{
  return {number(v.x()), number(v.y()), number(v.z())};
}

Json
matrixJson(const Eigen::Matrix3d& m)
{
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back(vectorJson(m.row(i).transpose()));
  return rows;
}

Json
poseJson(const Eigen::Isometry3d& pose)
{
  return {{"rotation", matrixJson(pose.linear())},
          {"translation", vectorJson(pose.translation())}};
}

// What is unset stays out of the file.
void
setText(Json& out, const char* key, const std::string& text)
{
  if (!text.empty())
    out[key] = text;
}

template <typename T>
void
setValue(Json& out, const char* key, const std::optional<T>& value)
{
  if (!value)
    return;
  if constexpr (std::is_same_v<T, double>)
    out[key] = number(*value);
  else if constexpr (std::is_same_v<T, Eigen::Isometry3d>)
    out[key] = poseJson(*value);
  else
    out[key] = *value;
}

// Known fields win over fields of the same name among what was read.
void
addExtra(Json& out, const std::string& extra)
{
  if (extra.empty())
    return;
  const Json more = Json::parse(extra, nullptr, false);
  if (!more.is_object())
    refuse("what an annotation says besides is not the text of a JSON object");
  for (const auto& [key, value] : more.items())
    if (!out.contains(key))
      out[key] = value;
}

Json
objectJson(const AnnotatedObject& object, bool say_shape)
{
  Json out = Json::object();
  if (object.label != 0)
    out["label"] = object.label;
  setText(out, "class", object.object_class);
  if (say_shape)
    out["is_cuboid"] = object.is_cuboid;
  out["center"] = vectorJson(object.center);
  out["size"] = vectorJson(object.size);
  out["rotation"] = matrixJson(object.rotation);
  if (object.symmetry != ObjectSymmetry::box)
    out["symmetry"] = toString(object.symmetry);
  setValue(out, "pose", object.pose);
  out["difficult"] = object.difficult;
  if (!object.difficult_reasons.empty())
    out["difficult_reasons"] = object.difficult_reasons;
  if (object.box_2d) {
    out["box_2d"] = Json::array();
    for (const double entry : *object.box_2d)
      out["box_2d"].push_back(number(entry));
  }
  setValue(out, "visible_fraction", object.visible_fraction);
  setValue(out, "visible_pixels", object.visible_pixels);
  setValue(out, "faces_visible", object.faces_visible);
  setValue(out, "observed_faces", object.observed_faces);
  setText(out, "material", object.material);
  setValue(out, "base_rgb", object.base_rgb);
  setValue(out, "fullness", object.fullness);
  setValue(out, "weight", object.weight);
  if (object.status)
    out["status"] = toString(*object.status);
  setValue(out, "moved_from", object.moved_from);
  setText(out, "global_id", object.global_id);
  addExtra(out, object.extra);
  return out;
}

Json
otherJson(const OtherObject& object)
{
  Json out = Json::object();
  if (object.label != 0)
    out["label"] = object.label;
  setText(out, "kind", object.kind);
  if (object.center)
    out["center"] = vectorJson(*object.center);
  addExtra(out, object.extra);
  return out;
}

Json
filesJson(const FrameFiles& files)
{
  Json out = Json::object();
  setText(out, "cloud", files.cloud);
  setText(out, "color", files.color);
  setText(out, "depth", files.depth);
  setText(out, "instances", files.instances);
  addExtra(out, files.extra);
  return out;
}

void
addCamera(Json& out, const FrameAnnotation& annotation)
{
  if (annotation.width > 0)
    out["width"] = annotation.width;
  if (annotation.height > 0)
    out["height"] = annotation.height;
  setText(out, "sensor", annotation.sensor);
  setValue(out, "baseline", annotation.baseline);
  setValue(out, "seed", annotation.seed);
  const Intrinsics& camera = annotation.intrinsics;
  if (camera.valid())
    out["intrinsics"] = {{"fx", number(camera.fx)},
                         {"fy", number(camera.fy)},
                         {"cx", number(camera.cx)},
                         {"cy", number(camera.cy)}};
  if (!annotation.distortion.empty()) {
    out["distortion"] = Json::array();
    for (const double entry : annotation.distortion)
      out["distortion"].push_back(number(entry));
  }
  setValue(out, "pose", annotation.pose);
  setValue(out, "registration", annotation.registration);
  if (annotation.support_plane) {
    out["support_plane"] = Json::array();
    for (int i = 0; i < 4; ++i)
      out["support_plane"].push_back(number((*annotation.support_plane)[i]));
  }
}

} // namespace

const char*
toString(ObjectStatus status)
{
  switch (status) {
  case ObjectStatus::added:
    return "new";
  case ObjectStatus::moved:
    return "moved";
  case ObjectStatus::removed:
    return "removed";
  default:
    return "unchanged";
  }
}

const char*
toString(ObjectSymmetry symmetry)
{
  switch (symmetry) {
  case ObjectSymmetry::axis0:
    return "axis 0";
  case ObjectSymmetry::axis1:
    return "axis 1";
  case ObjectSymmetry::axis2:
    return "axis 2";
  default:
    return "box";
  }
}

std::string
toJson(const FrameAnnotation& annotation, int indent)
{
  Json out;
  out["format"] = "hoist annotation";
  out["version"] = 1;
  setText(out, "scene", annotation.scene);
  setText(out, "sequence", annotation.sequence);
  setValue(out, "visit", annotation.visit);
  setValue(out, "index", annotation.index);
  setValue(out, "time", annotation.time);
  if (!annotation.files.empty())
    out["files"] = filesJson(annotation.files);
  setValue(out, "depth_scale", annotation.depth_scale);
  addCamera(out, annotation);
  out["cuboids"] = Json::array();
  out["objects"] = Json::array();
  for (const AnnotatedObject& object : annotation.objects)
    out[object.is_cuboid ? "cuboids" : "objects"].push_back(objectJson(object, false));
  if (!annotation.removed.empty()) {
    out["removed"] = Json::array();
    for (const AnnotatedObject& object : annotation.removed)
      out["removed"].push_back(objectJson(object, true));
  }
  if (!annotation.other_objects.empty()) {
    out["other_objects"] = Json::array();
    for (const OtherObject& object : annotation.other_objects)
      out["other_objects"].push_back(otherJson(object));
  }
  addExtra(out, annotation.extra);
  // a name that is no UTF-8 must not cost the annotation
  return out.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

void
saveAnnotation(const std::filesystem::path& file, const FrameAnnotation& annotation)
{
  writeFileAtomically(file, toJson(annotation));
}

} // namespace hoist
