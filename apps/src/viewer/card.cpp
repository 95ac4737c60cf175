#include "viewer/card.h"

#include "size_text.h"

#include <fmt/format.h>

#include <cmath>

namespace hoist {
namespace {

std::string
plusMinus(double sigma, double unit)
{
  return std::isfinite(sigma) ? fmt::format(" ± {:.2f}", sigma * unit)
                              : std::string(" ± ?");
}

std::string
sourceText(DimensionSource source)
{
  return source == DimensionSource::measured ? ""
                                             : fmt::format("  ({})", toString(source));
}

std::string
facesText(const Cuboid& cuboid)
{
  static const char* const names[] = {"+L", "-L", "+W", "-W", "+H", "-H"};
  std::string text;
  for (std::size_t i = 0; i < cuboid.observed_faces.size(); ++i)
    if (cuboid.observed_faces[i])
      text += (text.empty() ? "" : " ") + std::string(names[i]);
  return text.empty() ? "none" : text;
}

std::string
pointText(const Eigen::Vector3d& p)
{
  return fmt::format("{:.3f} {:.3f} {:.3f}", p.x(), p.y(), p.z());
}

std::string
turnText(const Eigen::Quaterniond& q)
{
  return fmt::format("{:.3f} {:.3f} {:.3f} {:.3f}", q.w(), q.x(), q.y(), q.z());
}

} // namespace

std::vector<std::string>
cardText(const Scene& scene, std::size_t cuboid)
{
  const RecognizedCuboid& recognized = scene.result.cuboids.at(cuboid);
  const Cuboid& c = recognized.cuboid;
  const CuboidFeatures& f = recognized.features;
  std::vector<std::string> lines = {fmt::format("#{}  cuboid", cuboid + 1)};
  static const char* const sides[] = {"length", "width ", "height"};
  for (int i = 0; i < 3; ++i)
    lines.push_back(fmt::format("{}  {}{} cm{}",
                                sides[i],
                                sizeText(c, i),
                                plusMinus(c.size_sigma[i], 100),
                                sourceText(c.dimension_source[i])));
  lines.push_back("centre  " + pointText(c.center) + " m");
  lines.push_back(fmt::format("  sigma {:.1f} {:.1f} {:.1f} mm",
                              1000 * c.center_sigma.x(),
                              1000 * c.center_sigma.y(),
                              1000 * c.center_sigma.z()));
  if (scene.result.pose_known)
    lines.push_back("  world " + pointText(scene.result.pose * c.center) + " m");
  lines.push_back("turn    " + turnText(f.orientation));
  if (std::isfinite(c.rotation_sigma))
    lines.push_back(fmt::format("  sigma {:.2f} deg", c.rotation_sigma * 180 / M_PI));
  lines.push_back(
      "colour  " +
      (f.color_name.empty()
           ? std::string("none")
           : fmt::format(
                 "{} ({}, {}, {})", f.color_name, f.rgb[0], f.rgb[1], f.rgb[2])));
  lines.push_back(
      "weight  " +
      (f.weight > 0
           ? fmt::format("{:.3g} ± {:.2g} kg, {}", f.weight, f.weight_sigma, f.material)
           : std::string("material not known")));
  lines.push_back(fmt::format("score   {:.2f}", c.score));
  lines.push_back(fmt::format("model   {}", toString(c.model)));
  lines.push_back("faces   " + facesText(c));
  lines.push_back(fmt::format("points  {}", c.indices.size()));
  return lines;
}

std::vector<std::string>
rejectionText(const Scene& scene, std::size_t rejection)
{
  const CuboidVerdict verdict = shownRejections(scene).at(rejection);
  const Cuboid& c = verdict.cuboid;
  return {"not reported:",
          "  " + verdict.rejected,
          fmt::format("size    {:.1f} x {:.1f} x {:.1f} cm",
                      100 * c.size[0],
                      100 * c.size[1],
                      100 * c.size[2]),
          "centre  " + pointText(c.center) + " m",
          "turn    " + turnText(Eigen::Quaterniond(c.axes)),
          fmt::format("score   {:.2f}", c.score),
          fmt::format("flat    {:.2f}", verdict.flat),
          fmt::format("outline {:.2f}", verdict.outline),
          fmt::format("trust   {:.2f}", verdict.trust)};
}

} // namespace hoist
