// Writes models and what is in them, for programs of other people to read:
// make_ifc_models DIR
#include "data/ifc/ifc_things.h"

#include <hoist/data/ifc/ifc_observe.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace {

using hoist::IfcEdit;
using hoist::IfcModel;
using hoist::IfcObject;

class Folder {
public:
  explicit Folder(std::string path) : path_(std::move(path)) {}

  // A model; each thing's corners, colour, material and weight as JSON.
  void
  write(const std::string& name,
        const std::string& bytes,
        const std::vector<IfcObject>& objects)
  {
    std::ofstream(path_ + "/" + name, std::ios::binary) << bytes;
    const IfcModel model = hoist::test::modelOf(bytes);
    const IfcEdit edit(model);
    json_ += (json_.empty() ? "" : ",\n") + std::string("{\"file\":\"") + name +
             "\",\"things\":[";
    for (const IfcObject& object : objects) {
      char text[400];
      std::string corners;
      for (int i = 0; i < 8; ++i) {
        Eigen::Vector3d half = object.box.size / 2;
        for (int k = 0; k < 3; ++k)
          half[k] = (i >> k & 1) != 0 ? half[k] : -half[k];
        const Eigen::Vector3d p = object.box.center + object.box.axes * half;
        std::snprintf(text,
                      sizeof(text),
                      "%s[%.9f,%.9f,%.9f]",
                      i == 0 ? "" : ",",
                      p.x(),
                      p.y(),
                      p.z());
        corners += text;
      }
      std::snprintf(text,
                    sizeof(text),
                    "\"rgb\":[%d,%d,%d],\"weight\":%.6f,\"entity\":\"%s\"",
                    (*object.rgb)[0],
                    (*object.rgb)[1],
                    (*object.rgb)[2],
                    *object.weight,
                    object.entity.c_str());
      json_ += (&object == objects.data() ? "" : ",") + std::string("\n {\"id\":\"") +
               edit.globalIdOf(object.key) + "\",\"name\":\"" + object.name + "\"," +
               text + ",\"material\":\"" + object.material + "\",\"corners\":[" +
               corners + "]}";
    }
    json_ += "]}";
  }

  void
  finish() const
  {
    std::ofstream(path_ + "/expected.json") << "[" << json_ << "]\n";
  }

private:
  std::string path_;
  std::string json_;
};

std::vector<IfcObject>
things(unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<IfcObject> out;
  for (const std::string& entity : hoist::ifcEntities()) {
    IfcObject object = hoist::test::thing(std::to_string(seed) + entity,
                                          hoist::test::randomBox(random));
    object.entity = entity;
    object.rgb = {static_cast<int>(random() % 256),
                  static_cast<int>(random() % 256),
                  static_cast<int>(random() % 256)};
    object.material = "Holz, gr\u00fcn 'A'";
    object.weight = 1 + static_cast<double>(random() % 1000) / 8;
    hoist::IfcPropertySet set;
    set.name = hoist::ifc_recognition_set;
    set.properties = {{"Status", "IFCLABEL", std::string("new")},
                      {"Score", "IFCREAL", 0.5},
                      {"CenterSigmaX", "IFCLENGTHMEASURE", 0.001}};
    object.property_sets = {set};
    out.push_back(std::move(object));
  }
  return out;
}

} // namespace

int
main(int argc, char** argv)
{
  if (argc != 2)
    return 2;
  Folder folder(argv[1]);
  unsigned seed = 1;
  for (const hoist::IfcSchema schema :
       {hoist::IfcSchema::ifc2x3, hoist::IfcSchema::ifc4})
    for (const double unit : {1., 0.001, 0.3048}) {
      hoist::IfcNewModel settings;
      settings.schema = schema;
      settings.length_unit = unit;
      if (unit != 1)
        settings.site_pose =
            Eigen::Translation3d(12, -7, 3) *
            Eigen::AngleAxisd(0.7, Eigen::Vector3d(0, 0.1, 1).normalized());
      std::vector<IfcObject> objects = things(seed++);
      const std::string name = std::string(toString(schema)) + "-" +
                               std::to_string(static_cast<int>(unit * 1e4)) + ".ifc";
      const std::string bytes = hoist::ifcModelOf(objects, settings);
      folder.write(name, bytes, objects);
      // the same, after half of the things were moved, resized and repainted
      const std::vector<IfcObject> others = things(seed + 100);
      for (std::size_t i = 0; i < objects.size(); i += 2) {
        objects[i].box = others[i].box;
        objects[i].rgb = others[i].rgb;
        objects[i].weight = others[i].weight;
        objects[i].material = "steel";
      }
      folder.write("updated-" + name,
                   hoist::test::edited(bytes,
                                       [&](IfcEdit& edit) {
                                         for (const IfcObject& object : objects)
                                           edit.put(object);
                                       }),
                   objects);
    }
  const std::vector<IfcObject> objects = things(77);
  folder.write("exported.ifc",
               hoist::test::edited(hoist::test::exportedModel(),
                                   [&](IfcEdit& edit) {
                                     for (const IfcObject& object : objects)
                                       edit.put(object);
                                   }),
               objects);
  folder.finish();
  return 0;
}
