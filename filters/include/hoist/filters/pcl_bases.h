#pragma once

// PCL's libraries hold PCL's base classes for PCL's point types only; hoist_filters
// holds them for hoist's. Declared here, so that no other translation unit makes its
// own.
#include <hoist/data/point_types.h>
#include <hoist/filters/export.h>

#include <pcl/filters/filter_indices.h>

extern template class HOIST_FILTERS_EXPORT pcl::PCLBase<hoist::PointXYZRGBUV>;
extern template class HOIST_FILTERS_EXPORT pcl::PCLBase<hoist::PointXYZUV>;
extern template class HOIST_FILTERS_EXPORT pcl::Filter<hoist::PointXYZRGBUV>;
extern template class HOIST_FILTERS_EXPORT pcl::Filter<hoist::PointXYZUV>;
extern template class HOIST_FILTERS_EXPORT pcl::FilterIndices<hoist::PointXYZRGBUV>;
