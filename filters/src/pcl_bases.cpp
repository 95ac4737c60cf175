#include <hoist/filters/pcl_bases.h>

#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>

template class pcl::PCLBase<hoist::PointXYZRGBUV>;
template class pcl::PCLBase<hoist::PointXYZUV>;
template class pcl::Filter<hoist::PointXYZRGBUV>;
template class pcl::Filter<hoist::PointXYZUV>;
template class pcl::FilterIndices<hoist::PointXYZRGBUV>;
