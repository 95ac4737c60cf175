#pragma once

#include <hoist/data/export.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace hoist {

/** \brief A file that appears under its name only when it is complete.
 *
 * Written as <name>.<process>.<number>.tmp in the same folder; commit() flushes it to
 * the disk and renames it. Without commit() nothing stays behind.
 */
class HOIST_DATA_EXPORT AtomicFile {
public:
  /** \throws pcl::IOException if the file cannot be made */
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /** \throws pcl::IOException, e.g. when the disk is full */
  void write(std::string_view bytes);

  /** \throws pcl::IOException */
  void commit();

  /** \brief The temporary file, for writers that insist on a name. */
  const std::filesystem::path&
  temporary() const
  {
    return temporary_;
  }

private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
};

/** \brief Writes a whole file so that readers see the old one or the new one, never a
 *  part, not even after a power cut.
 *  \throws pcl::IOException */
HOIST_DATA_EXPORT void writeFileAtomically(const std::filesystem::path& path,
                                           std::string_view bytes);

} // namespace hoist
