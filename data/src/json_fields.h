#pragma once

// Reads JSON of which nothing is known for sure: every value knows its place, so that
// what is wrong can be told.

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace hoist {
namespace json {

// Keys are looked up in logarithmic time: ordered_json takes a quadratic one to read an
// object of a million keys.
using Json = nlohmann::json;

/** \brief A value and its place, e.g. "cuboids[3].size". */
class Value {
public:
  /** \param file as it is named in messages; must outlive the value, as \a json must */
  Value(const Json& json, std::string path, const std::string& file)
  : json_(&json), path_(std::move(path)), file_(&file)
  {
  }

  const Json&
  json() const
  {
    return *json_;
  }

  const std::string&
  path() const
  {
    return path_;
  }

  /** \brief "expected ..., found ..."
   *  \throws LoadError */
  [[noreturn]] void fail(const std::string& expected) const;

  /** \brief "<what>", as it stands.
   *  \throws LoadError */
  [[noreturn]] void failWith(const std::string& what) const;

  // Each throws LoadError where the value is something else.

  double number() const; ///< finite
  double numberFrom(double low) const;
  double numberIn(double low, double high) const;
  std::int64_t integerIn(std::int64_t low, std::int64_t high) const;
  std::uint64_t natural() const; ///< the whole range of 64 bits
  bool boolean() const;
  std::string text() const;
  Eigen::Vector3d vector() const;
  Eigen::Matrix3d matrix() const;      ///< three rows of three
  Eigen::Matrix3d orthonormal() const; ///< within 1e-3 in every entry, either hand
  Eigen::Isometry3d pose() const;      ///< {rotation, translation}; right-handed
  std::vector<Value> items() const;    ///< of an array
  std::vector<Value> items(std::size_t n, const std::string& expected) const;

  /** \brief What \a key of this object is, with its place. */
  Value member(const std::string& key, const Json& json) const;

private:
  const Json* json_;
  std::string path_;
  const std::string* file_;
};

/** \brief The fields of a JSON object; remembers which were asked for. */
class Fields {
public:
  /** \throws LoadError if \a value is no object */
  explicit Fields(const Value& value);

  /** \throws LoadError if it is not there */
  Value at(const char* key);

  /** \brief The field; nothing if it is not there or null. */
  std::optional<Value> get(const char* key);

  std::string textOr(const char* key, const std::string& otherwise = "");

  /** \brief What nobody asked for, as the text of a JSON object; "" if there is none.
   */
  std::string rest() const;

private:
  Value value_;
  std::set<std::string_view> known_;
};

/** \brief Parses a text that is nested no deeper than 100 levels.
 *  \throws LoadError with "byte N" as its position */
Json parse(const std::string& text, const std::string& file);

/** \brief All bytes of a file of up to 256 MB.
 *  \throws LoadError */
std::string readText(const std::filesystem::path& file);

} // namespace json
} // namespace hoist
