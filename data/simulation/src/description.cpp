#include <hoist/simulation/description.h>

#include "read_file.h"
#include "yaml_reader.h"

#include <cctype>
#include <filesystem>

namespace hoist {
namespace simulation {
namespace {

using YAML::Node;

// Every setting, with its limits.
class DescriptionReader {
public:
  explicit DescriptionReader(const std::string& file) : file_(file), read_(file) {}

  Description
  read(const std::string& text)
  {
    Node root;
    try {
      root = YAML::Load(text);
    }
    catch (const YAML::Exception& error) {
      read_.fail(error.mark, "not YAML: " + error.msg);
    }
    if (!root.IsMap())
      read_.fail(root, "not a scene: expected a map of settings");
    d_.sensor = Sensor::ideal();
    read_.readMap(root,
                  "a scene",
                  {{"name", [&](const Node& n) { d_.name = fileName(n); }},
                   {"sensor", [&](const Node& n) { readSensor(n); }},
                   {"camera", [&](const Node& n) { readCamera(n); }},
                   {"area", [&](const Node& n) { readArea(n); }},
                   {"table", [&](const Node& n) { d_.table = triple(n, 0.05, 10); }},
                   {"ground", [&](const Node& n) { readGround(n); }},
                   {"walls", [&](const Node& n) { readWalls(n); }},
                   {"light", [&](const Node& n) { readLight(n); }},
                   {"things", [&](const Node& n) { readThings(n); }},
                   {"visits", [&](const Node& n) { readVisits(n); }}});
    return d_;
  }

private:
  // Becomes part of file names.
  std::string
  fileName(const Node& node) const
  {
    std::string name = read_.word(node);
    for (const char c : name)
      if (!(std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_'))
        read_.fail(node, "a name is made of letters, digits, '-' and '_'");
    return name;
  }

  YamlReader::Setter
  to(double& value, double low, double high) const
  {
    return [this, &value, low, high](const Node& n) {
      value = read_.number(n, low, high);
    };
  }

  YamlReader::Setter
  to(int& value, int low, int high) const
  {
    return [this, &value, low, high](const Node& n) {
      value = read_.integer(n, low, high);
    };
  }

  YamlReader::Setter
  to(Range& value, double low, double high) const
  {
    return
        [this, &value, low, high](const Node& n) { value = read_.range(n, low, high); };
  }

  std::array<Range, 3>
  triple(const Node& node, double low, double high) const
  {
    const std::vector<Range> list = read_.ranges(node, 3, low, high);
    return {{list[0], list[1], list[2]}};
  }

  Eigen::Vector3d
  vector(const Node& node, double limit) const
  {
    const std::vector<double> list = read_.numbers(node, 3, -limit, limit);
    return {list[0], list[1], list[2]};
  }

  Sensor
  sensorOf(const Node& node) const
  {
    const std::string kind = node.IsScalar()                ? read_.word(node)
                             : node.IsMap() && node["kind"] ? read_.word(node["kind"])
                                                            : std::string("ideal");
    if (kind == "ideal")
      return Sensor::ideal();
    if (kind == "kinect")
      return Sensor::kinect();
    if (kind == "tof")
      return Sensor::tof();
    if (kind == "stereo")
      return Sensor::stereo();
    read_.fail(node.IsMap() ? node["kind"] : node,
               "unknown sensor '" + kind + "': one of ideal, kinect, tof, stereo");
  }

  void
  readSensor(const Node& node)
  {
    d_.sensor = sensorOf(node);
    if (node.IsScalar())
      return;
    Sensor& s = d_.sensor;
    read_.readMap(node,
                  "sensor",
                  {{"kind", [](const Node&) {}},
                   {"width", to(s.width, 16, 8192)},
                   {"height", to(s.height, 16, 8192)},
                   {"fx", to(s.camera.fx, 10, 1e5)},
                   {"fy", to(s.camera.fy, 10, 1e5)},
                   {"cx", to(s.camera.cx, -1e4, 1e4)},
                   {"cy", to(s.camera.cy, -1e4, 1e4)},
                   {"distortion",
                    [&](const Node& n) {
                      const std::vector<double> k = read_.numbers(n, 5, -5, 5);
                      std::copy(k.begin(), k.end(), s.distortion.begin());
                    }},
                   {"assumed",
                    [&](const Node& n) {
                      const std::vector<double> k = read_.numbers(n, 4, 0, 1e5);
                      s.assumed.emplace();
                      s.assumed->fx = k[0];
                      s.assumed->fy = k[1];
                      s.assumed->cx = k[2];
                      s.assumed->cy = k[3];
                      if (!s.assumed->valid())
                        read_.fail(n, "fx and fy must be above 0");
                    }},
                   {"registration_shift",
                    [&](const Node& n) { s.registration_shift = vector(n, 1); }},
                   {"registration_turn",
                    [&](const Node& n) {
                      s.registration_turn = vector(n, 45) * 0.017453292519943295;
                    }},
                   {"registration_error", to(d_.registration_error, 0, 0.5)},
                   {"registration_turn_error", to(d_.registration_turn_error, 0, 20)},
                   {"min_range", to(s.min_range, 0.01, 1000)},
                   {"max_range", to(s.max_range, 0.01, 1000)},
                   {"noise", to(s.noise, 0, 100)},
                   {"sigma_constant", to(s.sigma_constant, 0, 1)},
                   {"sigma_quadratic", to(s.sigma_quadratic, 0, 1)},
                   {"baseline", to(s.baseline, -5, 5)},
                   {"focal_ir", to(s.focal_ir, 10, 1e5)},
                   {"disparity_step", to(s.disparity_step, 0, 4)},
                   {"lateral", to(s.lateral, 0, 5)},
                   {"edge_loss", to(s.edge_loss, 0, 1)},
                   {"grazing_loss", to(s.grazing_loss, 0, 1)},
                   {"color_noise", to(s.color_noise, 0, 20)},
                   {"exposure", to(d_.exposure, -5, 5)},
                   {"white_balance_error", to(d_.white_balance_error, 0, 0.8)},
                   {"vignetting", to(s.vignetting, 0, 0.9)},
                   {"blur", to(s.blur, 0, 2)},
                   {"max_disparity",
                    [&](const Node& n) {
                      s.max_disparity = read_.integer(n, 16, 1024);
                      if (s.max_disparity % 16 != 0)
                        read_.fail(n, "max_disparity must be a multiple of 16");
                    }},
                   {"block_size",
                    [&](const Node& n) {
                      s.block_size = read_.integer(n, 1, 21);
                      if (s.block_size % 2 == 0)
                        read_.fail(n, "block_size must be odd");
                    }},
                   {"eye_misalignment", to(s.eye_misalignment, -5, 5)}});
    if (s.min_range >= s.max_range)
      read_.fail(node, "min_range must be below max_range");
    if (s.kind == SensorKind::stereo && s.baseline <= 0)
      read_.fail(node, "a stereo sensor needs a baseline above 0");
    if (!node["fy"] && node["fx"])
      s.camera.fy = s.camera.fx;
    if (!node["cx"])
      s.camera.cx = (s.width - 1) / 2.0;
    if (!node["cy"])
      s.camera.cy = (s.height - 1) / 2.0;
  }

  void
  readCamera(const Node& node)
  {
    read_.readMap(node,
                  "camera",
                  {{"distance", to(d_.distance, 0.1, 200)},
                   {"elevation", to(d_.elevation, -80, 90)},
                   {"azimuth", to(d_.azimuth, -720, 720)},
                   {"roll", to(d_.roll, -180, 180)},
                   {"target_jitter", to(d_.target_jitter, 0, 1)},
                   {"eye", [&](const Node& n) { d_.eye = vector(n, 1000); }},
                   {"target", [&](const Node& n) { d_.target = vector(n, 1000); }}});
    if (d_.eye.has_value() != d_.target.has_value())
      read_.fail(node, "eye and target go together");
    if (d_.eye && (*d_.eye - *d_.target).norm() < 1e-6)
      read_.fail(node, "eye and target are the same place");
  }

  void
  readArea(const Node& node)
  {
    const std::vector<double> list = read_.numbers(node, 2, 0.1, 200);
    d_.area = {{list[0], list[1]}};
  }

  void
  readGround(const Node& node)
  {
    read_.readMap(
        node,
        "ground",
        {{"texture", [&](const Node& n) { d_.ground = read_.textures(n); }},
         {"color", [&](const Node& n) { d_.ground_colors = read_.colors(n); }}});
  }

  void
  readWalls(const Node& node)
  {
    d_.walls = Range{2, 4, 0};
    read_.readMap(node,
                  "walls",
                  {{"count", to(*d_.walls, 0, 4)},
                   {"distance", to(d_.wall_distance, 0, 50)},
                   {"height", to(d_.wall_height, 0.5, 30)}});
  }

  void
  readLight(const Node& node)
  {
    read_.readMap(node,
                  "light",
                  {{"sun", to(d_.sun, 0, 1)},
                   {"sun_elevation", to(d_.sun_elevation, 1, 90)},
                   {"sun_power", to(d_.sun_power, 0, 100)},
                   {"sky_power", to(d_.sky_power, 0, 100)},
                   {"lamps", to(d_.lamps, 0, 16)},
                   {"lamp_height", to(d_.lamp_height, 0.2, 50)},
                   {"lamp_power", to(d_.lamp_power, 0, 1000)}});
  }

  void
  readVisits(const Node& node)
  {
    d_.visits = 2;
    d_.frames_per_visit = 20;
    d_.added = d_.moved = d_.gone = 0.15;
    read_.readMap(node,
                  "visits",
                  {{"count", to(d_.visits, 1, 100)},
                   {"frames", to(d_.frames_per_visit, 1, 10000)},
                   {"new", to(d_.added, 0, 1)},
                   {"moved", to(d_.moved, 0, 1)},
                   {"removed", to(d_.gone, 0, 1)}});
  }

  void
  readThings(const Node& node)
  {
    if (!node.IsSequence())
      read_.fail(node, "things must be a list");
    for (const auto& item : node)
      readGroup(item);
  }

  void
  readGroup(const Node& node)
  {
    ThingGroup g;
    g.line = node.Mark().line + 1;
    read_.readMap(
        node,
        "a thing",
        {{"kind", [&](const Node& n) { g.kinds = kindsOf(n); }},
         {"count", to(g.count, 0, 1000)},
         {"name", [&](const Node& n) { g.name = read_.word(n); }},
         {"size", [&](const Node& n) { g.size = triple(n, 0.001, 100); }},
         {"color", [&](const Node& n) { g.colors = read_.colors(n); }},
         {"texture", [&](const Node& n) { g.textures = read_.textures(n); }},
         {"wear", [&](const Node& n) { g.wear = read_.range(n, 0, 1); }},
         {"full", to(g.full, 0, 1)},
         {"at",
          [&](const Node& n) {
            const std::vector<Range> list = read_.ranges(n, 2, -200, 200);
            g.at = std::array<Range, 2>{{list[0], list[1]}};
          }},
         {"heading", [&](const Node& n) { g.heading = read_.range(n, -720, 720); }},
         {"lift", [&](const Node& n) { g.lift = read_.range(n, 0, 100); }},
         {"stacked", to(g.stacked, 0, 1)},
         {"touching", to(g.touching, 0, 1)},
         {"timbers", to(g.timbers, 0, 1)},
         {"tipped", to(g.tipped, 0, 1)},
         {"mesh", [&](const Node& n) { g.mesh = beside(read_.word(n)); }},
         {"library", to(g.library_share, 0, 1)},
         {"split", [&](const Node& n) { g.split = splitOf(n); }}});
    if (g.kinds.empty())
      read_.fail(node, "a thing needs a kind");
    d_.things.push_back(g);
  }

  std::vector<std::string>
  kindsOf(const Node& node) const
  {
    std::vector<std::string> kinds = read_.words(node);
    for (const std::string& kind : kinds)
      if (findKind(kind) == nullptr) {
        std::string known;
        for (const KindTraits& traits : thingKinds())
          known += (known.empty() ? "" : ", ") + traits.kind;
        read_.fail(node, "unknown kind '" + kind + "': one of " + known);
      }
    return kinds;
  }

  std::string
  splitOf(const Node& node) const
  {
    std::string split = read_.word(node);
    if (split != "train" && split != "test" && split != "none")
      read_.fail(node, "split is train, test or none, not '" + split + "'");
    return split == "none" ? "" : split;
  }

  std::string
  beside(const std::string& name) const
  {
    return (std::filesystem::path(file_).parent_path() / name).string();
  }

  std::string file_;
  YamlReader read_;
  Description d_;
};

} // namespace

Description
parseDescription(const std::string& text, const std::string& file)
{
  return DescriptionReader(file).read(text);
}

Description
loadDescription(const std::string& file)
{
  const std::optional<std::string> text = readFile(file);
  if (!text)
    throw LoadError(file, "", "cannot be read");
  return parseDescription(*text, file);
}

} // namespace simulation
} // namespace hoist
