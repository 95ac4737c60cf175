#include <hoist/filters/texture_remover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace hoist {
namespace {

constexpr unsigned char unvisited = 255;
constexpr unsigned char visited = 254;

// Calls f(i) for every non-zero byte, eight at a time over the empty ones.
template <typename Function>
void
forEachNonZero(const unsigned char* data, int total, Function f)
{
  int i = 0;
  for (; i + 8 <= total; i += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, data + i, 8);
    if (eight == 0)
      continue;
    for (int k = i; k < i + 8; ++k)
      if (data[k] != 0)
        f(k);
  }
  for (; i < total; ++i)
    if (data[i] != 0)
      f(i);
}

} // namespace

void
TextureRemover::remove(const cv::Mat1s& dx,
                       const cv::Mat1s& dy,
                       const TextureParameters& parameters,
                       cv::Mat1b& edges)
{
  CV_Assert(edges.isContinuous() && dx.isContinuous() && dy.isContinuous());
  CV_Assert(dx.size() == edges.size() && dy.size() == edges.size());
  growRuns(dx, dy, edges);
  joinRuns(edges);
  clearClutter(parameters, edges);
}

void
TextureRemover::growRuns(const cv::Mat1s& dx_image,
                         const cv::Mat1s& dy_image,
                         cv::Mat1b& edges)
{
  constexpr float cos2 = 0.853553F; // cos^2 of 22.5 degrees
  const int step = edges.cols;
  const std::array<int, 8> around = {
      -step - 1, -step, -step + 1, -1, 1, step - 1, step, step + 1};
  unsigned char* state = edges[0];
  const short* dx = dx_image[0];
  const short* dy = dy_image[0];
  run_of_pixel_.create(edges.size());
  int* run_of_pixel = run_of_pixel_[0];

  pixels_.clear();
  runs_.clear();
  forEachNonZero(state, step * edges.rows, [&](int seed) {
    if (state[seed] != unvisited)
      return;
    Run run;
    run.begin = static_cast<int>(pixels_.size());
    run.chain = static_cast<int>(runs_.size());
    pixels_.push_back(seed);
    state[seed] = visited;
    run_of_pixel[seed] = run.chain;
    float gx = dx[seed], gy = dy[seed];
    // the border is clear, so that no neighbour lies outside
    for (std::size_t next = run.begin; next < pixels_.size(); ++next)
      for (const int offset : around) {
        const int i = pixels_[next] + offset;
        if (state[i] != unvisited)
          continue;
        const float x = dx[i], y = dy[i];
        const float dot = x * gx + y * gy;
        if (dot <= 0 || dot * dot < cos2 * (x * x + y * y) * (gx * gx + gy * gy))
          continue;
        state[i] = visited;
        run_of_pixel[i] = run.chain;
        pixels_.push_back(i);
        gx += x;
        gy += y;
      }
    run.end = static_cast<int>(pixels_.size());
    measure(run, step, gx, gy);
    runs_.push_back(run);
  });
}

void
TextureRemover::measure(Run& run, int columns, float gx, float gy) const
{
  const float norm = std::max(1.0F, std::hypot(gx, gy));
  run.tu = -gy / norm;
  run.tv = gx / norm;
  long sum_u = 0, sum_v = 0;
  for (int k = run.begin; k < run.end; ++k) {
    sum_u += pixels_[k] % columns;
    sum_v += pixels_[k] / columns;
  }
  const float size = static_cast<float>(run.end - run.begin);
  run.u = static_cast<float>(sum_u) / size;
  run.v = static_cast<float>(sum_v) / size;
  for (int k = run.begin; k < run.end; ++k) {
    const int column = pixels_[k] % columns, row = pixels_[k] / columns;
    const float t = run.tu * (static_cast<float>(column) - run.u) +
                    run.tv * (static_cast<float>(row) - run.v);
    run.least = std::min(run.least, t);
    run.most = std::max(run.most, t);
  }
}

int
TextureRemover::root(int run)
{
  while (runs_[run].chain != run)
    run = runs_[run].chain = runs_[runs_[run].chain].chain;
  return run;
}

void
TextureRemover::joinRuns(const cv::Mat1b& edges)
{
  constexpr float min_length = 5;    // [px]; shorter runs have no direction to follow
  constexpr int reach = 5;           // [px]; gap that is bridged
  constexpr float min_cos = 0.95F;   // 18 degrees between two runs
  constexpr float max_offset = 1.5F; // [px]; sideways shift at the joint

  chain_length_.resize(runs_.size());
  for (std::size_t i = 0; i < runs_.size(); ++i)
    chain_length_[i] = runs_[i].length();
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    if (run.length() < min_length)
      continue;
    for (const float sign : {-1.0F, 1.0F}) {
      const float end = sign > 0 ? run.most : run.least;
      const float end_u = run.u + end * run.tu, end_v = run.v + end * run.tv;
      bool found = false;
      for (int ahead = 1; ahead <= reach && !found; ++ahead)
        for (int side = -1; side <= 1 && !found; ++side) {
          const int u = cvRound(end_u + sign * ahead * run.tu - side * run.tv);
          const int v = cvRound(end_v + sign * ahead * run.tv + side * run.tu);
          if (u < 0 || v < 0 || u >= edges.cols || v >= edges.rows || edges(v, u) == 0)
            continue;
          const int j = run_of_pixel_(v, u);
          const Run& other = runs_[j];
          if (j == static_cast<int>(i) || other.length() < min_length ||
              run.tu * other.tu + run.tv * other.tv < min_cos)
            continue;
          // the other run must pass the end of this one, and go on from there
          const float du = end_u - other.u, dv = end_v - other.v;
          if (std::abs(du * other.tv - dv * other.tu) > max_offset ||
              sign * (run.tu * -du + run.tv * -dv) <= 0)
            continue;
          const int a = root(static_cast<int>(i)), b = root(j);
          if (a != b) {
            runs_[std::max(a, b)].chain = std::min(a, b);
            chain_length_[std::min(a, b)] += chain_length_[std::max(a, b)];
          }
          found = true;
        }
    }
  }
}

void
TextureRemover::clearClutter(const TextureParameters& parameters, cv::Mat1b& edges)
{
  constexpr int cells_per_window = 4;
  const int step = edges.cols;
  const int side = std::max(1, cvRound(parameters.window / double(cells_per_window)));
  const int columns = (edges.cols + side - 1) / side;
  const int rows = (edges.rows + side - 1) / side;
  const auto cell = [&](int pixel) {
    return pixel / step / side * columns + pixel % step / side;
  };

  unsigned char* state = edges[0];
  cells_.assign(static_cast<std::size_t>(columns) * rows, 0);
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const bool clutter =
        chain_length_[root(static_cast<int>(i))] < parameters.straight_length;
    for (int k = runs_[i].begin; k < runs_[i].end; ++k) {
      state[pixels_[k]] = clutter ? visited : 255;
      if (clutter)
        ++cells_[cell(pixels_[k])];
    }
  }

  // windows of 4 x 4 cells, by their first cell; then the cells of dense windows
  const double least =
      parameters.density * side * side * cells_per_window * cells_per_window;
  sums_.assign(cells_.size(), 0);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u)
      for (int k = u; k < std::min(columns, u + cells_per_window); ++k)
        sums_[v * columns + u] += cells_[v * columns + k];
  textured_.assign(cells_.size(), 0);
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u) {
      const int last_v = std::min(rows, v + cells_per_window);
      const int last_u = std::min(columns, u + cells_per_window);
      int sum = 0;
      for (int k = v; k < last_v; ++k)
        sum += sums_[k * columns + u];
      if (sum < least)
        continue;
      for (int k = v; k < last_v; ++k)
        std::fill(textured_.begin() + k * columns + u,
                  textured_.begin() + k * columns + last_u,
                  static_cast<unsigned char>(1));
    }
  for (const int pixel : pixels_)
    if (state[pixel] == visited)
      state[pixel] = textured_[cell(pixel)] != 0 ? 0 : 255;
}

} // namespace hoist
