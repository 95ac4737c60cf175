#include <hoist/recognition/region_ops.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace hoist {
namespace {

// One bilinear sample: four offsets into a channel and their weights, all 0 outside.
struct Sample {
  int offsets[4] = {0, 0, 0, 0};
  float weights[4] = {0, 0, 0, 0};
};

// The two neighbours along one side; beyond the last pixel its value goes on.
struct Neighbours {
  int low = 0, high = 0;
  float share = 0; ///< of the high one
};

bool
neighboursOf(float at, int count, Neighbours& n)
{
  if (!(at >= -1 && at <= static_cast<float>(count)))
    return false;
  at = std::max(at, 0.f);
  n.low = std::min(static_cast<int>(at), count - 1);
  n.high = std::min(n.low + 1, count - 1);
  n.share = n.low == n.high ? 0 : at - static_cast<float>(n.low);
  return true;
}

Sample
sampleAt(float x, float y, int width, int height)
{
  Sample sample;
  Neighbours h, v;
  if (!neighboursOf(x, width, h) || !neighboursOf(y, height, v))
    return sample;
  const int rows[] = {v.low, v.low, v.high, v.high};
  const int columns[] = {h.low, h.high, h.low, h.high};
  const float row_share[] = {1 - v.share, 1 - v.share, v.share, v.share};
  const float column_share[] = {1 - h.share, h.share, 1 - h.share, h.share};
  for (int k = 0; k < 4; ++k) {
    sample.offsets[k] = rows[k] * width + columns[k];
    sample.weights[k] = row_share[k] * column_share[k];
  }
  return sample;
}

double
areaOf(const Corners& box)
{
  return (static_cast<double>(box[2]) - box[0]) *
         (static_cast<double>(box[3]) - box[1]);
}

} // namespace

void
roiAlign(const cv::Mat& features,
         const std::vector<Corners>& regions,
         double scale,
         int side,
         int samples,
         cv::Mat& pooled)
{
  const int dims = features.dims;
  if (features.type() != CV_32F || !features.isContinuous() ||
      !(dims == 3 || (dims == 4 && features.size[0] == 1)) || features.empty())
    throw std::invalid_argument("roiAlign: features must be CxHxW or 1xCxHxW floats");
  if (!(scale > 0) || side < 1 || samples < 1)
    throw std::invalid_argument("roiAlign: scale, side and samples must be above 0");
  const int channels = features.size[dims - 3];
  const int height = features.size[dims - 2], width = features.size[dims - 1];
  const int shape[] = {static_cast<int>(regions.size()), channels, side, side};
  if (regions.empty()) {
    pooled.release();
    return;
  }
  pooled.create(4, shape, CV_32F);

  const auto by = static_cast<float>(scale);
  const int per_cell = samples * samples;
  std::vector<Sample> plan(static_cast<std::size_t>(side * side * per_cell));
  float* out = pooled.ptr<float>();
  for (const Corners& region : regions) {
    const float left = region[0] * by, top = region[1] * by;
    const float cell_width = std::max(region[2] * by - left, 1.f) / side;
    const float cell_height = std::max(region[3] * by - top, 1.f) / side;
    // the places are the same in every channel
    auto sample = plan.begin();
    for (int v = 0; v < side; ++v)
      for (int u = 0; u < side; ++u)
        for (int j = 0; j < samples; ++j)
          for (int i = 0; i < samples; ++i)
            *sample++ =
                sampleAt(left + u * cell_width + (i + 0.5f) * cell_width / samples,
                         top + v * cell_height + (j + 0.5f) * cell_height / samples,
                         width,
                         height);
    for (int c = 0; c < channels; ++c) {
      const float* map =
          features.ptr<float>() + static_cast<std::size_t>(c) * height * width;
      sample = plan.begin();
      for (int cell = 0; cell < side * side; ++cell) {
        float sum = 0;
        for (int s = 0; s < per_cell; ++s, ++sample)
          for (int k = 0; k < 4; ++k)
            sum += sample->weights[k] * map[sample->offsets[k]];
        *out++ = sum / static_cast<float>(per_cell);
      }
    }
  }
}

Corners
decodeBox(const Corners& anchor, const cv::Vec4f& delta, const cv::Vec4f& weights)
{
  const float longest = std::log(1000.f / 16);
  const float width = anchor[2] - anchor[0], height = anchor[3] - anchor[1];
  const float x = delta[0] / weights[0] * width + anchor[0] + width / 2;
  const float y = delta[1] / weights[1] * height + anchor[1] + height / 2;
  const float w = std::exp(std::min(delta[2] / weights[2], longest)) * width;
  const float h = std::exp(std::min(delta[3] / weights[3], longest)) * height;
  return {x - w / 2, y - h / 2, x + w / 2, y + h / 2};
}

std::vector<int>
suppressOverlaps(const std::vector<Corners>& boxes,
                 const std::vector<float>& scores,
                 double threshold)
{
  if (boxes.size() != scores.size())
    throw std::invalid_argument("suppressOverlaps: not one score per box");
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
      order.begin(), order.end(), [&](int a, int b) { return scores[a] > scores[b]; });
  std::vector<int> kept;
  for (const int i : order) {
    const Corners& a = boxes[i];
    const bool doubled = std::any_of(kept.begin(), kept.end(), [&](int k) {
      const Corners& b = boxes[k];
      const double wide =
          static_cast<double>(std::min(a[2], b[2])) - std::max(a[0], b[0]);
      const double high =
          static_cast<double>(std::min(a[3], b[3])) - std::max(a[1], b[1]);
      const double common = std::max(wide, 0.0) * std::max(high, 0.0);
      return common > threshold * (areaOf(a) + areaOf(b) - common);
    });
    if (!doubled)
      kept.push_back(i);
  }
  return kept;
}

} // namespace hoist
