#include "ifc_edit_parts.h"

#include "part21_scanner.h"

#include <pcl/exceptions.h>

#include <cmath>
#include <utility>

namespace hoist {
namespace {

using ifc::Arguments;
using ifc::Id;
using ifc::Writer;

/// How an entity is written: attributes in IFC2x3 and IFC4 (buildingSMART, IFC2x3 TC1
/// and IFC4 ADD2 TC1), and what the ninth says where IFC2x3 has it.
struct Layout {
  const char* entity;
  int attributes_2x3; ///< 0: IFC2x3 does not have it
  int attributes_4;
  const char* ninth_2x3;
};

constexpr Layout layouts[] = {{"IfcBuildingElementProxy", 9, 9, ".ELEMENT."},
                              {"IfcSlab", 9, 9, ".NOTDEFINED."},
                              {"IfcColumn", 8, 9, ""},
                              {"IfcBeam", 8, 9, ""},
                              {"IfcWall", 8, 9, ""},
                              {"IfcMember", 8, 9, ""},
                              {"IfcPlate", 8, 9, ""},
                              {"IfcFooting", 9, 9, ".NOTDEFINED."},
                              {"IfcCovering", 9, 9, ".NOTDEFINED."},
                              {"IfcFurniture", 0, 9, ""},
                              {"IfcFurnishingElement", 8, 8, ""}};

const Layout&
layoutOf(const std::string& entity, IfcSchema schema)
{
  for (const Layout& layout : layouts)
    if (entity == layout.entity) {
      if (schema == IfcSchema::ifc2x3 && layout.attributes_2x3 == 0)
        return layoutOf("IfcFurnishingElement", schema);
      return layout;
    }
  PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                      entity << " is none of the entities that are written");
}

std::string
hexColor(const std::array<int, 3>& rgb)
{
  std::string out;
  for (const int c : rgb) {
    out += "0123456789ABCDEF"[c >> 4 & 15];
    out += "0123456789ABCDEF"[c & 15];
  }
  return out;
}

// The text of a property's value, e.g. IFCLENGTHMEASURE(0.5).
std::string
valueText(const IfcProperty& property, double factor, bool typed)
{
  std::string value;
  if (const auto* flag = std::get_if<bool>(&property.value))
    value = *flag ? ".T." : ".F.";
  else if (const auto* whole = std::get_if<std::int64_t>(&property.value))
    value = factor == 1 ? std::to_string(*whole)
                        : part21Real(static_cast<double>(*whole) / factor);
  else if (const auto* real = std::get_if<double>(&property.value))
    value = part21Real(*real / factor);
  else if (const auto* text = std::get_if<std::string>(&property.value))
    value = encodePart21(*text);
  else
    return "$";
  return typed ? property.type + '(' + value + ')' : value;
}

bool
isWord(const std::string& text)
{
  for (const char c : text)
    if ((c < 'A' || c > 'Z') && (c < '0' || c > '9'))
      return false;
  return !text.empty();
}

} // namespace

const std::vector<std::string>&
ifcEntities()
{
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Layout& layout : layouts)
      out.emplace_back(layout.entity);
    return out;
  }();
  return names;
}

Id
IfcEdit::Parts::find(const std::string& global_id) const
{
  if (const auto one = added.find(global_id); one != added.end())
    return one->second;
  const IfcElement* const element = writer.model().find(global_id);
  return element == nullptr ? 0 : element->id;
}

const std::unordered_map<Id, std::vector<Id>>&
IfcEdit::Parts::firstReferences(const char* entity)
{
  const auto [of, is_first] = first_references.try_emplace(entity);
  if (is_first) {
    const Part21File& file = writer.model().file();
    for (const std::uint32_t number : file.ofType(entity)) {
      const Id id = file.instances()[number].id;
      of->second[writer.reference(id, 0)].push_back(id);
    }
  }
  return of->second;
}

Id
IfcEdit::Parts::bodyContext()
{
  const Part21File& file = writer.model().file();
  for (const std::uint32_t number :
       file.ofType("IFCGEOMETRICREPRESENTATIONSUBCONTEXT")) {
    const Id id = file.instances()[number].id;
    if (writer.edit().get(id, 0) == "'Body'")
      return id;
  }
  for (const std::uint32_t number : file.ofType("IFCGEOMETRICREPRESENTATIONCONTEXT")) {
    const Id id = file.instances()[number].id;
    if (writer.number(id, 2) == 3)
      return id;
  }
  PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                      file.name() << ": has no context of three dimensions");
}

void
IfcEdit::Parts::place(Id element, const Eigen::Isometry3d& world)
{
  Part21Edit& edit = writer.edit();
  const IfcModel& model = writer.model();
  const Id old = writer.reference(element, 5);
  const Id parent = old == 0 ? 0 : writer.reference(old, 0);
  const Eigen::Isometry3d relative = model.placement(parent).inverse() * world;
  // Placements of parts and openings are relative to it and go with it; anything else
  // that refers to it is another element, which must stay.
  const auto& children = firstReferences("IFCLOCALPLACEMENT");
  const auto below = children.find(old);
  const std::size_t allowed =
      1 + (below == children.end() || edit.isNew(old) ? 0 : below->second.size());
  if (old != 0 && writer.references(old) <= allowed) {
    const Id axes = writer.axisPlacement(writer.reference(old, 1), relative);
    edit.set(old, 1, Writer::ref(axes));
    placed[old] = world;
    return;
  }
  const Id axes = writer.axisPlacement(0, relative);
  const Id fresh =
      edit.append("IFCLOCALPLACEMENT", {Writer::ref(parent), Writer::ref(axes)});
  edit.set(element, 5, Writer::ref(fresh));
  placed[fresh] = world;
}

Id
IfcEdit::Parts::ownSolid(Id element) const
{
  const Id shape_id = writer.reference(element, 6);
  if (shape_id == 0 || writer.references(shape_id) > 1)
    return 0;
  const std::vector<Id> shapes = writer.references(shape_id, 2);
  if (shapes.size() != 1 || writer.references(shapes[0]) > 1)
    return 0;
  const std::vector<Id> items = writer.references(shapes[0], 3);
  return items.size() == 1 ? items[0] : 0;
}

void
IfcEdit::Parts::shape(Id element, const Eigen::Vector3d& size)
{
  Part21Edit& edit = writer.edit();
  const auto origin = [&](const char* entity, const char* zeros) {
    Arguments arguments = {Writer::ref(writer.shared("IFCCARTESIANPOINT", {zeros})),
                           "$"};
    if (std::string(entity) == "IFCAXIS2PLACEMENT3D")
      arguments.emplace_back("$");
    return Writer::ref(writer.shared(entity, arguments));
  };
  const Arguments rectangle = {".AREA.",
                               "$",
                               origin("IFCAXIS2PLACEMENT2D", "(0.,0.)"),
                               part21Real(size.x()),
                               part21Real(size.y())};
  const Arguments solid_rest = {
      origin("IFCAXIS2PLACEMENT3D", "(0.,0.,0.)"),
      Writer::ref(writer.shared("IFCDIRECTION", {"(0.,0.,1.)"})),
      part21Real(size.z())};

  Id solid = ownSolid(element);
  const auto& styles = firstReferences("IFCSTYLEDITEM");
  const auto styled = styles.find(solid);
  const std::size_t allowed =
      1 + (styled == styles.end() || edit.isNew(solid) ? 0 : styled->second.size());
  if (solid != 0 && edit.entity(solid) == "IFCEXTRUDEDAREASOLID" &&
      writer.references(solid) <= allowed) {
    const Id profile = writer.reference(solid, 0);
    const Id written = writer.write(profile, "IFCRECTANGLEPROFILEDEF", rectangle);
    edit.set(solid, 0, Writer::ref(written));
    for (std::size_t i = 0; i < 3; ++i)
      edit.set(solid, i + 1, solid_rest[i]);
    return;
  }
  const Id profile = edit.append("IFCRECTANGLEPROFILEDEF", rectangle);
  solid =
      edit.append("IFCEXTRUDEDAREASOLID",
                  {Writer::ref(profile), solid_rest[0], solid_rest[1], solid_rest[2]});
  const Id body = edit.append(
      "IFCSHAPEREPRESENTATION",
      {Writer::ref(bodyContext()), "'Body'", "'SweptSolid'", Writer::list({solid})});
  const Id whole =
      edit.append("IFCPRODUCTDEFINITIONSHAPE", {"$", "$", Writer::list({body})});
  edit.set(element, 6, Writer::ref(whole));
}

void
IfcEdit::Parts::color(Id element, const std::array<int, 3>& rgb)
{
  const Id solid = ownSolid(element);
  if (solid == 0)
    return;
  Arguments channels = {"$"};
  for (const int channel : rgb)
    channels.push_back(part21Real(channel / 255.0, 6));
  const Id rgb_id = writer.shared("IFCCOLOURRGB", channels);
  const Id rendering = writer.shared(
      "IFCSURFACESTYLERENDERING",
      {Writer::ref(rgb_id), "0.", "$", "$", "$", "$", "$", "$", ".NOTDEFINED."});
  Id style = writer.shared(
      "IFCSURFACESTYLE",
      {encodePart21("hoist " + hexColor(rgb)), ".BOTH.", Writer::list({rendering})});
  if (writer.model().schema() == IfcSchema::ifc2x3)
    style = writer.shared("IFCPRESENTATIONSTYLEASSIGNMENT", {Writer::list({style})});
  (void)firstReferences("IFCSTYLEDITEM");
  std::vector<Id>& styled = first_references["IFCSTYLEDITEM"][solid];
  if (!styled.empty())
    writer.edit().set(styled.front(), 1, Writer::list({style}));
  else
    styled.push_back(writer.edit().append(
        "IFCSTYLEDITEM", {Writer::ref(solid), Writer::list({style}), "$"}));
}

void
IfcEdit::Parts::material(Id element,
                         const std::string& global_id,
                         const std::string& name)
{
  Arguments arguments = {encodePart21(name)};
  if (writer.model().schema() == IfcSchema::ifc4)
    arguments.insert(arguments.end(), {"$", "$"});
  const char* const relation = "IFCRELASSOCIATESMATERIAL";
  for (const Id id : writer.relations(relation, element)) {
    const Id current = writer.reference(id, 5);
    if (writer.edit().entity(current) == "IFCMATERIAL" &&
        writer.edit().get(current, 0) == arguments[0])
      return;
    if (writer.references(id, 4).size() > 1)
      writer.unrelate(id, element);
    else {
      writer.edit().set(id, 5, Writer::ref(writer.shared("IFCMATERIAL", arguments)));
      return;
    }
  }
  writer.relate(relation,
                element,
                writer.shared("IFCMATERIAL", arguments),
                writer.globalId(global_id + "/material"));
}

void
IfcEdit::Parts::properties(Id element,
                           const std::string& global_id,
                           const IfcPropertySet& set)
{
  if (set.properties.empty())
    return; // a set of nothing is not valid
  const IfcModel& model = writer.model();
  Part21Edit& edit = writer.edit();
  const char* const entity = set.quantities ? "IFCELEMENTQUANTITY" : "IFCPROPERTYSET";
  const std::size_t list = set.quantities ? 5 : 4;
  const std::string name = encodePart21(set.name);
  std::string key = global_id + '/' + set.name;
  Id existing = 0;
  for (const Id relation : writer.relations("IFCRELDEFINESBYPROPERTIES", element)) {
    const Id one = writer.reference(relation, 5);
    if (edit.entity(one) != entity || edit.get(one, 2) != name)
      continue;
    if (writer.references(relation, 4).size() > 1 || writer.references(one) > 1) {
      if (writer.references(relation, 4).size() > 1)
        writer.unrelate(relation, element);
      key += "/own"; // the shared one may have the name
      continue;
    }
    existing = one;
    break;
  }
  const std::vector<Id> old =
      existing == 0 ? std::vector<Id>() : writer.references(existing, list);
  std::vector<Id> ids;
  for (const IfcProperty& property : set.properties) {
    if (!isWord(property.type))
      PCL_THROW_EXCEPTION(pcl::BadArgumentException,
                          '"' << property.type << "\" is no type of a property");
    double factor = 1;
    if (property.type.find("LENGTH") != std::string::npos)
      factor = model.lengthUnit();
    else if (property.type == "IFCMASSMEASURE" || property.type == "IFCQUANTITYWEIGHT")
      factor = model.massUnit();
    const Id before = ids.size() < old.size() ? old[ids.size()] : 0;
    const std::string property_name = encodePart21(property.name);
    Arguments arguments = {property_name, "$", valueText(property, factor, true), "$"};
    if (set.quantities) {
      arguments = {property_name, "$", "$", valueText(property, factor, false)};
      if (model.schema() == IfcSchema::ifc4)
        arguments.emplace_back("$");
    }
    const char* const single = "IFCPROPERTYSINGLEVALUE";
    ids.push_back(
        writer.write(before, set.quantities ? property.type : single, arguments));
  }
  if (existing != 0) {
    edit.set(existing, list, Writer::list(ids));
    return;
  }
  Arguments arguments = {
      writer.globalId(key), Writer::ref(writer.ownerHistory()), name, "$"};
  if (set.quantities)
    arguments.emplace_back("$");
  arguments.push_back(Writer::list(ids));
  const Id fresh = edit.append(entity, arguments);
  writer.relate(
      "IFCRELDEFINESBYPROPERTIES", element, fresh, writer.globalId(key + "/relation"));
}

Id
IfcEdit::Parts::add(const IfcObject& object, const std::string& global_id)
{
  const IfcSchema schema = writer.model().schema();
  const Layout& layout = layoutOf(object.entity, schema);
  const IfcSpatialNode& container = containerOf(object);
  const int attributes =
      schema == IfcSchema::ifc2x3 ? layout.attributes_2x3 : layout.attributes_4;
  Arguments arguments = {encodePart21(global_id),
                         Writer::ref(writer.ownerHistory()),
                         Writer::text(object.name),
                         "$",
                         Writer::text(object.object_type),
                         "$",
                         "$",
                         Writer::text(object.key)};
  if (attributes == 9 && schema == IfcSchema::ifc4)
    arguments.emplace_back(object.object_type.empty() ? ".NOTDEFINED."
                                                      : ".USERDEFINED.");
  else if (attributes == 9)
    arguments.emplace_back(layout.ninth_2x3);
  const Id id = writer.edit().append(part21::upperCase(layout.entity), arguments);
  const Id placement = writer.edit().append("IFCLOCALPLACEMENT",
                                            {Writer::ref(container.placement), "$"});
  writer.edit().set(id, 5, Writer::ref(placement));
  contain(container, id);
  added[global_id] = id;
  return id;
}

} // namespace hoist
