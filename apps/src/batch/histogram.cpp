#include "batch/histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hoist {

Histogram::Histogram(double step, double end, bool fixed)
: step_(step), fixed_(fixed), counts_(static_cast<std::size_t>(std::lround(end / step)))
{
}

void
Histogram::add(double value)
{
  if (!std::isfinite(value))
    return;
  const double bin = std::clamp(
      std::floor(value / step_), 0.0, static_cast<double>(counts_.size() - 1));
  ++counts_[static_cast<std::size_t>(bin)];
  ++total_;
}

std::string
Histogram::svg(const std::string& title, double scale, const std::string& unit) const
{
  // up to where 99 % lie, so that one giant does not flatten the rest
  std::size_t end = counts_.size();
  if (!fixed_) {
    std::size_t seen = 0;
    end = 0;
    while (end < counts_.size() && seen * 100 < total_ * 99)
      seen += counts_[end++];
    end = std::max<std::size_t>(end, 1);
  }
  const std::size_t wide = (end + 29) / 30; // fine bins in a bar
  const std::size_t n = (end + wide - 1) / wide;
  std::vector<std::size_t> bars(n, 0);
  for (std::size_t i = 0; i < counts_.size(); ++i)
    bars[std::min(i / wide, n - 1)] += counts_[i];
  const std::size_t highest =
      std::max<std::size_t>(*std::max_element(bars.begin(), bars.end()), 1);

  constexpr double left = 10, top = 26, width = 340, height = 120;
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 360 180\" role=\"img\" aria-label=\"{0}\"><text x=\"{1}\" "
      "y=\"14\" class=\"t\">{0}</text><text x=\"350\" y=\"14\" class=\"a e\">highest "
      "bar {2}</text>",
      title,
      left,
      highest);
  const double bar = width / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double h =
        height * static_cast<double>(bars[i]) / static_cast<double>(highest);
    const double from = static_cast<double>(i * wide) * step_ * scale;
    const double to = from + static_cast<double>(wide) * step_ * scale;
    out += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
                       "height=\"{:.2f}\"><title>{:g} to {}{}: {}</title></rect>",
                       left + bar * static_cast<double>(i),
                       top + height - h,
                       std::max(bar - 1, 0.5),
                       h,
                       from,
                       i + 1 == n && !fixed_ ? "more" : fmt::format("{:g}", to),
                       unit.empty() ? "" : " " + unit,
                       bars[i]);
  }
  out += fmt::format("<line x1=\"{0}\" y1=\"{1}\" x2=\"{2}\" y2=\"{1}\"/>",
                     left,
                     top + height,
                     left + width);
  for (int i = 0; i <= 4; ++i) {
    const double share = i / 4.0;
    const double value = share * static_cast<double>(n * wide) * step_ * scale;
    out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" class=\"a {}\">{:.4g}{}</text>",
                       left + share * width,
                       top + height + 16,
                       i == 0   ? ""
                       : i == 4 ? "e"
                                : "m",
                       value,
                       i == 4 ? (fixed_ ? "" : "+") + (unit.empty() ? "" : " " + unit)
                              : "");
  }
  return out + "</svg>";
}

} // namespace hoist
