#include "png.h"

#include <hoist/data/atomic_file.h>

#include <pcl/exceptions.h>

#include <opencv2/imgcodecs.hpp>

#include <vector>

namespace hoist {

std::string
pngBytes(const cv::Mat& picture, int effort)
{
  std::vector<int> settings;
  if (effort >= 0)
    settings = {cv::IMWRITE_PNG_COMPRESSION, effort};
  std::vector<unsigned char> bytes;
  if (picture.empty() || !cv::imencode(".png", picture, bytes, settings))
    throw pcl::IOException("a picture cannot be packed as PNG");
  return {bytes.begin(), bytes.end()};
}

void
savePng(const std::string& file, const cv::Mat& picture, int effort)
{
  writeFileAtomically(file, pngBytes(picture, effort));
}

} // namespace hoist
