#pragma once

// Reads the truth of a scene: data/samples/truth/*.json and the mOSD truth share one
// layout.

#include <hoist/data/cuboid.h>
#include <hoist/data/intrinsics.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace hoist {
namespace test {

struct TruthCuboid {
  Cuboid cuboid;
  bool difficult = false; ///< neither hit nor miss
  int faces_visible = 0;
  double visible_fraction = 0;
};

struct Truth {
  std::string scene;
  Intrinsics intrinsics;
  std::vector<TruthCuboid> cuboids;
};

/** \throws nlohmann::json::exception if the file is missing or of another layout */
inline Truth
loadTruth(const std::filesystem::path& path)
{
  std::ifstream in(path);
  const auto json = nlohmann::json::parse(in);
  Truth truth;
  truth.scene = json.at("scene");
  truth.intrinsics.fx = json.at("intrinsics").at("fx");
  truth.intrinsics.fy = json.at("intrinsics").at("fy");
  truth.intrinsics.cx = json.at("intrinsics").at("cx");
  truth.intrinsics.cy = json.at("intrinsics").at("cy");
  for (const auto& entry : json.at("cuboids")) {
    TruthCuboid t;
    for (int i = 0; i < 3; ++i) {
      t.cuboid.center[i] = entry.at("center").at(i);
      t.cuboid.size[i] = entry.at("size").at(i);
      for (int k = 0; k < 3; ++k)
        t.cuboid.axes(i, k) = entry.at("rotation").at(i).at(k);
    }
    t.difficult = entry.value("difficult", false);
    t.faces_visible = entry.value("faces_visible", 0);
    t.visible_fraction = entry.value("visible_fraction", 0.0);
    truth.cuboids.push_back(t);
  }
  return truth;
}

} // namespace test
} // namespace hoist
