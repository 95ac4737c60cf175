#include "faces.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace peers {
namespace {

constexpr float MAX_COSINE = 0.14f;       // of perpendicular normals: 8 degrees
constexpr float MEETING_DISTANCE = 0.02f; // of two faces that share an edge [m]
constexpr float MIN_SIDE = 0.015f;        // of a box [m]
constexpr float MAX_SIDE = 0.6f;
constexpr float UPRIGHT_COSINE = 0.995f;
constexpr float SNAP_HEIGHT = 0.03f; // a box that ends lower stands on the support [m]
constexpr float MAX_CONTRADICTION = 0.1f; // share of the visible surface
constexpr float MIN_FACE_SUPPORT = 0.5f;  // of what was seen of each face

/** \brief A box and the faces it was made from. */
struct Hypothesis {
  Box box;
  std::vector<int> faces;
  float gain = 0; ///< by which hypotheses compete
};

/** \brief Where the border of a face lies along a direction: the middle of the border
 *  points near either end, so that single points and rounded corners do not count. */
std::pair<float, float>
extent(const Cloud& cloud, const Face& face, const Eigen::Vector3f& direction)
{
  std::vector<float> values;
  values.reserve(face.border.size());
  for (const int i : face.border)
    values.push_back(direction.dot(cloud[i].getVector3fMap()));
  std::sort(values.begin(), values.end());
  const std::size_t skip = values.size() / 40;
  constexpr float BAND = 0.006f; // [m]
  const auto low = std::upper_bound(values.begin(), values.end(), values[skip] + BAND);
  const auto high = std::lower_bound(
      values.begin(), values.end(), values[values.size() - 1 - skip] - BAND);
  return {values[(low - values.begin()) / 2],
          values[(high - values.begin() + static_cast<long>(values.size())) / 2]};
}

/** \brief Whether two faces are perpendicular and meet in a convex edge. */
bool
formsEdge(const Cloud& cloud, const Face& a, const Face& b)
{
  const Eigen::Vector3f na = a.plane.head<3>();
  const Eigen::Vector3f nb = b.plane.head<3>();
  if (std::abs(na.dot(nb)) > MAX_COSINE)
    return false;
  // each lies behind the other and reaches up to it
  const float b_over_a = extent(cloud, b, na).second + a.plane[3];
  const float a_over_b = extent(cloud, a, nb).second + b.plane[3];
  if (std::abs(b_over_a) > MEETING_DISTANCE || std::abs(a_over_b) > MEETING_DISTANCE)
    return false;
  // side by side along the edge
  const Eigen::Vector3f edge = na.cross(nb).normalized();
  const auto along_a = extent(cloud, a, edge);
  const auto along_b = extent(cloud, b, edge);
  const float common =
      std::min(along_a.second, along_b.second) - std::max(along_a.first, along_b.first);
  const float shorter =
      std::min(along_a.second - along_a.first, along_b.second - along_b.first);
  return common > 0.6f * shorter;
}

/** \brief The rotation nearest to the faces' normals, weighted by their points; a third
 *  axis that no face gives is perpendicular to both. Columns in the faces' order. */
Eigen::Matrix3f
jointAxes(const std::vector<Face>& faces, const std::vector<int>& set, bool& mirrored)
{
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  for (std::size_t k = 0; k < set.size(); ++k)
    sum.col(static_cast<int>(k)) =
        faces[set[k]].plane.head<3>() * static_cast<float>(faces[set[k]].pixels.size());
  if (set.size() == 2)
    sum.col(2) = sum.col(0).cross(sum.col(1)).normalized() * 100;
  mirrored = sum.determinant() < 0;
  if (mirrored)
    sum.col(2) = -sum.col(2);
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(
      sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

/** \brief Whether something nearer hides the surface just below the lower end of the
 *  upright axis. */
bool
endIsHidden(const Scene& scene, const Box& box, int upright)
{
  constexpr float BELOW = 0.008f; // [m]
  constexpr float NEARER = 0.02f;
  constexpr int SAMPLES = 15;
  const float sign =
      box.axes.col(upright).dot(scene.support.head<3>()) > 0 ? -1.f : 1.f;
  int hidden = 0;
  int all = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == upright)
      continue;
    Eigen::Vector3f normal = box.axes.col(axis);
    if (normal.dot(box.center) > 0)
      normal = -normal;
    const Eigen::Vector3f middle =
        box.center + normal * box.size[axis] / 2 +
        box.axes.col(upright) * sign * (box.size[upright] / 2 + BELOW);
    if (normal.dot(middle) > -0.15f * middle.norm())
      continue;
    const int along = 3 - axis - upright;
    for (int i = 0; i < SAMPLES; ++i) {
      const float s = 0.9f * ((i + 0.5f) / SAMPLES - 0.5f);
      const Eigen::Vector3f p = middle + box.axes.col(along) * (s * box.size[along]);
      const Eigen::Vector3f nearer = p - p.normalized() * NEARER;
      ++all;
      hidden += look(scene, nearer) == Sight::occluded;
    }
  }
  return 2 * hidden > all;
}

/** \brief The support plane ends what stands on it where the end was not seen: the
 *  lowest points were taken for the plane's, or something hides them. */
void
standOnSupport(const Scene& scene, Box& box)
{
  for (int axis = 0; axis < 3; ++axis) {
    const float cosine = box.axes.col(axis).dot(scene.support.head<3>());
    if (std::abs(cosine) < UPRIGHT_COSINE)
      continue;
    const float above = scene.support.head<3>().dot(box.center) + scene.support[3] -
                        box.size[axis] / 2 * std::abs(cosine);
    if (above > SNAP_HEIGHT && !endIsHidden(scene, box, axis))
      continue;
    box.size[axis] += above;
    box.center -= scene.support.head<3>() * above / 2;
  }
}

bool
makeBox(const Scene& scene, const std::vector<Face>& faces, Hypothesis& hypothesis)
{
  const std::vector<int>& set = hypothesis.faces;
  bool mirrored = false;
  const Eigen::Matrix3f axes = jointAxes(faces, set, mirrored);
  Eigen::Vector3f lo, hi;
  for (int k = 0; k < 3; ++k) {
    lo[k] = std::numeric_limits<float>::max();
    hi[k] = -lo[k];
    for (std::size_t j = 0; j < set.size(); ++j)
      if (static_cast<int>(j) != k) {
        const auto ends = extent(*scene.cloud, faces[set[j]], axes.col(k));
        lo[k] = std::min(lo[k], ends.first);
        hi[k] = std::max(hi[k], ends.second);
      }
    if (k < static_cast<int>(set.size())) { // this end is a face
      const float near = axes.col(k).dot(faces[set[k]].centroid);
      (mirrored && k == 2 ? lo[k] : hi[k]) = near;
    }
  }
  Box& box = hypothesis.box;
  box.axes = axes;
  box.size = hi - lo;
  box.center = axes * (lo + hi) / 2;
  if (box.size.minCoeff() <= 0)
    return false;
  standOnSupport(scene, box);
  return box.size.minCoeff() > MIN_SIDE && box.size.maxCoeff() < MAX_SIDE;
}

void
judge(const Scene& scene, const std::vector<Face>& faces, Hypothesis& hypothesis)
{
  const DepthCheck check = checkDepth(scene, hypothesis.box);
  hypothesis.gain = 0;
  if (check.contradiction > MAX_CONTRADICTION || check.worst_face < MIN_FACE_SUPPORT)
    return;
  std::size_t points = 0;
  for (const int f : hypothesis.faces)
    points += faces[f].pixels.size();
  hypothesis.box.score =
      std::max(0.f, check.support - 2 * check.contradiction + 0.5f * check.occluded);
  hypothesis.gain = static_cast<float>(points) * hypothesis.box.score;
}

} // namespace

std::vector<Box>
boxesFromFaces(const Scene& scene, std::vector<Face> faces)
{
  const std::size_t patches = faces.size();
  joinFaces(scene, faces);
  const int count = static_cast<int>(faces.size());
  std::vector<std::vector<char>> meets(count, std::vector<char>(count, 0));
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      meets[a][b] = formsEdge(*scene.cloud, faces[a], faces[b]);
  std::vector<Hypothesis> hypotheses;
  const auto propose = [&](std::vector<int> set) {
    Hypothesis hypothesis;
    hypothesis.faces = std::move(set);
    if (!makeBox(scene, faces, hypothesis))
      return;
    judge(scene, faces, hypothesis);
    if (hypothesis.gain > 0)
      hypotheses.push_back(std::move(hypothesis));
  };
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      if (meets[a][b]) {
        propose({a, b});
        for (int c = b + 1; c < count; ++c)
          if (meets[a][c] && meets[b][c])
            propose({a, b, c});
      }
  std::stable_sort(
      hypotheses.begin(),
      hypotheses.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.gain > b.gain; });
  std::vector<char> used(patches, 0); // a patch belongs to one box
  std::vector<Box> boxes;
  for (const Hypothesis& hypothesis : hypotheses) {
    std::vector<int> parts;
    for (const int f : hypothesis.faces)
      parts.insert(parts.end(), faces[f].parts.begin(), faces[f].parts.end());
    if (std::any_of(parts.begin(), parts.end(), [&](int f) { return used[f] != 0; }))
      continue;
    for (const int f : parts)
      used[f] = 1;
    boxes.push_back(hypothesis.box);
  }
  return boxes;
}

} // namespace peers
