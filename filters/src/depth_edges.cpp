#include <hoist/filters/depth_edges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace hoist {
namespace {

void
check(bool condition, const char* what)
{
  if (!condition)
    throw std::invalid_argument(std::string("hoist::DepthEdges: ") + what);
}

// One row or column of the image: w at position i is data[i * stride].
struct Line {
  const float* data;
  int stride;
  int size;

  float
  operator[](int i) const
  {
    return data[static_cast<std::ptrdiff_t>(i) * stride];
  }
};

// Slope of the surface that ends at i and comes from i - side * base, per pixel along
// the line; 0 where there is no such surface.
float
slopeAt(const Line& w, int i, int side, int base, float sigma)
{
  const int far_end = i - side * base;
  if (far_end < 0 || far_end >= w.size)
    return 0;
  const float a = w[far_end], b = w[i - side * (base / 2)], c = w[i];
  // straight up to noise: 3 sigma of a second difference, sqrt(6) each
  if (a <= 0 || b <= 0 || std::abs(a - 2 * b + c) > 7.5F * sigma)
    return 0;
  return side * (c - a) / static_cast<float>(base);
}

enum class Gap { surface, step };

// Is the change of w from p to q > p one surface, or a step?
Gap
judge(const Line& w, int p, int q, float sigma, float sigmas)
{
  const int gap = q - p;
  const int base = gap <= 2 ? 4 : 8;
  const float jump = w[q] - w[p];
  if (std::abs(jump) <= sigmas * sigma * 1.41421F)
    return Gap::surface;
  // far extrapolation is worth nothing: the tolerance grows with it, up to 3 bases
  const float ratio = std::min(3.0F, static_cast<float>(gap) / base);
  const float tolerance =
      sigmas * sigma * std::sqrt(1 + (1 + ratio) * (1 + ratio) + ratio * ratio);
  const float before = slopeAt(w, p, 1, base, sigma);
  const float after = slopeAt(w, q, -1, base, sigma);
  const float length = static_cast<float>(gap);
  const float by_p = before * length, by_q = after * length;
  if (gap <= 2) // a crease between p and q changes w by something between the two
    return jump < std::min(by_p, by_q) - tolerance ||
                   jump > std::max(by_p, by_q) + tolerance
               ? Gap::step
               : Gap::surface;
  const float miss = std::min(std::abs(jump - by_p), std::abs(jump - by_q));
  return miss > tolerance ? Gap::step : Gap::surface;
}

// Is the unmeasured run through i longer than that?
bool
isLonger(const Line& w, int i, int length)
{
  int first = i, last = i;
  while (first > 0 && last - first < length && w[first - 1] <= 0)
    --first;
  while (last + 1 < w.size && last - first < length && w[last + 1] <= 0)
    ++last;
  return last - first + 1 > length;
}

} // namespace

InverseDepthNoise::InverseDepthNoise(const SensorModel& sensor)
{
  // exact at three inverse depths, and thus everywhere for a quadratic
  const std::array<double, 3> w = {0.25, 0.5, 1.0};
  std::array<double, 3> s{};
  for (int i = 0; i < 3; ++i)
    s[i] = sensor.sigmaZ(1 / w[i]) * w[i] * w[i];
  const double d01 = (s[1] - s[0]) / (w[1] - w[0]);
  const double d12 = (s[2] - s[1]) / (w[2] - w[1]);
  const double d012 = (d12 - d01) / (w[2] - w[0]);
  c = static_cast<float>(d012);
  b = static_cast<float>(d01 - d012 * (w[0] + w[1]));
  a = static_cast<float>(s[0] - d01 * w[0] + d012 * w[0] * w[1]);
}

void
DepthEdges::detect(const cv::Mat1f& inverse_depth,
                   const Intrinsics& intrinsics,
                   const DepthEdgeParameters& parameters,
                   int kinds,
                   cv::Mat1b& labels)
{
  check(parameters.step_sigmas > 0, "step_sigmas must be > 0");
  check(parameters.max_gap >= 0, "max_gap must be >= 0");
  check(parameters.crease_angle > 0 && parameters.crease_angle < 1.57,
        "crease_angle must be in (0, pi/2)");
  check(parameters.crease_sigmas > 0, "crease_sigmas must be > 0");
  check(labels.size() == inverse_depth.size(), "labels must have the frame's size");
  if (inverse_depth.empty())
    return;

  findSteps(inverse_depth, parameters);
  if ((kinds & EDGE_OCCLUSION) != 0)
    for (int v = 0; v < labels.rows; ++v) {
      const unsigned char* step = steps_[v];
      unsigned char* label = labels[v];
      int u = 0;
      for (; u + 8 <= labels.cols; u += 8) { // eight pixels in one word
        std::uint64_t s = 0, l = 0;
        std::memcpy(&s, step + u, 8);
        std::memcpy(&l, label + u, 8);
        const std::uint64_t only_near = s & ~(s >> 1) & 0x0101010101010101ULL;
        l |= only_near * EDGE_OCCLUSION; // no carry: bytes are 0 or 1
        std::memcpy(label + u, &l, 8);
      }
      for (; u < labels.cols; ++u)
        if (step[u] == step_near)
          label[u] |= EDGE_OCCLUSION;
    }
  if ((kinds & EDGE_CREASE) != 0 && intrinsics.valid())
    creases_.find(inverse_depth,
                  InverseDepthNoise(parameters.sensor),
                  steps_,
                  {parameters.crease_angle,
                   parameters.crease_sigmas,
                   std::sqrt(intrinsics.fx * intrinsics.fy)},
                  EDGE_CREASE,
                  labels);
}

void
DepthEdges::findSteps(const cv::Mat1f& w, const DepthEdgeParameters& parameters)
{
  const int rows = w.rows, cols = w.cols;
  const int max_gap =
      std::max(1, parameters.max_gap > 0 ? parameters.max_gap : cols / 10);
  // a void is looked at some pixels behind its border, which may be ragged
  const int deep = std::min(4, max_gap);
  const InverseDepthNoise noise(parameters.sensor);
  const float sigmas = static_cast<float>(parameters.step_sigmas);
  const float a = noise.a * sigmas * 1.41421F, b = noise.b * sigmas * 1.41421F,
              c = noise.c * sigmas * 1.41421F;
  const auto isCandidate = [=](float p, float q) -> unsigned char {
    const float most = std::max(p, q);
    return static_cast<unsigned char>(
        static_cast<int>(std::abs(p - q) > a + most * (b + most * c)) |
        static_cast<int>((p > 0) != (q > 0)));
  };
  steps_.create(w.size());
  for (int v = 0; v < rows; ++v) // setTo would allocate
    std::fill(steps_[v], steps_[v] + cols, static_cast<unsigned char>(0));
  const int stride = static_cast<int>(w.step1());

  // The gap from p to q, both measured, of a line; mark(i, flags) sets them. `wide(i)`
  // tells whether the unmeasured pixel i lies in a void across the line, too: a shadow
  // is narrow in one direction, however long it is in the other.
  const auto settle =
      [&](const Line& line, int p, int q, const auto& mark, const auto& wide) {
        if (q - p > max_gap) {
          const bool ends_p = wide(p + deep), ends_q = wide(q - deep);
          if (ends_p)
            mark(p, step_near);
          if (ends_q)
            mark(q, step_near);
          if (ends_p || ends_q)
            return;
        }
        const float sigma = noise(std::max(line[p], line[q]));
        if (judge(line, p, q, sigma, sigmas) == Gap::step) {
          const bool first_is_near = line[p] > line[q];
          mark(first_is_near ? p : q, step_near);
          mark(first_is_near ? q : p, step_far);
        }
      };

  // rows, and candidates of columns in one pass; most pixels are no candidates
  candidates_.resize(static_cast<std::size_t>(cols) + 8);
  // a local pointer: bytes may alias the vector itself, which would cost the loops
  unsigned char* candidates = candidates_.data();
  const auto scan = [&](const auto& visit) {
    for (int i = 0; i < cols;) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, candidates + i, 8);
      if (eight == 0) {
        i += 8;
        continue;
      }
      for (const int end = std::min(cols, i + 8); i < end; ++i)
        if (candidates[i] != 0)
          visit(i);
    }
  };
  for (int v = 0; v < rows; ++v) {
    const float* row = w[v];
    const Line line{row, 1, cols};
    std::fill(candidates + cols - 1, candidates + cols + 8, 0);
    for (int u = 0; u + 1 < cols; ++u) {
      candidates[u] = isCandidate(row[u], row[u + 1]);
    }
    const auto mark = [&](int u, StepSide side) { steps_(v, u) |= side; };
    const auto wide = [&](int u) {
      return isLonger({w[0] + u, stride, rows}, v, max_gap);
    };
    int last = row[0] > 0 ? 0 : -1; // last measured pixel before a gap
    scan([&](int u) {
      if (row[u] > 0)
        last = u;
      if (row[u + 1] <= 0)
        return;
      if (last >= 0)
        settle(line, last, u + 1, mark, wide);
      else if (u + 1 > max_gap && wide(u + 1 - deep))
        mark(u + 1, step_near);
    });
    if (row[cols - 1] <= 0 && last >= 0 && cols - 1 - last > max_gap &&
        wide(last + deep))
      mark(last, step_near);
  }
  last_.assign(static_cast<std::size_t>(cols), -1);
  for (int u = 0; u < cols; ++u)
    if (w(0, u) > 0)
      last_[u] = 0;
  for (int v = 0; v + 1 < rows; ++v) {
    const float* row = w[v];
    const float* next = w[v + 1];
    std::fill(candidates + cols, candidates + cols + 8, 0);
    for (int u = 0; u < cols; ++u) {
      candidates[u] = isCandidate(row[u], next[u]);
    }
    scan([&](int u) {
      if (row[u] > 0)
        last_[u] = v;
      if (next[u] <= 0)
        return;
      const auto mark = [&](int i, StepSide side) { steps_(i, u) |= side; };
      const auto wide = [&](int i) { return isLonger({w[i], 1, cols}, u, max_gap); };
      if (last_[u] >= 0)
        settle({w[0] + u, stride, rows}, last_[u], v + 1, mark, wide);
      else if (v + 1 > max_gap && wide(v + 1 - deep))
        mark(v + 1, step_near);
    });
  }
  for (int u = 0; u < cols; ++u)
    if (w(rows - 1, u) <= 0 && last_[u] >= 0 && rows - 1 - last_[u] > max_gap &&
        isLonger({w[last_[u] + deep], 1, cols}, u, max_gap))
      steps_(last_[u], u) |= step_near;
}

} // namespace hoist
