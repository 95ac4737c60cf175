#include <hoist/data/point_types.h>
#include <hoist/recognition/impl/yolox_detector.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistYoloxDetector, HOIST_COLOR_POINT_TYPES)
