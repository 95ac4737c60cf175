#pragma once

// Registered at global scope, as PCL does; see pcl/register_point_struct.h.
#include <pcl/memory.h>
#include <pcl/pcl_macros.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

namespace hoist {

/** \brief A point that knows its colour and its pixel: one Bumblebee record.
 *
 * x, y, z in the camera frame [m]; u is the column and v the row of the pixel, both
 * from 0 at the top left.
 */
struct EIGEN_ALIGN16 PointXYZRGBUV {
  PCL_ADD_POINT4D;
  PCL_ADD_RGB;
  std::uint32_t u;
  std::uint32_t v;

  inline PointXYZRGBUV() : u(0), v(0)
  {
    x = y = z = 0.0f;
    data[3] = 1.0f;
    r = g = b = 0;
    a = 255;
  }

  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

/** \brief A point that knows its pixel, without colour. */
struct EIGEN_ALIGN16 PointXYZUV {
  PCL_ADD_POINT4D;
  std::uint32_t u;
  std::uint32_t v;

  inline PointXYZUV() : u(0), v(0)
  {
    x = y = z = 0.0f;
    data[3] = 1.0f;
  }

  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace hoist

POINT_CLOUD_REGISTER_POINT_STRUCT(hoist::PointXYZRGBUV,
                                  (float, x, x)(float, y, y)(float, z, z)(
                                      std::uint32_t,
                                      rgba,
                                      rgba)(std::uint32_t, u, u)(std::uint32_t, v, v))
POINT_CLOUD_REGISTER_POINT_STRUCT(
    hoist::PointXYZUV,
    (float, x, x)(float, y, y)(float, z, z)(std::uint32_t, u, u)(std::uint32_t, v, v))

/// The point types every templated class of hoist is instantiated for.
#define HOIST_COLOR_POINT_TYPES                                                        \
  (pcl::PointXYZRGB)(pcl::PointXYZRGBA)(pcl::PointXYZRGBL)(hoist::PointXYZRGBUV)

/// Those, and the ones without colour, for stages that need none.
#define HOIST_XYZ_POINT_TYPES (pcl::PointXYZ)(pcl::PointXYZI) HOIST_COLOR_POINT_TYPES
