#include <hoist/data/point_types.h>
#include <hoist/filters/impl/region_crop.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistExternFrameFilterIndices, HOIST_XYZ_POINT_TYPES)
PCL_INSTANTIATE(HoistRegionCrop, HOIST_XYZ_POINT_TYPES)
