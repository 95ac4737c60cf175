#pragma once

#include "peer.h"

#include <pcl/types.h>

#include <vector>

namespace peers {

/** \brief A planar patch of the frame. */
struct Face {
  Eigen::Vector4f plane; ///< n.p + d = 0, |n| = 1, the camera on the positive side
  Eigen::Vector3f centroid;
  pcl::Indices pixels;    ///< its points, indices into the cloud
  pcl::Indices border;    ///< those of them with a 4-neighbour that is not in the face
  std::vector<int> parts; ///< numbers of the patches it was joined from
};

/** \brief The frame and the plane that things stand on. */
struct Scene {
  Cloud::ConstPtr cloud;
  Camera camera;
  Eigen::Vector4f support; ///< the camera on the positive side
};

/** \brief The largest plane, by RANSAC on every eighth pixel of every eighth row.
 *  \return false if no plane is found */
bool findSupport(const Cloud& cloud, Eigen::Vector4f& plane);

/** \brief Height over the support plane [m]. */
inline float
height(const Scene& scene, const pcl::PointXYZRGB& p)
{
  return scene.support.head<3>().dot(p.getVector3fMap()) + scene.support[3];
}

/** \brief Depth noise, about three sigma of a Kinect, with room for bent planes [m]. */
inline float
tolerance(float z)
{
  return 0.002f + 0.0045f * z * z;
}

/** \brief Grows the patches over neighbouring points of their planes, as normals end
 *  some pixels before an edge does, then fits planes and lists borders.
 *  \param faces pixels given; small ones are removed, the rest is filled in */
void growFaces(const Scene& scene, std::vector<Face>& faces);

/** \brief What was measured where a point should be. */
enum class Sight { none, support, occluded, contradiction };

/** \brief Compares a point of a supposed surface with the depth image. */
Sight look(const Scene& scene, const Eigen::Vector3f& point);

/** \brief Appends faces joined from two patches of one plane that something nearer
 *  cuts apart. */
void joinFaces(const Scene& scene, std::vector<Face>& faces);

/** \brief Boxes from pairs and triples of perpendicular faces that meet in convex
 *  edges, completed by the support plane and checked against the depth image. */
std::vector<Box> boxesFromFaces(const Scene& scene, std::vector<Face> faces);

/** \brief What the depth image says of a box. */
struct DepthCheck {
  float support = 0;       ///< share of its visible surface that was measured there
  float occluded = 0;      ///< share that something nearer hides
  float contradiction = 0; ///< share through which the sensor saw something farther
  float worst_face = 1;    ///< least share of support in what was seen of a face
};

/** \brief Samples the box's faces that look at the camera. */
DepthCheck checkDepth(const Scene& scene, const Box& box);

} // namespace peers
