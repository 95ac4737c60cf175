#include "filters/filter_contract.h"

#include <hoist/filters/edge_pixels.h>
#include <hoist/filters/organize_by_pixel.h>
#include <hoist/filters/region_crop.h>
#include <hoist/filters/white_balance.h>

namespace hoist {
namespace test {
namespace {

template <typename PointT>
struct EdgePixelsSubject {
  using Point = PointT;
  using Filter = EdgePixels<PointT>;
  static void
  configure(Filter&)
  {
  }
};

template <typename PointT>
struct BoxCropSubject {
  using Point = PointT;
  using Filter = RegionCrop<PointT>;
  static void
  configure(Filter& filter)
  {
    filter.setBox({10, 5, 30, 30});
  }
};

template <typename PointT>
struct PolygonCropSubject {
  using Point = PointT;
  using Filter = RegionCrop<PointT>;
  static void
  configure(Filter& filter)
  {
    filter.setPolygon({{5, 5}, {60, 10}, {30, 100}});
  }
};

template <typename PointT>
struct WhiteBalanceSubject {
  using Point = PointT;
  using Filter = WhiteBalance<PointT>;
  static void
  configure(Filter&)
  {
  }
};

template <typename PointT>
struct OrganizeSubject {
  using Point = PointT;
  using Filter = OrganizeByPixel<PointT>;
  static void
  configure(Filter&)
  {
  }
};

// every type of HOIST_XYZ_POINT_TYPES
template <template <typename> class Subject>
using AllPoints = ::testing::Types<Subject<pcl::PointXYZ>,
                                   Subject<pcl::PointXYZI>,
                                   Subject<pcl::PointXYZRGB>,
                                   Subject<pcl::PointXYZRGBA>,
                                   Subject<pcl::PointXYZRGBL>,
                                   Subject<PointXYZRGBUV>>;

template <template <typename> class Subject>
using ColorPoints = ::testing::Types<Subject<pcl::PointXYZRGB>,
                                     Subject<pcl::PointXYZRGBA>,
                                     Subject<pcl::PointXYZRGBL>,
                                     Subject<PointXYZRGBUV>>;

using PixelPoints =
    ::testing::Types<OrganizeSubject<PointXYZRGBUV>, OrganizeSubject<PointXYZUV>>;
using PolygonPoints = ::testing::Types<PolygonCropSubject<pcl::PointXYZRGB>>;

INSTANTIATE_TYPED_TEST_SUITE_P(EdgePixels,
                               SelectionContract,
                               AllPoints<EdgePixelsSubject>);
INSTANTIATE_TYPED_TEST_SUITE_P(RegionCropBox,
                               SelectionContract,
                               AllPoints<BoxCropSubject>);
INSTANTIATE_TYPED_TEST_SUITE_P(RegionCropPolygon, SelectionContract, PolygonPoints);
INSTANTIATE_TYPED_TEST_SUITE_P(WhiteBalance,
                               PointFilterContract,
                               ColorPoints<WhiteBalanceSubject>);
INSTANTIATE_TYPED_TEST_SUITE_P(OrganizeByPixel, PointFilterContract, PixelPoints);

} // namespace
} // namespace test
} // namespace hoist
