#pragma once

#include "settings.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace hoist {

/** \brief A setting that keys change. */
struct TunedSetting {
  std::string name; ///< the long option without its dashes
  double step;      ///< added, or a factor
  bool factor;
  double low, high;  ///< as far as keys go; within what the option accepts
  bool whole;        ///< a whole number
  std::string modes; ///< in which mode it counts: "full", "paper" or ""
};

/** \brief The settings of the recognition while a program runs: the options of a
 * command line, which keys change afterwards, and which are saved as YAML. */
class LiveSettings {
public:
  /** \param command holds the options of addMethodOptions for \a settings, parsed; both
   *         must outlive this */
  LiveSettings(CLI::App& command, RecognizeSettings& settings);

  const RecognizeSettings&
  settings() const
  {
    return settings_;
  }

  /** \brief Full mode becomes paper mode and the other way round. */
  void toggleMode();

  /** \brief Another setting becomes the one that step() changes; \a by +1 or -1. */
  void choose(int by);

  /** \brief The chosen one goes up or down by a step; +1 or -1.
   *  \return false, and nothing changed, at the end of its range */
  bool step(int by);

  /** \brief All as they were at the start. */
  void reset();

  /** \brief The chosen setting and its value, e.g. "min-score 0.5". */
  std::string chosen() const;

  /** \brief The text of the value of any option, its default where it was not set; ""
   *  where there is none. */
  std::string value(const std::string& name) const;

  /** \brief All settings as YAML that `hoist recognize --config` reads. */
  std::string yaml() const;

private:
  std::vector<TunedSetting> tuned() const;
  void set(const std::string& name, const std::string& value);

  CLI::App& command_;
  RecognizeSettings& settings_;
  RecognizeSettings at_start_;
  std::vector<std::pair<std::string, std::vector<std::string>>> results_at_start_;
  std::string chosen_ = "min-score";
};

} // namespace hoist
