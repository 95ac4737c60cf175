#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace hoist {

/** \brief A new SQLite database, filled in one go and then only read. */
class SqliteFile {
public:
  /** \throws StoreError */
  explicit SqliteFile(const std::filesystem::path& path);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  /** \throws StoreError */
  void execute(const char* sql);

  /** \brief Ends the one transaction and closes the file.
   *  \throws StoreError */
  void close();

private:
  friend class SqliteInsert;
  [[noreturn]] void fail() const;

  sqlite3* database_ = nullptr;
};

/** \brief Adds rows to a table. */
class SqliteInsert {
public:
  /** \param columns how many the table has
   *  \throws StoreError */
  SqliteInsert(SqliteFile& file, const std::string& table, int columns);
  ~SqliteInsert();
  SqliteInsert(const SqliteInsert&) = delete;
  SqliteInsert& operator=(const SqliteInsert&) = delete;

  /** \brief The next column's value; a double that is not finite becomes NULL. */
  SqliteInsert& add(const std::string& value);
  SqliteInsert& add(double value);
  SqliteInsert& add(std::int64_t value);
  SqliteInsert& addNull();

  /** \brief Writes the row.
   *  \throws StoreError */
  void end();

private:
  SqliteFile& file_;
  sqlite3_stmt* statement_ = nullptr;
  int column_ = 0;
};

} // namespace hoist
