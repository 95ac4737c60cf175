#pragma once

#include <hoist/filters/color_gains.h>
#include <hoist/filters/export.h>
#include <hoist/filters/pcl_bases.h>

#include <pcl/filters/filter.h>

namespace hoist {

/** \brief Takes the colour of the light out of a cloud's colours (paper 4.3).
 *
 * The output is the input with other colours: same points, same order, organized if the
 * input was; in == out is the in-place use. With user indices only those points tell
 * the light's colour (a detector's box would be a bad choice, a grey floor a good one);
 * all points are changed. Points without depth count too: they have a colour.
 * Without input the output is cleared and PCL_ERROR tells; indices outside the cloud
 * throw pcl::BadArgumentException. No point is ever removed.
 */
template <typename PointT>
class WhiteBalance : public pcl::Filter<PointT> {
public:
  using Base = pcl::Filter<PointT>;
  using PointCloud = pcl::PointCloud<PointT>;
  using Ptr = pcl::shared_ptr<WhiteBalance<PointT>>;
  using ConstPtr = pcl::shared_ptr<const WhiteBalance<PointT>>;

  WhiteBalance() { filter_name_ = "WhiteBalance"; }

  /** \brief The cloud with balanced colours; cleared first unless it is the input. */
  void filter(PointCloud& output);

  /** \brief How the light's colour is guessed; default white_patch. */
  void
  setMethod(WhiteBalanceMethod method)
  {
    parameters_.method = method;
  }

  WhiteBalanceMethod
  getMethod() const
  {
    return parameters_.method;
  }

  /** \brief Percentile of the white patch, in (0, 100]; default 97.
   *  \throws pcl::BadArgumentException otherwise */
  void setPercentile(double percentile);

  double
  getPercentile() const
  {
    return parameters_.percentile;
  }

  /** \brief All settings at once, for the ones without a setter of their own. */
  void
  setParameters(const WhiteBalanceParameters& parameters)
  {
    parameters_ = parameters;
  }

  const WhiteBalanceParameters&
  getParameters() const
  {
    return parameters_;
  }

  /** \brief Gains that the last filter() applied; all 1 and not valid where it had
   *  nothing to learn from. */
  const ColorGains&
  getGains() const
  {
    return gains_;
  }

protected:
  using Base::filter_name_;
  using Base::indices_;
  using Base::input_;
  using Base::removed_indices_;

  void applyFilter(PointCloud& output) override;

private:
  WhiteBalanceParameters parameters_;
  ColorGains gains_;
};

} // namespace hoist

#ifdef PCL_NO_PRECOMPILE
#include <hoist/filters/impl/white_balance.hpp>
#endif
