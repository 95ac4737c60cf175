#include <hoist/data/impl/estimate_intrinsics.hpp>
#include <hoist/data/point_types.h>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistEstimateIntrinsics, HOIST_XYZ_POINT_TYPES(hoist::PointXYZUV))
