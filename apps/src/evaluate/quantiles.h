#pragma once

#include <cstddef>
#include <vector>

namespace hoist {

/** \brief The q-quantile of \a sorted numbers, linear between ranks; NaN of none.
 *  \param q in [0, 1] */
double quantile(const std::vector<double>& sorted, double q);

/** \brief What a list of numbers looks like; NaN without numbers. */
struct Summary {
  std::size_t n = 0;
  double median = 0;
  double p90 = 0;
  double p99 = 0;
  double max = 0;
  double mean = 0;
};

Summary summaryOf(std::vector<double> numbers);

} // namespace hoist
