#include "table.h"

#include "size_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace hoist {

std::string
reasonsText(const Tally& tally)
{
  auto entries = tally.entries();
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.second > b.second;
  });
  std::string text;
  for (const auto& [name, count] : entries)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  return text;
}

CuboidTable::CuboidTable(std::ostream& out, std::size_t scene_width, bool with_weight)
: out_(out)
, scene_width_(static_cast<int>(std::max<std::size_t>(scene_width, 5)))
, with_weight_(with_weight)
{
}

void
CuboidTable::add(const FrameResult& result)
{
  if (!head_done_) {
    out_ << fmt::format("{:<{}}  {:>2}  {:>22}  {:>22}  {:>5}  {:<8}  {:<6}{}\n",
                        "scene",
                        scene_width_,
                        "#",
                        "L x W x H [cm]",
                        "x y z [m]",
                        "score",
                        "model",
                        "colour",
                        with_weight_ ? "    weight" : "");
    head_done_ = true;
  }
  if (result.cuboids.empty()) {
    const std::string reasons = reasonsText(result.diagnostics.rejected);
    out_ << fmt::format("{:<{}}  no cuboid{}\n",
                        result.scene,
                        scene_width_,
                        reasons.empty() ? "" : "; rejected: " + reasons);
  }
  for (std::size_t i = 0; i < result.cuboids.size(); ++i) {
    const Cuboid& c = result.cuboids[i].cuboid;
    const CuboidFeatures& f = result.cuboids[i].features;
    const std::string size =
        sizeText(c, 0) + " x " + sizeText(c, 1) + " x " + sizeText(c, 2);
    const std::string center =
        fmt::format("{:.3f} {:.3f} {:.3f}", c.center.x(), c.center.y(), c.center.z());
    out_ << fmt::format("{:<{}}  {:>2}  {:>22}  {:>22}  {:>5.2f}  {:<8}  {:<6}",
                        i == 0 ? result.scene : "",
                        scene_width_,
                        i + 1,
                        size,
                        center,
                        c.score,
                        toString(c.model),
                        f.color_name);
    if (with_weight_)
      out_ << fmt::format("  {:>6.4g} kg", f.weight);
    out_ << '\n';
  }
  out_.flush();
}

} // namespace hoist
