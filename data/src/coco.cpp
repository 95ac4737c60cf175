#include "json_fields.h"

#include <hoist/data/coco.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace hoist {
namespace {

using json::Fields;
using json::Value;

constexpr int max_side = 1 << 15;

// COCO's compressed run lengths: five bits a character from 48 on, the sixth says that
// more follow; from the third run on the difference to the run before the last one.
std::vector<std::uint32_t>
unpacked(const Value& value)
{
  std::vector<std::uint32_t> runs;
  const std::string text = value.text();
  std::size_t i = 0;
  while (i < text.size()) {
    std::int64_t number = 0;
    int shift = 0;
    bool more = true;
    while (more) {
      if (i >= text.size() || shift > 35 || text[i] < 48 || text[i] > 111)
        value.failWith("no run lengths as COCO packs them");
      const std::int64_t bits = text[i++] - 48;
      number |= (bits & 31) << shift;
      shift += 5;
      more = (bits & 32) != 0;
      if (!more && (bits & 16) != 0)
        number |= -(std::int64_t(1) << shift); // the sign
    }
    if (runs.size() > 2)
      number += runs[runs.size() - 2];
    if (number < 0 || number > std::int64_t(max_side) * max_side)
      value.failWith("a run length is out of range");
    runs.push_back(static_cast<std::uint32_t>(number));
  }
  return runs;
}

void
readRuns(const Value& value, const CocoImage& image, CocoAnnotation& out)
{
  Fields fields(value);
  const auto size = fields.at("size").items(2, "height and width");
  if (size[0].integerIn(0, max_side) != image.height ||
      size[1].integerIn(0, max_side) != image.width)
    fields.at("size").failWith("is not the image's: expected " +
                               std::to_string(image.height) + " and " +
                               std::to_string(image.width));
  const Value counts = fields.at("counts");
  if (counts.json().is_string())
    out.runs = unpacked(counts);
  else
    for (const Value& run : counts.items())
      out.runs.push_back(static_cast<std::uint32_t>(
          run.integerIn(0, std::int64_t(max_side) * max_side)));
}

void
readOutline(const Value& value, const CocoImage& image, CocoAnnotation& out)
{
  if (value.json().is_object()) {
    readRuns(value, image, out);
    return;
  }
  for (const Value& polygon : value.items()) {
    const std::vector<Value> entries = polygon.items();
    if (entries.size() % 2 != 0 || entries.size() < 6)
      polygon.fail("x0 y0 x1 y1 x2 y2 ... of three corners or more");
    out.polygons.emplace_back();
    for (const Value& entry : entries)
      out.polygons.back().push_back(entry.numberIn(-1e6, 1e6));
  }
}

// "#a0b1c2" or three numbers.
std::array<int, 3>
colorOf(const Value& value)
{
  std::array<int, 3> rgb{};
  if (value.json().is_string()) {
    const std::string text = value.text();
    if (text.size() != 7 || text[0] != '#' ||
        text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
      value.fail("a colour like \"#a0b1c2\" or three numbers from 0 to 255");
    for (std::size_t i = 0; i < 3; ++i)
      rgb[i] = std::stoi(text.substr(1 + 2 * i, 2), nullptr, 16);
    return rgb;
  }
  const auto entries = value.items(3, "a colour like \"#a0b1c2\" or three numbers");
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<int>(entries[i].integerIn(0, 255));
  return rgb;
}

// Tools write yes and no as true and false or as 1 and 0.
bool
yesNo(const Value& value)
{
  return value.json().is_boolean() ? value.boolean() : value.integerIn(0, 1) != 0;
}

void
readAttributes(Fields& fields, CocoAnnotation& out)
{
  out.material = fields.textOr("material", out.material);
  for (const char* const key : {"color", "rgb", "base_rgb"})
    if (const auto color = fields.get(key))
      out.rgb = colorOf(*color);
  if (const auto fullness = fields.get("fullness"))
    out.fullness = yesNo(*fullness);
  if (const auto weight = fields.get("weight"))
    out.weight = weight->numberFrom(0);
}

std::int64_t
idOf(Fields& fields, const char* key)
{
  constexpr std::int64_t most = std::int64_t(1) << 62;
  return fields.at(key).integerIn(-most, most);
}

CocoAnnotation
readAnnotation(Fields& fields,
               const CocoImage& image,
               const std::map<std::int64_t, std::string>& categories)
{
  CocoAnnotation out;
  if (fields.get("id"))
    out.id = idOf(fields, "id");
  const auto category = categories.find(idOf(fields, "category_id"));
  if (category == categories.end())
    fields.at("category_id").failWith("no such category");
  out.category = category->second;
  if (const auto crowd = fields.get("iscrowd"))
    out.crowd = yesNo(*crowd);
  if (const auto outline = fields.get("segmentation"))
    readOutline(*outline, image, out);
  if (const auto box = fields.get("bbox")) {
    const auto entries = box->items(4, "left, top, width and height");
    out.bbox.emplace();
    for (std::size_t i = 0; i < 4; ++i)
      (*out.bbox)[i] = entries[i].numberIn(i < 2 ? -1e6 : 0, 1e6);
  }
  readAttributes(fields, out);
  if (const auto attributes = fields.get("attributes")) {
    Fields inner(*attributes);
    readAttributes(inner, out);
  }
  return out;
}

void
fillPolygon(const std::vector<double>& corners, cv::Mat1b& mask)
{
  const std::size_t n = corners.size() / 2;
  std::vector<double> crossings;
  for (int v = 0; v < mask.rows; ++v) {
    const double y = v + 0.5;
    crossings.clear();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const double x0 = corners[2 * i], y0 = corners[2 * i + 1];
      const double x1 = corners[2 * j], y1 = corners[2 * j + 1];
      if ((y0 <= y) != (y1 <= y))
        crossings.push_back(x0 + (y - y0) / (y1 - y0) * (x1 - x0));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const auto limit = static_cast<double>(mask.cols);
      const int from =
          static_cast<int>(std::clamp(std::ceil(crossings[i] - 0.5), 0.0, limit));
      const int to =
          static_cast<int>(std::clamp(std::ceil(crossings[i + 1] - 0.5), 0.0, limit));
      for (int u = from; u < to; ++u)
        mask(v, u) = 255;
    }
  }
}

} // namespace

std::vector<CocoImage>
cocoFromJson(const std::string& text, const std::string& name)
{
  const json::Json parsed = json::parse(text, name);
  Fields root(Value(parsed, "", name));
  std::map<std::int64_t, std::string> categories;
  for (const Value& entry : root.at("categories").items()) {
    Fields fields(entry);
    categories[idOf(fields, "id")] = fields.at("name").text();
  }
  std::vector<CocoImage> images;
  std::map<std::int64_t, std::size_t> by_id;
  for (const Value& entry : root.at("images").items()) {
    Fields fields(entry);
    CocoImage image;
    image.id = idOf(fields, "id");
    image.file_name = fields.at("file_name").text();
    image.width = static_cast<int>(fields.at("width").integerIn(1, max_side));
    image.height = static_cast<int>(fields.at("height").integerIn(1, max_side));
    if (!by_id.emplace(image.id, images.size()).second)
      fields.at("id").failWith("two images have it");
    images.push_back(std::move(image));
  }
  for (const Value& entry : root.at("annotations").items()) {
    Fields fields(entry);
    const auto image = by_id.find(idOf(fields, "image_id"));
    if (image == by_id.end())
      fields.at("image_id").failWith("no such image");
    CocoImage& owner = images[image->second];
    owner.annotations.push_back(readAnnotation(fields, owner, categories));
  }
  return images;
}

std::vector<CocoImage>
loadCoco(const std::filesystem::path& file)
{
  return cocoFromJson(json::readText(file), file.string());
}

cv::Mat1b
cocoMask(const CocoAnnotation& annotation, int width, int height)
{
  cv::Mat1b mask(height, width, uchar(0));
  const std::size_t all = static_cast<std::size_t>(width) * height;
  std::size_t position = 0;
  bool inside = false;
  for (const std::uint32_t run : annotation.runs) {
    const std::size_t end = std::min(all, position + run);
    for (; position < end; ++position)
      if (inside)
        mask(static_cast<int>(position % height), static_cast<int>(position / height)) =
            255;
    inside = !inside;
  }
  for (const std::vector<double>& polygon : annotation.polygons)
    fillPolygon(polygon, mask);
  if (annotation.runs.empty() && annotation.polygons.empty() && annotation.bbox) {
    const auto& [left, top, w, h] = *annotation.bbox;
    fillPolygon({left, top, left + w, top, left + w, top + h, left, top + h}, mask);
  }
  return mask;
}

} // namespace hoist
