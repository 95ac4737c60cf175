#include "viewer/camera_file.h"

#include "failures.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

namespace hoist {
namespace {

std::vector<double>
numbersOf(const std::string& part, const std::string& file)
{
  std::vector<double> numbers;
  std::istringstream items(part);
  std::string item;
  while (std::getline(items, item, ',')) {
    double number = 0;
    const char* const end = item.data() + item.size();
    const char* begin = item.data();
    while (begin != end && *begin == ' ')
      ++begin;
    const auto read = std::from_chars(begin, end, number);
    if (read.ec != std::errc() || read.ptr != end || !std::isfinite(number))
      throw FileError(file + ": '" + item + "' is no number of a camera");
    numbers.push_back(number);
  }
  return numbers;
}

void
append(std::string& text, std::initializer_list<double> numbers, char end)
{
  bool first = true;
  for (const double number : numbers) {
    char digits[40];
    const auto to = std::to_chars(digits, digits + sizeof digits, number);
    text += (first ? "" : ",") + std::string(digits, to.ptr);
    first = false;
  }
  text += end;
}

} // namespace

ViewCamera
readCameraFile(const std::string& file)
{
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line))
    throw FileError(file + ": cannot be read, or is empty");
  if (!line.empty() && line.back() == '\r')
    line.pop_back();
  std::vector<std::vector<double>> parts;
  std::istringstream texts(line);
  for (std::string part; std::getline(texts, part, '/');)
    parts.push_back(numbersOf(part, file));
  constexpr std::array<std::size_t, 7> sizes = {2, 3, 3, 3, 1, 2, 2};
  bool good = parts.size() == sizes.size();
  for (std::size_t i = 0; good && i < sizes.size(); ++i)
    good = parts[i].size() == sizes[i];
  if (!good)
    throw FileError(file + ": not near,far/focal/position/up/angle/size/corner");
  ViewCamera camera;
  camera.clip = Eigen::Vector2d(parts[0].data());
  camera.focal = Eigen::Vector3d(parts[1].data());
  camera.position = Eigen::Vector3d(parts[2].data());
  camera.up = Eigen::Vector3d(parts[3].data());
  camera.angle = parts[4][0];
  const auto whole = [](double number) {
    return static_cast<int>(std::min(std::max(number, -1e5), 1e5));
  };
  camera.window = {whole(parts[5][0]), whole(parts[5][1])};
  camera.corner = {whole(parts[6][0]), whole(parts[6][1])};
  const Eigen::Vector3d way = camera.focal - camera.position;
  if (!(camera.angle > 0 && camera.angle < 3.1) || way.norm() == 0 ||
      way.cross(camera.up).norm() == 0)
    throw FileError(file + ": this camera sees nothing");
  return camera;
}

std::string
cameraText(const ViewCamera& c)
{
  std::string text;
  append(text, {c.clip[0], c.clip[1]}, '/');
  append(text, {c.focal[0], c.focal[1], c.focal[2]}, '/');
  append(text, {c.position[0], c.position[1], c.position[2]}, '/');
  append(text, {c.up[0], c.up[1], c.up[2]}, '/');
  append(text, {c.angle}, '/');
  append(text, {double(c.window[0]), double(c.window[1])}, '/');
  append(text, {double(c.corner[0]), double(c.corner[1])}, '\n');
  return text;
}

} // namespace hoist
