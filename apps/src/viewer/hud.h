#pragma once

#include "viewer/layers.h"

#include <opencv2/core.hpp>

#include <vtkSmartPointer.h>

#include <optional>
#include <string>
#include <vector>

class vtkProp;
class vtkRenderer;

namespace hoist {

/** \brief A line of a panel. */
struct HudLine {
  std::string text;
  cv::Scalar color{235, 235, 235};  ///< BGR
  std::optional<cv::Scalar> swatch; ///< a square of this colour before the text
  std::optional<Layer> layer;       ///< a click on it switches this layer
};

/** \brief The words over the views. */
struct HudContent {
  std::vector<HudLine> legend; ///< on top of the column
  std::vector<HudLine> card;   ///< below the legend
  std::vector<HudLine> help;   ///< in the middle, over all else
  std::string notice;          ///< over the views: why there is nothing to see
  std::string status;          ///< lower left: file and result
  std::string progress;        ///< lower right: what is being worked on
  std::string message;         ///< above the status: what has just been done
};

/** \brief Draws them in a renderer that covers the whole window. */
class Hud {
public:
  explicit Hud(vtkRenderer* renderer);
  ~Hud();
  Hud(const Hud&) = delete;
  Hud& operator=(const Hud&) = delete;

  /** \brief How wide the column of words is in a window of this size [px]. */
  static int columnWidth(cv::Size window);

  /** \param window size [px]
   *  \param column width of the column on the right [px], 0 for none */
  void show(const HudContent& content, cv::Size window, int column);

  /** \brief The layer whose line of the legend is at a place of the window. */
  std::optional<Layer> layerAt(int x, int y) const;

private:
  enum class Align { left, center };

  int panel(const std::vector<HudLine>& lines, cv::Point corner, Align align);
  void bar(const HudContent& content, cv::Size window);
  cv::Size text(const std::string& words, cv::Point at, const cv::Scalar& color);
  void square(const cv::Rect& where, const cv::Scalar& color, double opacity);
  int widthOf(const std::string& words) const;

  vtkRenderer* renderer_;
  std::vector<vtkSmartPointer<vtkProp>> props_;
  std::vector<std::pair<cv::Rect, Layer>> layers_;
  int font_ = 14;
};

} // namespace hoist
