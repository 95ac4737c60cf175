#pragma once

#include "viewer/handlers.h"

#include <pcl/visualization/interactor_style.h>

namespace hoist {

/** \brief pcl_viewer's way of moving and its keys; the viewer is asked first. */
class ViewerStyle : public pcl::visualization::PCLVisualizerInteractorStyle {
public:
  vtkTypeMacro(
      ViewerStyle,
      pcl::visualization::PCLVisualizerInteractorStyle) static ViewerStyle* New();

  void setHandlers(KeyHandler keys, ClickHandler clicks);

  /** \brief In this renderer nothing turns: it is moved and enlarged. */
  void setFlatRenderer(vtkRenderer* renderer);

  void OnKeyDown() override;
  void OnChar() override;
  void OnLeftButtonDown() override;
  void OnTimer() override;
  void Rotate() override;
  void Spin() override;

private:
  bool flat() const;

  KeyHandler keys_;
  ClickHandler clicks_;
  vtkRenderer* flat_renderer_ = nullptr;
  bool own_key_ = false;
};

} // namespace hoist
