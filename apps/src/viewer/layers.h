#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <cstddef>

namespace hoist {

/** \brief What the viewer can show of a frame, in the order of the legend. */
enum class Layer {
  cloud,
  color_edges,
  occlusion_edges,
  crease_edges,
  segments,
  vertices,
  cuboids,
  faces,
  uncertainty,
  rejected,
  detections,
  truth
};

constexpr std::size_t layer_count = 12;

/** \brief How a layer is named, called and drawn. */
struct LayerInfo {
  Layer layer;
  const char* key; ///< as X names it; also shown in the legend
  const char* text;
  cv::Scalar color; ///< BGR
  bool shown;       ///< at the start
};

/** \brief All layers, in the order of Layer. */
const std::array<LayerInfo, layer_count>& layerTable();

const LayerInfo& infoOf(Layer layer);

/** \brief What is drawn stronger or more fully than the rest. */
struct Highlight {
  int cuboid = -1;    ///< number of the chosen cuboid; -1 for none
  int rejection = -1; ///< of shownRejections(); -1 for none
  bool labels = true; ///< whether cuboids show their sizes
};

/** \brief Which layers are shown. */
class LayerSet {
public:
  /** \brief Those that are shown at the start. */
  LayerSet();

  bool
  shows(Layer layer) const
  {
    return shown_[static_cast<std::size_t>(layer)];
  }

  void
  set(Layer layer, bool shown)
  {
    shown_[static_cast<std::size_t>(layer)] = shown;
  }

  void
  toggle(Layer layer)
  {
    set(layer, !shows(layer));
  }

private:
  std::array<bool, layer_count> shown_{};
};

} // namespace hoist
