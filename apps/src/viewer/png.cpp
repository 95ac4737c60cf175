#include "viewer/png.h"

#include <hoist/data/atomic_file.h>

#include <opencv2/imgcodecs.hpp>

#include <vector>

namespace hoist {

void
savePng(const std::string& file, const cv::Mat3b& picture)
{
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  writeFileAtomically(file,
                      {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

} // namespace hoist
