#pragma once

#include "viewer/scene.h"

namespace pcl {
namespace visualization {
class PCLVisualizer;
}
} // namespace pcl

namespace hoist {

/** \brief The cloud with the colour handlers that pcl_viewer gives it, chosen by its
 *  keys: 1 to 5 are one colour, x, y, z, rgb, 6 is by object, and 7, 8, 9, 0, Ctrl+1
 * and so on are the other fields of the file in their order. */
class CloudLayer {
public:
  explicit CloudLayer(pcl::visualization::PCLVisualizer& visualizer);

  /** \brief Puts a scene's cloud in the place of the one before; the chosen handler and
   *  the size of the points stay. */
  void show(const Scene& scene);

  void clear();

  void setVisible(bool visible);

  /** \param pixels from 1 to 20 count */
  void setPointSize(double pixels);

private:
  void remember();

  pcl::visualization::PCLVisualizer& visualizer_;
  int handler_ = -1; ///< chosen by a key; -1: none, so colour if there is some
  int given_handler_ = -1;
  double point_size_ = 2;
  bool visible_ = true;
  bool shown_ = false;
};

} // namespace hoist
