#pragma once

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief Text boxes beside the things that they name, with lines that lead to them.
 *
 * A label goes where it covers no thing and no other label, as near as it can, and is
 * always inside the picture. */
class LabelPlacer {
public:
  /** \param owners for every pixel of the picture the number of the thing seen there,
   *         -1 for none
   *  \param text_scale size of the text, 1 for a picture of 1280 columns */
  LabelPlacer(cv::Mat1i owners, int text_scale);

  /** \brief Adds the label of a thing; earlier labels have the better places. */
  void add(const std::vector<std::string>& lines, int thing, const cv::Scalar& color);

  void draw(cv::Mat3b& image) const;

private:
  struct Label {
    std::vector<std::string> lines;
    cv::Rect box;
    cv::Point anchor; ///< on the thing
    cv::Scalar color;
  };

  cv::Point anchorOf(int thing) const;
  double cost(const cv::Rect& box, cv::Point anchor, int thing) const;

  cv::Mat1i owners_;
  cv::Mat1i things_above_left_; ///< integral image of the pixels of all things
  int text_scale_;
  std::vector<Label> labels_;
};

} // namespace hoist
