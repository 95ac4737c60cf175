#include <hoist/data/point_types.h>
#include <hoist/filters/impl/organize_by_pixel.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistOrganizeByPixel, (hoist::PointXYZRGBUV)(hoist::PointXYZUV))
