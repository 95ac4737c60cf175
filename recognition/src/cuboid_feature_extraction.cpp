#include <hoist/data/point_types.h>
#include <hoist/recognition/impl/cuboid_feature_extraction.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistCuboidFeatureExtraction, HOIST_XYZ_POINT_TYPES)
