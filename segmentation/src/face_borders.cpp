#include <hoist/segmentation/face_borders.h>

#include <cmath>

namespace hoist {
namespace {

// What lies beyond a side of a face.
struct Beyond {
  BorderKind kind = BorderKind::open;
  short neighbour = -1;
};

struct Walker {
  const cv::Mat1s& labels;
  const cv::Mat1f& image;
  const cv::Mat1b& mask;
  const SensorModel& sensor;
  const std::vector<PlanarFace>& faces;

  double
  plane(int face, double u, double v) const
  {
    const Eigen::Vector3d& p = faces[face].inverse_depth;
    return p[0] * u + p[1] * v + p[2];
  }

  bool
  inside(int u, int v) const
  {
    return u >= 0 && v >= 0 && u < labels.cols && v < labels.rows &&
           (mask.empty() || mask(v, u) != 0);
  }

  // Walks from (u, v) in steps (du, dv) until something is known.
  Beyond
  look(int face, int u, int v, int du, int dv) const
  {
    constexpr int max_fringe = 4; // unlabelled pixels at a border [px]
    constexpr int max_hole = 64;  // run without measurement [px]
    const double su = u + 0.5 * du, sv = v + 0.5 * dv;
    const double own = plane(face, su, sv);
    const double z = 1 / own;
    const double sigma = sensor.sigmaZ(z) * own * own;
    const double gate = 4 * sigma;
    int fringe = 0;
    float last = 0; // an unlabelled measurement on the way
    for (int k = 1; k <= max_hole; ++k) {
      const int x = u + k * du, y = v + k * dv;
      if (!inside(x, y))
        return {k == 1 ? BorderKind::cut : BorderKind::open, -1};
      const float w = image(y, x);
      const short label = labels(y, x);
      if (label != 0) {
        const int other = label - 1;
        if (other == face)
          return {BorderKind::cut, static_cast<short>(face)};
        // across a gap the other surface is carried back to the border
        const double there = k <= max_fringe + 1 ? plane(other, su, sv) : w;
        const double here = k <= max_fringe + 1 ? own : plane(face, x, y);
        // one pixel beside the crease they disagree by the difference of their slopes
        const Eigen::Vector3d turn =
            faces[face].inverse_depth - faces[other].inverse_depth;
        const double slope = k <= max_fringe + 1 ? std::hypot(turn.x(), turn.y()) : 0.0;
        BorderKind kind = BorderKind::crease;
        if (there < here - gate - slope)
          kind = BorderKind::jump;
        else if (there > here + gate + slope)
          kind = BorderKind::occluded;
        return {kind, static_cast<short>(other)};
      }
      if (w > 0) {
        last = w;
        if (++fringe >= max_fringe)
          break;
      }
    }
    if (last > 0) {
      if (last < own - gate)
        return {BorderKind::jump, -1};
      if (last > own + gate)
        return {BorderKind::occluded, -1};
      return {BorderKind::crease, -1};
    }
    return {BorderKind::open, -1};
  }
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
  const Walker walker{labels, inverse_depth, mask, sensor, faces};
  const int width = labels.cols, height = labels.rows;
  const auto n = static_cast<int>(faces.size());
  const auto at = [&](int u, int v) -> short {
    return u < 0 || v < 0 || u >= width || v >= height ? 0 : labels(v, u);
  };
  constexpr int steps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};

  // Collected in one walk, then laid out face by face without sorting.
  borders.first.assign(n + 1, 0);
  borders.found.clear();
  for (int v = 0; v < height; ++v) {
    const short* row = labels[v];
    for (int u = 0; u < width; ++u) {
      const short label = row[u];
      if (label == 0)
        continue;
      for (const auto& s : steps) {
        if (at(u + s[0], v + s[1]) == label)
          continue;
        const int face = label - 1;
        const Beyond beyond = walker.look(face, u, v, s[0], s[1]);
        if (beyond.neighbour == face)
          continue; // a hole, no border
        const double x = u + 0.5 * s[0], y = v + 0.5 * s[1];
        const Eigen::Vector3d p = camera.ray(x, y) / walker.plane(face, x, y);
        const double x2 = x + s[0], y2 = y + s[1];
        const Eigen::Vector3d q = camera.ray(x2, y2) / walker.plane(face, x2, y2);
        BorderElement e;
        e.pixel = {static_cast<float>(x), static_cast<float>(y)};
        e.point = p.cast<float>();
        e.outward = (q - p).normalized().cast<float>();
        e.kind = beyond.kind;
        e.face = static_cast<short>(face);
        e.neighbour = beyond.neighbour;
        borders.found.push_back(e);
        ++borders.first[label];
      }
    }
  }
  for (int i = 0; i < n; ++i)
    borders.first[i + 1] += borders.first[i];
  borders.elements.resize(borders.found.size());
  borders.next.assign(borders.first.begin(), borders.first.end() - 1);
  for (const BorderElement& e : borders.found)
    borders.elements[borders.next[e.face]++] = e;
}

} // namespace hoist
