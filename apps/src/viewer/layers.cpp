#include "viewer/layers.h"

#include "palette.h"

namespace hoist {

const std::array<LayerInfo, layer_count>&
layerTable()
{
  static const std::array<LayerInfo, layer_count> table = {
      {{Layer::cloud, "F1", "cloud", {225, 225, 225}, true},
       {Layer::color_edges, "F2", "colour edges", color_edge_color, false},
       {Layer::occlusion_edges, "F3", "occlusion edges", occlusion_edge_color, false},
       {Layer::crease_edges, "F4", "crease edges", crease_edge_color, false},
       {Layer::segments, "F5", "line segments", segment_color, false},
       {Layer::vertices, "F6", "vertices, by degree", vertex_color, false},
       {Layer::cuboids, "F7", "cuboids", cuboidColor(0), true},
       {Layer::faces, "F8", "observed faces", {150, 205, 120}, true},
       {Layer::uncertainty, "F9", "centre, 3 sigma x 10", {255, 190, 120}, false},
       {Layer::rejected, "F10", "rejected boxes", {170, 150, 150}, false},
       {Layer::detections, "F11", "detector boxes", {90, 220, 120}, true},
       {Layer::truth, "F12", "ground truth", {255, 255, 255}, false}}};
  return table;
}

const LayerInfo&
infoOf(Layer layer)
{
  return layerTable()[static_cast<std::size_t>(layer)];
}

LayerSet::LayerSet()
{
  for (const LayerInfo& info : layerTable())
    set(info.layer, info.shown);
}

} // namespace hoist
