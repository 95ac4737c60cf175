#include <hoist/simulation/mesh_library.h>

#include "zip_archive.h"
#include <hoist/data/load_error.h>
#include <hoist/simulation/random.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <sstream>

namespace hoist {
namespace simulation {
namespace {

namespace fs = std::filesystem;

// Names of the catalogues that are things of a class beyond doubt.
const std::map<std::string, std::set<std::string>>&
namesOfKinds()
{
  static const std::map<std::string, std::set<std::string>> names = {
      {"chair",
       {"Chair",
        "Oak chair",
        "Chair with cushion",
        "Folding chair",
        "Osaka chair",
        "Child chair",
        "Cafe chair",
        "Teck chair",
        "Plastic chair",
        "Children chair",
        "Armchair",
        "Modern armchair",
        "Rattan armchair"}},
      {"plant",
       {"Plant",
        "Little plant",
        "Decorative plant",
        "Indoor plant",
        "Spider plant",
        "Succulent plant",
        "Ficus",
        "Bonsai tree",
        "Flowers"}},
      {"recycle bin",
       {"Dustbin",
        "Park trashcan",
        "Residential trashcan",
        "Recycling bin",
        "Bullet trash can"}},
      {"safety cone", {"Cone"}},
      {"safety gloves", {"Glove"}}};
  return names;
}

const char*
substanceOf(const std::string& kind)
{
  return kind == "plant" ? "organic" : kind == "safety gloves" ? "fabric" : "plastic";
}

std::string
folder()
{
  const char* given = std::getenv("HOIST_FURNITURE");
  return given != nullptr ? given : "/usr/share/sweethome3d/furniture";
}

// Archives stay open: each is some megabytes.
const ZipArchive&
archiveNamed(const std::string& name)
{
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<ZipArchive>> open;
  const std::lock_guard<std::mutex> lock(mutex);
  std::unique_ptr<ZipArchive>& archive = open[name];
  if (!archive)
    archive = std::make_unique<ZipArchive>((fs::path(folder()) / name).string());
  return *archive;
}

std::vector<double>
numbersIn(const std::string& text)
{
  std::vector<double> list;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at < end) {
    double value = 0;
    const auto result = std::from_chars(at, end, value);
    if (result.ec == std::errc())
      list.push_back(value);
    at = result.ec == std::errc() ? result.ptr : at + 1;
  }
  return list;
}

// Entries "key#number=value" of a catalogue, by number.
std::map<int, std::map<std::string, std::string>>
catalogueOf(const std::string& text)
{
  std::map<int, std::map<std::string, std::string>> entries;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t hash = line.find('#'), equals = line.find('=');
    if (hash == 0 || hash == std::string::npos || equals == std::string::npos ||
        hash > equals)
      continue;
    int number = 0;
    std::from_chars(line.data() + hash + 1, line.data() + equals, number);
    std::string value = line.substr(equals + 1);
    while (!value.empty() && (value.back() == '\r' || value.back() == ' '))
      value.pop_back();
    entries[number][line.substr(0, hash)] = value;
  }
  return entries;
}

// Which axis of the mesh is which of the catalogue; exact, or not used.
bool
turnOf(const std::map<std::string, std::string>& entry, Eigen::Matrix3d& turn)
{
  turn.setIdentity();
  const auto given = entry.find("modelRotation");
  if (given == entry.end())
    return true;
  const std::vector<double> list = numbersIn(given->second);
  if (list.size() != 9)
    return false;
  for (int i = 0; i < 9; ++i)
    turn(i / 3, i % 3) = list[static_cast<std::size_t>(i)];
  return (turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3;
}

std::vector<LibraryMesh>
readLibrary()
{
  std::vector<LibraryMesh> library;
  for (const char* name : {"BlendSwap-CC-0.sh3f",
                           "BlendSwap-CC-BY.sh3f",
                           "KatorLegaz.sh3f",
                           "Scopia.sh3f"}) {
    if (!fs::exists(fs::path(folder()) / name))
      throw LoadError((fs::path(folder()) / name).string(),
                      "",
                      "is missing: shapes of the library need the package "
                      "sweethome3d-furniture");
    const ZipArchive& archive = archiveNamed(name);
    const auto entries = catalogueOf(archive.read("PluginFurnitureCatalog.properties"));
    for (const auto& numbered : entries) {
      const std::map<std::string, std::string>& entry = numbered.second;
      const auto text = [&](const char* key) {
        const auto found = entry.find(key);
        return found == entry.end() ? std::string() : found->second;
      };
      for (const auto& [kind, names] : namesOfKinds()) {
        if (names.count(text("name")) == 0)
          continue;
        LibraryMesh mesh;
        mesh.kind = kind;
        mesh.name = text("name");
        mesh.archive = name;
        mesh.model = text("model");
        if (!mesh.model.empty() && mesh.model.front() == '/')
          mesh.model.erase(0, 1);
        std::array<double, 3> size{};
        const char* keys[] = {"depth", "width", "height"};
        bool good = archive.has(mesh.model) && turnOf(entry, mesh.turn);
        for (std::size_t i = 0; i < 3; ++i) {
          const std::vector<double> list = numbersIn(text(keys[i]));
          size[i] = list.empty() ? 0 : list.front() / 100; // cm
          good = good && size[i] > 0.02 && size[i] < 3;
        }
        if (!good)
          continue;
        mesh.size = {size[0], size[1], size[2]};
        mesh.substance = substanceOf(kind);
        mesh.test = subSeed(3, mesh.model) % 3 == 0 || names.size() == 1;
        library.push_back(mesh);
      }
    }
  }
  return library;
}

std::shared_ptr<const LoadedMesh>
readShape(const LibraryMesh& entry)
{
  const ZipArchive& archive = archiveNamed(entry.archive);
  const FileSource source = [&](const std::string& name) -> std::optional<std::string> {
    const std::string path = fs::path(name).lexically_normal().string();
    if (!archive.has(path))
      return std::nullopt;
    return archive.read(path);
  };
  auto shape = std::make_shared<LoadedMesh>(loadMesh(entry.model, source));
  // the catalogue's x right, y up, z front to ours: x front, y to its right, z up
  Eigen::Matrix3d to_ours;
  to_ours << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Eigen::Matrix3d turn = to_ours * entry.turn;
  for (Eigen::Vector3d& p : shape->mesh.vertices)
    p = turn * p;
  for (Eigen::Vector3f& n : shape->mesh.normals)
    n = turn.cast<float>() * n;
  const Eigen::AlignedBox3d box = shape->mesh.bounds();
  const Eigen::Vector3d scale = entry.size.cwiseQuotient(box.sizes().cwiseMax(1e-9));
  for (Eigen::Vector3d& p : shape->mesh.vertices)
    p = (p - box.center()).cwiseProduct(scale);
  for (Eigen::Vector3f& n : shape->mesh.normals)
    n = n.cwiseQuotient(scale.cast<float>()).normalized();
  return shape;
}

} // namespace

const std::vector<LibraryMesh>&
meshLibrary()
{
  static const std::vector<LibraryMesh> library = readLibrary();
  return library;
}

std::shared_ptr<const LoadedMesh>
libraryShape(const LibraryMesh& entry)
{
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const LoadedMesh>> shapes;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<const LoadedMesh>& shape = shapes[entry.archive + ":" + entry.model];
  if (!shape)
    shape = readShape(entry);
  return shape;
}

} // namespace simulation
} // namespace hoist
