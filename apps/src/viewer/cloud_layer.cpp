#include "viewer/cloud_layer.h"

#include "palette.h"

#include <pcl/conversions.h>
#include <pcl/visualization/pcl_visualizer.h>
#include <pcl/visualization/point_cloud_color_handlers.h>

#include <vtkLODActor.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hoist {
namespace {

namespace pv = pcl::visualization;
using Blob = pcl::PCLPointCloud2;
using Handler = pv::PointCloudColorHandler<Blob>;

constexpr const char* cloud_id = "cloud";

// Points in the colour of the cuboid that they support, the others grey.
class ObjectHandler : public Handler {
public:
  ObjectHandler(const Blob::ConstPtr& blob, const Scene& scene) : Handler(blob)
  {
    const auto& points = scene.frame->loaded.cloud->points;
    const std::size_t n = points.size();
    owners_.assign(n, -1);
    for (std::size_t i = scene.result.cuboids.size(); i-- > 0;) // the best wins
      for (const pcl::index_t index : scene.result.cuboids[i].cuboid.indices)
        owners_[static_cast<std::size_t>(index)] = static_cast<int>(i);
    // as all handlers do: only for the points that are drawn
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (std::isfinite(points[i].x) && std::isfinite(points[i].y) &&
          std::isfinite(points[i].z))
        owners_[drawn++] = owners_[i];
    owners_.resize(drawn);
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
    auto colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
    colors->SetNumberOfComponents(3);
    colors->SetNumberOfTuples(static_cast<vtkIdType>(owners_.size()));
    for (std::size_t i = 0; i < owners_.size(); ++i) {
      const cv::Scalar color = owners_[i] < 0
                                   ? cv::Scalar(90, 90, 90)
                                   : cuboidColor(static_cast<std::size_t>(owners_[i]));
      for (int c = 0; c < 3; ++c)
        colors->SetComponent(static_cast<vtkIdType>(i), c, color[2 - c]);
    }
    return colors;
  }

private:
  std::vector<int> owners_;
};

std::vector<Handler::ConstPtr>
handlersOf(const Blob::ConstPtr& blob, const Scene& scene)
{
  std::vector<Handler::ConstPtr> handlers;
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
  return handlers;
}

} // namespace

CloudLayer::CloudLayer(pv::PCLVisualizer& visualizer) : visualizer_(visualizer) {}

void
CloudLayer::remember()
{
  const auto& map = *visualizer_.getCloudActorMap();
  const auto found = map.find(cloud_id);
  if (found == map.end())
    return;
  if (found->second.color_handler_index_ != given_handler_) // a key has changed it
    handler_ = found->second.color_handler_index_;
  point_size_ = found->second.actor->GetProperty()->GetPointSize();
}

void
CloudLayer::clear()
{
  if (!shown_)
    return;
  remember();
  visualizer_.removePointCloud(cloud_id);
  shown_ = false;
}

void
CloudLayer::show(const Scene& scene)
{
  clear();
  if (!scene.frame)
    return;
  const auto& cloud = *scene.frame->loaded.cloud;
  const auto blob = pcl::make_shared<Blob>();
  pcl::toPCLPointCloud2(cloud, *blob);
  const Eigen::Vector4f origin = cloud.sensor_origin_;
  const Eigen::Quaternionf orientation = cloud.sensor_orientation_;
  const auto geometry = pcl::make_shared<pv::PointCloudGeometryHandlerXYZ<Blob>>(blob);
  const std::vector<Handler::ConstPtr> handlers = handlersOf(blob, scene);
  for (const Handler::ConstPtr& handler : handlers)
    visualizer_.addPointCloud(blob, geometry, handler, origin, orientation, cloud_id);
  shown_ = true;
  constexpr int gray = 0, rgb = 4;
  const int wanted =
      handler_ >= 0 ? handler_ : (scene.frame->loaded.has_color ? rgb : gray);
  given_handler_ = std::min(wanted, static_cast<int>(handlers.size()) - 1);
  visualizer_.updateColorHandlerIndex(cloud_id, given_handler_);
  visualizer_.setPointCloudRenderingProperties(
      pv::PCL_VISUALIZER_POINT_SIZE, point_size_, cloud_id);
  setVisible(visible_);
}

void
CloudLayer::setPointSize(double pixels)
{
  point_size_ = std::clamp(pixels, 1.0, 20.0);
  if (shown_)
    visualizer_.setPointCloudRenderingProperties(
        pv::PCL_VISUALIZER_POINT_SIZE, point_size_, cloud_id);
}

void
CloudLayer::setVisible(bool visible)
{
  visible_ = visible;
  const auto& map = *visualizer_.getCloudActorMap();
  const auto found = map.find(cloud_id);
  if (found != map.end())
    found->second.actor->SetVisibility(visible ? 1 : 0);
}

} // namespace hoist
