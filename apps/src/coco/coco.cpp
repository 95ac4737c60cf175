#include "coco/fit_box.h"
#include "commands.h"
#include "failures.h"
#include "png.h"
#include "validators.h"

#include <hoist/data/annotation.h>
#include <hoist/data/coco.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <utility>

namespace hoist {
namespace {

namespace fs = std::filesystem;

const char* const footer =
    "\n"
    "Writes DIR/<name>.json and DIR/<name>.instances.png for every image that has a "
    "depth "
    "image\nDEPTH_DIR/<name>.png, 16 bits, registered to it. Boxes are those around "
    "the "
    "points that are\nseen: what is hidden of a thing is not in its box.\n"
    "Exit codes: 0 done; 1 a file is broken or cannot be written; 2 unknown option, "
    "bad "
    "value,\nmissing file, or no image has depth.\n"
    "Example: hoist coco instances.json depth -o truth --camera 525,525,319.5,239.5\n";

struct CocoSettings {
  std::string annotations;
  std::string depth;
  std::string images;
  std::string output;
  std::vector<double> camera;
  double depth_scale = 0.001;
  std::vector<double> up = {0, -1, 0};
  int min_pixels = 50;
};

struct Outline {
  const CocoAnnotation* annotation;
  cv::Mat1b mask;
};

std::string
nameOf(const CocoImage& image)
{
  return fs::path(image.file_name).stem().string();
}

cv::Mat1f
readDepth(const fs::path& file, const CocoImage& image, double scale)
{
  const cv::Mat raw = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (raw.empty() || raw.type() != CV_16UC1)
    throw FileError(file.string() + ": expected a PNG of one channel and 16 bits");
  if (raw.cols != image.width || raw.rows != image.height)
    throw FileError(fmt::format("{}: expected {} x {} pixels as the image has, found "
                                "{} x {}",
                                file.string(),
                                image.width,
                                image.height,
                                raw.cols,
                                raw.rows));
  cv::Mat1f depth;
  raw.convertTo(depth, CV_32F, scale);
  depth.setTo(std::numeric_limits<float>::quiet_NaN(), raw == 0);
  return depth;
}

// Large ones first, so that what lies on or before them keeps its pixels.
std::vector<Outline>
outlinesOf(const CocoImage& image)
{
  std::vector<Outline> outlines;
  for (const CocoAnnotation& annotation : image.annotations)
    if (!annotation.crowd)
      outlines.push_back(
          {&annotation, cocoMask(annotation, image.width, image.height)});
  std::stable_sort(outlines.begin(), outlines.end(), [](const auto& a, const auto& b) {
    return cv::countNonZero(a.mask) > cv::countNonZero(b.mask);
  });
  return outlines;
}

std::string
relativeTo(const fs::path& file, const std::string& folder)
{
  std::error_code error;
  const fs::path relative = fs::relative(file, folder, error);
  return error || relative.empty() ? fs::absolute(file).generic_string()
                                   : relative.generic_string();
}

class Converter {
public:
  explicit Converter(const CocoSettings& settings) : settings_(settings)
  {
    camera_.fx = settings.camera[0];
    camera_.fy = settings.camera[1];
    camera_.cx = settings.camera[2];
    camera_.cy = settings.camera[3];
    up_ = Eigen::Vector3d(settings.up[0], settings.up[1], settings.up[2]).normalized();
  }

  void
  convert(const CocoImage& image, const fs::path& depth_file)
  {
    const cv::Mat1f depth = readDepth(depth_file, image, settings_.depth_scale);
    const std::vector<Outline> outlines = outlinesOf(image);
    if (outlines.size() > 65535)
      throw FileError(settings_.annotations + ": more than 65535 things in " +
                      image.file_name);
    cv::Mat1w instances(image.height, image.width, std::uint16_t(0));
    for (std::size_t i = 0; i < outlines.size(); ++i)
      instances.setTo(static_cast<double>(i + 1), outlines[i].mask);

    FrameAnnotation out;
    const std::string name = nameOf(image);
    out.scene = name;
    out.width = image.width;
    out.height = image.height;
    out.intrinsics = camera_;
    out.depth_scale = settings_.depth_scale;
    out.files.depth = relativeTo(depth_file, settings_.output);
    const fs::path color = fs::path(settings_.images) / image.file_name;
    if (fs::exists(color))
      out.files.color = relativeTo(color, settings_.output);
    out.files.instances = name + ".instances.png";
    for (std::size_t i = 0; i < outlines.size(); ++i)
      addObject(static_cast<int>(i + 1),
                *outlines[i].annotation,
                instances == static_cast<double>(i + 1),
                depth,
                out);

    const fs::path folder(settings_.output);
    savePng((folder / out.files.instances).string(), instances);
    saveAnnotation(folder / (name + ".json"), out);
    objects_ += out.objects.size();
    without_box_ += out.other_objects.size();
    ++frames_;
  }

  void
  report(std::size_t without_depth) const
  {
    fmt::print("{} frame{} with {} thing{} in {}\n",
               frames_,
               frames_ == 1 ? "" : "s",
               objects_,
               objects_ == 1 ? "" : "s",
               settings_.output);
    if (without_box_ > 0)
      fmt::print("{} without enough depth for a box\n", without_box_);
    if (without_depth > 0)
      fmt::print("{} image{} without depth left out\n",
                 without_depth,
                 without_depth == 1 ? "" : "s");
  }

private:
  void
  addObject(int label,
            const CocoAnnotation& annotation,
            const cv::Mat1b& mask,
            const cv::Mat1f& depth,
            FrameAnnotation& out) const
  {
    const int pixels = cv::countNonZero(mask);
    std::optional<OrientedBox> box;
    if (pixels >= settings_.min_pixels)
      box = uprightBox(pointsOf(mask, depth, camera_), up_);
    if (!box) {
      out.other_objects.push_back({label, annotation.category, {}, ""});
      return;
    }
    AnnotatedObject object;
    object.label = label;
    object.object_class = annotation.category;
    object.is_cuboid = false;
    object.center = box->center;
    object.size = box->size;
    object.rotation = box->axes;
    const cv::Rect seen = cv::boundingRect(mask);
    object.box_2d = {
        double(seen.x), double(seen.y), double(seen.width), double(seen.height)};
    object.visible_pixels = pixels;
    object.material = annotation.material;
    object.base_rgb = annotation.rgb;
    object.fullness = annotation.fullness;
    object.weight = annotation.weight;
    object.extra = R"({"box_source":"visible points"})";
    out.objects.push_back(object);
  }

  const CocoSettings& settings_;
  Intrinsics camera_;
  Eigen::Vector3d up_;
  std::size_t frames_ = 0, objects_ = 0, without_box_ = 0;
};

int
run(CocoSettings settings)
{
  if (settings.camera[0] <= 0 || settings.camera[1] <= 0)
    throw UsageError("--camera: fx and fy must be above 0");
  if (Eigen::Vector3d(settings.up[0], settings.up[1], settings.up[2]).norm() < 1e-9)
    throw UsageError("--up: 0,0,0 is no direction");
  if (settings.images.empty())
    settings.images = fs::path(settings.annotations).parent_path().string();
  const std::vector<CocoImage> images = loadCoco(settings.annotations);
  std::vector<std::pair<const CocoImage*, fs::path>> frames;
  std::map<std::string, int> names;
  for (const CocoImage& image : images) {
    const fs::path depth = fs::path(settings.depth) / (nameOf(image) + ".png");
    if (!fs::exists(depth))
      continue;
    if (++names[nameOf(image)] > 1)
      throw UsageError("two images are named " + nameOf(image) + " in " +
                       settings.annotations);
    frames.emplace_back(&image, depth);
  }
  if (frames.empty())
    throw UsageError("no image of " + settings.annotations + " has depth in " +
                     settings.depth);
  std::error_code error;
  fs::create_directories(settings.output, error);
  if (!fs::is_directory(settings.output))
    throw FileError(settings.output + ": cannot be made" +
                    (error ? ": " + error.message() : ""));
  Converter converter(settings);
  for (const auto& [image, depth] : frames)
    converter.convert(*image, depth);
  converter.report(images.size() - frames.size());
  return exit_ok;
}

} // namespace

Action
addCocoCommand(CLI::App& program)
{
  CLI::App* command = program.add_subcommand(
      "coco", "Make annotations from COCO outlines of images that have depth");
  auto settings = std::make_shared<CocoSettings>();
  CocoSettings& s = *settings;
  command->add_option("ANNOTATIONS", s.annotations, "COCO file of instances (JSON)")
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("");
  command->add_option("DEPTH_DIR", s.depth, "Folder of the depth images")
      ->required()
      ->check(CLI::ExistingDirectory)
      ->type_name("");
  command->add_option("-o,--output", s.output, "Folder for the annotations")
      ->required()
      ->type_name("DIR");
  command->add_option("--camera", s.camera, "fx,fy,cx,cy of the images, in pixels")
      ->required()
      ->delimiter(',')
      ->expected(4)
      ->check(numberIn(-1e6, 1e6))
      ->type_name("LIST");
  command
      ->add_option(
          "--depth-scale", s.depth_scale, "Metres per unit of the depth images")
      ->check(numberIn(1e-9, 1e3))
      ->type_name("M")
      ->capture_default_str();
  command
      ->add_option(
          "--up", s.up, "x,y,z of up in the camera frame (x right, y down, z forward)")
      ->delimiter(',')
      ->expected(3)
      ->check(numberIn(-1e6, 1e6))
      ->type_name("LIST")
      ->capture_default_str();
  command
      ->add_option(
          "--images", s.images, "Folder of the images; default: that of ANNOTATIONS")
      ->type_name("DIR");
  command
      ->add_option("--min-pixels", s.min_pixels, "Things with fewer pixels get no box")
      ->check(integerIn(1, 1000000))
      ->type_name("N")
      ->capture_default_str();
  command->footer(footer);
  return [settings] { return run(*settings); };
}

} // namespace hoist
