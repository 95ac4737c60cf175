#include "onnx_inputs.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

namespace hoist {
namespace {

bool
readVarint(std::string_view& text, std::uint64_t& value)
{
  value = 0;
  for (int shift = 0; shift < 64 && !text.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(text.front());
    text.remove_prefix(1);
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80)
      return true;
  }
  return false;
}

// A field: its number, and its bytes or its whole number.
using Field = std::function<bool(std::uint64_t, std::string_view, std::uint64_t)>;

// false if the text ends within a field or the field's function says so.
bool
readMessage(std::string_view text, const Field& field)
{
  while (!text.empty()) {
    std::uint64_t key = 0, value = 0, length = 0;
    if (!readVarint(text, key))
      return false;
    const std::uint64_t kind = key & 7;
    if (kind == 0) {
      if (!readVarint(text, value))
        return false;
    }
    else if (kind == 2) {
      if (!readVarint(text, length))
        return false;
    }
    else if (kind == 1 || kind == 5)
      length = kind == 1 ? 8 : 4;
    else
      return false;
    if (length > text.size() || !field(key >> 3, text.substr(0, length), value))
      return false;
    text.remove_prefix(length);
  }
  return true;
}

// TypeProto.tensor_type (1) .shape (2) .dim (1) .dim_value (1)
bool
readShape(std::string_view type, std::vector<int>& shape)
{
  const Field side = [&](std::uint64_t number, std::string_view, std::uint64_t value) {
    if (number == 1 && value <= std::numeric_limits<int>::max())
      shape.back() = static_cast<int>(value);
    return true;
  };
  const Field sides = [&](std::uint64_t number, std::string_view text, std::uint64_t) {
    if (number != 1)
      return true;
    shape.push_back(-1);
    return readMessage(text, side);
  };
  const Field tensor = [&](std::uint64_t number, std::string_view text, std::uint64_t) {
    return number != 2 || readMessage(text, sides);
  };
  return readMessage(type,
                     [&](std::uint64_t number, std::string_view text, std::uint64_t) {
                       return number != 1 || readMessage(text, tensor);
                     });
}

} // namespace

bool
onnxInputs(const std::string& bytes, std::vector<std::vector<int>>& shapes)
{
  shapes.clear();
  std::set<std::string> weights;
  std::vector<std::pair<std::string, std::vector<int>>> inputs;
  const Field weight = [&](std::uint64_t number, std::string_view text, std::uint64_t) {
    if (number == 8)
      weights.emplace(text);
    return true;
  };
  const Field input = [&](std::uint64_t number, std::string_view text, std::uint64_t) {
    if (number == 1)
      inputs.back().first = std::string(text);
    return number != 2 || readShape(text, inputs.back().second);
  };
  const Field graph = [&](std::uint64_t number, std::string_view text, std::uint64_t) {
    if (number == 5)
      return readMessage(text, weight);
    if (number != 11)
      return true;
    inputs.emplace_back();
    return readMessage(text, input);
  };
  const bool good = readMessage(
      bytes, [&](std::uint64_t number, std::string_view text, std::uint64_t) {
        return number != 7 || readMessage(text, graph);
      });
  for (const auto& entry : inputs)
    if (weights.count(entry.first) == 0)
      shapes.push_back(entry.second);
  return good;
}

} // namespace hoist
