#include "sample_files.h"

#include "generate.h"
#include "render.h"

#include <hoist/data/pts_io.h>

#include <pcl/io/pcd_io.h>

#include <fstream>
#include <stdexcept>

namespace hoist {
namespace samples {

std::vector<std::filesystem::path>
writeSamples(const std::filesystem::path& folder)
{
  namespace fs = std::filesystem;
  fs::create_directories(folder / "scenes");
  fs::create_directories(folder / "truth");
  std::vector<fs::path> written;
  for (const Scene& scene : sampleScenes()) {
    const Frame frame = render(scene);
    const fs::path pcd = folder / "scenes" / (scene.name + ".pcd");
    if (pcl::PCDWriter().writeBinaryCompressed(pcd.string(), frame.cloud) < 0)
      throw std::runtime_error("cannot write " + pcd.string());
    written.push_back(pcd);

    if (scene.width <= 320) {
      const fs::path pts = folder / "scenes" / (scene.name + ".pts");
      if (savePTSFile(pts.string(), frame.cloud) < 0)
        throw std::runtime_error("cannot write " + pts.string());
      written.push_back(pts);
    }

    const fs::path truth = folder / "truth" / (scene.name + ".json");
    std::ofstream out(truth, std::ios::binary);
    out << truthJson(scene, frame.truth);
    if (!out.flush())
      throw std::runtime_error("cannot write " + truth.string());
    written.push_back(truth);
  }
  return written;
}

} // namespace samples
} // namespace hoist
