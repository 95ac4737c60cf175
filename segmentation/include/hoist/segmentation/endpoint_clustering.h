#pragma once

#include <hoist/segmentation/export.h>
#include <hoist/segmentation/line_segment.h>

#include <pcl/memory.h>
#include <pcl/point_types.h>
#include <pcl/search/search.h>

#include <vector>

namespace hoist {

/** \brief Groups segment ends into vertices (paper 4.2.3, equation 1).
 *
 * Two ends of different segments are linked when their distance is at most D. A vertex
 * is a connected component of the linked ends with ends of at least two segments. Ends
 * of the same segment are never linked directly, but other ends may link both into one
 * vertex; the segment then counts once in the aggregation degree. The vertex's point is
 * the mean of its ends.
 *
 * The links are found by radius search, so the cost is that of the tree and of the
 * pairs within D. The result equals the comparison of all pairs: the tree only proposes
 * pairs (it computes in float), equation 1 is evaluated in double.
 */
class HOIST_SEGMENTATION_EXPORT EndpointClustering {
public:
  using Ptr = pcl::shared_ptr<EndpointClustering>;
  using ConstPtr = pcl::shared_ptr<const EndpointClustering>;
  using Search = pcl::search::Search<pcl::PointXYZ>;
  using SearchPtr = Search::Ptr;

  EndpointClustering();

  /** \brief The distance D [m], finite and >= 0; default 0.03, the paper's.
   *  \throw pcl::BadArgumentException outside that range */
  void setDistanceThreshold(double distance);

  double
  getDistanceThreshold() const
  {
    return distance_;
  }

  /** \brief The search over the ends; default a pcl::search::KdTree. Its input cloud is
   *  replaced. */
  void setSearchMethod(const SearchPtr& search);

  SearchPtr
  getSearchMethod() const
  {
    return search_;
  }

  /** \brief The vertices, ordered by their first end.
   *
   * \param segments ends that are not finite are left out
   * \param vertices cleared, then filled
   */
  void cluster(const std::vector<LineSegment>& segments, std::vector<Vertex>& vertices);

private:
  double distance_ = 0.03;
  SearchPtr search_;
};

} // namespace hoist
