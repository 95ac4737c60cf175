#include <hoist/segmentation/line_segments.h>

#include <Eigen/Eigenvalues>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoist {
namespace {

Eigen::Vector2f
toVector(int u, int v)
{
  return {static_cast<float>(u), static_cast<float>(v)};
}

// Longest first; ties by position, so that the order never depends on the input's.
bool
longerFirst(const PixelSegment& a, const PixelSegment& b)
{
  const auto key = [](const PixelSegment& s) {
    return std::array<float, 5>{-s.length(),
                                s.pixels[0].x(),
                                s.pixels[0].y(),
                                s.pixels[1].x(),
                                s.pixels[1].y()};
  };
  return key(a) < key(b);
}

// Extends keep by other if both are pieces of one edge.
bool
absorb(PixelSegment& keep, const PixelSegment& other, const MergeParameters& p)
{
  const float length = keep.length();
  const Eigen::Vector2f direction = (keep.pixels[1] - keep.pixels[0]) / length;
  const Eigen::Vector2f normal(-direction.y(), direction.x());
  std::array<float, 2> along{};
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2f d = other.pixels[k] - keep.pixels[0];
    if (std::abs(normal.dot(d)) > p.max_offset)
      return false;
    along[k] = direction.dot(d);
  }
  // A piece shorter than the offset has no direction worth the name.
  const Eigen::Vector2f run = other.pixels[1] - other.pixels[0];
  if (run.norm() > p.max_offset &&
      std::abs(normal.dot(run)) > std::sin(p.max_angle) * run.norm())
    return false;
  const auto [low, high] = std::minmax(along[0], along[1]);
  if (low > length + p.max_gap || high < -p.max_gap)
    return false;
  const Eigen::Vector2f origin = keep.pixels[0];
  keep.pixels[0] = origin + std::min(0.0f, low) * direction;
  keep.pixels[1] = origin + std::max(length, high) * direction;
  return true;
}

} // namespace

void
houghSegments(const cv::Mat1b& mask,
              const HoughParameters& parameters,
              std::vector<PixelSegment>& segments)
{
  segments.clear();
  if (!parameters.valid())
    throw std::invalid_argument("hoist::houghSegments: a parameter is out of range");
  if (mask.empty())
    return;
  const cv::Rect box = cv::boundingRect(mask);
  if (box.empty())
    return;
  std::vector<cv::Vec4i> lines;
  cv::HoughLinesP(mask(box),
                  lines,
                  parameters.rho,
                  parameters.theta,
                  parameters.threshold,
                  parameters.min_length,
                  parameters.max_gap);
  segments.reserve(lines.size());
  for (const cv::Vec4i& line : lines)
    segments.push_back({{toVector(line[0] + box.x, line[1] + box.y),
                         toVector(line[2] + box.x, line[3] + box.y)}});
}

void
mergeSegments(std::vector<PixelSegment>& segments, const MergeParameters& parameters)
{
  for (bool changed = true; changed;) {
    changed = false;
    std::sort(segments.begin(), segments.end(), longerFirst);
    std::vector<PixelSegment> kept;
    for (const PixelSegment& segment : segments) {
      const auto host = std::find_if(kept.begin(), kept.end(), [&](PixelSegment& k) {
        return absorb(k, segment, parameters);
      });
      if (host == kept.end() && segment.length() > 0)
        kept.push_back(segment);
      else
        changed = true;
    }
    segments.swap(kept);
  }
}

void
collectSupport(const cv::Mat1b& mask,
               const PixelSegment& segment,
               int radius,
               pcl::Indices& indices)
{
  indices.clear();
  const Eigen::Vector2f run = segment.pixels[1] - segment.pixels[0];
  const bool flat = std::abs(run.x()) >= std::abs(run.y());
  const int steps = cvRound(std::max(std::abs(run.x()), std::abs(run.y())));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2f at =
        segment.pixels[0] + run * (static_cast<float>(i) / std::max(1, steps));
    for (int s = -radius; s <= radius; ++s) {
      const int u = cvRound(at.x()) + (flat ? 0 : s);
      const int v = cvRound(at.y()) + (flat ? s : 0);
      if (u >= 0 && v >= 0 && u < mask.cols && v < mask.rows && mask(v, u) != 0)
        indices.push_back(v * mask.cols + u);
    }
  }
}

bool
refineSegment(const pcl::Indices& support, int width, PixelSegment& segment)
{
  if (support.size() < 3)
    return false;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const int index : support)
    mean += Eigen::Vector2d(index % width, index / width);
  mean /= static_cast<double>(support.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const int index : support) {
    const Eigen::Vector2d d = Eigen::Vector2d(index % width, index / width) - mean;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  if (!(solver.eigenvalues()[1] > 0))
    return false;
  const Eigen::Vector2d direction = solver.eigenvectors().col(1);
  for (auto& pixel : segment.pixels) {
    const double t = direction.dot(pixel.cast<double>() - mean);
    pixel = (mean + t * direction).cast<float>();
  }
  return true;
}

} // namespace hoist
