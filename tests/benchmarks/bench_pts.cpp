// How fast hoist reads PTS text on one core. Beside other readers: bench_pts.py.
//   bench_pts make FILE DIALECT MEGABYTES   DIALECT: bumblebee, xyzrgb or xyzirgb
//   bench_pts read FILE                     prints "SECONDS POINTS"
#include <hoist/data/atomic_file.h>
#include <hoist/data/pts_io.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <random>
#include <string>

namespace {

void
make(const std::string& file, const std::string& dialect, std::size_t bytes)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-5, 5);
  hoist::AtomicFile out(file);
  std::string block;
  std::size_t written = 0;
  char line[160];
  for (int pixel = 0; written < bytes; ++pixel) {
    int n = std::snprintf(line,
                          sizeof line,
                          "%f %f %f",
                          coordinate(random),
                          coordinate(random),
                          coordinate(random) + 6);
    const unsigned rgb = random();
    if (dialect == "xyzirgb")
      n += std::snprintf(line + n, sizeof line - n, " %d", int(random() % 4096) - 2048);
    n += std::snprintf(line + n,
                       sizeof line - n,
                       " %u %u %u",
                       rgb & 255,
                       rgb >> 8 & 255,
                       rgb >> 16 & 255);
    if (dialect == "bumblebee") // wide enough for any size
      n += std::snprintf(
          line + n, sizeof line - n, " %d %d", pixel / 4096, pixel % 4096);
    line[n++] = '\n';
    block.append(line, n);
    if (block.size() > 1 << 20) {
      out.write(block);
      written += block.size();
      block.clear();
    }
  }
  out.commit();
}

} // namespace

int
main(int argc, char** argv)
{
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "make" && argc == 5) {
    make(argv[2], argv[3], std::strtoull(argv[4], nullptr, 10) << 20);
    return 0;
  }
  if (command == "read" && argc == 3) {
    pcl::PCLPointCloud2 cloud;
    // time of the processor, not of the clock on the wall: others may be at work too
    const std::clock_t start = std::clock();
    hoist::readPTS(argv[2], cloud);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::cout << seconds << ' ' << cloud.width * std::size_t(cloud.height) << '\n';
    return 0;
  }
  std::cerr << "usage: bench_pts make FILE DIALECT MEGABYTES | bench_pts read FILE\n";
  return 2;
}
