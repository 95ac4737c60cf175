#include "ifc/model_report.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace hoist {
namespace {

using Json = nlohmann::ordered_json;

Json
vectorJson(const Eigen::Vector3d& v)
{
  return {v.x(), v.y(), v.z()};
}

Json
propertiesJson(const IfcModel& model, const IfcElement& element)
{
  Json out = Json::object();
  for (const IfcPropertySet& set : model.propertySets(element.id)) {
    Json properties = Json::object();
    for (const IfcProperty& property : set.properties)
      std::visit(
          [&](const auto& value) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
              properties[property.name] = nullptr;
            else
              properties[property.name] = value;
          },
          property.value);
    out[set.name] = std::move(properties);
  }
  return out;
}

// Sides and place to the millimetre.
std::string
vectorText(const Eigen::Vector3d& v, const char* between)
{
  return fmt::format("{:.3f}{}{:.3f}{}{:.3f}", v.x(), between, v.y(), between, v.z());
}

// Characters, not bytes: what a terminal shows of UTF-8.
std::size_t
widthOf(const std::string& text)
{
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string
printable(std::string text)
{
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == 127)
      c = '?';
  return text;
}

} // namespace

std::string
modelTable(const IfcModel& model)
{
  std::vector<std::vector<std::string>> rows = {{"GlobalId",
                                                 "class",
                                                 "name",
                                                 "storey",
                                                 "size [m]",
                                                 "centre [m]",
                                                 "weight [kg]",
                                                 "material"}};
  std::size_t without_box = 0;
  for (const IfcElement& element : model.elements()) {
    without_box += element.box ? 0 : 1;
    rows.push_back({printable(element.global_id),
                    element.entity,
                    printable(element.name),
                    printable(element.storey),
                    element.box ? vectorText(element.box->size, " x ")
                                : printable(element.box_source),
                    element.box ? vectorText(element.box->center, "  ") : "-",
                    element.weight ? fmt::format("{:.1f}", *element.weight) : "-",
                    element.material.empty() ? "-" : printable(element.material)});
  }
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], widthOf(row[i]));
  std::string out = fmt::format(
      "{}: {}, {} instances, unit {:g} m, project \"{}\"\n{} elements, {} without a "
      "box\n",
      model.file().name(),
      toString(model.schema()),
      model.file().instances().size(),
      model.lengthUnit(),
      printable(model.spatial().front().name),
      model.elements().size(),
      without_box);
  if (model.elements().empty())
    return out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + std::string(widths[i] - widthOf(row[i]) + 2, ' ');
    while (line.back() == ' ')
      line.pop_back();
    out += line + '\n';
  }
  return out;
}

std::string
modelJson(const IfcModel& model)
{
  Json out;
  out["file"] = model.file().name();
  out["schema"] = toString(model.schema());
  out["instances"] = model.file().instances().size();
  out["length_unit"] = model.lengthUnit();
  out["project"] = {{"global_id", model.spatial().front().global_id},
                    {"name", model.spatial().front().name}};
  out["elements"] = Json::array();
  for (const IfcElement& element : model.elements()) {
    Json one;
    one["global_id"] = element.global_id;
    one["class"] = element.entity;
    one["name"] = element.name;
    one["object_type"] = element.object_type;
    one["storey"] = element.storey;
    if (element.box) {
      one["center"] = vectorJson(element.box->center);
      one["size"] = vectorJson(element.box->size);
      one["rotation"] = Json::array();
      for (int i = 0; i < 3; ++i)
        one["rotation"].push_back(vectorJson(element.box->axes.row(i).transpose()));
    }
    else
      one["center"] = nullptr;
    one["box_source"] = element.box_source;
    one["weight"] = element.weight ? Json(*element.weight) : Json(nullptr);
    one["material"] = element.material;
    one["properties"] = propertiesJson(model, element);
    out["elements"].push_back(std::move(one));
  }
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace hoist
