// Cost of every stage of segmentation and of the whole, against pixels and against the
// number of segments, with PCL's integral image normals as a yardstick. Scenes are
// rendered outside the timed loops.
#include <hoist/data/frame_images.h>
#include <hoist/filters/edge_detector.h>
#include <hoist/segmentation/cuboid_segmentation.h>
#include <hoist/segmentation/endpoint_clustering.h>
#include <hoist/segmentation/extract_line_segments.h>
#include <hoist/segmentation/vertex_models.h>

#include <samples/generate.h>
#include <samples/render.h>

#include <pcl/features/integral_image_normal.h>

#include <benchmark/benchmark.h>

#include <map>
#include <random>

namespace {

using namespace hoist;
using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

// Boxes on a table as a Kinect sees them, at any width (4 : 3).
struct Input {
  Cloud::Ptr cloud;
  FrameImages::Ptr images;
  cv::Mat1b edges;
};

const Input&
inputOf(int width)
{
  static std::map<int, Input> cache;
  Input& input = cache[width];
  if (input.cloud)
    return input;
  samples::Scene scene = samples::randomTableScene(3, 6);
  const double scale = width / 640.0;
  scene.width = width;
  scene.height = width * 3 / 4;
  scene.camera.fx *= scale;
  scene.camera.fy *= scale;
  scene.camera.cx = (scene.camera.cx + 0.5) * scale - 0.5;
  scene.camera.cy = (scene.camera.cy + 0.5) * scale - 0.5;
  input.cloud = pcl::make_shared<Cloud>(samples::render(scene).cloud);
  input.images = pcl::make_shared<FrameImages>();
  toFrameImages(*input.cloud, *input.images);
  EdgeDetector detector;
  detector.detect(*input.images, {}, input.edges);
  return input;
}

void
countPixels(benchmark::State& state)
{
  state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0) * 3 / 4);
}

void
frameImages(benchmark::State& state)
{
  const Input& input = inputOf(static_cast<int>(state.range(0)));
  FrameImages images;
  for (auto _ : state)
    toFrameImages(*input.cloud, images);
  countPixels(state);
}

void
lineSegments(benchmark::State& state, LineLift lift)
{
  const Input& input = inputOf(static_cast<int>(state.range(0)));
  LineExtractionParameters parameters;
  parameters.lift = lift;
  std::vector<LineSegment> segments;
  for (auto _ : state) {
    Diagnostics diagnostics;
    extractLineSegments(*input.images, input.edges, parameters, segments, diagnostics);
  }
  state.counters["segments"] = static_cast<double>(segments.size());
  countPixels(state);
}

void
cuboids(benchmark::State& state, SegmentationMode mode, bool lines)
{
  const Input& input = inputOf(static_cast<int>(state.range(0)));
  CuboidSegmentation<pcl::PointXYZRGB> segmentation;
  segmentation.setMode(mode);
  segmentation.setReportLines(lines);
  segmentation.setInputCloud(input.cloud);
  segmentation.setFrameImages(input.images);
  std::vector<Cuboid> found;
  for (auto _ : state)
    if (!segmentation.segment(found))
      state.SkipWithError("segment() failed");
  state.counters["cuboids"] = static_cast<double>(found.size());
  state.counters["rounds"] =
      static_cast<double>(segmentation.getDiagnostics().counts["rounds"]);
  countPixels(state);
}

void
pclIntegralImageNormals(benchmark::State& state)
{
  const Input& input = inputOf(static_cast<int>(state.range(0)));
  pcl::IntegralImageNormalEstimation<pcl::PointXYZRGB, pcl::Normal> normals;
  normals.setNormalEstimationMethod(normals.COVARIANCE_MATRIX);
  normals.setNormalSmoothingSize(10.0F);
  pcl::PointCloud<pcl::Normal> out;
  for (auto _ : state) {
    normals.setInputCloud(input.cloud);
    normals.compute(out);
  }
  countPixels(state);
}

// Segments spread at a fixed density of ends, so that the number of pairs within D
// grows with the number of segments and not faster.
std::vector<LineSegment>
spread(int count)
{
  std::mt19937 random(1);
  const double side = 0.05 * std::cbrt(2.0 * count);
  std::uniform_real_distribution<double> at(0, side);
  std::vector<LineSegment> segments(static_cast<std::size_t>(count));
  for (LineSegment& s : segments)
    for (auto& p : s.points)
      p = Eigen::Vector3d(at(random), at(random), 1 + at(random));
  return segments;
}

void
endpointClustering(benchmark::State& state)
{
  const auto segments = spread(static_cast<int>(state.range(0)));
  EndpointClustering clustering;
  std::vector<Vertex> vertices;
  for (auto _ : state)
    clustering.cluster(segments, vertices);
  state.counters["vertices"] = static_cast<double>(vertices.size());
  state.SetComplexityN(state.range(0));
}

void
vertexModels(benchmark::State& state)
{
  const auto segments = spread(static_cast<int>(state.range(0)));
  std::vector<Vertex> vertices;
  EndpointClustering clustering;
  clustering.setDistanceThreshold(0.02); // below percolation: clusters stay small
  clustering.cluster(segments, vertices);
  VertexModels models;
  std::vector<Cuboid> found;
  std::size_t hypotheses = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    models.find(segments, vertices, found, diagnostics);
    hypotheses = diagnostics.counts["hypotheses"];
  }
  state.counters["hypotheses"] = static_cast<double>(hypotheses);
  state.SetComplexityN(state.range(0));
}

void
sizes(benchmark::internal::Benchmark* b)
{
  b->Arg(320)->Arg(640)->Arg(1280)->Arg(1920)->Unit(benchmark::kMillisecond);
}

void
counts(benchmark::internal::Benchmark* b)
{
  b->RangeMultiplier(4)->Range(64, 65536)->Unit(benchmark::kMillisecond)->Complexity();
}

BENCHMARK(frameImages)->Apply(sizes);
BENCHMARK_CAPTURE(lineSegments, endpoints, LineLift::endpoints)->Apply(sizes);
BENCHMARK_CAPTURE(lineSegments, robust, LineLift::robust)->Apply(sizes);
BENCHMARK_CAPTURE(cuboids, paper, SegmentationMode::paper, false)->Apply(sizes);
BENCHMARK_CAPTURE(cuboids, full, SegmentationMode::full, false)->Apply(sizes);
BENCHMARK_CAPTURE(cuboids, full_with_lines, SegmentationMode::full, true)->Apply(sizes);
BENCHMARK(pclIntegralImageNormals)->Apply(sizes);
BENCHMARK(endpointClustering)->Apply(counts);
BENCHMARK(vertexModels)->Apply(counts);

} // namespace

BENCHMARK_MAIN();
