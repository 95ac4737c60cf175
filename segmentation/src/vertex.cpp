#include <hoist/segmentation/line_segment.h>

namespace hoist {

int
Vertex::aggregationDegree() const
{
  int degree = 0;
  for (std::size_t i = 0; i < ends.size(); ++i)
    degree += i == 0 || ends[i].segment != ends[i - 1].segment ? 1 : 0;
  return degree;
}

} // namespace hoist
