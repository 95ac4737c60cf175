#include <hoist/segmentation/face_borders.h>

#include "planar_faces_marks.h"
#include "planar_faces_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hoist {
namespace {

using Side = FaceBorders::Side;

constexpr std::array<std::array<int, 2>, 4> steps = {
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

// What lies beyond a side of a face.
struct Beyond {
  BorderKind kind = BorderKind::open;
  short neighbour = -1;
};

class Walker {
public:
  Walker(const cv::Mat1s& labels,
         const cv::Mat1f& image,
         const cv::Mat1b& mask,
         const SensorModel& sensor,
         const std::vector<PlanarFace>& faces)
  : labels_(labels)
  , image_(image)
  , mask_(mask)
  , noise_(detail::InverseDepthNoise(sensor) * 4.0) // gate of 4 sigma
  , faces_(faces)
  {
    const std::ptrdiff_t row = labels.step1(), image_row = image.step1();
    label_steps_ = {-1, 1, -row, row};
    image_steps_ = {-1, 1, -image_row, image_row};
    if (!mask.empty()) {
      const std::ptrdiff_t mask_row = mask.step1();
      mask_steps_ = {-1, 1, -mask_row, mask_row};
    }
  }

  // Walks from (u, v) until something is known.
  Beyond
  look(int face, int u, int v, int direction) const
  {
    const std::array<int, 4> room = {u, labels_.cols - 1 - u, v, labels_.rows - 1 - v};
    const short* label = labels_[v] + u;
    const float* depth = image_[v] + u;
    const unsigned char* use = mask_.empty() ? nullptr : mask_[v] + u;
    const std::ptrdiff_t image_step = image_steps_[direction];
    int fringe = 0;
    float last = 0; // an unlabelled measurement on the way
    const int end = std::min(max_hole, room[direction]);
    for (int k = 1; k <= end; ++k) {
      depth += image_step;
      if (use != nullptr && *(use += mask_steps_[direction]) == 0)
        return {k == 1 ? BorderKind::cut : BorderKind::open, -1};
      if (!(*depth > 0))
        continue;
      const short other = label[k * label_steps_[direction]];
      if (other != 0)
        return meet(face, other - 1, u, v, direction, k, *depth);
      last = *depth;
      if (++fringe >= max_fringe)
        return compare(face, u, v, direction, last);
    }
    if (end < max_hole) // the image ends
      return {end == 0 ? BorderKind::cut : BorderKind::open, -1};
    return last > 0 ? compare(face, u, v, direction, last) : Beyond{};
  }

private:
  static constexpr int max_fringe = 4; // unlabelled pixels at a border [px]
  static constexpr int max_hole = 64;  // run without measurement [px]

  double
  plane(int face, double u, double v) const
  {
    const Eigen::Vector3d& p = faces_[face].inverse_depth;
    return p[0] * u + p[1] * v + p[2];
  }

  // Another face k pixels away, where \a w was measured.
  Beyond
  meet(int face, int other, int u, int v, int direction, int k, float w) const
  {
    const auto neighbour = static_cast<short>(other);
    if (other == face)
      return {BorderKind::cut, neighbour};
    const double du = steps[direction][0], dv = steps[direction][1];
    const double su = u + 0.5 * du, sv = v + 0.5 * dv;
    const double own = plane(face, su, sv);
    double there = w, here = own, gate = noise_(own);
    if (k <= max_fringe + 1) {
      // carried back to the border; one pixel beside the crease they disagree by the
      // difference of their slopes
      there = plane(other, su, sv);
      const Eigen::Vector3d& p = faces_[face].inverse_depth;
      const Eigen::Vector3d& q = faces_[other].inverse_depth;
      gate += std::sqrt((p.head<2>() - q.head<2>()).squaredNorm());
    }
    else // across a gap
      here = plane(face, u + k * du, v + k * dv);
    if (there < here - gate)
      return {BorderKind::jump, neighbour};
    if (there > here + gate)
      return {BorderKind::occluded, neighbour};
    return {BorderKind::crease, neighbour};
  }

  // A measurement without a face.
  Beyond
  compare(int face, int u, int v, int direction, float w) const
  {
    const double own =
        plane(face, u + 0.5 * steps[direction][0], v + 0.5 * steps[direction][1]);
    const double gate = noise_(own);
    if (w < own - gate)
      return {BorderKind::jump, -1};
    if (w > own + gate)
      return {BorderKind::occluded, -1};
    return {BorderKind::crease, -1};
  }

  const cv::Mat1s& labels_;
  const cv::Mat1f& image_;
  const cv::Mat1b& mask_;
  const detail::InverseDepthNoise noise_;
  const std::vector<PlanarFace>& faces_;
  std::array<std::ptrdiff_t, 4> label_steps_{}, image_steps_{}, mask_steps_{};
};

// Marks the pixels of a row that have a face and a neighbour without it.
void
markRow(const cv::Mat1s& labels, int v, std::vector<short>& marks)
{
  const int width = labels.cols;
  const short* here = labels[v];
  short* mark = marks.data();
  if (v == 0 || v + 1 == labels.rows) {
    std::copy(here, here + width, mark);
    return;
  }
  const short *up = labels[v - 1], *down = labels[v + 1];
  for (int u = 1; u + 1 < width; ++u) {
    const short own = here[u];
    const short other =
        (own ^ here[u - 1]) | (own ^ here[u + 1]) | (own ^ up[u]) | (own ^ down[u]);
    mark[u] = own != 0 ? other : short{0};
  }
  mark[0] = here[0];
  mark[width - 1] = here[width - 1];
}

void
collectSides(const cv::Mat1s& labels, const Walker& walker, FaceBorders& borders)
{
  const int width = labels.cols, height = labels.rows;
  const auto row = static_cast<std::ptrdiff_t>(labels.step1());
  borders.sides.clear();
  detail::resizeMarks(borders.marks, width);
  for (int v = 0; v < height; ++v) {
    markRow(labels, v, borders.marks);
    const short* here = labels[v];
    detail::forEachMark(borders.marks, width, [&](int u) {
      const short* label = here + u;
      const auto look = [&](unsigned char direction) {
        const int face = *label - 1;
        const Beyond beyond = walker.look(face, u, v, direction);
        if (beyond.neighbour == face)
          return; // a hole, no border
        borders.sides.push_back(
            {u, v, direction, beyond.kind, static_cast<short>(face), beyond.neighbour});
        ++borders.first[*label];
      };
      if (u == 0 || label[-1] != *label)
        look(0);
      if (u + 1 == width || label[1] != *label)
        look(1);
      if (v == 0 || label[-row] != *label)
        look(2);
      if (v + 1 == height || label[row] != *label)
        look(3);
    });
  }
}

// A side's place and direction on its face's plane.
class Lift {
public:
  explicit Lift(const Intrinsics& camera)
  : cx_(camera.cx), cy_(camera.cy), fx_(1 / camera.fx), fy_(1 / camera.fy)
  {
  }

  void
  operator()(const Side& side, const PlanarFace& face, BorderElement& e) const
  {
    const int du = steps[side.direction][0], dv = steps[side.direction][1];
    const double u = side.u + 0.5 * du, v = side.v + 0.5 * dv;
    const Eigen::Vector3d& p = face.inverse_depth;
    const double w = p[0] * u + p[1] * v + p[2], z = 1 / w;
    const double x = (u - cx_) * fx_, y = (v - cy_) * fy_;
    // the derivative of (x, y, 1) / w along the step, times w^2
    const double slope = p[0] * du + p[1] * dv;
    const double dx = du * fx_ * w - x * slope, dy = dv * fy_ * w - y * slope;
    const double unit = 1 / std::sqrt(dx * dx + dy * dy + slope * slope);
    e.pixel = {static_cast<float>(u), static_cast<float>(v)};
    e.point = {
        static_cast<float>(x * z), static_cast<float>(y * z), static_cast<float>(z)};
    e.outward = {static_cast<float>(dx * unit),
                 static_cast<float>(dy * unit),
                 static_cast<float>(-slope * unit)};
    e.kind = side.kind;
    e.face = side.face;
    e.neighbour = side.neighbour;
  }

private:
  double cx_, cy_, fx_, fy_; // the last two inverted
};

} // namespace

void
findFaceBorders(const cv::Mat1s& labels,
                const cv::Mat1f& inverse_depth,
                const cv::Mat1b& mask,
                const Intrinsics& camera,
                const SensorModel& sensor,
                const std::vector<PlanarFace>& faces,
                FaceBorders& borders)
{
  // Collected in one walk, then laid out face by face without sorting.
  borders.first.assign(faces.size() + 1, 0);
  collectSides(labels, Walker(labels, inverse_depth, mask, sensor, faces), borders);
  for (std::size_t i = 0; i < faces.size(); ++i)
    borders.first[i + 1] += borders.first[i];
  borders.elements.resize(borders.sides.size());
  borders.next.assign(borders.first.begin(), borders.first.end() - 1);
  const Lift lift(camera);
  for (const Side& side : borders.sides)
    lift(side, faces[side.face], borders.elements[borders.next[side.face]++]);
}

} // namespace hoist
