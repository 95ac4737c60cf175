#include "viewer/hud.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace hoist {
namespace {

const cv::Scalar panel_color(34, 30, 28);
const cv::Scalar dim(165, 165, 165);
const cv::Scalar warning(120, 160, 255);

int
fontOf(cv::Size window)
{
  return std::clamp(window.height / 58, 10, 24);
}

vtkSmartPointer<vtkTextActor>
textActor(const std::string& words, int font, const cv::Scalar& color)
{
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(words.c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToCourier(); // columns stay columns
  property->SetBold(1);
  property->SetFontSize(font);
  property->SetColor(color[2] / 255, color[1] / 255, color[0] / 255);
  property->SetVerticalJustificationToBottom();
  return actor;
}

} // namespace

Hud::Hud(vtkRenderer* renderer) : renderer_(renderer) {}

Hud::~Hud()
{
  for (const vtkSmartPointer<vtkProp>& prop : props_)
    renderer_->RemoveViewProp(prop);
}

// In characters, as Courier has it: VTK's own measure is of the letters' ink.
int
Hud::widthOf(const std::string& words) const
{
  const auto letters = std::count_if(words.begin(), words.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; // of UTF-8
  });
  return static_cast<int>(static_cast<double>(letters) * font_ * 0.602) + 1;
}

cv::Size
Hud::text(const std::string& words, cv::Point at, const cv::Scalar& color)
{
  if (words.empty())
    return {};
  const vtkSmartPointer<vtkTextActor> actor = textActor(words, font_, color);
  actor->SetDisplayPosition(at.x, at.y);
  renderer_->AddViewProp(actor);
  props_.emplace_back(actor);
  return {widthOf(words), font_};
}

void
Hud::square(const cv::Rect& where, const cv::Scalar& color, double opacity)
{
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->InsertNextPoint(where.x, where.y, 0);
  points->InsertNextPoint(where.br().x, where.y, 0);
  points->InsertNextPoint(where.br().x, where.br().y, 0);
  points->InsertNextPoint(where.x, where.br().y, 0);
  const auto cells = vtkSmartPointer<vtkCellArray>::New();
  const vtkIdType ids[] = {0, 1, 2, 3};
  cells->InsertNextCell(4, ids);
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  const auto mapper = vtkSmartPointer<vtkPolyDataMapper2D>::New();
  mapper->SetInputData(data);
  const auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color[2] / 255, color[1] / 255, color[0] / 255);
  actor->GetProperty()->SetOpacity(opacity);
  renderer_->AddViewProp(actor);
  props_.emplace_back(actor);
}

// \a corner: the upper left or the centre of the panel. Returns where it ends below.
int
Hud::panel(const std::vector<HudLine>& lines, cv::Point corner, Align align)
{
  if (lines.empty())
    return corner.y;
  const int row = font_ * 3 / 2, pad = font_ * 2 / 3, mark = font_ * 3 / 2;
  bool marked = false;
  int width = 0;
  for (const HudLine& line : lines) {
    marked = marked || line.swatch;
    width = std::max(width, widthOf(line.text));
  }
  width += 2 * pad + (marked ? mark : 0);
  const int height = row * static_cast<int>(lines.size()) + pad;
  cv::Rect box(corner.x, corner.y - height, width, height);
  if (align == Align::center)
    box = {corner.x - width / 2, corner.y - height / 2, width, height};
  square(box, panel_color, 0.85);
  int y = box.br().y - pad / 2;
  for (const HudLine& line : lines) {
    y -= row;
    if (line.swatch)
      square({box.x + pad, y + row / 2 - font_ * 3 / 8, font_ * 3 / 4, font_ * 3 / 4},
             *line.swatch,
             1.0);
    text(line.text, {box.x + pad + (marked ? mark : 0), y + row / 5}, line.color);
    if (line.layer)
      layers_.emplace_back(cv::Rect(box.x, y, width, row), *line.layer);
  }
  return box.y;
}

void
Hud::bar(const HudContent& content, cv::Size window)
{
  const int row = font_ * 7 / 4, pad = font_ * 2 / 3;
  square({0, 0, window.width, row}, panel_color, 0.9);
  text(content.status, {pad, row / 4}, {235, 235, 235});
  if (!content.progress.empty())
    text(content.progress,
         {window.width - widthOf(content.progress) - pad, row / 4},
         dim);
  if (!content.message.empty()) {
    square({0, row, widthOf(content.message) + 2 * pad, row}, panel_color, 0.8);
    text(content.message, {pad, row + row / 4}, {110, 220, 255});
  }
}

int
Hud::columnWidth(cv::Size window)
{
  return 26 * fontOf(window); // 38 letters and a square
}

void
Hud::show(const HudContent& content, cv::Size window, int column)
{
  for (const vtkSmartPointer<vtkProp>& prop : props_)
    renderer_->RemoveViewProp(prop);
  props_.clear();
  layers_.clear();
  font_ = fontOf(window);
  const int views = window.width - column;
  if (column > 0)
    square({views, 0, column, window.height}, panel_color, 1.0);
  const int below = panel(content.legend, {views, window.height}, Align::left);
  panel(content.card, {views, below - font_ / 2}, Align::left);
  std::vector<HudLine> notice;
  const auto letters = static_cast<std::size_t>(std::max(20, views * 3 / (2 * font_)));
  for (std::size_t begin = 0; begin < content.notice.size(); begin += letters)
    notice.push_back({content.notice.substr(begin, letters), warning, {}, {}});
  panel(notice, {views / 2, window.height / 2}, Align::center);
  bar(content, window);
  panel(content.help, {views / 2, window.height / 2}, Align::center);
}

std::optional<Layer>
Hud::layerAt(int x, int y) const
{
  for (const auto& [where, layer] : layers_)
    if (where.contains({x, y}))
      return layer;
  return {};
}

} // namespace hoist
