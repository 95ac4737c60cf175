#include "viewer/style.h"

#include <vtkCommand.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>

#include <utility>

namespace hoist {

vtkStandardNewMacro(ViewerStyle); // NOLINT(readability-identifier-naming): VTK's name

void
ViewerStyle::setHandlers(KeyHandler keys, ClickHandler clicks)
{
  keys_ = std::move(keys);
  clicks_ = std::move(clicks);
  if (lut_actor_)
    lut_actor_->SetPosition(0.1, 0.06); // above the line at the bottom
  // PCL's picker looks through all actors; clicks come to OnLeftButtonDown without it
  RemoveObservers(vtkCommand::LeftButtonPressEvent);
}

void
ViewerStyle::setFlatRenderer(vtkRenderer* renderer)
{
  flat_renderer_ = renderer;
}

bool
ViewerStyle::flat() const
{
  return CurrentRenderer != nullptr && CurrentRenderer == flat_renderer_;
}

void
ViewerStyle::OnKeyDown()
{
  const char* symbol = Interactor->GetKeySym();
  own_key_ =
      symbol != nullptr && keys_ &&
      keys_(symbol, Interactor->GetControlKey() != 0, Interactor->GetAltKey() != 0);
  if (!own_key_)
    Superclass::OnKeyDown();
}

void
ViewerStyle::OnChar()
{
  // VTK's own meaning of 3, stereo, is not pcl_viewer's
  if (!own_key_ && Interactor->GetKeyCode() != '3')
    Superclass::OnChar();
}

void
ViewerStyle::OnLeftButtonDown()
{
  const int* at = Interactor->GetEventPosition();
  FindPokedRenderer(at[0], at[1]);
  if (clicks_ && clicks_(at[0], at[1], Interactor->GetShiftKey() != 0))
    return;
  Superclass::OnLeftButtonDown();
}

// PCL draws the window again at every tick.
void
ViewerStyle::OnTimer()
{
}

void
ViewerStyle::Rotate()
{
  flat() ? Pan() : Superclass::Rotate();
}

void
ViewerStyle::Spin()
{
  flat() ? Pan() : Superclass::Spin();
}

} // namespace hoist
