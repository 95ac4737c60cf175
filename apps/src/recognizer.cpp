#include "recognizer.h"

#include "failures.h"
#include "overlay.h"

#include <hoist/filters/edge_pixels.h>
#include <hoist/filters/white_balance.h>
#include <hoist/recognition/cuboid_feature_extraction.h>

namespace hoist {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

pcl::IndicesPtr
indicesOf(const cv::Rect& region, const Cloud& cloud)
{
  const cv::Rect frame(
      0, 0, static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  const cv::Rect part = region & frame;
  if (part.empty())
    throw UsageError("the region --roi lies outside the frame of " +
                     std::to_string(frame.width) + " x " +
                     std::to_string(frame.height) + " pixels");
  auto indices = pcl::make_shared<pcl::Indices>();
  for (int v = part.y; v < part.br().y; ++v)
    for (int u = part.x; u < part.br().x; ++u)
      indices->push_back(v * frame.width + u);
  return indices;
}

} // namespace

Frame
openFrame(const std::string& file)
{
  Frame frame;
  frame.loaded = loadFrame(file);
  frame.images = pcl::make_shared<FrameImages>();
  toFrameImages(*frame.loaded.cloud, *frame.images);
  if (!frame.loaded.has_color) {
    frame.images->bgr.release();
    frame.images->gray.release();
  }
  return frame;
}

Recognizer::Recognizer(const RecognizeSettings& settings) : settings_(settings)
{
  segmentation_.setMode(settings.mode == "paper" ? SegmentationMode::paper
                                                 : SegmentationMode::full);
  segmentation_.setFullParameters(settings.full);
  segmentation_.setPaperParameters(settings.paper);
}

FrameResult
Recognizer::recognize(const Frame& frame, const std::string& scene)
{
  FrameResult result;
  result.scene = scene;
  result.mode = settings_.mode;
  result.width = frame.images->width();
  result.height = frame.images->height();
  result.intrinsics = frame.images->intrinsics;
  result.pose = frame.loaded.pose;
  result.pose_known = frame.loaded.pose_known;

  segmentation_.setInputCloud(frame.loaded.cloud);
  segmentation_.setFrameImages(frame.images);
  segmentation_.setIndices(settings_.region.empty()
                               ? pcl::IndicesPtr()
                               : indicesOf(settings_.region, *frame.loaded.cloud));
  if (settings_.mode == "paper" && !frame.images->hasColor())
    throw FileError(scene + ": the paper mode needs colour, and the frame has none");
  if (settings_.mode == "full" && !frame.images->intrinsics.valid())
    throw FileError(scene + ": the points do not fit a camera (too few, or not a "
                            "pinhole's), so pixels cannot be lifted");
  std::vector<Cuboid> cuboids;
  if (!segmentation_.segment(cuboids))
    throw FileError(scene + ": the frame cannot be segmented");
  result.diagnostics = segmentation_.getDiagnostics();

  CuboidFeatureExtraction<pcl::PointXYZRGB> extraction;
  extraction.setInputCloud(balanced(frame));
  extraction.setCuboids(cuboids);
  extraction.setMaterial(settings_.material);
  if (frame.loaded.pose_known) // the world's z is up
    extraction.setUpDirection(frame.loaded.pose.linear().transpose() *
                              Eigen::Vector3d::UnitZ());
  std::vector<CuboidFeatures> features;
  extraction.compute(features);
  for (std::size_t i = 0; i < cuboids.size(); ++i) {
    if (!frame.loaded.has_color)
      features[i].color_name.clear(); // black is a colour, none is not
    result.cuboids.push_back({cuboids[i], features[i]});
  }
  return result;
}

Cloud::ConstPtr
Recognizer::balanced(const Frame& frame) const
{
  if (settings_.white_balance == "none" || !frame.loaded.has_color)
    return frame.loaded.cloud;
  WhiteBalance<pcl::PointXYZRGB> balance;
  balance.setMethod(settings_.white_balance == "grey-world"
                        ? WhiteBalanceMethod::grey_world
                        : WhiteBalanceMethod::white_patch);
  balance.setInputCloud(frame.loaded.cloud);
  auto cloud = pcl::make_shared<Cloud>();
  balance.filter(*cloud);
  return cloud;
}

cv::Mat1b
Recognizer::edgeKinds(const Frame& frame) const
{
  if (settings_.mode == "paper") { // the contours that it worked with
    const int width = frame.images->width();
    cv::Mat1b kinds(
        frame.images->height(), width, static_cast<unsigned char>(EDGE_NONE));
    for (const pcl::index_t i : segmentation_.getEdgePixels())
      kinds(i / width, i % width) = EDGE_COLOR;
    return kinds;
  }
  EdgePixels<pcl::PointXYZRGB> edges;
  edges.setInputCloud(frame.loaded.cloud);
  edges.setFrameImages(frame.images);
  edges.setSensorModel(settings_.full.sensor);
  if (!frame.images->hasColor())
    edges.setKinds(EDGE_OCCLUSION | EDGE_CREASE);
  pcl::Indices indices;
  edges.filter(indices);
  return edges.getKindImage().clone();
}

cv::Mat3b
Recognizer::overlay(const Frame& frame, const FrameResult& result) const
{
  return drawOverlay({*frame.images,
                      result,
                      edgeKinds(frame),
                      segmentation_.getSegments(),
                      segmentation_.getVertices()});
}

} // namespace hoist
