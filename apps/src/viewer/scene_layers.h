#pragma once

#include "viewer/layers.h"
#include "viewer/scene.h"
#include "viewer/wire_boxes.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkProp;
class vtkRenderer;

namespace hoist {

/** \brief A scene's layers in space, all but the cloud, as things in two renderers: one
 *  with the cloud, and one above it where nothing is hidden by points. */
class SceneLayers {
public:
  SceneLayers(vtkRenderer* among_points, vtkRenderer* above);
  ~SceneLayers();
  SceneLayers(const SceneLayers&) = delete;
  SceneLayers& operator=(const SceneLayers&) = delete;

  /** \brief Puts a scene in the place of the one before. */
  void show(const Scene& scene, const LayerSet& layers, const Highlight& highlight);

  void clear();

private:
  void addEdges(const Scene& scene, const LayerSet& layers);
  void addSegments(const Scene& scene);
  void addVertices(const Scene& scene);
  void addCuboids(const Scene& scene, const Highlight& highlight);
  void addFaces(const Scene& scene);
  void addUncertainty(const Scene& scene);
  void addRejected(const Scene& scene, int selected);
  void addDetections(const Scene& scene);
  void addTruth(const Scene& scene);
  void addAmongPoints(const vtkSmartPointer<vtkProp>& prop);
  void addAbove(const vtkSmartPointer<vtkProp>& prop);

  vtkRenderer* among_points_;
  vtkRenderer* above_;
  WireBoxes cuboids_;
  std::vector<vtkSmartPointer<vtkProp>> props_;
};

} // namespace hoist
