#include "viewer/wire_boxes.h"

#include "viewer/hidden_edges.h"
#include "viewer/shapes.h"

#include <hoist/data/cuboid.h>

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hoist {
namespace {

// Dashes of one edge, and as many gaps but one; at most so many of them.
constexpr int most_dashes = 100;

void
addLine(const Eigen::Vector3d& from,
        const Eigen::Vector3d& to,
        vtkPoints* points,
        vtkCellArray* cells)
{
  const std::array<vtkIdType, 2> ids = {
      points->InsertNextPoint(from.x(), from.y(), from.z()),
      points->InsertNextPoint(to.x(), to.y(), to.z())};
  cells->InsertNextCell(2, ids.data());
}

} // namespace

WireBoxes::WireBoxes(vtkRenderer* renderer) : renderer_(renderer)
{
  const auto callback = vtkSmartPointer<vtkCallbackCommand>::New();
  callback->SetClientData(this);
  callback->SetCallback([](vtkObject*, unsigned long, void* self, void*) {
    static_cast<WireBoxes*>(self)->look();
  });
  observer_ = renderer_->AddObserver(vtkCommand::StartEvent, callback);
}

WireBoxes::~WireBoxes()
{
  renderer_->RemoveObserver(observer_);
  clear();
}

void
WireBoxes::clear()
{
  for (const Box& box : boxes_)
    renderer_->RemoveViewProp(box.actor);
  boxes_.clear();
}

void
WireBoxes::add(const Eigen::Matrix<double, 3, 8>& corners,
               const cv::Scalar& color,
               float width,
               double dash)
{
  Box box{corners,
          dash,
          vtkSmartPointer<vtkPolyData>::New(),
          linesActor({}, color, width, 1.0)};
  vtkPolyDataMapper::SafeDownCast(box.actor->GetMapper())->SetInputData(box.lines);
  box.actor->PickableOff();
  renderer_->AddViewProp(box.actor);
  boxes_.push_back(box);
}

void
WireBoxes::look()
{
  vtkCamera* camera = renderer_->GetActiveCamera();
  const bool parallel = camera->GetParallelProjection() != 0;
  const Eigen::Vector3d eye = parallel
                                  ? -Eigen::Vector3d(camera->GetDirectionOfProjection())
                                  : Eigen::Vector3d(camera->GetPosition());
  for (Box& box : boxes_) {
    const int hidden = hiddenEdges(box.corners, eye, parallel);
    if (hidden == box.hidden)
      continue;
    box.hidden = hidden;
    const auto points = vtkSmartPointer<vtkPoints>::New();
    const auto cells = vtkSmartPointer<vtkCellArray>::New();
    int bit = 1;
    for (const auto& edge : Cuboid::edges()) {
      const Eigen::Vector3d from = box.corners.col(edge[0]);
      const Eigen::Vector3d way = box.corners.col(edge[1]) - from;
      int dashes = 1;
      if ((hidden & bit) != 0)
        dashes = std::clamp(
            static_cast<int>(std::round(way.norm() / (2 * box.dash))), 2, most_dashes);
      const double part = 1.0 / (2 * dashes - 1); // it begins and ends with a dash
      for (int i = 0; i < dashes; ++i)
        addLine(
            from + 2 * i * part * way, from + (2 * i + 1) * part * way, points, cells);
      bit <<= 1;
    }
    box.lines->SetPoints(points);
    box.lines->SetLines(cells);
  }
}

} // namespace hoist
