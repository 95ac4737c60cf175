#include <hoist/segmentation/box_sizes.h>

#include <algorithm>
#include <cmath>

namespace hoist {
namespace {

constexpr std::array<std::array<int, 3>, 6> orders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

// What a hypothesis says of one of its sides.
enum class Side { measured, at_least, anything };

Side
sideOf(const CuboidHypothesis& h, int axis)
{
  Side side = Side::measured;
  for (const EndSource end : {h.ends[2 * axis], h.ends[2 * axis + 1]}) {
    if (end == EndSource::unknown)
      return Side::anything;
    if (end == EndSource::bound || end == EndSource::contact)
      side = Side::at_least;
  }
  return side;
}

// Between which lengths a side may lie.
SideRange
possible(const CuboidHypothesis& h, int axis, double slack)
{
  const Side side = sideOf(h, axis);
  const double length = h.size()[axis];
  SideRange range;
  if (side != Side::anything)
    range.min = length - slack;
  if (side == Side::measured)
    range.max = length + slack;
  return range;
}

// Whether sides within ranges a can lie in the ranges b of the longest, the middle and
// the shortest.
bool
fitsRanges(const std::array<SideRange, 3>& a, const std::array<SideRange, 3>& b)
{
  return std::any_of(orders.begin(), orders.end(), [&](const auto& order) {
    double longest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) { // each as long as it may be
      const SideRange& side = a[order[k]];
      longest = std::min({longest, side.max, b[k].max});
      if (longest < std::max(side.min, b[k].min))
        return false;
    }
    return true;
  });
}

// Whether sides within ranges can be those of a known box, in this order.
bool
fitsBox(const std::array<SideRange, 3>& a,
        const Eigen::Vector3d& box,
        const std::array<int, 3>& order)
{
  for (int i = 0; i < 3; ++i)
    if (box[order[i]] < a[i].min || box[order[i]] > a[i].max)
      return false;
  return true;
}

// The hidden one of an axis's two ends, -1 if both are known, -2 if neither is.
int
hiddenEnd(const CuboidHypothesis& h, int axis)
{
  int hidden = -1;
  for (const int f : {2 * axis, 2 * axis + 1}) {
    const EndSource end = h.ends[f];
    if (end == EndSource::seen || end == EndSource::support)
      continue;
    if (hidden >= 0)
      return -2;
    hidden = f;
  }
  return hidden;
}

} // namespace

bool
BoxSizes::valid() const
{
  const auto range = [](const SideRange& r) { return r.min >= 0 && r.max >= r.min; };
  const auto size = [](const Eigen::Vector3d& s) {
    return s.allFinite() && s.minCoeff() > 0;
  };
  return min_side > 0 && max_side >= min_side && tolerance > 0 &&
         std::isfinite(tolerance) && std::all_of(ranges.begin(), ranges.end(), range) &&
         std::all_of(known.begin(), known.end(), size);
}

const char*
sizeRejection(const CuboidHypothesis& h, const BoxSizes& sizes, double slack)
{
  std::array<SideRange, 3> sides;
  for (int i = 0; i < 3; ++i) {
    sides[i] = possible(h, i, slack);
    // what is known of a side must be long enough by itself to be believed
    if (sideOf(h, i) != Side::anything &&
        (h.size()[i] < sizes.min_side - slack || h.size()[i] > sizes.max_side + slack))
      return "side length outside the limits";
  }
  if (!fitsRanges(sides, sizes.ranges))
    return "side length outside the limits";
  for (int i = 0; i < 3; ++i)
    sides[i] = possible(h, i, slack + sizes.tolerance);
  const auto isKnown = [&](const Eigen::Vector3d& box) {
    return std::any_of(orders.begin(), orders.end(), [&](const auto& order) {
      return fitsBox(sides, box, order);
    });
  };
  if (!sizes.known.empty() &&
      std::none_of(sizes.known.begin(), sizes.known.end(), isKnown))
    return "not a known size";
  return nullptr;
}

void
completeFromCatalogue(const BoxSizes& sizes,
                      const Intrinsics& camera,
                      const SensorModel& sensor,
                      std::vector<CuboidHypothesis>& hypotheses)
{
  const std::size_t n = hypotheses.size();
  for (std::size_t i = 0; i < n; ++i) {
    const CuboidHypothesis h = hypotheses[i]; // they move when one is added
    const Eigen::Array3i hidden(hiddenEnd(h, 0), hiddenEnd(h, 1), hiddenEnd(h, 2));
    if (hidden.maxCoeff() < 0 || hidden.minCoeff() < -1)
      continue;
    // ends are placed to a few pixels before refinement
    const double z = h.center().z();
    const double reach =
        sizes.tolerance + 3 * (z / std::min(camera.fx, camera.fy) + sensor.sigmaZ(z));
    const std::array<SideRange, 3> sides = {
        possible(h, 0, reach), possible(h, 1, reach), possible(h, 2, reach)};
    for (const Eigen::Vector3d& box : sizes.known) {
      const auto first = static_cast<std::ptrdiff_t>(hypotheses.size());
      for (const auto& order : orders) {
        if (!fitsBox(sides, box, order))
          continue;
        CuboidHypothesis whole = h;
        for (int axis = 0; axis < 3; ++axis) {
          const int f = hidden[axis];
          if (f < 0)
            continue;
          whole.given[axis] = box[order[axis]];
          whole.end(f) = h.end(f ^ 1) + CuboidHypothesis::side(f) * whole.given[axis];
          whole.ends[f] = EndSource::catalogue;
          whole.room[f] = 2 * sizes.tolerance;
        }
        // sides of one length give the same box again
        const auto same = [&](const CuboidHypothesis& other) {
          return other.lower == whole.lower && other.upper == whole.upper;
        };
        if (std::none_of(hypotheses.begin() + first, hypotheses.end(), same))
          hypotheses.push_back(whole);
      }
    }
  }
}

} // namespace hoist
