#pragma once

#include <hoist/data/export.h>

#include <pcl/exceptions.h>

#include <string>

namespace hoist {

/** \brief A file that cannot be read, and why.
 *
 * what() reads "file:position: reason", where the position is a line number of text or
 * "byte N" of binary data and is left out where the whole file is meant.
 */
class HOIST_DATA_EXPORT LoadError : public pcl::IOException {
public:
  LoadError(const std::string& file, const std::string& position, std::string reason);

  const char*
  what() const noexcept override
  {
    return message_.c_str();
  }

  /** \brief The file as it was named by the caller. */
  const std::string&
  file() const
  {
    return file_;
  }

  /** \brief A line number, "byte N", or "". */
  const std::string&
  position() const
  {
    return position_;
  }

  /** \brief What was expected and what was found. */
  const std::string&
  reason() const
  {
    return reason_;
  }

private:
  std::string message_;
  std::string file_;
  std::string position_;
  std::string reason_;
};

} // namespace hoist
