#pragma once

#include "batch/histogram.h"
#include "batch/summary.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace hoist {

/** \brief The page that shows a batch to people: counts, histograms of size and score,
 *  the failures with their reasons, and a table with thumbnails. One HTML file that
 *  needs nothing else. */
class Report {
public:
  /** \param most_rows files and failures beyond are counted but not listed */
  Report(std::string version, std::string settings, std::size_t most_rows);

  void add(const SummaryEntry& entry);

  std::string html() const;

  std::size_t
  files() const
  {
    return files_;
  }

  std::size_t
  quarantined() const
  {
    return quarantined_;
  }

  std::size_t
  cuboids() const
  {
    return cuboids_;
  }

private:
  std::string facts() const;
  std::string failureTable() const;
  std::string fileTable() const;

  std::string version_;
  std::string settings_;
  std::size_t most_rows_;
  std::size_t files_ = 0, quarantined_ = 0, empty_ = 0, cuboids_ = 0;
  std::array<std::size_t, 5> causes_{};
  std::array<Histogram, 3> sizes_;
  Histogram scores_;
  std::vector<std::string> failures_; ///< rows
  std::vector<std::string> rows_;
};

} // namespace hoist
