#include "read_file.h"
#include <hoist/data/load_error.h>
#include <hoist/simulation/mesh_file.h>

#include <opencv2/imgcodecs.hpp>

#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

namespace hoist {
namespace simulation {
namespace {

namespace fs = std::filesystem;

constexpr unsigned most_triangles = 2000000;

// A file in memory, for assimp.
class MemoryStream : public Assimp::IOStream {
public:
  explicit MemoryStream(std::string bytes) : bytes_(std::move(bytes)) {}

  std::size_t
  Read(void* buffer, std::size_t size, std::size_t count) override // NOLINT: assimp's
  {
    if (size == 0)
      return 0;
    const std::size_t n = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(buffer, bytes_.data() + at_, n * size);
    at_ += n * size;
    return n;
  }

  std::size_t
  Write(const void*, std::size_t, std::size_t) override // NOLINT
  {
    return 0;
  }

  aiReturn
  Seek(std::size_t offset, aiOrigin origin) override // NOLINT
  {
    const std::size_t base = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    if (base + offset > bytes_.size())
      return aiReturn_FAILURE;
    at_ = base + offset;
    return aiReturn_SUCCESS;
  }

  std::size_t
  Tell() const override // NOLINT
  {
    return at_;
  }

  std::size_t
  FileSize() const override // NOLINT
  {
    return bytes_.size();
  }

  void
  Flush() override // NOLINT
  {
  }

private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class SourceSystem : public Assimp::IOSystem {
public:
  explicit SourceSystem(const FileSource& source) : source_(source) {}

  bool
  Exists(const char* name) const override // NOLINT
  {
    return source_(name).has_value();
  }

  char
  getOsSeparator() const override
  {
    return '/';
  }

  Assimp::IOStream*
  Open(const char* name, const char*) override // NOLINT
  {
    std::optional<std::string> bytes = source_(name);
    return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
  }

  void
  Close(Assimp::IOStream* stream) override // NOLINT
  {
    delete stream;
  }

private:
  const FileSource& source_;
};

unsigned char
byteOf(double value)
{
  return static_cast<unsigned char>(std::clamp(value * 255 + 0.5, 0.0, 255.0));
}

Material
materialOf(const aiMaterial& from, const std::string& name, const FileSource& source)
{
  Material material;
  aiColor3D color(0.6f, 0.6f, 0.6f);
  from.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  material.color = {{byteOf(color.r), byteOf(color.g), byteOf(color.b)}};
  float shininess = 0;
  from.Get(AI_MATKEY_SHININESS, shininess);
  material.gloss = std::clamp(static_cast<double>(shininess) / 1000, 0.0, 0.3);
  if (substanceNamed(from.GetName().C_Str()) == "metal") {
    material.metal = true;
    material.gloss = std::max(material.gloss, 0.3);
  }
  aiString picture;
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &picture) == aiReturn_SUCCESS) {
    const auto bytes =
        source((fs::path(name).parent_path() / picture.C_Str()).string());
    cv::Mat image;
    if (bytes && !bytes->empty())
      image = cv::imdecode(cv::Mat(1,
                                   static_cast<int>(bytes->size()),
                                   CV_8U,
                                   const_cast<char*>(bytes->data())),
                           cv::IMREAD_COLOR);
    if (!image.empty()) {
      const cv::Scalar mean = cv::mean(image);
      for (std::size_t i = 0; i < 3; ++i)
        material.color[i] =
            static_cast<unsigned char>(std::lround(mean[2 - static_cast<int>(i)]));
    }
  }
  return material;
}

void
addMesh(const aiMesh& from, LoadedMesh& out, const std::string& name)
{
  Mesh& mesh = out.mesh;
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiVector3D& p = from.mVertices[i];
    mesh.vertices.emplace_back(p.x, p.y, p.z);
    if (!mesh.vertices.back().allFinite())
      throw LoadError(name, "", "has a vertex that is not finite");
    const aiVector3D n = from.HasNormals() ? from.mNormals[i] : aiVector3D(0, 0, 0);
    mesh.normals.emplace_back(n.x, n.y, n.z);
    if (!mesh.normals.back().allFinite())
      mesh.normals.back().setZero();
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) // points and lines have no surface
      continue;
    mesh.triangles.push_back({{{offset + face.mIndices[0],
                                offset + face.mIndices[1],
                                offset + face.mIndices[2]}},
                              static_cast<std::uint16_t>(from.mMaterialIndex),
                              Mesh::no_face});
  }
}

bool
endsInObj(const std::string& name)
{
  std::string ending = fs::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return ending == ".obj";
}

} // namespace

std::string
substanceNamed(const std::string& material)
{
  // English, and what the library's authors speak; paint hides what is under it
  static const std::vector<std::pair<const char*, const char*>> words = {
      {"plasti", "plastic"}, {"plzstic", "plastic"}, {"rubber", "plastic"},
      {"paint", ""},         {"metal", "metal"},     {"chrom", "metal"},
      {"alumin", "metal"},   {"steel", "metal"},     {"wood", "wood"},
      {"oak", "wood"},       {"pine", "wood"},       {"theca", "wood"},
      {"madeira", "wood"},   {"fusta", "wood"},      {"rattan", "wood"},
      {"cloth", "fabric"},   {"fabric", "fabric"},   {"textile", "fabric"},
      {"cushion", "fabric"}, {"tela", "fabric"},     {"coixi", "fabric"},
      {"estofa", "fabric"}};
  std::string name = material;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  for (const auto& [word, substance] : words)
    if (name.find(word) != std::string::npos)
      return substance;
  return "";
}

std::string
substanceOfMost(const LoadedMesh& shape)
{
  std::map<std::string, double> areas;
  for (const Mesh::Triangle& t : shape.mesh.triangles) {
    const Eigen::Vector3d& a = shape.mesh.vertices[t.corners[0]];
    areas[shape.substances[t.material]] +=
        (shape.mesh.vertices[t.corners[1]] - a)
            .cross(shape.mesh.vertices[t.corners[2]] - a)
            .norm();
  }
  const auto most =
      std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  return most == areas.end() ? std::string() : most->first;
}

LoadedMesh
loadMesh(const std::string& name, const FileSource& source)
{
  const std::optional<std::string> bytes = source(name);
  if (!bytes)
    throw LoadError(name, "", "cannot be read");
  Assimp::Importer importer;
  importer.SetIOHandler(new SourceSystem(source)); // the importer deletes it
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 50);
  const aiScene* scene = importer.ReadFile(
      name,
      aiProcess_Triangulate | aiProcess_PreTransformVertices |
          aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices |
          aiProcess_FindInvalidData);
  if (scene == nullptr)
    throw LoadError(name, "", importer.GetErrorString());
  LoadedMesh out;
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
    const aiMaterial& material = *scene->mMaterials[i];
    out.materials.push_back(materialOf(material, name, source));
    out.substances.push_back(substanceNamed(material.GetName().C_Str()));
  }
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    addMesh(*scene->mMeshes[i], out, name);
  if (out.mesh.triangles.empty())
    throw LoadError(name, "", "holds no triangles");
  if (out.mesh.triangles.size() > most_triangles)
    throw LoadError(name, "", "holds more than two million triangles");
  return out;
}

LoadedMesh
loadMesh(const std::string& file)
{
  if (endsInObj(file))
    if (const std::optional<std::string> text = readFile(file))
      checkObj(*text, file);
  return loadMesh(file, readFile);
}

} // namespace simulation
} // namespace hoist
