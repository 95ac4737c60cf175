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
 * Pixels with a hue vote for it, pixels without one for their lightness, in between for
 * both in part. The heaviest window of 50 degrees of hue, or of 40 of lightness among
 * the greys, has the surface in it, at its densest hue: print, labels and highlights
 * are other clusters and do not pull the answer; a mean would give a colour that no
 * pixel has. The answer is the median of the cluster's purer half (of higher chroma, or
 * lighter among the greys), for shade and the blur between two inks only take purity
 * away.
 *
 * \param pixels one colour per supporting pixel, OpenCV's channel order
 * \param color the answer
 * \return false if there are no pixels; \a color is then black
 */
HOIST_RECOGNITION_EXPORT bool dominantColor(const std::vector<cv::Vec3b>& pixels,
                                            Color& color);

/** \brief L* of what counts as white among the pixels of a frame: their 97 % quantile,
 *  held in [80, 100]; 100 if there are none.
 *
 * The lightest surface of a scene is seen as white (Gilchrist et al., "An anchoring
 * theory of lightness perception", 1999), whatever the exposure was. */
HOIST_RECOGNITION_EXPORT double lightnessOfWhite(const std::vector<cv::Vec3b>& pixels);

/** \brief One of the eleven basic colour terms of Berlin and Kay, "Basic Color Terms",
 *  1969: black, white, grey, red, green, yellow, blue, brown, purple, pink, orange.
 *
 * A partition of lightness, chroma and hue angle; see docs/features.md for the borders.
 * \param white L* of white, in (0, 100]; lightness is taken relative to it
 */
HOIST_RECOGNITION_EXPORT std::string colorName(const std::array<double, 3>& lab,
                                               double white = 100.0);

} // namespace hoist
