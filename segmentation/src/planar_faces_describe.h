#pragma once

#include "planar_faces_pixels.h"

#include <vector>

namespace hoist {
namespace detail {

/** \brief Fits the labelled pixels and says what each face is. Keeps its buffers. */
class FaceDescriber {
public:
  /** \param regions how many labels there may be
   *  \param labels out: number of the face + 1, 0 where none
   *  \param faces out: those of at least \a min_pixels, in the order of their labels */
  void describe(const cv::Mat1f& inverse_depth,
                const CellGrid& grid,
                const PixelLabels& pixels,
                std::size_t regions,
                const InverseDepthNoise& noise,
                const Intrinsics& camera,
                int min_pixels,
                cv::Mat1s& labels,
                std::vector<PlanarFace>& faces);

private:
  struct Bounds {
    int left, top, right, bottom;
  };

  void sumCellRow(const cv::Mat1f& image,
                  const CellGrid& grid,
                  const PixelLabels& pixels,
                  int row);
  void
  sumPixels(const cv::Mat1f& image, const PixelLabels& pixels, const cv::Rect& part);
  void number(const PixelLabels& pixels, cv::Mat1s& labels) const;
  void
  sumMixedCell(const cv::Mat1f& image, const PixelLabels& pixels, int column, int row);
  void extendTo(short label, unsigned found, int left, int top);
  void extend(short label, int left, int top, int right, int bottom);

  std::vector<PlaneMoments> sums_;   // by label
  std::vector<FullCellSums> wholes_; // by label
  std::vector<Bounds> bounds_;       // by label
  std::vector<short> number_;        // of the face + 1 by label
};

} // namespace detail
} // namespace hoist
