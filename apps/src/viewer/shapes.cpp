#include "viewer/shapes.h"

#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>

namespace hoist {
namespace {

vtkSmartPointer<vtkActor>
flatActor(vtkPolyData* data, const cv::Scalar& color)
{
  const auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color[2] / 255, color[1] / 255, color[0] / 255);
  actor->GetProperty()->LightingOff();
  return actor;
}

vtkIdType
add(vtkPoints* points, const Eigen::Vector3d& p)
{
  return points->InsertNextPoint(p.x(), p.y(), p.z());
}

} // namespace

vtkSmartPointer<vtkActor>
pointsActor(const std::vector<Eigen::Vector3d>& points,
            const cv::Scalar& color,
            float size)
{
  const auto positions = vtkSmartPointer<vtkPoints>::New();
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const Eigen::Vector3d& p : points) {
    const vtkIdType id = add(positions, p);
    cells->InsertNextCell(1, &id);
  }
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(positions);
  data->SetVerts(cells);
  vtkSmartPointer<vtkActor> actor = flatActor(data, color);
  actor->GetProperty()->SetPointSize(size);
  return actor;
}

vtkSmartPointer<vtkActor>
linesActor(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& lines,
           const cv::Scalar& color,
           float width,
           double opacity)
{
  const auto positions = vtkSmartPointer<vtkPoints>::New();
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const auto& [from, to] : lines) {
    const std::array<vtkIdType, 2> ids = {add(positions, from), add(positions, to)};
    cells->InsertNextCell(2, ids.data());
  }
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(positions);
  data->SetLines(cells);
  vtkSmartPointer<vtkActor> actor = flatActor(data, color);
  actor->GetProperty()->SetLineWidth(width);
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

vtkSmartPointer<vtkActor>
quadsActor(const std::vector<std::array<Eigen::Vector3d, 4>>& quads,
           const cv::Scalar& color,
           double opacity)
{
  const auto positions = vtkSmartPointer<vtkPoints>::New();
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const auto& quad : quads) {
    std::array<vtkIdType, 4> ids{};
    for (std::size_t i = 0; i < ids.size(); ++i)
      ids[i] = add(positions, quad[i]);
    cells->InsertNextCell(4, ids.data());
  }
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(positions);
  data->SetPolys(cells);
  vtkSmartPointer<vtkActor> actor = flatActor(data, color);
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

vtkSmartPointer<vtkActor>
ellipsoidActor(const Eigen::Vector3d& center,
               const Eigen::Matrix3d& half_axes,
               const cv::Scalar& color)
{
  const auto sphere = vtkSmartPointer<vtkSphereSource>::New();
  sphere->SetRadius(1.0);
  sphere->SetThetaResolution(24);
  sphere->SetPhiResolution(16);
  sphere->Update();
  vtkSmartPointer<vtkActor> actor = flatActor(sphere->GetOutput(), color);
  const auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k)
      matrix->SetElement(i, k, half_axes(i, k));
    matrix->SetElement(i, 3, center[i]);
  }
  actor->SetUserMatrix(matrix);
  actor->GetProperty()->LightingOn();
  actor->GetProperty()->SetAmbient(0.5);
  return actor;
}

vtkSmartPointer<vtkProp>
labelActor(const std::string& text,
           const Eigen::Vector3d& at,
           const cv::Scalar& color,
           int size,
           int lift)
{
  auto actor = vtkSmartPointer<vtkBillboardTextActor3D>::New();
  actor->SetDisplayOffset(0, lift);
  actor->SetInput(text.c_str());
  actor->SetPosition(at.x(), at.y(), at.z());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontSize(size);
  property->SetColor(1, 1, 1); // on a dark shade of the thing's colour
  property->SetBackgroundColor(
      0.35 * color[2] / 255, 0.35 * color[1] / 255, 0.35 * color[0] / 255);
  property->SetBackgroundOpacity(1);
  property->SetBold(1);
  property->SetJustificationToCentered();
  property->SetVerticalJustificationToCentered();
  return actor;
}

} // namespace hoist
