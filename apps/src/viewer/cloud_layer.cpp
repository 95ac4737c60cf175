#include "viewer/cloud_layer.h"

#include "viewer/cloud_handlers.h"

#include <pcl/conversions.h>
#include <pcl/visualization/pcl_visualizer.h>
#include <pcl/visualization/point_cloud_color_handlers.h>

#include <vtkLODActor.h>
#include <vtkProperty.h>

#include <algorithm>
#include <vector>

namespace hoist {
namespace {

namespace pv = pcl::visualization;
using Blob = pcl::PCLPointCloud2;

constexpr const char* cloud_id = "cloud";

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
  const std::vector<CloudHandler::ConstPtr> handlers = cloudHandlers(blob, scene);
  for (const CloudHandler::ConstPtr& handler : handlers)
    visualizer_.addPointCloud(blob, geometry, handler, origin, orientation, cloud_id);
  shown_ = true;
  constexpr int gray = 0, rgb = 4;
  const bool known = handler_ >= 0 && handler_ < static_cast<int>(handlers.size());
  given_handler_ = known ? handler_ : (scene.frame->loaded.has_color ? rgb : gray);
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
