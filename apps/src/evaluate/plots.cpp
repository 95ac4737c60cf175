#include "evaluate/plots.h"

#include "evaluate/chart.h"
#include "failures.h"
#include "png.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace hoist {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;
const cv::Scalar grey(150, 150, 150);
constexpr std::size_t least_errors = 10; // fewer make no distribution

void
save(const std::string& folder, const std::string& name, const cv::Mat3b& picture)
{
  constexpr int smallest = 9;
  savePng((std::filesystem::path(folder) / name).string(), picture, smallest);
}

// Share of the numbers that are at most x, as a line that starts at 0.
Chart::Points
cumulated(std::vector<double> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  Chart::Points points = {{0, 0}};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    points.push_back({numbers[i], points.back()[1]});
    points.push_back(
        {numbers[i], static_cast<double>(i + 1) / static_cast<double>(numbers.size())});
  }
  return points;
}

cv::Mat3b
precisionRecall(const Evaluation& evaluation)
{
  Chart chart("Precision against recall", "recall", "precision");
  chart.setRangeX(0, 1);
  chart.setRangeY(0, 1.02);
  std::size_t number = 0;
  for (const Level& level : evaluation.overall.levels) {
    Chart::Points points;
    for (const auto& point : level.detection.curve)
      points.push_back(point);
    chart.addLine(points,
                  chartColor(number++),
                  fmt::format("IoU {:g}: AP {:.3f}, F1 {:.3f}",
                              level.iou,
                              level.detection.average_precision.value_or(0),
                              level.detection.all.f1()));
  }
  return chart.draw();
}

Chart
errorChart(const std::string& title,
           const std::string& unit,
           std::vector<double> numbers,
           double scale)
{
  for (double& number : numbers)
    number *= scale;
  const Summary s = summaryOf(numbers);
  Chart chart(title, fmt::format("error [{}]", unit), "share of the hits");
  // one giant must not flatten the rest
  chart.setRangeX(0, 1.05 * std::min(s.max, 3 * s.p90));
  chart.setRangeY(0, 1.02);
  chart.addLine(cumulated(std::move(numbers)),
                chartColor(0),
                fmt::format("median {:.2g}, 90 % {:.2g}", s.median, s.p90));
  chart.addLine({{s.median, 0}, {s.median, 0.5}, {0, 0.5}}, grey, "", true);
  return chart;
}

cv::Mat3b
errors(const Evaluation& evaluation)
{
  std::vector<double> center, size, rotation;
  for (const Hit& hit : evaluation.hits) {
    center.push_back(hit.errors.center.norm());
    for (int i = 0; i < 3; ++i)
      size.push_back(std::abs(hit.errors.size[i]));
    rotation.push_back(hit.errors.rotation);
  }
  return besideEachOther({errorChart("Centre", "mm", center, 1000),
                          errorChart("Sides", "mm", size, 1000),
                          errorChart("Rotation", "degrees", rotation, degrees)});
}

cv::Mat3b
breakdownPicture(const Breakdown& breakdown)
{
  const std::string label =
      breakdown.quantity + (breakdown.quantity == "distance" ? " [m]" : "");
  Chart::Points recall, f1, center, size, rotation;
  double longest = 0, widest = 0;
  for (const Breakdown::Bin& bin : breakdown.bins) {
    if (bin.counts.hits + bin.counts.missed == 0)
      continue;
    const double x =
        breakdown.quantity == "faces visible" ? bin.from : (bin.from + bin.to) / 2;
    recall.push_back({x, bin.counts.recall()});
    f1.push_back({x, bin.counts.f1()});
    if (bin.errors.center.n == 0)
      continue;
    center.push_back({x, 1000 * bin.errors.center.median});
    size.push_back({x, 1000 * bin.errors.size.median});
    rotation.push_back({x, degrees * bin.errors.rotation.median});
    longest = std::max({longest, center.back()[1], size.back()[1]});
    widest = std::max(widest, rotation.back()[1]);
  }
  const double low = breakdown.bins.front().from, high = breakdown.bins.back().to;
  std::vector<Chart> charts = {
      {"Found", label, "share"},
      {"Errors of the hits", label, "median error [mm]"},
      {"Rotation of the hits", label, "median error [degrees]"}};
  for (Chart& chart : charts)
    chart.setRangeX(low, high);
  charts[0].setRangeY(0, 1.02);
  charts[0].addDots(recall, chartColor(0), "recall");
  if (breakdown.precise)
    charts[0].addDots(f1, chartColor(1), "F1");
  charts[1].setRangeY(0, 1.1 * longest);
  charts[1].addDots(center, chartColor(0), "centre");
  charts[1].addDots(size, chartColor(1), "sides");
  charts[2].setRangeY(0, 1.1 * widest);
  charts[2].addDots(rotation, chartColor(0), "");
  return besideEachOther(charts);
}

cv::Mat3b
scores(const ScoreCalibration& calibration)
{
  Chart reliability("Is the score a probability?", "score", "share of hits");
  reliability.setRangeX(0, 1);
  reliability.setRangeY(0, 1.02);
  reliability.addLine({{0, 0}, {1, 1}}, grey, "if it were", true);
  Chart::Points points;
  std::size_t most = 1;
  for (const ScoreBin& bin : calibration.bins)
    if (bin.n > 0) {
      points.push_back({bin.mean_score, bin.hit_share});
      most = std::max(most, bin.n);
    }
  reliability.addDots(
      points, chartColor(0), fmt::format("tenths; ECE {:.3f}", calibration.ece));
  Chart counts("How many boxes have which score", "score", "boxes");
  counts.setRangeX(0, 1);
  counts.setRangeY(0, 1.1 * static_cast<double>(most));
  for (std::size_t i = 0; i < calibration.bins.size(); ++i) {
    const ScoreBin& bin = calibration.bins[i];
    const double from = 0.1 * static_cast<double>(i);
    if (bin.n == 0)
      continue;
    counts.addBar(from, from + 0.1, static_cast<double>(bin.n), chartColor(1));
    counts.addBar(from, from + 0.1, static_cast<double>(bin.hits), chartColor(0));
  }
  counts.addLine({}, chartColor(0), "hits");
  counts.addLine({}, chartColor(1), "wrong");
  return besideEachOther({reliability, counts});
}

cv::Mat3b
sigmas(const std::vector<SigmaCalibration>& calibrations)
{
  Chart chart("Are errors as large as their sigma says?", "|error| / sigma", "share");
  chart.setRangeX(0, 5);
  chart.setRangeY(0, 1.02);
  std::size_t number = 0;
  for (const SigmaCalibration& calibration : calibrations) {
    if (number == 5) // no more colours
      break;
    if (calibration.n < least_errors && calibrations.size() > 1)
      continue;
    chart.addLine(cumulated(calibration.sorted),
                  chartColor(number++),
                  fmt::format("{}: {:.0f} % within 1",
                              calibration.quantity,
                              100 * calibration.within_1));
  }
  Chart::Points normal;
  for (double x = 0; x <= 5.01; x += 0.05)
    normal.push_back({x, std::erf(x / std::sqrt(2.0))});
  chart.addLine(normal, cv::Scalar(60, 60, 60), "normal: 68 %");
  return chart.draw();
}

} // namespace

void
writePlots(const std::string& folder, const Evaluation& evaluation)
{
  save(folder, "precision_recall.png", precisionRecall(evaluation));
  if (!evaluation.hits.empty())
    save(folder, "errors.png", errors(evaluation));
  for (const Breakdown& breakdown : evaluation.breakdowns) {
    std::string name = breakdown.quantity;
    std::replace(name.begin(), name.end(), ' ', '_');
    save(folder, name + ".png", breakdownPicture(breakdown));
  }
  if (evaluation.scores.n > 0)
    save(folder, "scores.png", scores(evaluation.scores));
  if (!evaluation.sigmas.empty())
    save(folder, "sigmas.png", sigmas(evaluation.sigmas));
}

} // namespace hoist
