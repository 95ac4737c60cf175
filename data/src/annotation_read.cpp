#include "json_fields.h"

#include <hoist/data/annotation.h>

namespace hoist {
namespace {

using json::Fields;
using json::Value;

template <typename Enum>
Enum
wordOf(const Value& value, Enum last)
{
  const std::string text = value.text();
  std::string words;
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    const char* const word = toString(static_cast<Enum>(i));
    if (text == word)
      return static_cast<Enum>(i);
    words += (i == 0 ? "\"" : ", \"") + std::string(word) + '"';
  }
  value.fail("one of " + words);
}

Eigen::Vector3d
sizeOf(const Value& value)
{
  const Eigen::Vector3d size = value.vector();
  if (size.minCoeff() <= 0)
    value.failWith("expected three positive numbers, found one that is not");
  return size;
}

int
labelOf(Fields& fields)
{
  const auto label = fields.get("label");
  return label ? static_cast<int>(label->integerIn(0, 65535)) : 0;
}

void
readVisibility(Fields& fields, AnnotatedObject& object)
{
  if (const auto box = fields.get("box_2d")) {
    const auto entries = box->items(4, "left, top, width and height in pixels");
    object.box_2d = {entries[0].number(),
                     entries[1].number(),
                     entries[2].numberFrom(0),
                     entries[3].numberFrom(0)};
  }
  if (const auto fraction = fields.get("visible_fraction"))
    object.visible_fraction = fraction->numberIn(0, 1);
  if (const auto pixels = fields.get("visible_pixels"))
    object.visible_pixels = pixels->integerIn(0, std::int64_t(1) << 40);
  if (const auto faces = fields.get("faces_visible"))
    object.faces_visible = static_cast<int>(faces->integerIn(0, 6));
  if (const auto faces = fields.get("observed_faces")) {
    const auto entries = faces->items(6, "six of true and false");
    object.observed_faces.emplace();
    for (std::size_t i = 0; i < 6; ++i)
      (*object.observed_faces)[i] = entries[i].boolean();
  }
}

void
readAttributes(Fields& fields, AnnotatedObject& object)
{
  object.material = fields.textOr("material");
  if (const auto rgb = fields.get("base_rgb")) {
    const auto entries = rgb->items(3, "red, green and blue from 0 to 255");
    object.base_rgb.emplace();
    for (std::size_t i = 0; i < 3; ++i)
      (*object.base_rgb)[i] = static_cast<int>(entries[i].integerIn(0, 255));
  }
  if (const auto fullness = fields.get("fullness"))
    object.fullness = fullness->boolean();
  if (const auto weight = fields.get("weight"))
    object.weight = weight->numberFrom(0);
  object.global_id = fields.textOr("global_id");
}

AnnotatedObject
readObject(const Value& value, bool is_cuboid)
{
  Fields fields(value);
  AnnotatedObject object;
  object.label = labelOf(fields);
  object.object_class = fields.textOr("class");
  const auto shape = fields.get("is_cuboid");
  object.is_cuboid = shape ? shape->boolean() : is_cuboid;
  object.center = fields.at("center").vector();
  object.size = sizeOf(fields.at("size"));
  object.rotation = fields.at("rotation").orthonormal();
  if (const auto symmetry = fields.get("symmetry"))
    object.symmetry = wordOf(*symmetry, ObjectSymmetry::axis2);
  if (const auto pose = fields.get("pose"))
    object.pose = pose->pose();
  if (const auto difficult = fields.get("difficult"))
    object.difficult = difficult->boolean();
  if (const auto reasons = fields.get("difficult_reasons"))
    for (const Value& reason : reasons->items())
      object.difficult_reasons.push_back(reason.text());
  readVisibility(fields, object);
  readAttributes(fields, object);
  if (const auto status = fields.get("status"))
    object.status = wordOf(*status, ObjectStatus::removed);
  if (const auto pose = fields.get("moved_from"))
    object.moved_from = pose->pose();
  object.extra = fields.rest();
  return object;
}

OtherObject
readOther(const Value& value)
{
  Fields fields(value);
  OtherObject object;
  object.label = labelOf(fields);
  object.kind = fields.textOr("kind");
  if (const auto center = fields.get("center"))
    object.center = center->vector();
  object.extra = fields.rest();
  return object;
}

void
readCamera(Fields& fields, FrameAnnotation& out)
{
  if (const auto camera = fields.get("intrinsics")) {
    Fields numbers(*camera);
    out.intrinsics.fx = numbers.at("fx").numberFrom(0);
    out.intrinsics.fy = numbers.at("fy").numberFrom(0);
    out.intrinsics.cx = numbers.at("cx").number();
    out.intrinsics.cy = numbers.at("cy").number();
  }
  if (const auto distortion = fields.get("distortion")) {
    for (const Value& entry : distortion->items())
      out.distortion.push_back(entry.number());
    const std::size_t n = out.distortion.size();
    if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14)
      distortion->fail("4, 5, 8, 12 or 14 numbers, k1 k2 p1 p2 k3 ...");
  }
  if (const auto pose = fields.get("pose"))
    out.pose = pose->pose();
  if (const auto pose = fields.get("registration"))
    out.registration = pose->pose();
  if (const auto plane = fields.get("support_plane")) {
    const auto entries = plane->items(4, "four numbers a b c d");
    out.support_plane = Eigen::Vector4d(entries[0].number(),
                                        entries[1].number(),
                                        entries[2].number(),
                                        entries[3].number());
  }
}

void
readSensor(Fields& fields, FrameAnnotation& out)
{
  if (const auto width = fields.get("width"))
    out.width = static_cast<int>(width->integerIn(0, 1 << 20));
  if (const auto height = fields.get("height"))
    out.height = static_cast<int>(height->integerIn(0, 1 << 20));
  out.sensor = fields.textOr("sensor");
  if (const auto baseline = fields.get("baseline"))
    out.baseline = baseline->numberFrom(0);
  if (const auto seed = fields.get("seed"))
    out.seed = seed->natural();
}

void
readFiles(Fields& fields, FrameAnnotation& out)
{
  if (const auto files = fields.get("files")) {
    Fields names(*files);
    out.files.cloud = names.textOr("cloud");
    out.files.color = names.textOr("color");
    out.files.depth = names.textOr("depth");
    out.files.instances = names.textOr("instances");
    out.files.extra = names.rest();
  }
  if (const auto scale = fields.get("depth_scale"))
    out.depth_scale = scale->numberFrom(0);
}

void
readSequence(Fields& fields, FrameAnnotation& out)
{
  out.sequence = fields.textOr("sequence");
  if (const auto visit = fields.get("visit"))
    out.visit = static_cast<int>(visit->integerIn(1, 1 << 30));
  if (const auto index = fields.get("index"))
    out.index = static_cast<int>(index->integerIn(0, 1 << 30));
  if (const auto time = fields.get("time"))
    out.time = time->number();
}

void
readList(Fields& fields,
         const char* key,
         bool is_cuboid,
         std::vector<AnnotatedObject>& list)
{
  if (const auto entries = fields.get(key))
    for (const Value& entry : entries->items())
      list.push_back(readObject(entry, is_cuboid));
}

// Pixels of an image of instances have one owner.
void
checkLabels(const FrameAnnotation& annotation, const Value& root)
{
  std::set<int> seen;
  const auto check = [&](int label) {
    if (label != 0 && !seen.insert(label).second)
      root.failWith("label " + std::to_string(label) + " is given to two objects");
  };
  for (const AnnotatedObject& object : annotation.objects)
    check(object.label);
  for (const OtherObject& object : annotation.other_objects)
    check(object.label);
}

} // namespace

FrameAnnotation
annotationFromJson(const std::string& text, const std::string& name)
{
  const json::Json parsed = json::parse(text, name);
  const Value root(parsed, "", name);
  Fields fields(root);
  if (const auto format = fields.get("format"))
    if (format->text() != "hoist annotation")
      format->fail("\"hoist annotation\"");
  if (const auto version = fields.get("version"))
    if (version->integerIn(1, 1 << 30) > 1)
      version->failWith("version " + std::to_string(version->integerIn(1, 1 << 30)) +
                        " is newer than what this program reads, 1");
  if (!fields.get("cuboids") && !fields.get("objects"))
    root.failWith("no annotation: neither \"cuboids\" nor \"objects\" is in it");

  FrameAnnotation out;
  out.scene = fields.textOr("scene");
  readSensor(fields, out);
  readCamera(fields, out);
  readFiles(fields, out);
  readSequence(fields, out);
  readList(fields, "cuboids", true, out.objects);
  readList(fields, "objects", false, out.objects);
  readList(fields, "removed", true, out.removed);
  if (const auto others = fields.get("other_objects"))
    for (const Value& entry : others->items())
      out.other_objects.push_back(readOther(entry));
  checkLabels(out, root);
  out.extra = fields.rest();
  return out;
}

FrameAnnotation
loadAnnotation(const std::filesystem::path& file)
{
  FrameAnnotation out = annotationFromJson(json::readText(file), file.string());
  if (out.scene.empty())
    out.scene = file.stem().string();
  return out;
}

} // namespace hoist
