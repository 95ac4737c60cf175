#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/result.h>
#include <hoist/segmentation/export.h>
#include <hoist/segmentation/line_segment.h>

#include <pcl/memory.h>

#include <vector>

namespace hoist {

/** \brief Cuboids from vertices by the paper's two models (4.2.4, equations 2 and 3).
 *
 * Model I: three different segments that end in one vertex, each pair perpendicular.
 * Model II: a segment whose two ends lie in two different vertices, with one more
 * segment at each of them, each pair of the three perpendicular.
 *
 * The paper leaves open, and here is settled:
 *  - Perpendicular: |di . dj| <= tolerance. The paper's Delta is not normalised, so its
 *    0.05 would be in square metres and mean another angle for every pair of lengths;
 *    with unit vectors (default) it is a cosine, 2.87 degrees. Raw is an option.
 *  - An aggregation degree above 3: every triple of different segments is tried.
 *  - A segment with both ends in the vertex at hand is shorter than the cluster and is
 *    no edge of it: it is left out.
 *
 * The three segments fix the cuboid: with the edges e1, e2, e3 as vectors away from
 * their vertices, the centroid is vertex + (e1 + e2 + e3) / 2 by the triangle rule
 * (4.3), where the vertex is the mean of the three ends that meet in it. In model II e1
 * is the middle segment, e2 and e3 leave its two ends, and the vertex is half of e1
 * before the mean of the four ends that meet. The sizes are the lengths |ei|; the axes
 * are the rotation nearest to their directions.
 *
 * Score, ours (the paper has none), in [0, 1]:
 *   (1 - max |cos|) * mean over the three segments of (support * closed),
 * support = supporting edge pixels per pixel of length, at most 1; closed = 1 if the
 * end that does not meet the others lies in a vertex too, else 0.5. It prefers edges
 * that are seen from corner to corner, whose lengths are the sizes.
 */
class HOIST_SEGMENTATION_EXPORT VertexModels {
public:
  using Ptr = pcl::shared_ptr<VertexModels>;
  using ConstPtr = pcl::shared_ptr<const VertexModels>;

  /** \brief Largest |Delta i . Delta j| of equation 3, finite and >= 0; default 0.05.
   *  A cosine, or square metres when not normalized.
   *  \throw pcl::BadArgumentException outside that range */
  void setTolerance(double tolerance);

  double
  getTolerance() const
  {
    return tolerance_;
  }

  /** \brief Unit vectors in equation 3 (default true), or the raw Delta in metres. */
  void
  setNormalized(bool normalized)
  {
    normalized_ = normalized;
  }

  bool
  getNormalized() const
  {
    return normalized_;
  }

  /** \brief Vertices with more segments are not searched, since the triples grow with
   *  the cube; they are counted as "vertex of too many segments". >= 3, default 64.
   *  \throw pcl::BadArgumentException below 3 */
  void setMaxDegree(int degree);

  int
  getMaxDegree() const
  {
    return max_degree_;
  }

  /** \brief Model I. Appends one cuboid per triple.
   *  \param vertices of these segments, every end in at most one of them
   *  \param diagnostics counts and reject reasons are added */
  void findModelOne(const std::vector<LineSegment>& segments,
                    const std::vector<Vertex>& vertices,
                    std::vector<Cuboid>& cuboids,
                    Diagnostics& diagnostics) const;

  /** \brief Model II. Appends one cuboid per triple; as findModelOne. */
  void findModelTwo(const std::vector<LineSegment>& segments,
                    const std::vector<Vertex>& vertices,
                    std::vector<Cuboid>& cuboids,
                    Diagnostics& diagnostics) const;

  /** \brief Both models; \a cuboids is cleared first. */
  void find(const std::vector<LineSegment>& segments,
            const std::vector<Vertex>& vertices,
            std::vector<Cuboid>& cuboids,
            Diagnostics& diagnostics) const;

private:
  bool perpendicular(const LineSegment& a, const LineSegment& b) const;

  double tolerance_ = 0.05;
  bool normalized_ = true;
  int max_degree_ = 64;
};

/** \brief One cuboid per box: of cuboids whose centres lie in each other or in a better
 * one, the best score stays.
 *
 * \param cuboids replaced, best score first; ties keep the order given
 * \return how many were removed
 */
HOIST_SEGMENTATION_EXPORT std::size_t keepBestOfEachBox(std::vector<Cuboid>& cuboids);

} // namespace hoist
