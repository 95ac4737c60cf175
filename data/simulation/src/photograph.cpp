#include "shading.h"

#include <hoist/simulation/random.h>
#include <hoist/simulation/render.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int sky_step = 5; // the open share of the sky changes slowly [px]

class Photographer {
public:
  Photographer(const RayCaster& caster,
               const Scene& scene,
               const Lens& lens,
               const PixelHits& seen,
               const Eigen::Isometry3d& pose)
  : caster_(caster), scene_(scene), lens_(lens), seen_(seen), pose_(pose)
  {
    pixel_angle_ = (lens.ray(size_.width / 2.0 + 1, size_.height / 2.0) -
                    lens.ray(size_.width / 2.0, size_.height / 2.0))
                       .norm();
  }

  /** \brief Scene light at every pixel, linear, BGR. */
  cv::Mat3f
  take()
  {
    castSky();
    cv::Mat3f picture(size_);
    for (int v = 0; v < size_.height; ++v)
      for (int u = 0; u < size_.width; u += 4) {
        const int count = std::min(4, size_.width - u);
        Sample samples[4];
        for (int i = 0; i < count; ++i)
          samples[i] = {double(u + i), double(v), &seen_(u + i, v), u + i, v};
        Vector3f lights[4];
        lightsAt(samples, count, lights);
        for (int i = 0; i < count; ++i) {
          if (onSilhouette(u + i, v))
            lights[i] = smoothed(u + i, v, lights[i]);
          picture(v, u + i) = {lights[i].z(), lights[i].y(), lights[i].x()};
        }
      }
    return picture;
  }

private:
  static constexpr double offsets[4][2] = {{-0.375, -0.125},
                                           {0.125, -0.375},
                                           {0.375, 0.125},
                                           {-0.125, 0.375}};

  Vector3d
  direction(double u, double v) const
  {
    return pose_.linear() * lens_.ray(u, v);
  }

  // A place in the picture, what a ray through it met, and the pixel it belongs to.
  struct Sample {
    double x, y;
    const Hit* hit;
    int u, v;
  };

  // Four rays more, so that silhouettes are no stairs.
  Vector3f
  smoothed(int u, int v, const Vector3f& middle)
  {
    Vector3d directions[4];
    for (int i = 0; i < 4; ++i)
      directions[i] = direction(u + offsets[i][0], v + offsets[i][1]);
    Hit hits[4];
    caster_.cast4(pose_.translation(), directions, hits);
    Sample samples[4];
    for (int i = 0; i < 4; ++i)
      samples[i] = {u + offsets[i][0], v + offsets[i][1], &hits[i], u, v};
    Vector3f lights[4];
    lightsAt(samples, 4, lights);
    return (middle + lights[0] + lights[1] + lights[2] + lights[3]) / 5;
  }

  // What is known of the sky at one pixel of many.
  struct Cell {
    Vector3f normal = Vector3f::Zero();
    float distance = -1; ///< -1 where nothing is seen
    float open = 1;
  };

  // 1 for the same surface, next to nothing for another.
  static float
  alike(const Cell& cell, const Vector3f& normal, float distance)
  {
    const float apart = (cell.distance - distance) / distance;
    const float turn = 1 - cell.normal.dot(normal);
    return 1 / (1 + 400 * apart * apart + 20 * turn);
  }

  void
  castSky()
  {
    sky_size_ = cv::Size(size_.width / sky_step + 2, size_.height / sky_step + 2);
    std::vector<Cell> rough(static_cast<std::size_t>(sky_size_.area()));
    for (int j = 0; j < sky_size_.height; ++j)
      for (int i = 0; i < sky_size_.width; ++i) {
        const int u = skyPixel(i, size_.width), v = skyPixel(j, size_.height);
        const Hit& hit = seen_(u, v);
        Cell& cell = rough[static_cast<std::size_t>(j) * sky_size_.width + i];
        if (hit.thing < 0)
          continue;
        cell.normal = hit.normal.cast<float>();
        cell.distance = static_cast<float>(hit.distance);
        cell.open = openSky(
            caster_,
            placeOf(caster_, pose_.translation(), direction(u, v), hit, pixel_angle_),
            2.5,
            static_cast<std::uint64_t>(j) * 8192 + static_cast<std::uint64_t>(i));
      }
    // eight rays are few: neighbours on the same surface share theirs
    cells_ = rough;
    for (int j = 0; j < sky_size_.height; ++j)
      for (int i = 0; i < sky_size_.width; ++i) {
        Cell& cell = cells_[static_cast<std::size_t>(j) * sky_size_.width + i];
        if (cell.distance > 0)
          cell.open =
              meanOpen(rough, i - 1, i + 1, j - 1, j + 1, cell.normal, cell.distance);
      }
  }

  float
  meanOpen(const std::vector<Cell>& cells,
           int left,
           int right,
           int top,
           int bottom,
           const Vector3f& normal,
           float distance) const
  {
    float sum = 0, weights = 0;
    for (int j = std::max(0, top); j <= std::min(bottom, sky_size_.height - 1); ++j)
      for (int i = std::max(0, left); i <= std::min(right, sky_size_.width - 1); ++i) {
        const Cell& cell = cells[static_cast<std::size_t>(j) * sky_size_.width + i];
        if (cell.distance < 0)
          continue;
        const float weight = alike(cell, normal, distance);
        sum += weight * cell.open;
        weights += weight;
      }
    return weights > 0 ? sum / weights : 0.7f;
  }

  static int
  skyPixel(int cell, int extent)
  {
    return std::min(cell * sky_step, extent - 1);
  }

  // Between the four cells around, those on the same surface.
  float
  openAt(const Sample& sample) const
  {
    const int i0 = sample.u / sky_step, j0 = sample.v / sky_step;
    const float x = static_cast<float>(sample.u % sky_step) / sky_step;
    const float y = static_cast<float>(sample.v % sky_step) / sky_step;
    const Vector3f normal = sample.hit->normal.cast<float>();
    const auto distance = static_cast<float>(sample.hit->distance);
    float sum = 0, weights = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const Cell& cell =
            cells_[static_cast<std::size_t>(j0 + j) * sky_size_.width + i0 + i];
        if (cell.distance < 0)
          continue;
        const float weight =
            ((i ? x : 1 - x) * (j ? y : 1 - y) + 1e-3f) * alike(cell, normal, distance);
        sum += weight * cell.open;
        weights += weight;
      }
    return weights > 0 ? sum / weights : 0.7f;
  }

  bool
  onSilhouette(int u, int v) const
  {
    const Hit& here = seen_(u, v);
    const auto differs = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= size_.width || y >= size_.height)
        return false;
      const Hit& other = seen_(x, y);
      if (here.thing != other.thing)
        return true;
      if (here.thing < 0)
        return false;
      return here.normal.dot(other.normal) < 0.8 ||
             std::abs(here.distance - other.distance) > 0.06 * here.distance;
    };
    return differs(u + 1, v) || differs(u - 1, v) || differs(u, v + 1) ||
           differs(u, v - 1);
  }

  void
  lightsAt(const Sample* samples, int count, Vector3f* lights)
  {
    Place places[4];
    int met[4], hits = 0;
    for (int i = 0; i < count; ++i) {
      const Vector3d way = direction(samples[i].x, samples[i].y);
      if (samples[i].hit->thing < 0) {
        lights[i] = skyColor(scene_.light, way);
        continue;
      }
      places[hits] =
          placeOf(caster_, pose_.translation(), way, *samples[i].hit, pixel_angle_);
      met[hits++] = i;
    }
    if (hits == 0)
      return;
    directLight(caster_, scene_.light, places, hits, direct_);
    for (int k = 0; k < hits; ++k)
      lights[met[k]] = shadeOf(
          scene_, *samples[met[k]].hit, places[k], direct_[k], openAt(samples[met[k]]));
  }

  const RayCaster& caster_;
  const Scene& scene_;
  const Lens& lens_;
  const PixelHits& seen_;
  cv::Size size_ = seen_.size;
  Eigen::Isometry3d pose_;
  double pixel_angle_ = 0;
  cv::Size sky_size_;
  std::vector<Cell> cells_;
  std::vector<float> direct_[4];
};

// A Gaussian of three taps. OpenCV's rounds differently from processor to processor.
void
blurred(cv::Mat3f& picture, double sigma)
{
  const double tail = std::exp(-0.5 / (sigma * sigma));
  const auto side = static_cast<float>(tail / (1 + 2 * tail)), middle = 1 - 2 * side;
  cv::Mat3f rows(picture.size());
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u) {
      const cv::Vec3f &left = picture(v, std::max(u - 1, 0)),
                      &right = picture(v, std::min(u + 1, picture.cols - 1));
      for (int c = 0; c < 3; ++c)
        rows(v, u)[c] = picture(v, u)[c] * middle + (left[c] + right[c]) * side;
    }
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u) {
      const cv::Vec3f &above = rows(std::max(v - 1, 0), u),
                      &below = rows(std::min(v + 1, picture.rows - 1), u);
      for (int c = 0; c < 3; ++c)
        picture(v, u)[c] = rows(v, u)[c] * middle + (above[c] + below[c]) * side;
    }
}

// The luminance that becomes middle grey: the mean with what is very bright cut off, as
// cameras meter.
double
metered(const cv::Mat3f& picture)
{
  std::vector<float> samples;
  for (int v = 2; v < picture.rows; v += 4)
    for (int u = 2; u < picture.cols; u += 4) {
      const cv::Vec3f& p = picture(v, u);
      samples.push_back(0.0722f * p[0] + 0.7152f * p[1] + 0.2126f * p[2]);
    }
  std::vector<float> sorted = samples;
  const std::size_t high = sorted.size() * 9 / 10;
  std::nth_element(sorted.begin(), sorted.begin() + high, sorted.end());
  const float cap = sorted[high];
  double sum = 0;
  for (const float sample : samples)
    sum += std::min(sample, cap);
  return std::max(1e-4, sum / static_cast<double>(samples.size()));
}

// Mean 0, variance 1: four uniform numbers of 16 bits added up, which noise of a few
// grey levels cannot be told from normal.
double
roughNormal(std::uint64_t bits)
{
  const auto sum = static_cast<std::int64_t>((bits & 0xffff) + (bits >> 16 & 0xffff) +
                                             (bits >> 32 & 0xffff) + (bits >> 48));
  return (static_cast<double>(sum) / 65535.0 - 2.0) * 1.7320508075688772;
}

// A soft shoulder instead of a hard clip.
float
shoulder(float x)
{
  return x < 0.8f ? x : 1 - 0.04f / (x - 0.6f);
}

} // namespace

cv::Mat3b
photograph(const RayCaster& caster,
           const Scene& scene,
           const Lens& lens,
           const PixelHits& seen,
           const Eigen::Isometry3d& pose,
           const Exposure& exposure,
           double* key)
{
  const cv::Size size = seen.size;
  cv::Mat3f picture = Photographer(caster, scene, lens, seen, pose).take();
  if (exposure.blur > 0)
    blurred(picture, exposure.blur);
  const double grey = exposure.key > 0 ? exposure.key : metered(picture);
  if (key != nullptr)
    *key = grey;
  const double scale = 0.21 / grey * std::exp2(exposure.error);
  cv::Mat3b out(size);
  const double radius2 = 0.25 * (size.width * size.width + size.height * size.height);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const double dx = u - 0.5 * size.width, dy = v - 0.5 * size.height;
      const double fall =
          scale * (1 - exposure.vignetting * (dx * dx + dy * dy) / radius2);
      const std::uint64_t pixel =
          mix(exposure.seed + static_cast<std::uint64_t>(v) * 65536U +
              static_cast<std::uint64_t>(u));
      for (int c = 0; c < 3; ++c) {
        double value = picture(v, u)[c] * fall * exposure.gain[2 - c];
        if (exposure.noise > 0) {
          // shot noise of about 10000 electrons at white, and that of reading
          const double sigma =
              exposure.noise * std::sqrt(1e-4 * std::max(value, 0.0) + 4e-6);
          value += sigma * roughNormal(mix(pixel + static_cast<unsigned>(c)));
        }
        const float encoded = encodeSrgb(shoulder(static_cast<float>(value)));
        out(v, u)[c] = static_cast<unsigned char>(std::floor(encoded * 255 + 0.5f));
      }
    }
  return out;
}

} // namespace simulation
} // namespace hoist
