#pragma once

#include "batch/summary.h"

#include <cstdio>
#include <filesystem>
#include <string>

namespace hoist {

/** \brief A text file that grows. */
class TextFile {
public:
  /** \throws StoreError */
  explicit TextFile(const std::filesystem::path& path);
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  /** \throws StoreError */
  void write(const std::string& text);

  /** \throws StoreError */
  void close();

private:
  std::filesystem::path path_;
  std::FILE* file_;
};

/** \brief Two tables as RFC 4180 has them: a line per file and a line per cuboid, the
 *  latter with the columns of toCsv(), where the scene is the file's path. */
class SummaryCsv {
public:
  /** \throws StoreError */
  SummaryCsv(const std::filesystem::path& files, const std::filesystem::path& cuboids);

  /** \throws StoreError */
  void add(const SummaryEntry& entry);

  /** \throws StoreError */
  void close();

private:
  TextFile files_;
  TextFile cuboids_;
};

} // namespace hoist
