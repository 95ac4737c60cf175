#include "viewer/cloud_handlers.h"

#include "palette.h"

#include <vtkFloatArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace hoist {
namespace {

namespace pv = pcl::visualization;
using Blob = pcl::PCLPointCloud2;

bool
drawn(const pcl::PointXYZRGB& p)
{
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// One byte colours of the points that are drawn.
vtkSmartPointer<vtkDataArray>
colorArray(const std::vector<cv::Scalar>& colors)
{
  auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(colors.size()));
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 3; ++c)
      array->SetComponent(static_cast<vtkIdType>(i), c, colors[i][2 - c]);
  return array;
}

// Points in the colour of the cuboid that they support, the others grey.
class ObjectHandler : public CloudHandler {
public:
  ObjectHandler(const Blob::ConstPtr& blob, const Scene& scene) : CloudHandler(blob)
  {
    const auto& points = scene.frame->loaded.cloud->points;
    std::vector<int> owners(points.size(), -1);
    for (std::size_t i = scene.result.cuboids.size(); i-- > 0;) // the best wins
      for (const pcl::index_t index : scene.result.cuboids[i].cuboid.indices)
        owners[static_cast<std::size_t>(index)] = static_cast<int>(i);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (drawn(points[i]))
        colors_.push_back(owners[i] < 0
                              ? cv::Scalar(90, 90, 90)
                              : cuboidColor(static_cast<std::size_t>(owners[i])));
    capable_ = true;
  }

  std::string
  getName() const override
  {
    return "ObjectHandler";
  }

  std::string
  getFieldName() const override
  {
    return "object";
  }

  vtkSmartPointer<vtkDataArray>
  getColor() const override
  {
    return colorArray(colors_);
  }

private:
  std::vector<cv::Scalar> colors_;
};

// A field of the file, through the lookup table that the key u shows. PCL's own takes
// the bits of whole numbers for those of a float.
class FieldHandler : public CloudHandler {
public:
  FieldHandler(const Blob::ConstPtr& blob, const Scene& scene, const FrameField& field)
  : CloudHandler(blob), name_(field.name)
  {
    constexpr float none = std::numeric_limits<float>::quiet_NaN(); // of no range
    const auto& points = scene.frame->loaded.cloud->points;
    for (std::size_t i = 0; i < std::min(points.size(), field.values.size()); ++i)
      if (drawn(points[i]))
        values_.push_back(std::isfinite(field.values[i]) ? field.values[i] : none);
    capable_ = true;
  }

  std::string
  getName() const override
  {
    return "FieldHandler";
  }

  std::string
  getFieldName() const override
  {
    return name_;
  }

  vtkSmartPointer<vtkDataArray>
  getColor() const override
  {
    auto array = vtkSmartPointer<vtkFloatArray>::New();
    array->SetNumberOfComponents(1);
    array->SetNumberOfTuples(static_cast<vtkIdType>(values_.size()));
    for (std::size_t i = 0; i < values_.size(); ++i)
      array->SetValue(static_cast<vtkIdType>(i), values_[i]);
    return array;
  }

private:
  std::string name_;
  std::vector<float> values_;
};

// Labels are names, not numbers: neighbours must not look alike.
class LabelHandler : public CloudHandler {
public:
  LabelHandler(const Blob::ConstPtr& blob, const Scene& scene, const FrameField& field)
  : CloudHandler(blob)
  {
    const auto& points = scene.frame->loaded.cloud->points;
    for (std::size_t i = 0; i < std::min(points.size(), field.values.size()); ++i)
      if (drawn(points[i]))
        colors_.push_back(colorOf(field.values[i]));
    capable_ = true;
  }

  std::string
  getName() const override
  {
    return "LabelHandler";
  }

  std::string
  getFieldName() const override
  {
    return "label";
  }

  vtkSmartPointer<vtkDataArray>
  getColor() const override
  {
    return colorArray(colors_);
  }

private:
  // 0 is no label for most programs
  static cv::Scalar
  colorOf(float label)
  {
    return label >= 1 && label < 1e9F ? cuboidColor(static_cast<std::size_t>(label) - 1)
                                      : cv::Scalar(90, 90, 90);
  }

  std::vector<cv::Scalar> colors_;
};

} // namespace

std::vector<CloudHandler::ConstPtr>
cloudHandlers(const Blob::ConstPtr& blob, const Scene& scene)
{
  std::vector<CloudHandler::ConstPtr> handlers;
  handlers.push_back(
      pcl::make_shared<pv::PointCloudColorHandlerCustom<Blob>>(blob, 200, 200, 200));
  for (const pcl::PCLPointField& field : blob->fields) {
    if (field.name == "rgb" || field.name == "rgba")
      handlers.push_back(
          pcl::make_shared<pv::PointCloudColorHandlerRGBField<Blob>>(blob));
    else if (field.name != "_")
      handlers.push_back(pcl::make_shared<pv::PointCloudColorHandlerGenericField<Blob>>(
          blob, field.name));
  }
  handlers.push_back(pcl::make_shared<ObjectHandler>(blob, scene));
  for (const FrameField& field : *scene.fields) {
    if (field.name == "label")
      handlers.push_back(pcl::make_shared<LabelHandler>(blob, scene, field));
    else
      handlers.push_back(pcl::make_shared<FieldHandler>(blob, scene, field));
  }
  return handlers;
}

} // namespace hoist
