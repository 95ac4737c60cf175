#pragma once

#include <hoist/recognition/export.h>

#include <opencv2/core.hpp>

#include <array>
#include <string>
#include <vector>

namespace hoist {

/** \brief A colour as it is printed and as it is compared. */
struct Color {
  std::array<unsigned char, 3> rgb{}; ///< sRGB
  std::array<double, 3> lab{};        ///< CIE L*a*b*, D65, L in [0, 100]
};

/** \brief sRGB to CIE L*a*b* with the D65 white point (IEC 61966-2-1, CIE 15). */
HOIST_RECOGNITION_EXPORT std::array<double, 3>
labFromRgb(const std::array<unsigned char, 3>& rgb);

/** \brief The colour most of the pixels have.
 *
 * The mode of the pixels in L*a*b*, found on a coarse histogram and refined by mean
 * shift, then the median of the pixels near it. Print, labels and highlights are other
 * modes and do not pull the answer; a mean would give a colour that no pixel has.
 * Lightness counts half as much as hue and chroma, because faces of one box are shaded
 * differently.
 *
 * \param pixels one colour per supporting pixel, OpenCV's channel order
 * \param color the answer
 * \return false if there are no pixels; \a color is then black
 */
HOIST_RECOGNITION_EXPORT bool dominantColor(const std::vector<cv::Vec3b>& pixels,
                                            Color& color);

/** \brief One of the eleven basic colour terms of Berlin and Kay, "Basic Color Terms",
 *  1969: black, white, grey, red, green, yellow, blue, brown, purple, pink, orange.
 *
 * A partition of lightness, chroma and hue angle; see docs/features.md for the borders.
 */
HOIST_RECOGNITION_EXPORT std::string colorName(const std::array<double, 3>& lab);

} // namespace hoist
