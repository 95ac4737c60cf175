#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hoist {

/** \brief Counts numbers from 0 up in steps, whatever their range turns out to be, and
 *  draws them. */
class Histogram {
public:
  /** \param step width of the finest bin
   *  \param end larger numbers fall into the last bin
   *  \param fixed draw the whole range, not only up to the 99 % quantile */
  Histogram(double step, double end, bool fixed);

  /** \brief Numbers that are not finite are left out. */
  void add(double value);

  std::size_t
  total() const
  {
    return total_;
  }

  /** \brief An SVG picture of at most 30 bars.
   *  \param title of the picture
   *  \param scale the axis shows numbers times this, e.g. 100 for cm
   *  \param unit behind the axis's numbers */
  std::string
  svg(const std::string& title, double scale, const std::string& unit) const;

private:
  double step_;
  bool fixed_;
  std::vector<std::size_t> counts_;
  std::size_t total_ = 0;
};

} // namespace hoist
