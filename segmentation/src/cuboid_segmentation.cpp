#include <hoist/data/point_types.h>
#include <hoist/segmentation/impl/cuboid_segmentation.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistCuboidSegmentation, HOIST_XYZ_POINT_TYPES)
