#include "size_text.h"

#include <fmt/format.h>

namespace hoist {

std::string
sizeText(const Cuboid& cuboid, int i)
{
  const char* mark = "";
  switch (cuboid.dimension_source[i]) {
  case DimensionSource::unknown:
    return "?";
  case DimensionSource::partial:
    mark = ">";
    break;
  case DimensionSource::bracketed:
    mark = "~";
    break;
  default:
    break;
  }
  return fmt::format("{}{:.1f}", mark, 100.0 * cuboid.size[i]);
}

} // namespace hoist
