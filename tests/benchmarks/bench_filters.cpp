// Cost of the filters against the number of pixels, beside PCL's own edge detector.
// Everything runs on one thread.

#include <hoist/filters/edge_pixels.h>
#include <hoist/filters/organize_by_pixel.h>
#include <hoist/filters/region_crop.h>
#include <hoist/filters/white_balance.h>

#include <samples/generate.h>
#include <samples/render.h>

#include <pcl/common/io.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/features/organized_edge_detection.h>

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>

#include <map>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

// A table with six printed boxes, Kinect noise; width x width * 3 / 4.
Cloud::ConstPtr
scene(int width)
{
  static std::map<int, Cloud::ConstPtr> rendered;
  Cloud::ConstPtr& cloud = rendered[width];
  if (!cloud) {
    hoist::samples::RandomTableOptions options;
    options.width = width;
    options.height = width * 3 / 4;
    hoist::samples::Scene table = hoist::samples::randomTableScene(5, 6, options);
    for (auto& box : table.boxes)
      box.texture = hoist::samples::Texture::print;
    cloud = pcl::make_shared<Cloud>(hoist::samples::render(table).cloud);
  }
  return cloud;
}

const hoist::FrameImages&
images(int width)
{
  static std::map<int, hoist::FrameImages> converted;
  hoist::FrameImages& frame = converted[width];
  if (frame.points.empty())
    hoist::toFrameImages(*scene(width), frame);
  return frame;
}

void
finish(benchmark::State& state)
{
  const double pixels = static_cast<double>(state.range(0) * state.range(0)) * 3 / 4;
  state.counters["pixels/s"] =
      benchmark::Counter(pixels, benchmark::Counter::kIsIterationInvariantRate);
}

void
cannyImproved(benchmark::State& state)
{
  const auto& frame = images(static_cast<int>(state.range(0)));
  hoist::Canny canny;
  cv::Mat1b edges;
  for (auto _ : state) {
    canny.setImage(frame.gray);
    canny.detect({}, edges);
  }
  state.counters["edge pixels"] = cv::countNonZero(edges);
  finish(state);
}

void
cannyWithTexture(benchmark::State& state)
{
  const auto& frame = images(static_cast<int>(state.range(0)));
  hoist::Canny canny;
  hoist::CannyParameters parameters;
  parameters.remove_texture = false;
  cv::Mat1b edges;
  for (auto _ : state) {
    canny.setImage(frame.gray);
    canny.detect(parameters, edges);
  }
  state.counters["edge pixels"] = cv::countNonZero(edges);
  finish(state);
}

void
depthEdges(benchmark::State& state, int kinds)
{
  const auto& frame = images(static_cast<int>(state.range(0)));
  hoist::DepthEdges detector;
  cv::Mat1b labels(frame.height(), frame.width());
  for (auto _ : state) {
    labels.setTo(0);
    detector.detect(frame.inverse_depth, frame.intrinsics, {}, kinds, labels);
  }
  state.counters["edge pixels"] = cv::countNonZero(labels);
  finish(state);
}

void
allEdges(benchmark::State& state)
{
  const auto& frame = images(static_cast<int>(state.range(0)));
  hoist::EdgeDetector detector;
  cv::Mat1b labels;
  for (auto _ : state)
    detector.detect(frame, {}, labels);
  state.counters["edge pixels"] = cv::countNonZero(labels);
  finish(state);
}

// As a PCL user calls it: from the cloud, with the conversion.
void
edgePixelsFromCloud(benchmark::State& state)
{
  hoist::EdgePixels<pcl::PointXYZRGB> filter;
  filter.setInputCloud(scene(static_cast<int>(state.range(0))));
  pcl::Indices indices;
  for (auto _ : state)
    filter.filter(indices);
  state.counters["edge pixels"] = static_cast<double>(indices.size());
  finish(state);
}

// PCL's detector needs normals, so they are part of its cost.
void
pclOrganizedEdgeFromRGBNormals(benchmark::State& state)
{
  const auto cloud = scene(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    pcl::IntegralImageNormalEstimation<pcl::PointXYZRGB, pcl::Normal> estimate;
    auto normals = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
    estimate.setNormalEstimationMethod(estimate.COVARIANCE_MATRIX);
    estimate.setNormalSmoothingSize(10);
    estimate.setInputCloud(cloud);
    estimate.compute(*normals);
    pcl::OrganizedEdgeFromRGBNormals<pcl::PointXYZRGB, pcl::Normal, pcl::Label> edges;
    edges.setInputCloud(cloud);
    edges.setInputNormals(normals);
    edges.setDepthDisconThreshold(0.02F);
    edges.setMaxSearchNeighbors(50);
    edges.setEdgeType(edges.getEdgeType() | edges.EDGELABEL_HIGH_CURVATURE |
                      edges.EDGELABEL_RGB_CANNY);
    pcl::PointCloud<pcl::Label> labels;
    std::vector<pcl::PointIndices> kinds;
    edges.compute(labels, kinds);
    benchmark::DoNotOptimize(kinds.data());
  }
  finish(state);
}

void
frameImages(benchmark::State& state)
{
  const auto cloud = scene(static_cast<int>(state.range(0)));
  hoist::FrameImages frame;
  for (auto _ : state)
    hoist::toFrameImages(*cloud, frame);
  finish(state);
}

void
whiteBalance(benchmark::State& state)
{
  hoist::WhiteBalance<pcl::PointXYZRGB> filter;
  filter.setInputCloud(scene(static_cast<int>(state.range(0))));
  Cloud out;
  for (auto _ : state)
    filter.filter(out);
  finish(state);
}

void
regionCrop(benchmark::State& state)
{
  hoist::RegionCrop<pcl::PointXYZRGB> filter;
  const float w = static_cast<float>(state.range(0));
  filter.setInputCloud(scene(static_cast<int>(state.range(0))));
  filter.setPolygon({{0.2F * w, 0.1F * w}, {0.8F * w, 0.2F * w}, {0.4F * w, 0.7F * w}});
  pcl::Indices indices;
  for (auto _ : state)
    filter.filter(indices);
  finish(state);
}

void
organizeByPixel(benchmark::State& state)
{
  const auto cloud = scene(static_cast<int>(state.range(0)));
  auto records = pcl::make_shared<pcl::PointCloud<hoist::PointXYZRGBUV>>();
  pcl::copyPointCloud(*cloud, *records);
  for (std::size_t i = 0; i < records->size(); ++i) {
    (*records)[i].u = static_cast<std::uint32_t>(i % cloud->width);
    (*records)[i].v = static_cast<std::uint32_t>(i / cloud->width);
  }
  hoist::OrganizeByPixel<hoist::PointXYZRGBUV> filter;
  filter.setInputCloud(records);
  pcl::PointCloud<hoist::PointXYZRGBUV> out;
  for (auto _ : state)
    filter.filter(out);
  finish(state);
}

void
sizes(benchmark::internal::Benchmark* b)
{
  for (const int width : {320, 640, 1280, 1920})
    b->Arg(width);
  b->Unit(benchmark::kMillisecond);
}

BENCHMARK(cannyImproved)->Apply(sizes);
BENCHMARK(cannyWithTexture)->Apply(sizes);
BENCHMARK_CAPTURE(depthEdges, occlusion, hoist::EDGE_OCCLUSION)->Apply(sizes);
BENCHMARK_CAPTURE(depthEdges, both, hoist::EDGE_OCCLUSION | hoist::EDGE_CREASE)
    ->Apply(sizes);
BENCHMARK(allEdges)->Apply(sizes);
BENCHMARK(edgePixelsFromCloud)->Apply(sizes);
BENCHMARK(pclOrganizedEdgeFromRGBNormals)->Apply(sizes);
BENCHMARK(frameImages)->Apply(sizes);
BENCHMARK(whiteBalance)->Apply(sizes);
BENCHMARK(regionCrop)->Apply(sizes);
BENCHMARK(organizeByPixel)->Apply(sizes);

} // namespace

int
main(int argc, char** argv)
{
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
    return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
