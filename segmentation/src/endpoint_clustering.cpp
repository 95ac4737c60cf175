#include <hoist/segmentation/endpoint_clustering.h>

#include <pcl/exceptions.h>
#include <pcl/point_cloud.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hoist {
namespace {

// Components of a graph that grows link by link; the root is the smallest member.
class Components {
public:
  explicit Components(std::size_t n) : parent_(n)
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int
  root(int i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void
  link(int i, int k)
  {
    const int a = root(i), b = root(k);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<int> parent_;
};

} // namespace

EndpointClustering::EndpointClustering()
// results need no order: every pair within D is looked at
: search_(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(false))
{
}

void
EndpointClustering::setDistanceThreshold(double distance)
{
  if (!(distance >= 0) || !std::isfinite(distance))
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::EndpointClustering: the distance threshold "
                        "must be finite and >= 0 metres");
  distance_ = distance;
}

void
EndpointClustering::setSearchMethod(const SearchPtr& search)
{
  if (!search)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                        "hoist::EndpointClustering: null search method");
  search_ = search;
}

void
EndpointClustering::cluster(const std::vector<LineSegment>& segments,
                            std::vector<Vertex>& vertices)
{
  vertices.clear();
  std::vector<SegmentEnd> ends;
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  float extent = 0;
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3f p = segments[i].points[k].cast<float>();
      if (!p.allFinite())
        continue;
      ends.push_back({static_cast<int>(i), k});
      cloud->push_back({p.x(), p.y(), p.z()});
      extent = std::max(extent, p.cwiseAbs().maxCoeff());
    }
  if (ends.size() < 2)
    return;
  const auto point = [&](const SegmentEnd& end) -> const Eigen::Vector3d& {
    return segments[end.segment].points[end.end];
  };

  // the tree works on floats and excludes its bound: propose a little more than D
  const double slack = 16.0 * std::numeric_limits<float>::epsilon() * extent +
                       1e-5 * distance_ + std::numeric_limits<float>::min();
  Components components(ends.size());
  search_->setInputCloud(cloud);
  pcl::Indices near;
  std::vector<float> squares;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    search_->radiusSearch((*cloud)[i], distance_ + slack, near, squares);
    for (const int k : near) {
      if (k <= static_cast<int>(i) || ends[k].segment == ends[i].segment)
        continue;
      const Eigen::Vector3d d = point(ends[i]) - point(ends[k]);
      const double e = std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
      // Equation (1), linked when E <= D
      if (e <= distance_)
        components.link(static_cast<int>(i), k);
    }
  }

  std::vector<int> vertex_of_root(ends.size(), -1);
  std::vector<Vertex> groups;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    int& vertex = vertex_of_root[components.root(static_cast<int>(i))];
    if (vertex < 0) {
      vertex = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[vertex].ends.push_back(ends[i]); // ends are visited in sorted order
    groups[vertex].point += point(ends[i]);
  }
  for (Vertex& group : groups) {
    if (group.aggregationDegree() < 2)
      continue;
    group.point /= static_cast<double>(group.ends.size());
    vertices.push_back(std::move(group));
  }
}

} // namespace hoist
