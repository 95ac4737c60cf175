#include <hoist/data/point_types.h>
#include <hoist/filters/impl/frame_filter_indices.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistFrameFilterIndices, HOIST_XYZ_POINT_TYPES)
