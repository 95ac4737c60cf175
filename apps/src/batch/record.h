#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hoist {

/** \brief What tells whether a file has changed. */
struct Stamp {
  bool exists = false;
  std::uint64_t size = 0; ///< bytes
  std::int64_t mtime = 0; ///< last change [ns since 1970]

  bool
  operator==(const Stamp& other) const
  {
    return exists == other.exists && size == other.size && mtime == other.mtime;
  }
};

Stamp stampOf(const std::string& path);

/** \brief Why a file is quarantined. */
enum class Cause {
  none,   ///< it is not
  input,  ///< it cannot be read or makes no frame
  memory, ///< it needs more than the limit
  crash,  ///< its process died
  hang    ///< it took longer than the limit
};

/** \brief "", "input", "memory", "crash", "hang". */
const char* toString(Cause cause);

struct Verdict {
  Cause cause = Cause::none;
  std::string reason; ///< in words
  std::string limit;  ///< the limit it broke, e.g. "60 s"; "" if none
};

/** \brief A file beside the record, e.g. the overlay. */
struct Extra {
  std::string suffix; ///< ".png"
  std::uint64_t size; ///< bytes
};

/** \brief What a record says of how it came about. */
struct RecordHead {
  std::string version;  ///< of the program
  std::string settings; ///< hash of all that changes results
  std::string path;     ///< the input, normalized
  Stamp stamp;
  Verdict verdict;
  std::vector<Extra> extras;

  /** \brief "done" or "quarantined". */
  const char*
  status() const
  {
    return verdict.cause == Cause::none ? "done" : "quarantined";
  }
};

/** \brief A record's text: a JSON object with "batch" (the head, the first line), all
 *  that a result's JSON has, "thumbnail" where there is one, and "check", the hash of
 *  the text before it.
 *  \param result a JSON object as toJson() writes it
 *  \param thumbnail bytes of a JPEG, or "" */
std::string makeRecord(const RecordHead& head,
                       const std::string& result,
                       const std::string& thumbnail);

/** \brief The head of a whole, unharmed record; none for any other text. */
std::optional<RecordHead> readRecordHead(std::string_view text);

/** \brief The thumbnail of a record as "data:image/jpeg;base64,...", or "". */
std::string thumbnailOf(std::string_view record);

/** \brief All bytes of a file; none if it cannot be read. */
std::optional<std::string> readBytes(const std::string& path);

} // namespace hoist
