#include <hoist/data/point_types.h>
#include <hoist/filters/impl/edge_pixels.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistExternFrameFilterIndices, HOIST_XYZ_POINT_TYPES)
PCL_INSTANTIATE(HoistEdgePixels, HOIST_XYZ_POINT_TYPES)
