#include <hoist/data/point_types.h>
#include <hoist/filters/impl/white_balance.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistWhiteBalance, HOIST_COLOR_POINT_TYPES)
