#include <hoist/data/atomic_file.h>
#include <hoist/data/pts_io.h>

#include <pcl/exceptions.h>

#include <array>
#include <charconv>
#include <cstring>
#include <string>

namespace hoist {
namespace {

// Where to find what in a record; -1 for what it has not.
struct Offsets {
  int x = -1, y = -1, z = -1, color = -1, u = -1, v = -1, intensity = -1;
};

Offsets
findOffsets(const pcl::PCLPointCloud2& cloud)
{
  Offsets out;
  for (const auto& field : cloud.fields) {
    const int at = static_cast<int>(field.offset);
    const bool real = field.datatype == pcl::PCLPointField::FLOAT32;
    const bool whole = field.datatype == pcl::PCLPointField::UINT32 ||
                       field.datatype == pcl::PCLPointField::INT32;
    if (field.name == "x" && real)
      out.x = at;
    else if (field.name == "y" && real)
      out.y = at;
    else if (field.name == "z" && real)
      out.z = at;
    else if ((field.name == "rgb" || field.name == "rgba") && (real || whole))
      out.color = at;
    else if (field.name == "u" && whole)
      out.u = at;
    else if (field.name == "v" && whole)
      out.v = at;
    else if (field.name == "intensity" && real)
      out.intensity = at;
  }
  return out;
}

// A line of text in the making. std::to_chars: no locale, exact.
class Line {
public:
  explicit Line(int decimals) : decimals_(decimals) {}

  void
  clear()
  {
    size_ = 0;
  }

  void
  real(float value)
  {
    // at most 48 digits before the point and decimals_ <= 20 after it
    char* const here = text_.data() + size_;
    const auto result =
        decimals_ < 0
            ? std::to_chars(here, last(), value, std::chars_format::fixed)
            : std::to_chars(here, last(), value, std::chars_format::fixed, decimals_);
    finish(result.ptr);
  }

  void
  whole(std::uint32_t value)
  {
    finish(std::to_chars(text_.data() + size_, last(), value).ptr);
  }

  void
  color(std::uint32_t rgba)
  {
    whole(rgba >> 16 & 255);
    whole(rgba >> 8 & 255);
    whole(rgba & 255);
  }

  std::string_view
  end()
  {
    text_[size_ - 1] = '\n';
    return {text_.data(), size_};
  }

private:
  // where a number must have ended: its separator still fits
  char*
  last()
  {
    return text_.data() + text_.size() - 1;
  }

  void
  finish(const char* stop)
  {
    size_ = static_cast<std::size_t>(stop - text_.data());
    text_[size_++] = ' ';
  }

  std::array<char, 1024> text_{};
  std::size_t size_ = 0;
  int decimals_;
};

template <typename T>
T
get(const std::uint8_t* record, int offset)
{
  T value;
  std::memcpy(&value, record + offset, sizeof(value));
  return value;
}

PTSDialect
chooseDialect(const pcl::PCLPointCloud2& cloud, const Offsets& at)
{
  if (cloud.height > 1 || (at.u >= 0 && at.v >= 0))
    return PTSDialect::bumblebee;
  if (at.intensity >= 0)
    return at.color >= 0 ? PTSDialect::xyzirgb : PTSDialect::xyzi;
  return at.color >= 0 ? PTSDialect::xyzrgb : PTSDialect::xyz;
}

} // namespace

int
PTSWriter::write(const std::string& file_name,
                 const pcl::PCLPointCloud2& cloud,
                 const Eigen::Vector4f& /*origin*/,
                 const Eigen::Quaternionf& /*orientation*/,
                 const bool binary)
{
  const auto fail = [&](const char* reason) {
    PCL_ERROR("[hoist::PTSWriter::write] %s: %s\n", file_name.c_str(), reason);
    return -1;
  };
  if (binary)
    return fail("PTS files are text");
  if (decimals_ > 20)
    return fail("more than 20 decimals");
  const Offsets at = findOffsets(cloud);
  if (at.x < 0 || at.y < 0 || at.z < 0)
    return fail("the cloud has no float fields x, y, z");
  const std::size_t n = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (cloud.data.size() < n * cloud.point_step)
    return fail("the cloud's size does not fit its data");
  const PTSDialect dialect =
      dialect_ == PTSDialect::automatic ? chooseDialect(cloud, at) : dialect_;
  const bool bumblebee = dialect == PTSDialect::bumblebee;
  const bool has_pixel = at.u >= 0 && at.v >= 0;
  if (bumblebee && cloud.height <= 1 && !has_pixel)
    return fail("Bumblebee records need an organized cloud or fields u and v");

  const auto measured = [&](const std::uint8_t* p) {
    return std::isfinite(get<float>(p, at.x)) && std::isfinite(get<float>(p, at.y)) &&
           std::isfinite(get<float>(p, at.z)) &&
           !(bumblebee && get<float>(p, at.z) <= 0);
  };
  try {
    AtomicFile file(file_name);
    Line line(decimals_);
    if (!bumblebee) {
      std::size_t count = 0;
      for (std::size_t i = 0; i < n; ++i)
        count += measured(&cloud.data[i * cloud.point_step]) ? 1 : 0;
      file.write(std::to_string(count) + '\n');
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint8_t* p = &cloud.data[i * cloud.point_step];
      const bool valid = measured(p);
      if (!valid && !(bumblebee && write_invalid_))
        continue;
      line.clear();
      for (const int offset : {at.x, at.y, at.z})
        line.real(valid ? get<float>(p, offset) : 0.0f);
      if (dialect == PTSDialect::xyzi || dialect == PTSDialect::xyzirgb)
        line.real(at.intensity >= 0 ? get<float>(p, at.intensity) : 0.0f);
      if (dialect != PTSDialect::xyz && dialect != PTSDialect::xyzi)
        line.color(at.color >= 0 ? get<std::uint32_t>(p, at.color) : 0);
      if (bumblebee) {
        // an organized cloud's index is its pixel, whatever its fields say
        const bool organized = cloud.height > 1;
        line.whole(organized ? static_cast<std::uint32_t>(i / cloud.width)
                             : get<std::uint32_t>(p, at.v));
        line.whole(organized ? static_cast<std::uint32_t>(i % cloud.width)
                             : get<std::uint32_t>(p, at.u));
      }
      file.write(line.end());
    }
    file.commit();
  }
  catch (const pcl::IOException& error) {
    return fail(error.what());
  }
  return 0;
}

int
savePTSFile(const std::string& file, const pcl::PCLPointCloud2& cloud)
{
  return PTSWriter().write(file, cloud);
}

} // namespace hoist
