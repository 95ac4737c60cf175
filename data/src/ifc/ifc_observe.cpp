#include <hoist/data/ifc/ifc_observe.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <tuple>
#include <utility>

namespace hoist {
namespace {

constexpr double pi = 3.14159265358979323846;

void
addText(IfcPropertySet& set, const char* name, const std::string& text)
{
  if (!text.empty())
    set.properties.push_back({name, "IFCLABEL", text});
}

void
addNumber(IfcPropertySet& set, const char* name, const char* type, double value)
{
  if (std::isfinite(value))
    set.properties.push_back({name, type, value});
}

void
addVector(IfcPropertySet& set, const std::string& name, const Eigen::Vector3d& value)
{
  for (int i = 0; i < 3; ++i)
    addNumber(set, (name + "XYZ"[i]).c_str(), "IFCLENGTHMEASURE", value[i]);
}

void
addOrigin(IfcPropertySet& set, const IfcObservation& seen)
{
  addNumber(set, "Score", "IFCREAL", seen.score);
  addText(set, "Frame", seen.frame);
  addText(set, "Time", seen.time);
  addText(set, "Tool", seen.tool);
}

// A set of an element as the model has it; empty if it has none of that name.
IfcPropertySet
setOf(const IfcModel& model, const IfcElement& element, const char* name)
{
  for (IfcPropertySet& set : model.propertySets(element.id))
    if (set.name == name && !set.quantities)
      return std::move(set);
  IfcPropertySet none;
  none.name = name;
  return none;
}

std::string
textOf(const IfcPropertySet& set, const char* property)
{
  const IfcProperty* const found = set.find(property);
  const auto* const text =
      found == nullptr ? nullptr : std::get_if<std::string>(&found->value);
  return text == nullptr ? "" : *text;
}

void
setText(IfcPropertySet& set, const char* property, const std::string& text)
{
  for (IfcProperty& one : set.properties)
    if (one.name == property) {
      one.type = "IFCLABEL";
      one.value = text;
      return;
    }
  addText(set, property, text);
}

IfcPropertySet
recognitionSet(const IfcObservation& seen, const std::string& status)
{
  IfcPropertySet set;
  set.name = ifc_recognition_set;
  addText(set, "Status", status);
  addText(set, "Class", seen.object_class);
  addOrigin(set, seen);
  addVector(set, "CenterSigma", seen.center_sigma);
  for (int i = 0; i < 3; ++i) {
    static const char* const names[] = {"LengthSigma", "WidthSigma", "HeightSigma"};
    addNumber(set, names[i], "IFCLENGTHMEASURE", seen.size_sigma[i]);
  }
  addNumber(set, "RotationSigmaDegrees", "IFCREAL", seen.rotation_sigma * (180 / pi));
  return set;
}

IfcPropertySet
attributeSet(const IfcObservation& seen)
{
  IfcPropertySet set;
  set.name = ifc_attribute_set;
  addText(set, "Material", seen.material);
  addText(set, "Color", seen.color_name);
  if (seen.rgb)
    for (std::size_t i = 0; i < 3; ++i) {
      static const char* const names[] = {"ColorRed", "ColorGreen", "ColorBlue"};
      set.properties.push_back({names[i], "IFCINTEGER", std::int64_t((*seen.rgb)[i])});
    }
  if (seen.fullness)
    set.properties.push_back({"Full", "IFCBOOLEAN", *seen.fullness});
  if (seen.weight)
    addNumber(set, "Weight", "IFCMASSMEASURE", *seen.weight);
  addNumber(set, "WeightSigma", "IFCMASSMEASURE", seen.weight_sigma);
  return set;
}

std::string
describe(double distance, double degrees)
{
  return "by " + part21Real(distance, 3) + " m, " + part21Real(degrees, 1) + " degrees";
}

class Observer {
public:
  Observer(IfcEdit& edit, const IfcModel& model, const IfcObserveSettings& settings)
  : edit_(edit), model_(model), settings_(settings)
  {
  }

  std::vector<IfcOutcome>
  observe(const std::vector<IfcObservation>& observations)
  {
    std::vector<IfcOutcome> out(observations.size());
    for (std::size_t i = 0; i < observations.size(); ++i)
      out[i].key = observations[i].key;
    const std::vector<std::size_t> standing = merge(observations, out);
    std::vector<const IfcElement*> match(observations.size(), nullptr);
    assign(observations, standing, match);
    for (const std::size_t i : standing)
      out[i] = apply(observations[i], match[i]);
    return out;
  }

private:
  // Which observations stand for a thing. The others are merged into them.
  std::vector<std::size_t>
  merge(const std::vector<IfcObservation>& all, std::vector<IfcOutcome>& out) const
  {
    std::vector<std::size_t> standing;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto same =
          std::find_if(standing.begin(), standing.end(), [&](std::size_t j) {
            return isSame(all[i], all[j]);
          });
      if (same == standing.end()) {
        standing.push_back(i);
        continue;
      }
      const bool worse = all[i].score < all[*same].score; // NaN is never worse
      out[worse ? i : *same].outcome = "merged";
      if (!worse)
        *same = i;
    }
    return standing;
  }

  bool
  isSame(const IfcObservation& a, const IfcObservation& b) const
  {
    if (!a.global_id.empty() && !b.global_id.empty())
      return a.global_id == b.global_id;
    if (!a.key.empty() && a.key == b.key)
      return true;
    return !a.missing && !b.missing && overlap(a.box, b.box) >= settings_.min_overlap;
  }

  // Far boxes, most of all, do not need the exact volume.
  static double
  overlap(const OrientedBox& a, const OrientedBox& b)
  {
    if ((a.center - b.center).norm() > (a.size.norm() + b.size.norm()) / 2)
      return 0;
    return intersectionOverUnion(a, b);
  }

  // Elements by GlobalId, by key, then by overlap, the largest first.
  void
  assign(const std::vector<IfcObservation>& all,
         const std::vector<std::size_t>& standing,
         std::vector<const IfcElement*>& match) const
  {
    std::set<const IfcElement*> taken;
    // what these observations made before is theirs alone: a second time is the same
    for (const IfcObservation& one : all)
      if (!one.key.empty())
        if (const IfcElement* element = model_.find(edit_.globalIdOf(one.key)))
          taken.insert(element);
    for (const std::size_t i : standing) {
      if (!all[i].global_id.empty())
        match[i] = model_.find(all[i].global_id);
      if (match[i] == nullptr && !all[i].key.empty())
        match[i] = model_.find(edit_.globalIdOf(all[i].key));
      if (match[i] != nullptr)
        taken.insert(match[i]);
    }
    std::vector<std::tuple<double, std::size_t, const IfcElement*>> pairs;
    for (const std::size_t i : standing)
      if (match[i] == nullptr)
        for (const IfcElement& element : model_.elements())
          if (element.box && taken.count(&element) == 0) {
            const double shared = overlap(all[i].box, *element.box);
            if (shared >= settings_.min_overlap)
              pairs.emplace_back(-shared, i, &element);
          }
    std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
      return std::make_tuple(std::get<0>(a), std::get<1>(a), std::get<2>(a)->id) <
             std::make_tuple(std::get<0>(b), std::get<1>(b), std::get<2>(b)->id);
    });
    for (const auto& [shared, i, element] : pairs)
      if (match[i] == nullptr && taken.insert(element).second)
        match[i] = element;
  }

  IfcOutcome
  apply(const IfcObservation& seen, const IfcElement* element)
  {
    if (seen.missing)
      return missing(seen, element);
    IfcPropertySet before;
    if (element != nullptr) {
      before = setOf(model_, *element, ifc_recognition_set);
      if (before.properties.empty())
        return other(seen, *element);
    }
    return own(seen, element, textOf(before, "Status"));
  }

  IfcOutcome
  own(const IfcObservation& seen,
      const IfcElement* element,
      const std::string& status_before)
  {
    IfcObject object;
    object.key = seen.key;
    object.name = seen.name;
    object.object_type = seen.object_class;
    object.entity = ifcEntityOfClass(seen.object_class);
    object.box = seen.box;
    object.rgb = seen.rgb;
    object.material = seen.material;
    object.weight = seen.weight;
    object.storey = settings_.storey;
    std::string status = "new";
    if (element != nullptr) {
      object.global_id = element->global_id;
      if (object.name.empty())
        object.name = element->name;
      // what it was called stays while it stays where it is
      status = status_before == "missing" ? "unchanged" : status_before;
      if (element->box) {
        const BoxErrors errors = boxErrors(seen.box, *element->box);
        if (isOff(seen, errors))
          status = "moved";
      }
    }
    object.property_sets = {recognitionSet(seen, status), attributeSet(seen)};
    const std::string global_id = edit_.put(object);
    const IfcChange& change = edit_.changes().back();
    return {seen.key, global_id, change.action, change.detail};
  }

  bool
  isOff(const IfcObservation& seen, const BoxErrors& errors) const
  {
    const double sigma =
        seen.center_sigma.allFinite() ? 3 * seen.center_sigma.norm() : 0;
    const double turn =
        std::isfinite(seen.rotation_sigma) ? 3 * seen.rotation_sigma : 0;
    return errors.center.norm() > std::max(settings_.distance, sigma) ||
           errors.rotation > std::max(settings_.angle * (pi / 180), turn);
  }

  IfcOutcome
  other(const IfcObservation& seen, const IfcElement& element)
  {
    IfcOutcome out{seen.key, element.global_id, "as modelled", ""};
    const IfcPropertySet before = setOf(model_, element, ifc_deviation_set);
    const std::string status = textOf(before, "Status");
    if (!element.box)
      return out; // nothing to compare with
    const BoxErrors errors = boxErrors(seen.box, *element.box);
    const double degrees = errors.rotation * (180 / pi);
    const bool off = isOff(seen, errors);
    if (!off && (status.empty() || status == "as modelled" || status == "moved"))
      return out;
    IfcPropertySet set;
    set.name = ifc_deviation_set;
    out.outcome = off ? "deviates" : "as modelled";
    out.detail = off ? describe(errors.center.norm(), degrees) : "";
    if (off && settings_.move_others && edit_.move(element.global_id, seen.box))
      out.outcome = "moved";
    addText(set, "Status", out.outcome);
    addText(set, "Class", seen.object_class);
    addVector(set, "Observed", seen.box.center);
    addVector(set, "Offset", errors.center);
    addVector(set, "SizeDifference", errors.size);
    addNumber(set, "RotationDegrees", "IFCREAL", degrees);
    addVector(set, "CenterSigma", seen.center_sigma);
    addOrigin(set, seen);
    edit_.setProperties(element.global_id, set);
    return out;
  }

  IfcOutcome
  missing(const IfcObservation& seen, const IfcElement* element)
  {
    if (element == nullptr)
      return {seen.key, seen.global_id, "unknown", ""};
    IfcPropertySet set = setOf(model_, *element, ifc_recognition_set);
    if (set.properties.empty())
      set = setOf(model_, *element, ifc_deviation_set);
    setText(set, "Status", "missing");
    if (!seen.frame.empty())
      setText(set, "MissingInFrame", seen.frame);
    if (!seen.time.empty())
      setText(set, "MissingTime", seen.time);
    if (!seen.tool.empty())
      setText(set, "Tool", seen.tool);
    edit_.setProperties(element->global_id, set);
    return {seen.key, element->global_id, "missing", ""};
  }

  IfcEdit& edit_;
  const IfcModel& model_;
  const IfcObserveSettings& settings_;
};

} // namespace

std::vector<IfcOutcome>
observeIfc(IfcEdit& edit,
           const IfcModel& model,
           const std::vector<IfcObservation>& observations,
           const IfcObserveSettings& settings)
{
  return Observer(edit, model, settings).observe(observations);
}

} // namespace hoist
