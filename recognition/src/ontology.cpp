#include <hoist/recognition/ontology.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <set>
#include <sstream>

#include <yaml-cpp/yaml.h>

namespace hoist {
namespace {

std::string
shown(const YAML::Node& node)
{
  if (node.IsScalar())
    return "'" + node.Scalar().substr(0, 40) + "'";
  if (node.IsSequence())
    return "a list of " + std::to_string(node.size());
  return node.IsMap() ? "a map" : "nothing";
}

// Walks the file and knows where it is: every value is read with its path.
class OntologyReader {
public:
  explicit OntologyReader(std::string file) : file_(std::move(file)) {}

  Ontology read(const YAML::Node& root) const;

private:
  [[noreturn]] void
  fail(const YAML::Node& node, const std::string& path, const std::string& reason) const
  {
    const YAML::Mark mark = node.Mark();
    throw LoadError(file_,
                    mark.is_null() ? "" : std::to_string(mark.line + 1),
                    path + ": " + reason);
  }

  // A map with no keys but these, none twice.
  void
  checkKeys(const YAML::Node& map,
            const std::string& path,
            const std::set<std::string>& known) const
  {
    if (!map.IsMap())
      fail(map, path, "expected a map, found " + shown(map));
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const std::string key = word(entry.first, path);
      if (!known.empty() && known.count(key) == 0)
        fail(entry.first, path, "unknown entry '" + key + "'");
      if (!seen.insert(key).second)
        fail(entry.first, path, "'" + key + "' is given twice");
    }
  }

  YAML::Node
  need(const YAML::Node& map, const std::string& path, const std::string& key) const
  {
    const YAML::Node node = map[key];
    if (!node)
      fail(map, path, "'" + key + "' is missing");
    return node;
  }

  std::string
  word(const YAML::Node& node, const std::string& path) const
  {
    if (!node.IsScalar() || node.Scalar().empty())
      fail(node, path, "expected a word, found " + shown(node));
    return node.Scalar();
  }

  std::string
  oneOf(const YAML::Node& node,
        const std::string& path,
        std::initializer_list<const char*> choices) const
  {
    const std::string text = word(node, path);
    std::string list;
    for (const char* choice : choices) {
      if (text == choice)
        return text;
      list += (list.empty() ? "" : " or ") + std::string(choice);
    }
    fail(node, path, "expected " + list + ", found " + shown(node));
  }

  // Words of a list, each once, at least \a least of them.
  std::vector<std::string>
  words(const YAML::Node& node, const std::string& path, std::size_t least) const
  {
    if (!node.IsSequence())
      fail(node, path, "expected a list of words, found " + shown(node));
    std::vector<std::string> list;
    for (const auto& item : node) {
      list.push_back(word(item, path));
      if (std::count(list.begin(), list.end(), list.back()) > 1)
        fail(item, path, "'" + list.back() + "' is given twice");
    }
    if (list.size() < least)
      fail(node, path, "needs at least " + std::to_string(least) + " entries");
    return list;
  }

  double
  number(const YAML::Node& node, const std::string& path) const
  {
    double value = 0;
    const std::string text = node.IsScalar() ? node.Scalar() : "";
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
      fail(node, path, "expected a number, found " + shown(node));
    return value;
  }

  std::array<double, 2>
  numbers(const YAML::Node& node, const std::string& path) const
  {
    if (!node.IsSequence() || node.size() != 2)
      fail(node, path, "expected two numbers, found " + shown(node));
    return {{number(node[0], path), number(node[1], path)}};
  }

  AttributeSpec attribute(const YAML::Node& node,
                          const std::string& name,
                          const std::string& path) const;
  ClassSpec
  oneClass(const YAML::Node& node, const std::string& path, const Ontology& all) const;
  void checkMaterials(const YAML::Node& attributes, const Ontology& all) const;

  std::string file_;
};

AttributeSpec
OntologyReader::attribute(const YAML::Node& node,
                          const std::string& name,
                          const std::string& path) const
{
  if (!node.IsMap())
    fail(node, path, "expected a map, found " + shown(node));
  AttributeSpec spec;
  spec.name = name;
  const std::string type = oneOf(
      need(node, path, "type"), path + ".type", {"numeric", "categorical", "boolean"});
  std::set<std::string> known = {"type", "encoding", "loss", "truth"};
  const char *encoding = "binary", *loss = "cross-entropy";
  if (type == "numeric") {
    known.insert({"components", "unit", "range"});
    encoding = "linear";
    loss = "quadratic";
    spec.type = AttributeType::numeric;
    spec.range = numbers(need(node, path, "range"), path + ".range");
    if (!(spec.range[0] < spec.range[1]))
      fail(node["range"], path + ".range", "its low end is not below its high end");
    if (const YAML::Node list = node["components"])
      spec.components = words(list, path + ".components", 1);
    if (const YAML::Node unit = node["unit"])
      spec.unit = word(unit, path + ".unit");
  }
  else if (type == "categorical") {
    known.insert("values");
    encoding = "one-hot";
    spec.type = AttributeType::categorical;
    spec.values = words(need(node, path, "values"), path + ".values", 2);
  }
  else
    spec.type = AttributeType::boolean;
  checkKeys(node, path, known);
  spec.encoding = oneOf(need(node, path, "encoding"), path + ".encoding", {encoding});
  spec.loss = oneOf(need(node, path, "loss"), path + ".loss", {loss});
  spec.truth = word(need(node, path, "truth"), path + ".truth");
  return spec;
}

ClassSpec
OntologyReader::oneClass(const YAML::Node& node,
                         const std::string& path,
                         const Ontology& all) const
{
  checkKeys(node, path, {"name", "attributes", "box_like"});
  ClassSpec spec;
  spec.name = word(need(node, path, "name"), path + ".name");
  if (all.findClass(spec.name) != nullptr)
    fail(node["name"], path + ".name", "there is a class '" + spec.name + "' already");
  const YAML::Node list = need(node, path, "attributes");
  for (const std::string& name : words(list, path + ".attributes", 0)) {
    const AttributeSpec* found = all.findAttribute(name);
    if (found == nullptr)
      fail(list, path + ".attributes", "there is no attribute '" + name + "'");
    spec.attributes.push_back(static_cast<std::size_t>(found - all.attributes.data()));
  }
  if (const YAML::Node flag = node["box_like"])
    spec.box_like = oneOf(flag, path + ".box_like", {"true", "false"}) == "true";
  return spec;
}

void
OntologyReader::checkMaterials(const YAML::Node& attributes, const Ontology& all) const
{
  // a weight needs the density of whatever a thing may turn out to be made of
  for (const AttributeSpec& spec : all.attributes)
    if (spec.truth == "material")
      for (const std::string& value : spec.values)
        if (all.findMaterial(value) == nullptr)
          fail(attributes[spec.name]["values"],
               "attributes." + spec.name + ".values",
               "'" + value + "' has no density in 'materials'");
}

Ontology
OntologyReader::read(const YAML::Node& root) const
{
  checkKeys(
      root, "ontology", {"name", "version", "materials", "attributes", "classes"});
  Ontology all;
  all.name = word(need(root, "ontology", "name"), "name");
  const YAML::Node version = need(root, "ontology", "version");
  if (number(version, "version") != 1)
    fail(version, "version", "expected 1, found " + shown(version));
  if (const YAML::Node map = root["materials"]) {
    checkKeys(map, "materials", {});
    for (const auto& entry : map) {
      MaterialSpec spec;
      spec.name = entry.first.Scalar();
      const std::string path = "materials." + spec.name;
      checkKeys(entry.second, path, {"density"});
      const YAML::Node density = need(entry.second, path, "density");
      spec.density = numbers(density, path + ".density");
      if (!(spec.density[0] > 0 && spec.density[0] <= spec.density[1]))
        fail(density, path + ".density", "must be 0 < low <= high [kg/m3]");
      all.materials.push_back(spec);
    }
  }
  const YAML::Node attributes = need(root, "ontology", "attributes");
  checkKeys(attributes, "attributes", {});
  for (const auto& entry : attributes)
    all.attributes.push_back(attribute(
        entry.second, entry.first.Scalar(), "attributes." + entry.first.Scalar()));
  checkMaterials(attributes, all);
  const YAML::Node classes = need(root, "ontology", "classes");
  if (!classes.IsSequence() || classes.size() == 0)
    fail(classes, "classes", "expected a list of classes, found " + shown(classes));
  for (std::size_t i = 0; i < classes.size(); ++i)
    all.classes.push_back(
        oneClass(classes[i], "classes[" + std::to_string(i) + "]", all));
  return all;
}

template <typename T>
const T*
named(const std::vector<T>& list, const std::string& name)
{
  const auto found = std::find_if(
      list.begin(), list.end(), [&](const T& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

} // namespace

const ClassSpec*
Ontology::findClass(const std::string& class_name) const
{
  return named(classes, class_name);
}

const AttributeSpec*
Ontology::findAttribute(const std::string& attribute_name) const
{
  return named(attributes, attribute_name);
}

const MaterialSpec*
Ontology::findMaterial(const std::string& material_name) const
{
  return named(materials, material_name);
}

Ontology
ontologyFromYaml(const std::string& text, const std::string& name)
{
  try {
    return OntologyReader(name).read(YAML::Load(text));
  }
  catch (const YAML::Exception& error) {
    throw LoadError(name,
                    error.mark.is_null() ? "" : std::to_string(error.mark.line + 1),
                    "not YAML: " + error.msg);
  }
}

Ontology
loadOntology(const std::filesystem::path& file)
{
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in.is_open() || text.bad() || std::filesystem::is_directory(file))
    throw LoadError(file.string(), "", "cannot be read");
  return ontologyFromYaml(text.str(), file.string());
}

} // namespace hoist
