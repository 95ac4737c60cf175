#include <hoist/data/load_error.h>

#include <utility>

namespace hoist {
namespace {

std::string
describe(const std::string& file,
         const std::string& position,
         const std::string& reason)
{
  return file + (position.empty() ? "" : ":" + position) + ": " + reason;
}

} // namespace

LoadError::LoadError(const std::string& file,
                     const std::string& position,
                     std::string reason)
: pcl::IOException(describe(file, position, reason))
, message_(describe(file, position, reason))
, file_(file)
, position_(position)
, reason_(std::move(reason))
{
}

} // namespace hoist
