#pragma once

#include <hoist/filters/export.h>

#include <opencv2/core.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace hoist {

/** \brief How the colour of the light is guessed. */
enum class WhiteBalanceMethod {
  grey_world, ///< the mean of a scene is grey (Buchsbaum 1980)
  white_patch ///< the brightest a channel gets is white (Land 1977), by a percentile
};

/** \brief Settings of \ref estimateGains. */
struct WhiteBalanceParameters {
  WhiteBalanceMethod method = WhiteBalanceMethod::white_patch;
  double percentile = 97; ///< white_patch: of each channel, (0, 100]; 100 = maximum
  int min_value = 8;      ///< pixels with a channel below are too noisy
  int max_value = 250;    ///< pixels with a channel above are clipped: their ratio lies
  double max_gain = 4;    ///< gains are held in [1, max_gain], >= 1
  double max_tint = 0.04; ///< a guess further off the colours of lamps and sky is none
};

/** \brief Factors of the three channels, on the 8 bit values. */
struct ColorGains {
  double r = 1, g = 1, b = 1;
  bool valid = false; ///< false: nothing to learn from or no light; all gains are 1
};

/** \brief Counts of 8 bit values by channel; all that the estimates need. */
class HOIST_FILTERS_EXPORT ColorHistogram {
public:
  explicit ColorHistogram(const WhiteBalanceParameters& parameters = {})
  : min_(parameters.min_value), max_(parameters.max_value)
  {
  }

  /** \brief Counts a pixel, unless it is too dark or clipped. */
  void
  add(std::uint8_t r, std::uint8_t g, std::uint8_t b)
  {
    if (r < min_ || g < min_ || b < min_ || r > max_ || g > max_ || b > max_)
      return;
    ++counts_[0][r];
    ++counts_[1][g];
    ++counts_[2][b];
    ++size_;
  }

  std::size_t
  size() const
  {
    return size_;
  }

  /** \brief Mean value of a channel (0 red, 1 green, 2 blue); size() > 0. */
  double mean(int channel) const;

  /** \brief Value that \a share of the pixels do not exceed, share in (0, 1], linear
   *  within the value's bin; size() > 0. */
  double quantile(int channel, double share) const;

private:
  std::array<std::array<std::size_t, 256>, 3> counts_{};
  std::size_t size_ = 0;
  int min_, max_;
};

/** \brief How far a colour lies from those of incandescent light and the sky: its
 *  distance from the Planckian locus, 2000 to 15000 K, in CIE 1960 (u, v).
 *
 * Lamps sold as white stay within 0.006 (ANSI C78.377), daylight within 0.004; a camera
 * that sets its own white adds its error. sRGB's red lies 0.12 off.
 *  \param rgb sRGB values, [0, 255], one at least > 0 */
HOIST_FILTERS_EXPORT double tintOfLight(const std::array<double, 3>& rgb);

/** \brief Gains that make the guessed light white: gain_c = max(e) / e_c, with e the
 *  guessed colour of the light.
 *
 * No gain is below 1: a clipped white stays white instead of taking the complement of
 * the light's colour. A guess that is no plausible light (\ref tintOfLight above
 * max_tint) is the colour of what fills the frame, and changes nothing.
 * Works on the coded values: where they follow a power law of the light, a gain of the
 * light is a gain of the value.
 * \throws std::invalid_argument on a parameter outside its range
 */
HOIST_FILTERS_EXPORT ColorGains estimateGains(const ColorHistogram& histogram,
                                              const WhiteBalanceParameters& parameters);

/** \brief The same from an image.
 *  \param mask pixels to use (non-zero), the image's size, or empty for all */
HOIST_FILTERS_EXPORT ColorGains
estimateGains(const cv::Mat3b& bgr,
              const cv::Mat1b& mask = cv::Mat1b(),
              const WhiteBalanceParameters& parameters = WhiteBalanceParameters());

/** \brief Tables of the new value for every old one, by channel red, green, blue:
 *  rounded to the nearest, at most 255. */
HOIST_FILTERS_EXPORT std::array<std::array<std::uint8_t, 256>, 3>
gainTables(const ColorGains& gains);

/** \brief Applies gains to an image, in place. */
HOIST_FILTERS_EXPORT void applyGains(const ColorGains& gains, cv::Mat3b& bgr);

} // namespace hoist
