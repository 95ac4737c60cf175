#include "ifc_units.h"

#include <cmath>
#include <string>
#include <utility>

namespace hoist {
namespace ifc {
namespace {

struct Prefix {
  const char* word;
  double factor;
};

constexpr Prefix prefixes[] = {{"EXA", 1e18},
                               {"PETA", 1e15},
                               {"TERA", 1e12},
                               {"GIGA", 1e9},
                               {"MEGA", 1e6},
                               {"KILO", 1e3},
                               {"HECTO", 1e2},
                               {"DECA", 1e1},
                               {"DECI", 1e-1},
                               {"CENTI", 1e-2},
                               {"MILLI", 1e-3},
                               {"MICRO", 1e-6},
                               {"NANO", 1e-9},
                               {"PICO", 1e-12},
                               {"FEMTO", 1e-15},
                               {"ATTO", 1e-18}};

double
siFactor(const Entity& unit)
{
  // IfcSIUnit: Dimensions (*), UnitType, Prefix, Name
  double factor = unit.at(3).word() == "GRAM" ? 1e-3 : 1; // the SI's own unit is kg
  if (unit.at(2).is(Part21Value::Kind::unset))
    return factor;
  for (const Prefix& prefix : prefixes)
    if (unit.at(2).word() == prefix.word)
      return factor * prefix.factor;
  unit.fail(2, "a prefix of the SI");
}

} // namespace

double
unitFactor(const Part21File& file, const Entity& unit, int depth)
{
  if (unit.name() == "IFCSIUNIT")
    return siFactor(unit);
  if (unit.name().substr(0, 22) != "IFCCONVERSIONBASEDUNIT" || depth > 4)
    unit.fail(1, "an IFCSIUNIT or IFCCONVERSIONBASEDUNIT around it");
  // IfcConversionBasedUnit: Dimensions, UnitType, Name, ConversionFactor
  const Entity measure = unit.follow(3, "IFCMEASUREWITHUNIT");
  const double factor =
      measure.number(0) * unitFactor(file, measure.follow(1), depth + 1);
  if (!(factor > 0) || !std::isfinite(factor))
    measure.fail(0, "a factor above 0");
  return factor;
}

Units
unitsOf(const Part21File& file, const Entity& project)
{
  Units out;
  if (!project.referenceIf(8))
    return out;
  for (const std::uint64_t id : project.follow(8, "IFCUNITASSIGNMENT").references(0)) {
    const Part21Instance* const instance = file.find(id);
    if (instance == nullptr || file.entity(*instance).empty())
      continue; // conversions with an offset, of temperatures, may be complex
    const Entity unit(file, id);
    if (unit.at(1).word() == "LENGTHUNIT")
      out.length = unitFactor(file, unit);
    else if (unit.at(1).word() == "MASSUNIT")
      out.mass = unitFactor(file, unit);
  }
  return out;
}

double
factorOf(std::string_view measure, const Units& units)
{
  if (measure == "IFCLENGTHMEASURE" || measure == "IFCPOSITIVELENGTHMEASURE" ||
      measure == "IFCNONNEGATIVELENGTHMEASURE" || measure == "IFCQUANTITYLENGTH")
    return units.length;
  return measure == "IFCMASSMEASURE" || measure == "IFCQUANTITYWEIGHT" ? units.mass : 1;
}

namespace {

// The value of IfcPropertySingleValue and its like.
void
setValue(IfcProperty& out, const Part21Value& value, double factor)
{
  using Kind = Part21Value::Kind;
  switch (value.kind) {
  case Kind::text:
    out.value = value.text();
    break;
  case Kind::integer:
    if (factor == 1 && std::abs(value.number) < 9e15) {
      out.value = static_cast<std::int64_t>(value.number);
      break;
    }
    out.value = value.number * factor;
    break;
  case Kind::real:
    out.value = value.number * factor;
    break;
  case Kind::enumeration:
    if (value.word() == "T" || value.word() == "F")
      out.value = value.word() == "T";
    else
      out.value = std::string(value.word());
    break;
  default:
    break;
  }
}

// Units of its own come before those of the project.
double
ownFactor(const Part21File& file, const Entity& entity, std::size_t i, double otherwise)
{
  const auto id = entity.referenceIf(i);
  if (!id)
    return otherwise;
  const Entity unit(file, *id);
  if (unit.at(1).word() != "LENGTHUNIT" && unit.at(1).word() != "MASSUNIT")
    return otherwise;
  return unitFactor(file, unit);
}

IfcProperty
readProperty(const Part21File& file, const Entity& entity, const Units& units)
{
  IfcProperty out;
  out.name = entity.text(0);
  out.type = std::string(entity.name());
  if (entity.name() == "IFCPROPERTYSINGLEVALUE") {
    // Name, Description, NominalValue, Unit
    const Part21Value& value = entity.at(2);
    if (value.is(Part21Value::Kind::typed) && value.items.size() == 1) {
      out.type = std::string(value.word());
      setValue(out,
               value.items.front(),
               ownFactor(file, entity, 3, factorOf(out.type, units)));
    }
  }
  else if (entity.name().substr(0, 11) == "IFCQUANTITY")
    // Name, Description, Unit, value
    setValue(out, entity.at(3), ownFactor(file, entity, 2, factorOf(out.type, units)));
  return out;
}

} // namespace

std::optional<IfcPropertySet>
readPropertySet(const Part21File& file, std::uint64_t id, const Units& units)
{
  const Part21Instance* const instance = file.find(id);
  if (instance == nullptr)
    return std::nullopt;
  const std::string_view name = file.entity(*instance);
  if (name != "IFCPROPERTYSET" && name != "IFCELEMENTQUANTITY")
    return std::nullopt;
  const Entity entity(file, id);
  IfcPropertySet out;
  out.id = id;
  out.name = entity.text(2);
  out.quantities = name == "IFCELEMENTQUANTITY";
  for (const std::uint64_t property : entity.references(out.quantities ? 5 : 4)) {
    const Part21Instance* const one = file.find(property);
    if (one != nullptr && !file.entity(*one).empty())
      out.properties.push_back(readProperty(file, Entity(file, property), units));
  }
  return out;
}

} // namespace ifc
} // namespace hoist
