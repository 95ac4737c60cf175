#include <hoist/segmentation/planar_faces.h>

#include "planar_faces_describe.h"

#include <cmath>

namespace hoist {

double
footprint(const PlanarFace& face, const Eigen::Vector3d& d, const Intrinsics& camera)
{
  // x = ray / w with w = a u + b v + c; dx/du = (ex / fx) / w - ray a / w^2
  const Eigen::Vector3d ray = face.centroid / face.centroid.z();
  const double z = face.centroid.z();
  const double along = d.dot(ray) * z * z;
  const double du = d.x() / camera.fx * z - along * face.inverse_depth[0];
  const double dv = d.y() / camera.fy * z - along * face.inverse_depth[1];
  return std::hypot(du, dv);
}

namespace {

// What is not to be used counts as not measured.
void
applyMask(const cv::Mat1f& image, const cv::Mat1b& mask, cv::Mat1f& masked)
{
  for (int v = 0; v < image.rows; ++v) {
    const float* in = image[v];
    const unsigned char* use = mask[v];
    float* out = masked[v];
    for (int u = 0; u < image.cols; ++u)
      out[u] = use[u] != 0 ? in[u] : 0.0F;
  }
}

} // namespace

struct PlanarFaceFinder::Workspace {
  cv::Mat1f masked;
  detail::CellGrid cells;
  detail::FlatWindows windows;
  detail::CellRegions regions;
  detail::PixelLabels pixels;
  detail::FaceDescriber describer;
};

PlanarFaceFinder::PlanarFaceFinder() : workspace_(std::make_unique<Workspace>()) {}
PlanarFaceFinder::~PlanarFaceFinder() = default;
PlanarFaceFinder::PlanarFaceFinder(PlanarFaceFinder&&) noexcept = default;
PlanarFaceFinder& PlanarFaceFinder::operator=(PlanarFaceFinder&&) noexcept = default;

void
PlanarFaceFinder::find(const cv::Mat1f& inverse_depth,
                       const cv::Mat1b& mask,
                       const Intrinsics& camera,
                       const PlanarFaceParameters& parameters,
                       cv::Mat1s& labels,
                       std::vector<PlanarFace>& faces)
{
  faces.clear();
  labels.create(inverse_depth.rows, inverse_depth.cols);
  noise_scale_ = 1;
  if (inverse_depth.empty())
    return;
  Workspace& w = *workspace_;
  cv::Mat1f image = inverse_depth;
  if (!mask.empty()) {
    w.masked.create(inverse_depth.rows, inverse_depth.cols);
    applyMask(inverse_depth, mask, w.masked);
    image = w.masked;
  }
  w.cells.assign(image);
  detail::InverseDepthNoise noise(parameters.sensor);
  noise_scale_ = w.windows.measure(w.cells, noise);
  noise = noise * noise_scale_;
  w.regions.find(w.cells, noise, parameters, w.windows);
  w.pixels.assign(image, w.cells, w.regions, noise, parameters.pixel_tolerance);
  w.pixels.addSlivers(image, noise, parameters.min_pixels, w.regions);
  w.describer.describe(image,
                       w.cells,
                       w.pixels,
                       w.regions.planes.size(),
                       noise,
                       camera,
                       parameters.min_pixels,
                       labels,
                       faces);
}

} // namespace hoist
