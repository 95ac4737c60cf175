#include <hoist/data/frame_fields.h>
#include <hoist/data/load_frame.h>
#include <hoist/data/pts_io.h>

#include "raw_cloud.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>

namespace hoist {
namespace {

std::string
ending(const std::string& file)
{
  std::string text = std::filesystem::path(file).extension().string();
  for (char& c : text)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return text;
}

detail::RawCloud
readPtsRecords(const std::string& file, const LoadOptions& options)
{
  std::uint64_t size = 0;
  (void)detail::readHead(file, 1, size);
  PTSStream stream(file, options.pts);
  if (stream.maxRecords() > options.max_points)
    throw LoadError(file,
                    "",
                    std::to_string(stream.maxRecords()) + " points are more than the " +
                        std::to_string(options.max_points) + " allowed");
  detail::RawCloud raw;
  std::vector<detail::Role> roles;
  for (const auto& field : stream.fields())
    roles.push_back(detail::roleOf(field.name));
  detail::checkRoles(file, roles, raw);
  std::vector<std::uint8_t> block;
  const auto convert = [&](const std::uint8_t* bytes, detail::Record& record) {
    for (std::size_t f = 0; f < roles.size(); ++f) {
      const auto& field = stream.fields()[f];
      const bool real = field.datatype == pcl::PCLPointField::FLOAT32;
      detail::assign(record, roles[f], {real ? 'F' : 'U', 4}, bytes + field.offset);
    }
  };
  const bool grid = stream.organized();
  const std::size_t width = static_cast<std::size_t>(stream.width());
  std::vector<bool> taken;
  if (grid) {
    raw.records.resize(width * stream.height());
    taken.resize(raw.records.size());
    for (auto& record : raw.records)
      record.x = record.y = record.z = std::numeric_limits<float>::quiet_NaN();
  }
  while (const std::size_t n = stream.next(block))
    for (std::size_t i = 0; i < n; ++i) {
      detail::Record record;
      convert(&block[i * stream.pointStep()], record);
      if (!grid) {
        raw.records.push_back(record);
        continue;
      }
      const std::size_t cell = record.v * width + record.u;
      detail::Record& old = raw.records[cell];
      if (!taken[cell] ||
          (std::isfinite(record.z) && !(std::isfinite(old.z) && old.z <= record.z)))
        old = record;
      taken[cell] = true;
    }
  raw.width = grid ? width : raw.records.size();
  raw.height = grid ? static_cast<std::uint64_t>(stream.height()) : 1;
  raw.format = "PTS " + stream.report().dialect;
  raw.warnings = stream.report().warnings;
  if (raw.records.empty())
    throw LoadError(file, "", "no points in it");
  return raw;
}

} // namespace

LoadedFrame
loadFrame(const std::string& file, const LoadOptions& options)
{
  const std::string kind = ending(file);
  LoadedFrame frame;
  frame.cloud.reset(new pcl::PointCloud<pcl::PointXYZRGB>);
  try {
    if (kind == ".pcd")
      detail::makeFrame(file, detail::readPcd(file, options), options, frame);
    else if (kind == ".ply")
      detail::makeFrame(file, detail::readPly(file, options), options, frame);
    else if (kind == ".pts" || kind == ".xyz" || kind == ".asc" || kind == ".txt")
      detail::makeFrame(file, readPtsRecords(file, options), options, frame);
    else
      throw LoadError(file,
                      "",
                      "expected a name that ends in .pcd, .ply, .pts, .xyz, .asc or "
                      ".txt");
  }
  catch (const std::bad_alloc&) {
    throw LoadError(file, "", "not enough memory for its points");
  }
  return frame;
}

std::vector<FrameField>
loadFrameFields(const std::string& file, std::size_t most, const LoadOptions& options)
{
  try {
    if (ending(file) == ".pcd")
      return detail::readPcdFields(file, options, most);
  }
  catch (const std::bad_alloc&) {
    throw LoadError(file, "", "not enough memory for its fields");
  }
  return {};
}

} // namespace hoist
