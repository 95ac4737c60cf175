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

// What the first ray of a pixel met.
struct Seen {
  std::vector<Hit> hits;
  cv::Size size;

  const Hit&
  operator()(int u, int v) const
  {
    return hits[static_cast<std::size_t>(v) * size.width + u];
  }
};

class Photographer {
public:
  Photographer(const RayCaster& caster,
               const Scene& scene,
               const Lens& lens,
               const cv::Size& size,
               const Eigen::Isometry3d& pose)
  : caster_(caster), scene_(scene), lens_(lens), size_(size), pose_(pose)
  {
    pixel_angle_ = (lens.ray(size.width / 2.0 + 1, size.height / 2.0) -
                    lens.ray(size.width / 2.0, size.height / 2.0))
                       .norm();
  }

  /** \brief Scene light at every pixel, linear, BGR. */
  cv::Mat3f
  take()
  {
    castPixels();
    castSky();
    cv::Mat3f picture(size_);
    for (int v = 0; v < size_.height; ++v)
      for (int u = 0; u < size_.width; ++u) {
        Vector3f light = lightAt(u, v, seen_(u, v), u, v);
        if (onSilhouette(u, v)) { // four more, so that silhouettes are no stairs
          for (const auto& offset : offsets) {
            const double x = u + offset[0], y = v + offset[1];
            const Hit hit = caster_.cast(pose_.translation(), direction(x, y));
            light += lightAt(x, y, hit, u, v);
          }
          light /= 5;
        }
        picture(v, u) = {light.z(), light.y(), light.x()};
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

  void
  castPixels()
  {
    seen_.size = size_;
    seen_.hits.resize(static_cast<std::size_t>(size_.area()));
    for (int v = 0; v < size_.height; ++v)
      for (int u = 0; u < size_.width; u += 4) {
        const int count = std::min(4, size_.width - u);
        Vector3d directions[4];
        for (int i = 0; i < 4; ++i)
          directions[i] = direction(u + std::min(i, count - 1), v);
        Hit hits[4];
        caster_.cast4(pose_.translation(), directions, hits);
        std::copy_n(
            hits, count, &seen_.hits[static_cast<std::size_t>(v) * size_.width + u]);
      }
  }

  void
  castSky()
  {
    sky_size_ = cv::Size(size_.width / sky_step + 2, size_.height / sky_step + 2);
    open_.create(sky_size_);
    for (int j = 0; j < sky_size_.height; ++j)
      for (int i = 0; i < sky_size_.width; ++i) {
        const int u = skyPixel(i, size_.width), v = skyPixel(j, size_.height);
        const Hit& hit = seen_(u, v);
        open_(j, i) = 1;
        if (hit.thing >= 0)
          open_(j, i) = openSky(
              caster_,
              placeOf(caster_, pose_.translation(), direction(u, v), hit, pixel_angle_),
              2.5,
              static_cast<std::uint64_t>(j) * 8192 + static_cast<std::uint64_t>(i));
      }
  }

  static int
  skyPixel(int cell, int extent)
  {
    return std::min(cell * sky_step, extent - 1);
  }

  // From the cells around, those on the same surface.
  float
  openAt(int u, int v, const Hit& hit, double distance) const
  {
    const int i0 = u / sky_step, j0 = v / sky_step;
    float sum = 0, weights = 0;
    for (int j = std::max(0, j0 - 1); j <= std::min(j0 + 2, sky_size_.height - 1); ++j)
      for (int i = std::max(0, i0 - 1); i <= std::min(i0 + 2, sky_size_.width - 1);
           ++i) {
        const int x = skyPixel(i, size_.width), y = skyPixel(j, size_.height);
        const Hit& other = seen_(x, y);
        if (other.thing < 0)
          continue;
        const double apart = std::abs(other.distance - distance) / distance;
        const double turn = 1 - other.normal.dot(hit.normal);
        const double far =
            ((x - u) * (x - u) + (y - v) * (y - v)) / double(sky_step * sky_step);
        if (far >= 4)
          continue;
        const auto weight = static_cast<float>(
            (1 - far / 4) / (1 + 400 * apart * apart + 20 * turn) + 1e-6);
        sum += weight * open_(j, i);
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

  Vector3f
  lightAt(double x, double y, const Hit& hit, int u, int v)
  {
    const Vector3d way = direction(x, y);
    if (hit.thing < 0)
      return skyColor(scene_.light, way);
    const Place place = placeOf(caster_, pose_.translation(), way, hit, pixel_angle_);
    directLight(caster_, scene_.light, place, direct_);
    return shadeOf(scene_, hit, place, direct_, openAt(u, v, hit, hit.distance));
  }

  const RayCaster& caster_;
  const Scene& scene_;
  const Lens& lens_;
  cv::Size size_;
  Eigen::Isometry3d pose_;
  double pixel_angle_ = 0;
  Seen seen_;
  cv::Size sky_size_;
  cv::Mat1f open_;
  std::vector<float> direct_;
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
           const cv::Size& size,
           const Eigen::Isometry3d& pose,
           const Exposure& exposure,
           double* key)
{
  cv::Mat3f picture = Photographer(caster, scene, lens, size, pose).take();
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
        out(v, u)[c] = static_cast<unsigned char>(encoded * 255 + 0.5f);
      }
    }
  return out;
}

} // namespace simulation
} // namespace hoist
