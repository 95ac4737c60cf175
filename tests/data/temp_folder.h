#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace hoist {
namespace test {

/** \brief A folder for a test's files, gone when the test ends. */
class TempFolder {
public:
  TempFolder()
  {
    std::string name =
        (std::filesystem::temp_directory_path() / "hoist-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }

  ~TempFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  /** \brief Writes a file and returns its name. */
  std::string
  write(const std::string& name, const std::string& bytes) const
  {
    const auto path = path_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

  std::string
  name(const std::string& file) const
  {
    return (path_ / file).string();
  }

  const std::filesystem::path&
  path() const
  {
    return path_;
  }

private:
  std::filesystem::path path_;
};

inline std::string
readFile(const std::filesystem::path& path)
{
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace test
} // namespace hoist
