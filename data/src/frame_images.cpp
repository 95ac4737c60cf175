#include <hoist/data/impl/frame_images.hpp>
#include <hoist/data/point_types.h>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistToFrameImages, HOIST_XYZ_POINT_TYPES)
