#include "batch/inputs.h"

#include "batch/hash.h"
#include "failures.h"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

namespace hoist {
namespace {

namespace fs = std::filesystem;

// File systems end at 255 bytes, and a record's ending comes behind.
constexpr std::size_t longest_name = 200;

bool
isCloud(const fs::path& file)
{
  std::string ending = file.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  // not .txt: in a folder that is a note more often than a cloud
  return ending == ".pcd" || ending == ".ply" || ending == ".pts" || ending == ".xyz" ||
         ending == ".asc";
}

class Expander {
public:
  explicit Expander(const InputRequest& request) : out_(request.out)
  {
    for (const std::string& input : request.inputs)
      if (input == "-")
        addList(std::cin, "standard input");
      else
        addInput(input);
    for (const std::string& file : request.manifests) {
      if (file == "-") {
        addList(std::cin, "standard input");
        continue;
      }
      std::ifstream list(file, std::ios::binary);
      if (!list)
        throw UsageError(file + ": cannot be read");
      addList(list, file);
    }
  }

  std::vector<std::string> paths;

private:
  void
  addInput(const std::string& input)
  {
    std::error_code error;
    const fs::file_status status = fs::status(input, error);
    if (fs::is_directory(status))
      addFolder(input);
    else if (fs::exists(status))
      paths.push_back(input);
    else if (input.find_first_of("*?[") != std::string::npos)
      addPattern(input);
    else
      throw UsageError(input + ": no such file or folder");
  }

  void
  addFolder(const std::string& folder)
  {
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, error);
    for (; !error && entry != fs::recursive_directory_iterator();
         entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_directory(ignored)) {
        // results of an earlier run are no inputs
        if (!out_.empty() && fs::equivalent(entry->path(), out_, ignored))
          entry.disable_recursion_pending();
      }
      else if (isCloud(entry->path()))
        paths.push_back(entry->path().string());
    }
    if (error)
      throw UsageError(folder + ": cannot be listed: " + error.message());
  }

  void
  addPattern(const std::string& pattern)
  {
    glob_t found{};
    const int failed = ::glob(pattern.c_str(), GLOB_ERR, nullptr, &found);
    const std::vector<std::string> matches(
        found.gl_pathv, found.gl_pathv + (failed == 0 ? found.gl_pathc : 0));
    ::globfree(&found);
    if (matches.empty())
      throw UsageError("no file matches '" + pattern + "'");
    for (const std::string& match : matches) {
      std::error_code ignored;
      if (fs::is_directory(match, ignored))
        addFolder(match);
      else
        paths.push_back(match);
    }
  }

  void
  addList(std::istream& in, const std::string& name)
  {
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (in.bad())
      throw UsageError(name + ": cannot be read");
    const char separator = text.find('\0') == std::string::npos ? '\n' : '\0';
    for (std::size_t start = 0; start < text.size();) {
      const std::size_t end = std::min(text.find(separator, start), text.size());
      std::string line = text.substr(start, end - start);
      if (separator == '\n' && !line.empty() && line.back() == '\r')
        line.pop_back();
      if (!line.empty())
        paths.push_back(std::move(line));
      start = end + 1;
    }
  }

  fs::path out_;
};

} // namespace

std::string
recordName(const std::string& path)
{
  std::string name;
  for (const fs::path& part : fs::path(path).lexically_normal().relative_path()) {
    std::string text = part.string();
    if (text.empty() || text == ".")
      continue;
    if (text == "..") // results stay below their folder
      text = "_parent";
    if (text.size() > longest_name)
      text = text.substr(0, longest_name - 17) + "~" + hexOf(hashOf(text));
    name += (name.empty() ? "" : "/") + text;
  }
  return name;
}

std::vector<InputFile>
expandInputs(const InputRequest& request)
{
  std::vector<InputFile> files;
  for (std::string& path : Expander(request).paths) {
    std::string name = recordName(path);
    if (!name.empty())
      files.push_back({std::move(path), std::move(name)});
  }
  std::sort(files.begin(), files.end(), [](const InputFile& a, const InputFile& b) {
    return a.name != b.name ? a.name < b.name : a.path < b.path;
  });
  const auto same = [](const InputFile& a, const InputFile& b) {
    if (a.name != b.name)
      return false;
    if (fs::path(a.path).lexically_normal() == fs::path(b.path).lexically_normal())
      return true;
    throw UsageError(a.path + " and " + b.path + " would both write " + a.name +
                     ".json");
  };
  files.erase(std::unique(files.begin(), files.end(), same), files.end());
  return files;
}

bool
inShard(const std::string& name, std::size_t k, std::size_t n)
{
  // FNV's low bits alone follow the last letters: mixed by Fibonacci's multiplier
  const std::uint64_t mixed = (hashOf(name) >> 32 ^ hashOf(name)) * 0x9e3779b97f4a7c15u;
  return (mixed >> 32) % n == k - 1;
}

} // namespace hoist
