#include <hoist/data/load_error.h>
#include <hoist/simulation/mesh_file.h>

#include <charconv>
#include <cmath>
#include <string_view>

namespace hoist {
namespace simulation {
namespace {

class ObjCheck {
public:
  explicit ObjCheck(const std::string& name) : name_(name) {}

  void
  line(std::string_view text)
  {
    ++line_;
    const std::string_view key = word(text);
    if (key == "v")
      vertex(text);
    else if (key == "f")
      face(text);
  }

private:
  [[noreturn]] void
  fail(const std::string& reason) const
  {
    throw LoadError(name_, std::to_string(line_), reason);
  }

  // Takes the next word off the text; empty at its end.
  static std::string_view
  word(std::string_view& text)
  {
    const std::size_t start = text.find_first_not_of(" \t\r");
    if (start == std::string_view::npos)
      return {};
    text.remove_prefix(start);
    const std::size_t end = std::min(text.find_first_of(" \t\r"), text.size());
    const std::string_view found = text.substr(0, end);
    text.remove_prefix(end);
    return found;
  }

  void
  vertex(std::string_view text)
  {
    for (int i = 0; i < 3; ++i) {
      const std::string_view token = word(text);
      double value = 0;
      const auto result =
          std::from_chars(token.data(), token.data() + token.size(), value);
      if (token.empty() || result.ec != std::errc() ||
          result.ptr != token.data() + token.size() || !std::isfinite(value))
        fail("a vertex needs three numbers, found '" + std::string(token) + "'");
    }
    ++vertices_;
  }

  void
  face(std::string_view text)
  {
    int corners = 0;
    for (std::string_view token = word(text); !token.empty(); token = word(text)) {
      long index = 0;
      const std::string_view first = token.substr(0, token.find('/'));
      const auto result =
          std::from_chars(first.data(), first.data() + first.size(), index);
      if (result.ec != std::errc() || result.ptr != first.data() + first.size())
        fail("a face names its vertices by number, found '" + std::string(token) + "'");
      const long number = index < 0 ? vertices_ + 1 + index : index;
      if (number < 1 || number > vertices_)
        fail("a face names vertex " + std::to_string(index) + ", but there are " +
             std::to_string(vertices_));
      ++corners;
    }
    if (corners < 3)
      fail("a face needs three vertices, found " + std::to_string(corners));
  }

  std::string name_;
  int line_ = 0;
  long vertices_ = 0;
};

} // namespace

void
checkObj(const std::string& text, const std::string& name)
{
  ObjCheck check(name);
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    check.line(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

} // namespace simulation
} // namespace hoist
