#pragma once

#include "batch/inputs.h"
#include "batch/record.h"

#include <filesystem>
#include <optional>
#include <string>

namespace hoist {

/** \brief Tells which records still stand: whole, of this program's version, with these
 *  settings, of the input as it is now, and with all files that belong to it. */
struct RecordCheck {
  std::filesystem::path folder; ///< of the batch's output
  std::string version;
  std::string settings;     ///< hash
  std::string memory_limit; ///< as in Verdict::limit
  std::string time_limit;
  bool retry = false; ///< quarantined files do not stand

  /** \brief The head of the file's record, if it stands. One that is quarantined for a
   *  limit stands only under the same limit.
   *  \param stamp of the file now */
  std::optional<RecordHead> standing(const InputFile& file, const Stamp& stamp) const;

  /** \brief The same, but whatever limits and \ref retry say; with the record's text.
   */
  std::optional<RecordHead> finished(const InputFile& file, std::string& text) const;

private:
  std::optional<RecordHead>
  find(const InputFile& file, const Stamp& stamp, std::string& text) const;
};

/** \brief The record's name below the batch's output. */
inline std::string
recordFile(const InputFile& file)
{
  return "results/" + file.name + ".json";
}

/** \brief The name of a file beside it. */
inline std::string
extraFile(const InputFile& file, const std::string& suffix)
{
  return "results/" + file.name + suffix;
}

} // namespace hoist
