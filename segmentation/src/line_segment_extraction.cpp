#include <hoist/data/point_types.h>
#include <hoist/segmentation/impl/line_segment_extraction.hpp>

#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(HoistLineSegmentExtraction, HOIST_XYZ_POINT_TYPES)
