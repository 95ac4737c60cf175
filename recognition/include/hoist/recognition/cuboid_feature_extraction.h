#pragma once

#include <hoist/data/result.h>
#include <hoist/recognition/export.h>
#include <hoist/recognition/weight.h>

#include <pcl/memory.h>
#include <pcl/pcl_base.h>

// PCL has no PCLBase for our own point types; with this the user needs no more.
#include <pcl/impl/pcl_base.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief The visible and invisible features of cuboids (paper 4.3): dominant colour
 * and its name, orientation, lifting pose and weight.
 *
 * The colour is read from the input as it is: white balance the cloud first, see
 * WhiteBalance. Its name is told against the lightest surface of the whole input, see
 * lightnessOfWhite. A cuboid's pixels are its own \c indices where it has some, else
 * the points of the input within the surface tolerance of its faces; with setIndices
 * only those among the given indices count. Point types without colour leave the colour
 * name empty.
 *
 * \code
 * hoist::CuboidFeatureExtraction<pcl::PointXYZRGBA> extraction;
 * extraction.setInputCloud(cloud);
 * extraction.setCuboids(cuboids);
 * extraction.setMaterial("concrete");
 * std::vector<hoist::CuboidFeatures> features;
 * extraction.compute(features);
 * \endcode
 */
template <typename PointT>
class CuboidFeatureExtraction : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<CuboidFeatureExtraction<PointT>>;
  using ConstPtr = pcl::shared_ptr<const CuboidFeatureExtraction<PointT>>;

  using pcl::PCLBase<PointT>::initCompute;
  using pcl::PCLBase<PointT>::deinitCompute;

  /** \brief The cuboids to describe, in the input's frame. */
  void
  setCuboids(const std::vector<Cuboid>& cuboids)
  {
    cuboids_ = cuboids;
  }

  const std::vector<Cuboid>&
  getCuboids() const
  {
    return cuboids_;
  }

  /** \brief Where up is, in the camera frame; it need not have unit length. The lifting
   *  face is then the one that looks up most. A zero vector (the default) means not
   *  known: the lifting face is the one that looks to the camera most. */
  void
  setUpDirection(const Eigen::Vector3d& up)
  {
    up_ = up;
  }

  const Eigen::Vector3d&
  getUpDirection() const
  {
    return up_;
  }

  /** \brief What the cuboids are made of: a name of materials(), or "" for not known
   *  (the default): then weights are 0.
   *  \return false, and nothing changed, if there is no such material */
  bool setMaterial(const std::string& name);

  const std::string&
  getMaterial() const
  {
    return material_;
  }

  /** \brief How far from a face a point still belongs to it, for cuboids without
   *  indices of their own [m], > 0, default 0.01. */
  void
  setSurfaceTolerance(double tolerance)
  {
    surface_tolerance_ = tolerance;
  }

  double
  getSurfaceTolerance() const
  {
    return surface_tolerance_;
  }

  /** \brief Describes every cuboid.
   *  \param features cleared, then one entry per cuboid, in their order
   *  \return false, with a message, without input, with an index out of range or a
   *          tolerance that is not positive */
  bool compute(std::vector<CuboidFeatures>& features);

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;

  std::string
  getClassName() const
  {
    return "CuboidFeatureExtraction";
  }

private:
  bool validIndices() const;

  double lightnessOfInputsWhite() const;

  pcl::Indices pixelsOf(const Cuboid& cuboid, const std::vector<bool>& given) const;

  std::vector<Cuboid> cuboids_;
  Eigen::Vector3d up_ = Eigen::Vector3d::Zero();
  std::string material_;
  double surface_tolerance_ = 0.01;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/recognition/impl/cuboid_feature_extraction.hpp>
#endif
