#include "render.h"

#include <nlohmann/json.hpp>

namespace hoist {
namespace samples {
namespace {

using Json = nlohmann::ordered_json;

Json
vectorJson(const Eigen::Vector3d& v)
{
  return {v.x(), v.y(), v.z()};
}

} // namespace

std::string
truthJson(const Scene& scene, const FrameTruth& truth)
{
  Json out;
  out["scene"] = scene.name;
  out["intrinsics"] = {{"fx", scene.camera.fx},
                       {"fy", scene.camera.fy},
                       {"cx", scene.camera.cx},
                       {"cy", scene.camera.cy}};
  if (scene.has_support && !scene.patches.empty()) {
    const Patch& support = scene.patches.front();
    Eigen::Vector3d normal = support.axes.col(2);
    double offset = -normal.dot(support.center);
    if (offset < 0) { // towards the camera, which is the origin
      normal = -normal;
      offset = -offset;
    }
    out["support_plane"] = {normal.x(), normal.y(), normal.z(), offset};
  }
  out["cuboids"] = Json::array();
  int label = 1;
  for (const BoxTruth& entry : truth.boxes) {
    const Box& box = entry.box;
    Json cuboid;
    cuboid["label"] = label++;
    cuboid["center"] = vectorJson(box.center);
    cuboid["size"] = vectorJson(box.size);
    Json rows = Json::array();
    for (int i = 0; i < 3; ++i)
      rows.push_back(vectorJson(box.axes.row(i).transpose()));
    cuboid["rotation"] = rows;
    cuboid["faces_visible"] = entry.facesVisible();
    cuboid["difficult"] = entry.difficult();
    cuboid["visible_fraction"] = entry.visibleFraction();
    cuboid["visible_pixels"] = entry.visible_pixels;
    cuboid["base_rgb"] = box.color;
    out["cuboids"].push_back(cuboid);
  }
  out["other_objects"] = Json::array();
  for (std::size_t i = 0; i < scene.cylinders.size(); ++i)
    out["other_objects"].push_back({{"label", label++},
                                    {"kind", "cylinder"},
                                    {"center", vectorJson(scene.cylinders[i].center)}});
  return out.dump(1) + "\n";
}

} // namespace samples
} // namespace hoist
