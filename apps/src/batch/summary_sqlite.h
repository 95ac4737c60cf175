#pragma once

#include "batch/sqlite_file.h"
#include "batch/summary.h"

#include <filesystem>
#include <optional>
#include <string>

namespace hoist {

/** \brief The database of a batch: tables run, files, cuboids, counts. */
class SummarySqlite {
public:
  /** \throws StoreError */
  SummarySqlite(const std::filesystem::path& path,
                const std::string& version,
                const std::string& settings);

  /** \throws StoreError */
  void add(const SummaryEntry& entry);

  /** \throws StoreError */
  void close();

private:
  void addCuboid(const FrameResult& result, std::size_t i);

  SqliteFile file_;
  std::int64_t id_ = 0;
  std::optional<SqliteInsert> files_, cuboids_, counts_;
};

} // namespace hoist
