#include "evaluate/attributes.h"

#include <cmath>

namespace hoist {
namespace {

AttributeCount
judged(bool known, bool said, bool right)
{
  AttributeCount count;
  count.truths = known ? 1 : 0;
  count.said = known && said ? 1 : 0;
  count.right = known && said && right ? 1 : 0;
  return count;
}

bool
sameColor(const std::array<int, 3>& a, const std::array<int, 3>& b, double tolerance)
{
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(a[i] - b[i]) > tolerance * 255)
      return false;
  return true;
}

} // namespace

void
AttributeCount::add(const AttributeCount& other)
{
  truths += other.truths;
  said += other.said;
  right += other.right;
}

void
Attributes::add(const Prediction& prediction,
                const AnnotatedObject& truth,
                double tolerance)
{
  const bool colors = truth.base_rgb && prediction.rgb;
  color.add(judged(truth.base_rgb.has_value(),
                   prediction.rgb.has_value(),
                   colors && sameColor(*truth.base_rgb, *prediction.rgb, tolerance)));
  material.add(judged(!truth.material.empty(),
                      !prediction.material.empty(),
                      truth.material == prediction.material));
  fullness.add(judged(truth.fullness.has_value(),
                      prediction.fullness.has_value(),
                      truth.fullness == prediction.fullness));
  if (truth.weight && *truth.weight > 0 && prediction.weight)
    weight.push_back(*prediction.weight / *truth.weight - 1);
}

void
Attributes::add(const Attributes& other)
{
  color.add(other.color);
  material.add(other.material);
  fullness.add(other.fullness);
  weight.insert(weight.end(), other.weight.begin(), other.weight.end());
}

} // namespace hoist
