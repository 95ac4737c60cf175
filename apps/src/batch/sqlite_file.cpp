#include "batch/sqlite_file.h"

#include "batch/store.h"

#include <sqlite3.h>

#include <cmath>

namespace hoist {

SqliteFile::SqliteFile(const std::filesystem::path& path)
{
  if (sqlite3_open_v2(path.c_str(),
                      &database_,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE,
                      nullptr) != SQLITE_OK) {
    const std::string reason = sqlite3_errmsg(database_);
    sqlite3_close(database_);
    throw StoreError("SQLite: " + reason);
  }
  try {
    // nobody sees the file before it is whole: no journal, one flush at the end
    execute("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA page_size=4096;"
            "PRAGMA temp_store=MEMORY; BEGIN");
  }
  catch (...) {
    sqlite3_close(database_);
    throw;
  }
}

SqliteFile::~SqliteFile()
{
  sqlite3_close(database_);
}

void
SqliteFile::fail() const
{
  throw StoreError("SQLite: " + std::string(sqlite3_errmsg(database_)));
}

void
SqliteFile::execute(const char* sql)
{
  if (sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) != SQLITE_OK)
    fail();
}

void
SqliteFile::close()
{
  execute("COMMIT");
  if (sqlite3_close(database_) != SQLITE_OK)
    fail();
  database_ = nullptr;
}

SqliteInsert::SqliteInsert(SqliteFile& file, const std::string& table, int columns)
: file_(file)
{
  std::string sql = "INSERT INTO " + table + " VALUES (?";
  for (int i = 1; i < columns; ++i)
    sql += ",?";
  sql += ")";
  if (sqlite3_prepare_v2(file.database_, sql.c_str(), -1, &statement_, nullptr) !=
      SQLITE_OK)
    file.fail();
}

SqliteInsert::~SqliteInsert()
{
  sqlite3_finalize(statement_);
}

SqliteInsert&
SqliteInsert::add(const std::string& value)
{
  sqlite3_bind_text(statement_,
                    ++column_,
                    value.data(),
                    static_cast<int>(value.size()),
                    SQLITE_TRANSIENT); // NOLINT(performance-no-int-to-ptr)
  return *this;
}

SqliteInsert&
SqliteInsert::add(double value)
{
  if (!std::isfinite(value))
    return addNull();
  sqlite3_bind_double(statement_, ++column_, value);
  return *this;
}

SqliteInsert&
SqliteInsert::add(std::int64_t value)
{
  sqlite3_bind_int64(statement_, ++column_, value);
  return *this;
}

SqliteInsert&
SqliteInsert::addNull()
{
  sqlite3_bind_null(statement_, ++column_);
  return *this;
}

void
SqliteInsert::end()
{
  const bool failed = sqlite3_step(statement_) != SQLITE_DONE;
  sqlite3_reset(statement_);
  column_ = 0;
  if (failed)
    file_.fail();
}

} // namespace hoist
