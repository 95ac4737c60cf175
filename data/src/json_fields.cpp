#include "json_fields.h"

#include <hoist/data/load_error.h>

#include <Eigen/SVD>

#include <cmath>
#include <fstream>
#include <limits>

namespace hoist {
namespace json {
namespace {

constexpr std::size_t max_bytes = std::size_t(256) << 20;
constexpr int max_depth = 100;

std::string
shortNumber(double value)
{
  return Json(value).dump();
}

std::string
described(const Json& json)
{
  if (json.is_array())
    return "an array of " + std::to_string(json.size());
  if (json.is_object())
    return "an object";
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 40)
    text = text.substr(0, 37) + "...";
  return text;
}

} // namespace

void
Value::fail(const std::string& expected) const
{
  failWith("expected " + expected + ", found " + described(*json_));
}

void
Value::failWith(const std::string& what) const
{
  throw LoadError(*file_, path_, what);
}

double
Value::number() const
{
  if (!json_->is_number() || !std::isfinite(json_->get<double>()))
    fail("a number");
  return json_->get<double>();
}

double
Value::numberFrom(double low) const
{
  if (!json_->is_number() || !(number() >= low))
    fail("a number of at least " + shortNumber(low));
  return number();
}

double
Value::numberIn(double low, double high) const
{
  if (!json_->is_number() || !(number() >= low && number() <= high))
    fail("a number from " + shortNumber(low) + " to " + shortNumber(high));
  return number();
}

std::int64_t
Value::integerIn(std::int64_t low, std::int64_t high) const
{
  // a number above 2^63 would wrap round to a negative one
  const bool fits =
      json_->is_number_integer() &&
      !(json_->is_number_unsigned() &&
        json_->get<std::uint64_t>() >
            static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  if (!fits || json_->get<std::int64_t>() < low || json_->get<std::int64_t>() > high)
    fail("a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return json_->get<std::int64_t>();
}

std::uint64_t
Value::natural() const
{
  if (!json_->is_number_unsigned())
    fail("a whole number from 0 to 18446744073709551615");
  return json_->get<std::uint64_t>();
}

bool
Value::boolean() const
{
  if (!json_->is_boolean())
    fail("true or false");
  return json_->get<bool>();
}

std::string
Value::text() const
{
  if (!json_->is_string())
    fail("a text");
  return json_->get<std::string>();
}

Eigen::Vector3d
Value::vector() const
{
  const std::vector<Value> entries = items(3, "three numbers");
  return {entries[0].number(), entries[1].number(), entries[2].number()};
}

Eigen::Matrix3d
Value::matrix() const
{
  const std::vector<Value> rows = items(3, "three rows of three numbers");
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    m.row(i) = rows[i].vector().transpose();
  return m;
}

Eigen::Matrix3d
Value::orthonormal() const
{
  const Eigen::Matrix3d m = matrix();
  const char* const wrong = "is not orthonormal: its columns must be three "
                            "perpendicular unit vectors within 0.001";
  // the decomposition does not end well on numbers whose squares overflow
  if (m.cwiseAbs().maxCoeff() > 2)
    failWith(wrong);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if ((svd.matrixU() * svd.matrixV().transpose() - m).cwiseAbs().maxCoeff() > 1e-3)
    failWith(wrong);
  return m;
}

Eigen::Isometry3d
Value::pose() const
{
  Fields fields(*this);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = fields.at("rotation").orthonormal();
  if (pose.linear().determinant() < 0)
    fields.at("rotation").failWith("is left-handed");
  pose.translation() = fields.at("translation").vector();
  return pose;
}

std::vector<Value>
Value::items() const
{
  if (!json_->is_array())
    fail("an array");
  std::vector<Value> out;
  out.reserve(json_->size());
  for (std::size_t i = 0; i < json_->size(); ++i)
    out.emplace_back((*json_)[i], path_ + '[' + std::to_string(i) + ']', *file_);
  return out;
}

std::vector<Value>
Value::items(std::size_t n, const std::string& expected) const
{
  if (!json_->is_array() || json_->size() != n)
    fail(expected);
  return items();
}

Value
Value::member(const std::string& key, const Json& json) const
{
  return {json, path_.empty() ? key : path_ + '.' + key, *file_};
}

// ------------------------------------------------------------------------- objects

Fields::Fields(const Value& value) : value_(value)
{
  if (!value.json().is_object())
    value.fail("an object");
}

Value
Fields::at(const char* key)
{
  if (const std::optional<Value> found = get(key))
    return *found;
  value_.failWith(std::string("\"") + key + "\" is missing");
}

std::optional<Value>
Fields::get(const char* key)
{
  known_.insert(key);
  const auto found = value_.json().find(key);
  if (found == value_.json().end() || found->is_null())
    return std::nullopt;
  return value_.member(key, *found);
}

std::string
Fields::textOr(const char* key, const std::string& otherwise)
{
  const std::optional<Value> found = get(key);
  return found ? found->text() : otherwise;
}

std::string
Fields::rest() const
{
  Json out = Json::object();
  for (const auto& [key, entry] : value_.json().items())
    if (known_.count(key) == 0)
      out[key] = entry;
  return out.empty() ? "" : out.dump();
}

// --------------------------------------------------------------------------- files

Json
parse(const std::string& text, const std::string& file)
{
  // what is nested without end would later be walked through by recursion
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        quoted = false;
    }
    else if (c == '"')
      quoted = true;
    else if (c == '[' || c == '{') {
      if (++depth > max_depth)
        throw LoadError(file,
                        "byte " + std::to_string(i + 1),
                        "nested deeper than " + std::to_string(max_depth) + " levels");
    }
    else if (c == ']' || c == '}')
      --depth;
  }
  try {
    return Json::parse(text);
  }
  catch (const Json::parse_error& error) {
    const std::string what = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::size_t start = what.find("] ");
    throw LoadError(file,
                    "byte " + std::to_string(error.byte),
                    "not JSON: " +
                        (start == std::string::npos ? what : what.substr(start + 2)));
  }
  catch (const Json::exception& error) { // a number that no double can hold
    throw LoadError(file, "", error.what());
  }
}

std::string
readText(const std::filesystem::path& file)
{
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw LoadError(file.string(), "", "is a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw LoadError(file.string(), "", "cannot be read");
  std::string text;
  char block[65536];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    if (text.size() > max_bytes)
      throw LoadError(file.string(), "", "larger than 256 MB");
  }
  if (in.bad())
    throw LoadError(file.string(), "", "cannot be read");
  return text;
}

} // namespace json
} // namespace hoist
