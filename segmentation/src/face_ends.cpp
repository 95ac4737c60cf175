#include "face_ends.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoist {
namespace detail {

FaceEnd
FaceEnds::find(int face, const Eigen::Vector3d& d, double sigma)
{
  for (const Known& k : known_)
    if (k.face == face && k.direction == d && k.sigma == sigma)
      return k.end;
  known_.push_back({face, d, sigma, measure(face, d, sigma)});
  return known_.back().end;
}

FaceEnd
FaceEnds::measure(int face, const Eigen::Vector3d& d, double sigma)
{
  const double pixel = footprint(faces_[face], d, camera_);
  const double window = 2 * pixel + sigma;
  votes_.clear();
  double farthest = -std::numeric_limits<double>::max();
  const Eigen::Vector3f direction = d.cast<float>();
  const int first = borders_.first[face], last = borders_.first[face + 1];
  for (int i = first; i < last; ++i) {
    const BorderElement& e = borders_.elements[i];
    const float t = direction.dot(e.point);
    farthest = std::max(farthest, static_cast<double>(t));
    if ((e.kind == BorderKind::crease || e.kind == BorderKind::jump ||
         e.kind == BorderKind::open) &&
        direction.dot(e.outward) > 0.3f)
      votes_.push_back(t);
  }
  FaceEnd end;
  end.pixel = pixel;
  end.value = farthest;
  if (votes_.empty())
    return end;
  std::sort(votes_.begin(), votes_.end());
  // the highest pile, then the outermost one that comes near it
  int highest = 0;
  const auto pile = [&](std::size_t hi, std::size_t& lo) {
    while (votes_[hi] - votes_[lo] > window)
      ++lo;
    return static_cast<int>(hi - lo + 1);
  };
  std::size_t lo = 0;
  for (std::size_t hi = 0; hi < votes_.size(); ++hi)
    highest = std::max(highest, pile(hi, lo));
  const int enough = std::max(4, static_cast<int>(0.4 * highest));
  lo = 0;
  for (std::size_t hi = 0; hi < votes_.size(); ++hi) {
    const int count = pile(hi, lo);
    if (count >= enough) {
      end.value = votes_[lo + (hi - lo) / 2];
      end.votes = count;
      end.seen = true;
    }
  }
  // Much of the outline beyond the pile and covered there: the pile is not the end.
  if (end.seen) {
    int beyond = 0;
    for (int i = first; i < last; ++i)
      beyond += direction.dot(borders_.elements[i].point) > end.value + window;
    if (beyond > 0.15 * (last - first) && farthest > end.value + 3 * window) {
      end.seen = false;
      end.value = farthest;
    }
  }
  if (end.seen)
    end.contact = contactAt(face, direction, static_cast<float>(end.value), window);
  return end;
}

FaceEnd
FaceEnds::find(const std::array<int, 2>& group, const Eigen::Vector3d& d, double sigma)
{
  const FaceEnd a = find(group[0], d, sigma);
  if (group[1] < 0)
    return a;
  const FaceEnd b = find(group[1], d, sigma);
  if (std::abs(a.value - b.value) < 2 * std::max(a.pixel, b.pixel) + sigma &&
      a.seen != b.seen)
    return a.seen ? a : b;
  return a.value > b.value ? a : b;
}

// The face that most of the outline at an end runs against, in front of this one.
int
FaceEnds::contactAt(int face, const Eigen::Vector3f& d, float value, float window) const
{
  const PlanarFace& own = faces_[face];
  int candidate = -1, lead = 0, all = 0, votes = 0;
  const auto atEnd = [&](const BorderElement& e) {
    return e.kind != BorderKind::occluded && e.kind != BorderKind::cut &&
           d.dot(e.outward) > 0.3f && std::abs(d.dot(e.point) - value) < window;
  };
  const auto inFront = [&](const BorderElement& e) {
    return e.kind == BorderKind::crease && e.neighbour >= 0 &&
           own.normal.dot(faces_[e.neighbour].centroid) + own.offset > 0;
  };
  // majority vote in two passes
  const int first = borders_.first[face], last = borders_.first[face + 1];
  for (int i = first; i < last; ++i) {
    const BorderElement& e = borders_.elements[i];
    if (!atEnd(e))
      continue;
    ++all;
    if (!inFront(e))
      continue;
    if (lead == 0)
      candidate = e.neighbour;
    lead += candidate == e.neighbour ? 1 : -1;
  }
  if (candidate < 0)
    return -1;
  for (int i = first; i < last; ++i) {
    const BorderElement& e = borders_.elements[i];
    votes += e.neighbour == candidate && atEnd(e) && inFront(e) ? 1 : 0;
  }
  return 2 * votes > all ? candidate : -1;
}

} // namespace detail
} // namespace hoist
