#include <hoist/data/atomic_file.h>
#include <hoist/data/result_io.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>

namespace hoist {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN.
Json
number(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json
vectorJson(const Eigen::Vector3d& v)
{
  return {number(v.x()), number(v.y()), number(v.z())};
}

Json
matrixJson(const Eigen::Matrix3d& m)
{
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back(vectorJson(m.row(i).transpose()));
  return rows;
}

Json
poseJson(const Cuboid& cuboid)
{
  Json out;
  out["center"] = vectorJson(cuboid.center);
  out["size"] = vectorJson(cuboid.size);
  out["rotation"] = matrixJson(cuboid.axes);
  return out;
}

Json
featuresJson(const CuboidFeatures& f)
{
  Json out;
  out["rgb"] = f.rgb;
  out["lab"] = {number(f.lab[0]), number(f.lab[1]), number(f.lab[2])};
  out["color_name"] = f.color_name;
  out["orientation"] = {number(f.orientation.w()),
                        number(f.orientation.x()),
                        number(f.orientation.y()),
                        number(f.orientation.z())};
  out["lift_point"] = vectorJson(f.lift_point);
  out["lift_normal"] = vectorJson(f.lift_normal);
  out["lift_face_observed"] = f.lift_face_observed;
  out["material"] = f.material;
  out["weight"] = number(f.weight);
  out["weight_sigma"] = number(f.weight_sigma);
  return out;
}

Json
cuboidJson(const RecognizedCuboid& item, const FrameResult& result)
{
  const Cuboid& cuboid = item.cuboid;
  Json out = poseJson(cuboid);
  out["score"] = number(cuboid.score);
  out["model"] = toString(cuboid.model);
  out["center_sigma"] = vectorJson(cuboid.center_sigma);
  out["size_sigma"] = vectorJson(cuboid.size_sigma);
  out["rotation_sigma"] = number(cuboid.rotation_sigma);
  out["observed_faces"] = cuboid.observed_faces;
  out["dimension_source"] = {toString(cuboid.dimension_source[0]),
                             toString(cuboid.dimension_source[1]),
                             toString(cuboid.dimension_source[2])};
  out["pixels"] = cuboid.indices.size();
  out["features"] = featuresJson(item.features);
  if (result.pose_known)
    out["world"] = poseJson(transformed(cuboid, result.pose));
  return out;
}

Json
tallyJson(const Tally& tally)
{
  Json out = Json::object();
  for (const auto& [name, count] : tally.entries())
    out[name] = count;
  return out;
}

// ------------------------------------------------------------------------- reading

double
toNumber(const Json& json)
{
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Eigen::Vector3d
toVector(const Json& json)
{
  return {toNumber(json.at(0)), toNumber(json.at(1)), toNumber(json.at(2))};
}

Eigen::Matrix3d
toMatrix(const Json& json)
{
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    m.row(i) = toVector(json.at(i)).transpose();
  return m;
}

// The enumerator whose text it is.
template <typename Enum>
Enum
toEnum(const std::string& text, Enum last)
{
  for (int i = 0; i <= static_cast<int>(last); ++i)
    if (text == toString(static_cast<Enum>(i)))
      return static_cast<Enum>(i);
  throw std::invalid_argument("unknown word \"" + text.substr(0, 40) + '"');
}

// A Tally keeps pointers, so names from a file must live for ever. There are few: the
// stages' counters. A hostile file cannot add more than this.
const char*
keepName(const std::string& name)
{
  static std::mutex mutex;
  static std::set<std::string> names;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = names.find(name);
  if (found != names.end())
    return found->c_str();
  if (names.size() >= 4096 || name.size() > 200)
    throw std::invalid_argument("too many names of counts");
  return names.insert(name).first->c_str();
}

void
readTally(const Json& json, Tally& tally)
{
  for (const auto& [name, count] : json.items())
    tally.add(keepName(name), count.get<std::size_t>());
}

void
readFeatures(const Json& json, CuboidFeatures& f)
{
  f.rgb = json.at("rgb").get<std::array<unsigned char, 3>>();
  for (int i = 0; i < 3; ++i)
    f.lab[i] = toNumber(json.at("lab").at(i));
  f.color_name = json.at("color_name");
  const Json& q = json.at("orientation");
  f.orientation.w() = toNumber(q.at(0));
  f.orientation.x() = toNumber(q.at(1));
  f.orientation.y() = toNumber(q.at(2));
  f.orientation.z() = toNumber(q.at(3));
  f.lift_point = toVector(json.at("lift_point"));
  f.lift_normal = toVector(json.at("lift_normal"));
  f.lift_face_observed = json.at("lift_face_observed");
  f.material = json.at("material");
  f.weight = toNumber(json.at("weight"));
  f.weight_sigma = toNumber(json.at("weight_sigma"));
}

RecognizedCuboid
readCuboid(const Json& json)
{
  RecognizedCuboid item;
  Cuboid& cuboid = item.cuboid;
  cuboid.center = toVector(json.at("center"));
  cuboid.size = toVector(json.at("size"));
  cuboid.axes = toMatrix(json.at("rotation"));
  cuboid.score = toNumber(json.at("score"));
  cuboid.model = toEnum(json.at("model").get<std::string>(), CuboidModel::face);
  cuboid.center_sigma = toVector(json.at("center_sigma"));
  cuboid.size_sigma = toVector(json.at("size_sigma"));
  cuboid.rotation_sigma = toNumber(json.at("rotation_sigma"));
  cuboid.observed_faces = json.at("observed_faces").get<std::array<bool, 6>>();
  for (int i = 0; i < 3; ++i)
    cuboid.dimension_source[i] = toEnum(
        json.at("dimension_source").at(i).get<std::string>(), DimensionSource::unknown);
  readFeatures(json.at("features"), item.features);
  return item;
}

} // namespace

Cuboid
transformed(const Cuboid& cuboid, const Eigen::Isometry3d& pose)
{
  Cuboid out = cuboid;
  out.center = pose * cuboid.center;
  out.axes = pose.linear() * cuboid.axes;
  return out;
}

std::string
toJson(const FrameResult& result, int indent)
{
  Json out;
  out["scene"] = result.scene;
  out["mode"] = result.mode;
  out["width"] = result.width;
  out["height"] = result.height;
  out["intrinsics"] = {{"fx", number(result.intrinsics.fx)},
                       {"fy", number(result.intrinsics.fy)},
                       {"cx", number(result.intrinsics.cx)},
                       {"cy", number(result.intrinsics.cy)},
                       {"rms", number(result.intrinsics.rms)},
                       {"inliers", result.intrinsics.inliers},
                       {"records", result.intrinsics.records}};
  if (result.pose_known)
    out["pose"] = {{"rotation", matrixJson(result.pose.linear())},
                   {"translation", vectorJson(result.pose.translation())}};
  else
    out["pose"] = nullptr;
  out["cuboids"] = Json::array();
  for (const RecognizedCuboid& item : result.cuboids)
    out["cuboids"].push_back(cuboidJson(item, result));
  out["counts"] = tallyJson(result.diagnostics.counts);
  out["rejected"] = tallyJson(result.diagnostics.rejected);
  // a name that is no UTF-8 must not cost the result
  return out.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

FrameResult
fromJson(const std::string& text, const std::string& name)
{
  FrameResult result;
  try {
    const Json json = Json::parse(text);
    result.scene = json.at("scene");
    result.mode = json.at("mode");
    result.width = json.at("width");
    result.height = json.at("height");
    const Json& camera = json.at("intrinsics");
    result.intrinsics.fx = toNumber(camera.at("fx"));
    result.intrinsics.fy = toNumber(camera.at("fy"));
    result.intrinsics.cx = toNumber(camera.at("cx"));
    result.intrinsics.cy = toNumber(camera.at("cy"));
    result.intrinsics.rms = toNumber(camera.at("rms"));
    result.intrinsics.inliers = camera.at("inliers");
    result.intrinsics.records = camera.at("records");
    result.pose_known = !json.at("pose").is_null();
    if (result.pose_known) {
      result.pose.linear() = toMatrix(json.at("pose").at("rotation"));
      result.pose.translation() = toVector(json.at("pose").at("translation"));
    }
    for (const Json& item : json.at("cuboids"))
      result.cuboids.push_back(readCuboid(item));
    readTally(json.at("counts"), result.diagnostics.counts);
    readTally(json.at("rejected"), result.diagnostics.rejected);
  }
  catch (const Json::parse_error& error) {
    throw LoadError(name, "byte " + std::to_string(error.byte), error.what());
  }
  catch (const std::exception& error) { // a missing or wrong entry
    throw LoadError(name, "", error.what());
  }
  return result;
}

void
saveJson(const std::filesystem::path& file, const FrameResult& result)
{
  writeFileAtomically(file, toJson(result));
}

FrameResult
loadJson(const std::filesystem::path& file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw LoadError(file.string(), "", "cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return fromJson(text, file.string());
}

} // namespace hoist
