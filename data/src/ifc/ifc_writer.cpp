#include "ifc_writer.h"

#include "ifc_access.h"
#include "part21_scanner.h"

#include <hoist/data/ifc/ifc_guid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hoist {
namespace ifc {
namespace {

// The value that a text stands for. The text must live as long as the value.
Part21Value
parsed(const std::string& text, const std::string& file)
{
  return part21::Scanner(text, file).value();
}

std::string
joined(const Arguments& arguments)
{
  std::string out;
  for (const std::string& one : arguments)
    out += one + '\n';
  return out;
}

std::string
coordinates(const Eigen::Vector3d& v, int decimals)
{
  return '(' + part21Real(v.x(), decimals) + ',' + part21Real(v.y(), decimals) + ',' +
         part21Real(v.z(), decimals) + ')';
}

} // namespace

Writer::Writer(const IfcModel& model) : model_(&model), edit_(model.file()) {}

Id
Writer::write(Id existing, std::string_view entity, const Arguments& arguments)
{
  if (existing != 0 && edit_.entity(existing) == entity) {
    bool same = true;
    for (std::size_t i = 0; i < arguments.size(); ++i)
      same = same && edit_.get(existing, i) == arguments[i];
    if (same)
      return existing;
    if (references(existing) <= 1) {
      for (std::size_t i = 0; i < arguments.size(); ++i)
        edit_.set(existing, i, arguments[i]);
      return existing;
    }
  }
  return edit_.append(entity, arguments);
}

Id
Writer::shared(std::string_view entity, const Arguments& arguments)
{
  const auto [of, is_first] = by_text_.try_emplace(std::string(entity));
  if (is_first)
    for (const std::uint32_t number : model_->file().ofType(entity)) {
      const Part21Instance& instance = model_->file().instances()[number];
      Arguments texts;
      for (const Part21Value& argument : model_->file().arguments(instance))
        texts.emplace_back(argument.raw);
      of->second.emplace(joined(texts), instance.id);
    }
  const std::string key = joined(arguments);
  if (const auto found = of->second.find(key); found != of->second.end()) {
    bool same = true; // this edit may have changed it
    for (std::size_t i = 0; i < arguments.size(); ++i)
      same = same && edit_.get(found->second, i) == arguments[i];
    if (same) {
      more_references_[found->second] += 2;
      return found->second;
    }
  }
  const Id id = edit_.append(entity, arguments);
  of->second[key] = id;
  more_references_[id] += 2; // never to be changed in place
  return id;
}

Id
Writer::reference(Id id, std::size_t argument) const
{
  const std::string text = edit_.get(id, argument);
  if (text.empty() || text[0] != '#')
    return 0;
  return parsed(text, model_->file().name()).id;
}

std::vector<Id>
Writer::references(Id id, std::size_t argument) const
{
  std::vector<Id> out;
  const std::string text = edit_.get(id, argument);
  if (text.empty() || text[0] != '(')
    return out;
  for (const Part21Value& item : parsed(text, model_->file().name()).items)
    if (item.is(Part21Value::Kind::reference))
      out.push_back(item.id);
  return out;
}

double
Writer::number(Id id, std::size_t argument) const
{
  const std::string text = edit_.get(id, argument);
  if (text.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const Part21Value value = parsed(text, model_->file().name());
  return value.isNumber() ? value.number : std::numeric_limits<double>::quiet_NaN();
}

std::uint32_t
Writer::references(Id id) const
{
  std::uint32_t count = 0;
  if (const Part21Instance* const instance = model_->file().find(id))
    count = model_->references()[static_cast<std::size_t>(
        instance - model_->file().instances().data())];
  const auto more = more_references_.find(id);
  return count + (more == more_references_.end() ? 0 : more->second);
}

std::vector<Id>
Writer::relations(std::string_view relation, Id object) const
{
  std::vector<Id> out;
  const auto removed = removed_relations_.find({std::string(relation), object});
  for (const std::uint32_t number : model_->relationsOf(relation, object)) {
    const Id id = model_->file().instances()[number].id;
    if (removed == removed_relations_.end() ||
        std::find(removed->second.begin(), removed->second.end(), id) ==
            removed->second.end())
      out.push_back(id);
  }
  if (const auto of = added_relations_.find(std::string(relation));
      of != added_relations_.end())
    if (const auto found = of->second.find(object); found != of->second.end())
      out.insert(out.end(), found->second.begin(), found->second.end());
  return out;
}

Id
Writer::relate(std::string_view relation,
               Id object,
               Id relating,
               const std::string& guid)
{
  const Id id = edit_.append(
      relation, {guid, ref(ownerHistory()), "$", "$", list({object}), ref(relating)});
  added_relations_[std::string(relation)][object].push_back(id);
  return id;
}

void
Writer::unrelate(Id relation, Id object)
{
  std::vector<Id> objects = references(relation, 4);
  objects.erase(std::remove(objects.begin(), objects.end(), object), objects.end());
  edit_.set(relation, 4, list(objects));
  removed_relations_[{std::string(edit_.entity(relation)), object}].push_back(relation);
}

Id
Writer::ownerHistory()
{
  if (owner_history_ != 0)
    return owner_history_;
  // ours if there is one: the application says so
  for (const std::uint32_t number : model_->file().ofType("IFCOWNERHISTORY")) {
    const Id id = model_->file().instances()[number].id;
    const Id application = reference(id, 1);
    if (application != 0 && edit_.get(application, 3) == "'hoist'")
      return owner_history_ = id;
  }
  const Id person = shared("IFCPERSON", {"'hoist'", "$", "$", "$", "$", "$", "$", "$"});
  const Id organization = shared("IFCORGANIZATION", {"$", "'hoist'", "$", "$", "$"});
  const Id both =
      shared("IFCPERSONANDORGANIZATION", {ref(person), ref(organization), "$"});
  const Id application =
      shared("IFCAPPLICATION", {ref(organization), "'0.1'", "'hoist'", "'hoist'"});
  return owner_history_ = edit_.append(
             "IFCOWNERHISTORY",
             {ref(both), ref(application), "$", ".NOCHANGE.", "$", "$", "$", "0"});
}

Id
Writer::axisPlacement(Id existing, const Eigen::Isometry3d& pose)
{
  // parts of a placement that somebody else uses too are somebody else's
  const bool own = existing != 0 && references(existing) <= 1 &&
                   edit_.entity(existing) == "IFCAXIS2PLACEMENT3D";
  const auto part = [&](std::size_t i) { return own ? reference(existing, i) : Id(0); };
  const Id place =
      write(part(0), "IFCCARTESIANPOINT", {coordinates(pose.translation(), 9)});
  Arguments arguments = {ref(place), "$", "$"};
  if (!pose.linear().isIdentity(1e-13)) {
    const auto axis = [&](std::size_t i, Eigen::Index column) {
      const std::string text = coordinates(pose.linear().col(column), 15);
      if (text == "(0.,0.,1.)" || text == "(1.,0.,0.)")
        return shared("IFCDIRECTION", {text});
      return write(part(i), "IFCDIRECTION", {text});
    };
    arguments[1] = ref(axis(1, 2));
    arguments[2] = ref(axis(2, 0));
  }
  return write(own ? existing : 0, "IFCAXIS2PLACEMENT3D", arguments);
}

std::string
Writer::globalId(const std::string& key) const
{
  return '\'' + ifcGuidOf(model_->spatial().front().global_id, key) + '\'';
}

std::string
Writer::list(const std::vector<Id>& ids)
{
  std::string out = "(";
  for (const Id id : ids)
    out += (out.size() == 1 ? "" : ",") + ref(id);
  return out + ')';
}

std::string
Writer::text(std::string_view text)
{
  return text.empty() ? "$" : encodePart21(text);
}

std::string
Writer::ref(Id id)
{
  return id == 0 ? "$" : part21Reference(id);
}

} // namespace ifc
} // namespace hoist
