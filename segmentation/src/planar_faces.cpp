#include <hoist/segmentation/planar_faces.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hoist {
namespace {

constexpr int cell_size = 4; // [px]
constexpr int min_cell_pixels = cell_size * cell_size / 2;
constexpr float table_max = 10.0f; // largest tabulated inverse depth: z = 0.1 m
constexpr int table_size = 4096;

} // namespace

double
footprint(const PlanarFace& face, const Eigen::Vector3d& d, const Intrinsics& camera)
{
  // x = ray / w with w = a u + b v + c; dx/du = (ex / fx) / w - ray a / w^2
  const Eigen::Vector3d ray = face.centroid / face.centroid.z();
  const double z = face.centroid.z();
  const double along = d.dot(ray) * z * z;
  const double du = d.x() / camera.fx * z - along * face.inverse_depth[0];
  const double dv = d.y() / camera.fy * z - along * face.inverse_depth[1];
  return std::hypot(du, dv);
}

PlanarFaceFinder::Moments&
PlanarFaceFinder::Moments::operator+=(const Moments& o)
{
  n += o.n;
  u += o.u;
  v += o.v;
  uu += o.uu;
  uv += o.uv;
  vv += o.vv;
  w += o.w;
  uw += o.uw;
  vw += o.vw;
  ww += o.ww;
  return *this;
}

bool
PlanarFaceFinder::Moments::fit(Eigen::Vector3d& plane) const
{
  if (n < 3)
    return false;
  // centred normal equations: a 2 x 2 system
  const double mu = u / n, mv = v / n, mw = w / n;
  const double cuu = uu - n * mu * mu, cuv = uv - n * mu * mv, cvv = vv - n * mv * mv;
  const double cuw = uw - n * mu * mw, cvw = vw - n * mv * mw;
  const double det = cuu * cvv - cuv * cuv;
  if (det <= 1e-6 * n * n)
    return false;
  plane[0] = (cvv * cuw - cuv * cvw) / det;
  plane[1] = (cuu * cvw - cuv * cuw) / det;
  plane[2] = mw - plane[0] * mu - plane[1] * mv;
  return true;
}

void
PlanarFaceFinder::Moments::residual(const Eigen::Vector3d& p,
                                    double& mean,
                                    double& square) const
{
  const double a = p[0], b = p[1], c = p[2];
  const double predicted = a * u + b * v + c * n;
  mean = (w - predicted) / n;
  const double cross = a * uw + b * vw + c * w;
  const double model =
      a * a * uu + b * b * vv + c * c * n + 2 * (a * b * uv + a * c * u + b * c * v);
  square = std::max(0.0, (ww - 2 * cross + model) / n);
}

double
PlanarFaceFinder::sigma(double inverse_depth) const
{
  const int i = static_cast<int>(inverse_depth * (table_size / table_max));
  return sigma_table_[std::min(std::max(i, 0), table_size - 1)];
}

void
PlanarFaceFinder::sumCells(const cv::Mat1f& image, const cv::Mat1b& mask)
{
  columns_ = image.cols / cell_size;
  rows_ = image.rows / cell_size;
  cells_.assign(static_cast<std::size_t>(columns_) * rows_, Moments{});
  for (int v = 0; v < rows_ * cell_size; ++v) {
    const float* w = image[v];
    const unsigned char* use = mask.empty() ? nullptr : mask[v];
    Moments* row = &cells_[static_cast<std::size_t>(v / cell_size) * columns_];
    for (int c = 0; c < columns_; ++c) {
      // sums relative to the cell's first column, shifted afterwards
      double n = 0, u = 0, uu = 0, sw = 0, uw = 0, ww = 0;
      const int first = c * cell_size;
      for (int k = 0; k < cell_size; ++k) {
        const float x = w[first + k];
        if (x > 0 && (use == nullptr || use[first + k] != 0)) {
          n += 1;
          u += k;
          uu += k * k;
          sw += x;
          uw += k * static_cast<double>(x);
          ww += static_cast<double>(x) * x;
        }
      }
      Moments& m = row[c];
      const double f = first;
      const double su = u + n * f;
      m.n += n;
      m.u += su;
      m.v += n * v;
      m.uu += uu + 2 * f * u + n * f * f;
      m.uv += su * v;
      m.vv += n * v * v;
      m.w += sw;
      m.uw += uw + f * sw;
      m.vw += sw * v;
      m.ww += ww;
    }
  }
}

void
PlanarFaceFinder::estimateNoise()
{
  constexpr int window = 4; // cells
  constexpr double floor = 0.05, ceiling = 1.0, waves = 2.0;
  qualities_.clear();
  Eigen::Vector3d plane;
  for (int r = 0; r + window <= rows_; r += window)
    for (int c = 0; c + window <= columns_; c += window) {
      Moments sum;
      for (int y = r; y < r + window; ++y)
        for (int x = c; x < c + window; ++x)
          sum += cells_[y * columns_ + x];
      if (sum.n < window * window * min_cell_pixels || !sum.fit(plane))
        continue;
      double mean = 0, square = 0;
      sum.residual(plane, mean, square);
      qualities_.push_back(
          static_cast<float>(std::sqrt(square) / sigma(sum.w / sum.n)));
    }
  noise_scale_ = ceiling;
  if (qualities_.empty())
    return;
  const auto quartile =
      qualities_.begin() + static_cast<std::ptrdiff_t>(qualities_.size() / 4);
  std::nth_element(qualities_.begin(), quartile, qualities_.end());
  noise_scale_ = std::min(ceiling, std::max(floor, waves * *quartile));
  for (float& s : sigma_table_)
    s *= static_cast<float>(noise_scale_);
}

void
PlanarFaceFinder::collectSeeds(int window_width, int window_height)
{
  seeds_.clear();
  Eigen::Vector3d plane;
  for (int r = 0; r + window_height <= rows_; ++r)
    for (int c = 0; c + window_width <= columns_; ++c) {
      Moments sum;
      bool free = true;
      for (int y = r; y < r + window_height && free; ++y)
        for (int x = c; x < c + window_width && free; ++x) {
          const int cell = y * columns_ + x;
          free = owner_[cell] == 0 && cells_[cell].n >= min_cell_pixels;
          if (free)
            sum += cells_[cell];
        }
      if (!free || !sum.fit(plane))
        continue;
      double mean = 0, square = 0;
      sum.residual(plane, mean, square);
      const double quality = std::sqrt(square) / sigma(sum.w / sum.n);
      constexpr double max_seed_rms = 1.6; // [sigma]
      if (quality < max_seed_rms)
        seeds_.push_back({static_cast<float>(quality), r * columns_ + c});
    }
  std::sort(seeds_.begin(), seeds_.end(), [](const Seed& a, const Seed& b) {
    return a.quality < b.quality || (a.quality == b.quality && a.cell < b.cell);
  });
}

bool
PlanarFaceFinder::growFrom(const Seed& seed, int window_width, int window_height)
{
  Moments sum;
  for (int y = 0; y < window_height; ++y)
    for (int x = 0; x < window_width; ++x) {
      const int cell = seed.cell + y * columns_ + x;
      if (owner_[cell] != 0)
        return false;
      sum += cells_[cell];
    }
  Eigen::Vector3d plane;
  if (!sum.fit(plane))
    return false;
  const short region = static_cast<short>(planes_.size() + 1);
  std::vector<int>& members = next_;

  // Grow with the seed's plane, fit, and grow again from scratch until it settles: the
  // first plane of a small window is too rough to reach the ends of a large face.
  constexpr int rounds = 4;
  std::size_t last = 0;
  for (int round = 0; round < rounds; ++round) {
    members.clear();
    queue_.clear();
    Moments grown;
    const auto visit = [&](int cell) {
      if (owner_[cell] != 0 || cells_[cell].n < min_cell_pixels)
        return;
      double mean = 0, square = 0;
      const Moments& m = cells_[cell];
      m.residual(plane, mean, square);
      const double s = sigma(m.w / m.n);
      if (std::abs(mean) > parameters_.mean_tolerance * s ||
          square > parameters_.rms_tolerance * parameters_.rms_tolerance * s * s)
        return;
      owner_[cell] = region;
      members.push_back(cell);
      queue_.push_back(cell);
      grown += m;
    };
    for (int y = 0; y < window_height; ++y)
      for (int x = 0; x < window_width; ++x)
        visit(seed.cell + y * columns_ + x);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const int cell = queue_[i], c = cell % columns_, r = cell / columns_;
      if (c > 0)
        visit(cell - 1);
      if (c + 1 < columns_)
        visit(cell + 1);
      if (r > 0)
        visit(cell - columns_);
      if (r + 1 < rows_)
        visit(cell + columns_);
    }
    sum = grown;
    const bool settled = members.size() <= last || round + 1 == rounds;
    const bool fits = sum.n >= parameters_.min_pixels / 2.0 && sum.fit(plane);
    if (!fits || !settled)
      for (const int cell : members)
        owner_[cell] = 0;
    if (!fits)
      return false;
    if (settled)
      break;
    last = members.size();
  }
  planes_.push_back(plane);
  sums_.push_back(sum);
  return true;
}

void
PlanarFaceFinder::mergeCoplanar()
{
  const auto n = static_cast<int>(planes_.size());
  std::vector<short> parent(n + 1);
  std::iota(parent.begin(), parent.end(), short{0});
  const auto root = [&](short r) {
    while (parent[r] != r)
      r = parent[r];
    return r;
  };
  const auto tryMerge = [&](int cell, int other) {
    if (owner_[cell] == 0 || owner_[other] == 0)
      return;
    const short a = root(owner_[cell]), b = root(owner_[other]);
    if (a == b)
      return;
    // each piece must lie on the common plane
    Moments sum = sums_[a - 1];
    sum += sums_[b - 1];
    Eigen::Vector3d plane;
    if (!sum.fit(plane))
      return;
    for (const short r : {a, b}) {
      const Moments& m = sums_[r - 1];
      double mean = 0, square = 0, own_mean = 0, own_square = 0;
      m.residual(plane, mean, square);
      m.residual(planes_[r - 1], own_mean, own_square);
      const double s = sigma(m.w / m.n);
      constexpr double max_growth = 1.0; // added variance [sigma^2]
      if (std::abs(mean) > 1.2 * s || square - own_square > max_growth * s * s)
        return;
    }
    const short keep = std::min(a, b), drop = std::max(a, b);
    parent[drop] = keep;
    sums_[keep - 1] = sum;
    planes_[keep - 1] = plane;
  };
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c) {
      const int cell = r * columns_ + c;
      if (c + 1 < columns_)
        tryMerge(cell, cell + 1);
      if (r + 1 < rows_)
        tryMerge(cell, cell + columns_);
    }
  for (short& o : owner_)
    if (o != 0)
      o = root(o);
}

void
PlanarFaceFinder::labelPixels(const cv::Mat1f& image,
                              const cv::Mat1b& mask,
                              cv::Mat1s& labels)
{
  const int width = image.cols, height = image.rows;
  labels.create(height, width);
  labels.setTo(0);
  const auto residual = [&](short label, int u, int v, float w) {
    const Eigen::Vector3d& p = planes_[label - 1];
    return std::abs(w - (p[0] * u + p[1] * v + p[2]));
  };
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c) {
      const short label = owner_[r * columns_ + c];
      if (label == 0)
        continue;
      for (int v = r * cell_size; v < (r + 1) * cell_size; ++v)
        for (int u = c * cell_size; u < (c + 1) * cell_size; ++u) {
          const float w = image(v, u);
          if (w > 0 && (mask.empty() || mask(v, u) != 0) &&
              residual(label, u, v, w) < parameters_.pixel_tolerance * sigma(w))
            labels(v, u) = label;
        }
    }

  // Layer by layer outwards into pixels that no cell claimed.
  queue_.clear();
  const auto push = [&](int u, int v) {
    if (u >= 0 && v >= 0 && u < width && v < height && labels(v, u) == 0 &&
        image(v, u) > 0 && (mask.empty() || mask(v, u) != 0))
      queue_.push_back(v * width + u);
  };
  const auto pushNeighbours = [&](int u, int v) {
    push(u - 1, v);
    push(u + 1, v);
    push(u, v - 1);
    push(u, v + 1);
  };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      if (labels(v, u) == 0 && image(v, u) > 0 &&
          ((u > 0 && labels(v, u - 1) != 0) ||
           (u + 1 < width && labels(v, u + 1) != 0) ||
           (v > 0 && labels(v - 1, u) != 0) ||
           (v + 1 < height && labels(v + 1, u) != 0)))
        push(u, v);
  constexpr int layers = 2 * cell_size;
  for (int layer = 0; layer < layers && !queue_.empty(); ++layer) {
    next_.clear();
    for (const int index : queue_) {
      const int u = index % width, v = index / width;
      if (labels(v, u) != 0)
        continue;
      const float w = image(v, u);
      const double limit = parameters_.pixel_tolerance * sigma(w);
      short best = 0;
      double best_residual = limit;
      const auto consider = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= width || y >= height || labels(y, x) == 0)
          return;
        const double d = residual(labels(y, x), u, v, w);
        if (d < best_residual) {
          best_residual = d;
          best = labels(y, x);
        }
      };
      consider(u - 1, v);
      consider(u + 1, v);
      consider(u, v - 1);
      consider(u, v + 1);
      if (best != 0) {
        labels(v, u) = best;
        next_.push_back(index);
      }
    }
    queue_.clear();
    for (const int index : next_)
      pushNeighbours(index % width, index / width);
  }

  // Where two faces meet, each pixel goes to the plane it fits best: the border moves
  // to the line where the planes intersect. A few sweeps reach as far as a cell.
  const auto settle = [&](int u, int v) {
    short* row = labels[v];
    const short own = row[u];
    const short up = labels(v - 1, u), down = labels(v + 1, u);
    if (own == 0 ||
        (row[u - 1] == own && row[u + 1] == own && up == own && down == own))
      return;
    const float w = image(v, u);
    short best = own;
    double best_residual = residual(own, u, v, w);
    for (const short other : {row[u - 1], row[u + 1], up, down})
      if (other != 0 && other != best) {
        const double d = residual(other, u, v, w);
        if (d < best_residual) {
          best_residual = d;
          best = other;
        }
      }
    if (best != own) {
      row[u] = best;
      next_.push_back(v * width + u);
    }
  };
  next_.clear();
  for (int v = 1; v + 1 < height; ++v)
    for (int u = 1; u + 1 < width; ++u)
      settle(u, v);
  for (int sweep = 1; sweep < cell_size; ++sweep) {
    queue_.swap(next_);
    next_.clear();
    for (const int index : queue_) {
      const int u = index % width, v = index / width;
      if (u > 1)
        settle(u - 1, v);
      if (u + 2 < width)
        settle(u + 1, v);
      if (v > 1)
        settle(u, v - 1);
      if (v + 2 < height)
        settle(u, v + 1);
    }
  }
}

void
PlanarFaceFinder::addSlivers(const cv::Mat1f& image,
                             const cv::Mat1b& mask,
                             cv::Mat1s& labels)
{
  constexpr short seen = -1; // visited, belongs to no face
  const int width = image.cols, height = image.rows;
  const auto open = [&](int u, int v) {
    return labels(v, u) == 0 && image(v, u) > 0 && (mask.empty() || mask(v, u) != 0);
  };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if (!open(u, v))
        continue;
      // a connected piece without a break in depth
      queue_.clear();
      queue_.push_back(v * width + u);
      labels(v, u) = seen;
      Moments sum;
      for (std::size_t i = 0; i < queue_.size(); ++i) {
        const int x = queue_[i] % width, y = queue_[i] / width;
        const double w = image(y, x);
        Moments m;
        m.n = 1;
        m.u = x;
        m.v = y;
        m.uu = static_cast<double>(x) * x;
        m.uv = static_cast<double>(x) * y;
        m.vv = static_cast<double>(y) * y;
        m.w = w;
        m.uw = x * w;
        m.vw = y * w;
        m.ww = w * w;
        sum += m;
        const auto visit = [&](int x2, int y2) {
          constexpr double max_step = 0.02; // of the inverse depth
          if (x2 < 0 || y2 < 0 || x2 >= width || y2 >= height || !open(x2, y2) ||
              std::abs(image(y2, x2) - w) > max_step * w)
            return;
          labels(y2, x2) = seen;
          queue_.push_back(y2 * width + x2);
        };
        visit(x - 1, y);
        visit(x + 1, y);
        visit(x, y - 1);
        visit(x, y + 1);
      }
      Eigen::Vector3d plane;
      if (sum.n < parameters_.min_pixels || !sum.fit(plane))
        continue;
      double mean = 0, square = 0;
      sum.residual(plane, mean, square);
      // depth taken half a pixel beside shifts by half a pixel's slope
      const double slope = 0.5 * std::hypot(plane[0], plane[1]);
      const double limit = std::hypot(1.2 * sigma(sum.w / sum.n), slope);
      if (square > limit * limit ||
          planes_.size() + 1 >= std::numeric_limits<short>::max())
        continue;
      planes_.push_back(plane);
      sums_.push_back(sum);
      for (const int index : queue_)
        labels(index / width, index % width) = static_cast<short>(planes_.size());
    }
  for (int v = 0; v < height; ++v) {
    short* row = labels[v];
    for (int u = 0; u < width; ++u)
      row[u] = std::max(row[u], short{0});
  }
}

void
PlanarFaceFinder::describe(const cv::Mat1f& image,
                           const Intrinsics& camera,
                           cv::Mat1s& labels,
                           std::vector<PlanarFace>& faces)
{
  const std::size_t n = planes_.size();
  std::vector<Moments> sums(n);
  std::vector<cv::Rect> boxes(n);
  std::vector<std::array<int, 4>> bounds(
      n, {std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), -1, -1});
  // Run by run: within a run the sums over u and v are known in closed form.
  for (int v = 0; v < image.rows; ++v) {
    const short* row = labels[v];
    const float* depth = image[v];
    for (int u = 0; u < image.cols;) {
      const short label = row[u];
      const int first = u;
      double sw = 0, uw = 0, ww = 0;
      if (label == 0) {
        while (u < image.cols && row[u] == 0)
          ++u;
        continue;
      }
      for (; u < image.cols && row[u] == label; ++u) {
        const double w = depth[u];
        sw += w;
        uw += (u - first) * w;
        ww += w * w;
      }
      const double k = u - first;
      const double su = k * first + k * (k - 1) / 2;
      Moments& m = sums[label - 1];
      m.n += k;
      m.u += su;
      m.v += k * v;
      m.uu += k * first * first + first * k * (k - 1) + (k - 1) * k * (2 * k - 1) / 6;
      m.uv += su * v;
      m.vv += k * v * v;
      m.w += sw;
      m.uw += uw + first * sw;
      m.vw += sw * v;
      m.ww += ww;
      auto& b = bounds[label - 1];
      b = {std::min(b[0], first),
           std::min(b[1], v),
           std::max(b[2], u - 1),
           std::max(b[3], v)};
    }
  }

  std::vector<short> number(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Moments& m = sums[i];
    PlanarFace face;
    if (m.n < parameters_.min_pixels || !m.fit(face.inverse_depth))
      continue;
    const Eigen::Vector3d& p = face.inverse_depth;
    // 1/z = a u + b v + c with u = fx x/z + cx, v = fy y/z + cy gives
    // (a fx) x + (b fy) y + (a cx + b cy + c) z = 1
    const Eigen::Vector3d g(
        p[0] * camera.fx, p[1] * camera.fy, p[0] * camera.cx + p[1] * camera.cy + p[2]);
    const double norm = g.norm();
    if (norm < 1e-9)
      continue;
    face.normal = -g / norm; // g . x = 1 > 0 on the plane, so -g looks at the camera
    face.offset = 1 / norm;
    const double mu = m.u / m.n, mv = m.v / m.n;
    const double w = p[0] * mu + p[1] * mv + p[2];
    face.centroid = camera.ray(mu, mv) / w;
    face.pixels = static_cast<int>(m.n);
    double mean = 0, square = 0;
    m.residual(p, mean, square);
    const double s = sigma(m.w / m.n);
    face.rms = std::sqrt(square) / s;
    Eigen::Matrix2d spread;
    spread << m.uu - m.n * mu * mu, m.uv - m.n * mu * mv, m.uv - m.n * mu * mv,
        m.vv - m.n * mv * mv;
    const double weakest =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()[0];
    // neighbouring depths are correlated: the notes' factor 50 on the variance
    constexpr double correlation = 50;
    const double slope = s * std::sqrt(correlation / std::max(weakest, 1e-9));
    face.normal_sigma = slope * std::max(camera.fx, camera.fy) / norm;
    const auto& b = bounds[i];
    face.box = cv::Rect(b[0], b[1], b[2] - b[0] + 1, b[3] - b[1] + 1);
    faces.push_back(face);
    number[i + 1] = static_cast<short>(faces.size());
  }
  for (int v = 0; v < labels.rows; ++v)
    for (int u = 0; u < labels.cols; ++u)
      labels(v, u) = number[labels(v, u)];
}

void
PlanarFaceFinder::find(const cv::Mat1f& inverse_depth,
                       const cv::Mat1b& mask,
                       const Intrinsics& camera,
                       const PlanarFaceParameters& parameters,
                       cv::Mat1s& labels,
                       std::vector<PlanarFace>& faces)
{
  parameters_ = parameters;
  faces.clear();
  planes_.clear();
  sums_.clear();
  sigma_table_.resize(table_size);
  for (int i = 0; i < table_size; ++i) {
    const double w = (i + 0.5) * table_max / table_size;
    // sigma of 1/z is sigma of z times its derivative
    sigma_table_[i] = static_cast<float>(parameters.sensor.sigmaZ(1 / w) * w * w);
  }
  sumCells(inverse_depth, mask);
  estimateNoise();
  owner_.assign(cells_.size(), 0);
  constexpr int windows[][2] = {{4, 4}, {2, 2}, {4, 1}, {1, 4}};
  for (const auto& window : windows) {
    collectSeeds(window[0], window[1]);
    for (const Seed& seed : seeds_) {
      if (planes_.size() + 1 >= std::numeric_limits<short>::max())
        break;
      growFrom(seed, window[0], window[1]);
    }
  }
  mergeCoplanar();
  labelPixels(inverse_depth, mask, labels);
  addSlivers(inverse_depth, mask, labels);
  describe(inverse_depth, camera, labels, faces);
}

} // namespace hoist
