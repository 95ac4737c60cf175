#include "cuboid_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hoist {
namespace detail {
namespace {

// Just beyond an edge between a visible and a hidden face, the visible face must end.
class OutlineEdge {
public:
  OutlineEdge(const CuboidView& view,
              const cv::Mat1f& image,
              const cv::Mat3b& colors,
              const cv::Mat1s& labels,
              const std::vector<PlanarFace>& faces,
              int face,
              int neighbour)
  : view_(view)
  , image_(image)
  , colors_(colors)
  , labels_(labels)
  , faces_(faces)
  , face_(face)
  , neighbour_(neighbour)
  , across_(neighbour / 2)
  , along_(3 - face / 2 - neighbour / 2)
  , normal_(view.box.outward(face))
  , offset_(view.box.end(face) * CuboidHypothesis::side(face))
  {
    Eigen::Vector3d center = (view.box.lower + view.box.upper) / 2;
    center[face / 2] = view.box.end(face);
    face_center_ = view.box.axes * center;
  }

  // False where the face is seen so obliquely that nothing beyond it can be told.
  bool
  place()
  {
    local_ = (view_.box.lower + view_.box.upper) / 2;
    local_[face_ / 2] = view_.box.end(face_);
    local_[across_] = view_.box.end(neighbour_);
    const double side = CuboidHypothesis::side(neighbour_);
    const Eigen::Vector3d on_edge = view_.box.axes * local_;
    const Eigen::Vector3d outside =
        on_edge + side * view_.pixel * view_.box.axes.col(across_);
    if (on_edge.z() < min_depth || outside.z() < min_depth)
      return false;
    // Far enough that the sensor's fringe is passed, in the image too: an oblique face
    // is foreshortened.
    const double shift =
        (view_.camera.project(outside) - view_.camera.project(on_edge)).norm(); // [px]
    constexpr double max_stretch = 4, fringe = 3.5; // [1], [px]
    if (shift * max_stretch < 1)
      return false;
    beyond_ =
        fringe * view_.pixel / std::min(1.0, shift) + view_.sensor.sigmaZ(on_edge.z());
    local_[across_] += side * beyond_;
    return true;
  }

  EdgeEvidence
  sample(int max_samples)
  {
    EdgeEvidence edge;
    edge.face = face_;
    edge.neighbour = neighbour_;
    const double first = view_.box.lower[along_];
    const double length = view_.box.upper[along_] - first;
    const auto wanted = static_cast<int>(length / (2 * view_.pixel));
    edge.samples = std::max(4, std::min(max_samples, wanted));
    for (int s = 0; s < edge.samples; ++s) {
      local_[along_] = first + length * (s + 0.5) / edge.samples;
      judge(edge);
    }
    // Two boxes flush with each other: the surface goes on, its colour does not. Print
    // has steps too, but hardly in a line with the edge.
    int in_line = 0;
    for (int k = 0; k < positions; ++k)
      in_line = std::max(in_line,
                         steps_[k] + (k > 0 ? steps_[k - 1] : 0) +
                             (k + 1 < positions ? steps_[k + 1] : 0));
    constexpr double min_share = 0.75;
    constexpr int min_steps = 4;
    if (in_line >= min_steps && in_line >= min_share * edge.bad) {
      edge.bad -= in_line;
      edge.color = in_line;
    }
    return edge;
  }

private:
  // The pixel of a point in the box's axes; false outside of the image.
  bool
  look(const Eigen::Vector3d& local, cv::Point& at, double& z) const
  {
    const Eigen::Vector3d x = view_.box.axes * local;
    z = x.z();
    if (z < min_depth)
      return false;
    const Eigen::Vector2d q = view_.camera.project(x);
    at.x = static_cast<int>(std::lround(q.x()));
    at.y = static_cast<int>(std::lround(q.y()));
    return at.x >= 0 && at.y >= 0 && at.x < image_.cols && at.y < image_.rows;
  }

  // Height over the face's plane of what is measured at a pixel, and its noise.
  double
  height(const cv::Point& at, double z, double& noise) const
  {
    const double cosine = normal_.dot(view_.camera.ray(at.x, at.y));
    noise = view_.sensor.sigmaZ(z) * std::abs(cosine) + 0.5 * view_.pixel;
    return cosine / image_(at) - offset_;
  }

  // What the box stands on or leans against meets it concavely: the middle of the face
  // lies in front of that surface.
  bool
  isSupport(const cv::Point& at, double noise) const
  {
    const short label = labels_(at);
    if (label <= 0)
      return false;
    constexpr double max_cosine = 0.94; // more alike is the same surface
    const PlanarFace& other = faces_[label - 1];
    return other.normal.dot(normal_) < max_cosine &&
           other.normal.dot(face_center_) + other.offset > 2 * noise;
  }

  // The same as isSupport() without a label: farther out it is clearly above the plane.
  bool
  risesFartherOut() const
  {
    Eigen::Vector3d local = local_;
    local[across_] += CuboidHypothesis::side(neighbour_) * 1.5 * beyond_;
    cv::Point at;
    double z = 0, noise = 0;
    return look(local, at, z) && image_(at) > 0 && height(at, z, noise) > 2 * noise;
  }

  // A parallel surface farther back is a step, however small; what bends away is not
  // parallel.
  bool
  isSetBack(const cv::Point& at) const
  {
    constexpr double min_cosine = 0.985;
    const short label = labels_(at);
    return label > 0 && faces_[label - 1].normal.dot(normal_) > min_cosine;
  }

  void
  judge(EdgeEvidence& edge)
  {
    cv::Point at;
    double z = 0, noise = 0;
    if (!look(local_, at, z) || view_.covers(at.x, at.y))
      return; // off the image, or round a corner: another face of the box is seen there
    if (!(image_(at) > 0)) {
      ++edge.good;
      return;
    }
    // Just below the plane means that the surface goes on or bends away slowly, as a
    // cylinder's does; a box ends in a step.
    constexpr double gate = 2.5;
    const double up = height(at, z, noise);
    if (up > gate * noise)
      return; // covered, or a surface that rises: says nothing
    if (up < -gate * noise - beyond_ || (up < -gate * noise && isSetBack(at)))
      ++edge.good;
    else if (!isSupport(at, noise) && !risesFartherOut()) {
      ++edge.bad;
      const int place = colorStep(at);
      if (place >= 0)
        ++steps_[place];
    }
  }

  // Where the colour changes most across the edge, within the few pixels that colour
  // and depth may be apart: a place in steps_, -1 where it does not.
  int
  colorStep(const cv::Point& at) const
  {
    if (colors_.empty())
      return -1;
    Eigen::Vector3d on_edge = local_;
    on_edge[across_] = view_.box.end(neighbour_);
    const Eigen::Vector2d q = view_.camera.project(view_.box.axes * on_edge);
    const Eigen::Vector2d d = (Eigen::Vector2d(at.x, at.y) - q).normalized();
    std::array<cv::Vec3b, 2 * reach + 1> line;
    for (int k = -reach; k <= reach; ++k) {
      const auto u = static_cast<int>(std::lround(q.x() + k * d.x()));
      const auto v = static_cast<int>(std::lround(q.y() + k * d.y()));
      if (u < 0 || v < 0 || u >= colors_.cols || v >= colors_.rows)
        return -1;
      line[k + reach] = colors_(v, u);
    }
    constexpr int min_step = 40; // sum over the channels, of 765
    int highest = min_step, place = -1;
    for (int k = 0; k < positions; ++k) {
      int step = 0;
      for (int c = 0; c < 3; ++c)
        step += std::abs(line[k][c] - line[k + step_width][c]);
      if (step > highest) {
        highest = step;
        place = k;
      }
    }
    return place;
  }

  // The colour is looked at this far to either side of the edge, over this distance
  // [px].
  static constexpr int reach = 5, step_width = 2;
  static constexpr int positions = 2 * reach + 1 - step_width;

  const CuboidView& view_;
  const cv::Mat1f& image_;
  const cv::Mat3b& colors_;
  const cv::Mat1s& labels_;
  const std::vector<PlanarFace>& faces_;
  int face_, neighbour_, across_, along_;
  Eigen::Vector3d normal_; // outward
  double offset_;          // normal . x on the face [m]
  Eigen::Vector3d face_center_;
  Eigen::Vector3d local_;              // the sample, in the box's axes
  std::array<int, positions> steps_{}; // bad samples by where the colour changes
  double beyond_ = 0;                  // distance of the samples from the edge [m]
};

} // namespace

void
collectOutlineEvidence(const CuboidView& view,
                       const cv::Mat1f& inverse_depth,
                       const cv::Mat3b& colors,
                       const cv::Mat1s& labels,
                       const std::vector<PlanarFace>& faces,
                       int max_samples,
                       CuboidEvidence& evidence)
{
  const Eigen::Vector3d toward = view.box.center().normalized();
  for (int k = 0; k < view.fronts; ++k) {
    const int face = view.front[k];
    // A face seen at a grazing angle is a sliver; a degree of tilt hides or shows it.
    constexpr double min_cosine = 0.2;
    if (std::abs(view.box.axes.col(face / 2).dot(toward)) < min_cosine)
      continue;
    for (int m = 0; m < view.n_hidden; ++m) {
      const int neighbour = view.hidden[m];
      if (neighbour / 2 == face / 2)
        continue;
      OutlineEdge edge(view, inverse_depth, colors, labels, faces, face, neighbour);
      if (edge.place())
        evidence.edges.push_back(edge.sample(max_samples));
    }
  }
}

} // namespace detail
} // namespace hoist
