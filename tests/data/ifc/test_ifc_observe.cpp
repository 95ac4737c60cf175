// What was seen becomes what a model says.
#include "data/ifc/ifc_things.h"

#include <hoist/data/ifc/ifc_observe.h>

#include <gtest/gtest.h>

#include <string>

namespace {

using hoist::IfcEdit;
using hoist::IfcElement;
using hoist::IfcModel;
using hoist::IfcObservation;
using hoist::IfcObserveSettings;
using hoist::IfcOutcome;
using hoist::IfcPropertySet;
using hoist::test::boxAt;
using hoist::test::cornerDistance;
using hoist::test::exportedModel;
using hoist::test::modelOf;

IfcObservation
seen(const std::string& key, const hoist::OrientedBox& box)
{
  IfcObservation out;
  out.key = key;
  out.name = "crate " + key;
  out.object_class = "crate";
  out.box = box;
  out.score = 0.9;
  out.center_sigma = Eigen::Vector3d(0.001, 0.002, 0.003);
  out.size_sigma = Eigen::Vector3d(0.004, 0.005, 0.006);
  out.rotation_sigma = 0.01;
  out.rgb = {10, 20, 30};
  out.fullness = true;
  out.weight = 21.5;
  out.weight_sigma = 1.5;
  out.material = "wood";
  out.frame = "frame-7";
  out.time = "12.5 s";
  out.tool = "hoist test";
  return out;
}

struct Updated {
  std::string bytes;
  std::vector<IfcOutcome> outcomes;
};

// The update, and that a second one changes nothing.
Updated
update(const std::string& bytes,
       const std::vector<IfcObservation>& observations,
       const IfcObserveSettings& settings = {})
{
  Updated out;
  for (int time = 0; time < 2; ++time) {
    const IfcModel model = modelOf(time == 0 ? bytes : out.bytes);
    IfcEdit edit(model);
    const auto outcomes = observeIfc(edit, model, observations, settings);
    if (time == 1) {
      EXPECT_EQ(edit.part21().bytes(), out.bytes);
      continue;
    }
    out.outcomes = outcomes;
    out.bytes = edit.part21().bytes();
  }
  return out;
}

std::string
word(const IfcModel& model,
     const std::string& global_id,
     const char* set,
     const char* name)
{
  const IfcElement* const element = model.find(global_id);
  if (element == nullptr)
    return "no element";
  for (const IfcPropertySet& one : model.propertySets(element->id))
    if (one.name == set && one.find(name) != nullptr) {
      const auto& value = one.find(name)->value;
      if (const auto* text = std::get_if<std::string>(&value))
        return *text;
      if (const auto* number = std::get_if<double>(&value))
        return hoist::part21Real(*number, 6);
      return "another value";
    }
  return "";
}

TEST(IfcObserve, NewMovedMissing)
{
  const Updated first = update(exportedModel(), {seen("a", boxAt(8, 8, 1))});
  ASSERT_EQ(first.outcomes.at(0).outcome, "added");
  const std::string id = first.outcomes[0].global_id;
  IfcModel model = modelOf(first.bytes);
  const char* const set = hoist::ifc_recognition_set;
  EXPECT_EQ(word(model, id, set, "Status"), "new");
  EXPECT_EQ(word(model, id, set, "Frame"), "frame-7");
  EXPECT_EQ(word(model, id, set, "Score"), "0.9");
  EXPECT_EQ(word(model, id, set, "CenterSigmaY"), "0.002");
  EXPECT_EQ(word(model, id, set, "WidthSigma"), "0.005");
  EXPECT_EQ(word(model, id, hoist::ifc_attribute_set, "WeightSigma"), "1.5");
  EXPECT_EQ(word(model, id, hoist::ifc_attribute_set, "Full"), "another value");
  EXPECT_EQ(model.find(id)->weight, 21.5);

  // the same crate, half a side further, under another name: it overlaps itself
  const Updated second = update(first.bytes, {seen("b", boxAt(8.2, 8, 1))});
  EXPECT_EQ(second.outcomes.at(0).outcome, "moved");
  EXPECT_EQ(second.outcomes[0].global_id, id);
  model = modelOf(second.bytes);
  EXPECT_EQ(word(model, id, set, "Status"), "moved");
  EXPECT_LT(cornerDistance(*model.find(id)->box, boxAt(8.2, 8, 1)), 1e-4);
  EXPECT_EQ(model.elements().size(), 4u);

  IfcObservation gone = seen("b", boxAt(8.2, 8, 1));
  gone.missing = true;
  gone.frame = "frame-9";
  const Updated third = update(second.bytes, {gone});
  EXPECT_EQ(third.outcomes.at(0).outcome, "missing");
  model = modelOf(third.bytes);
  EXPECT_EQ(word(model, id, set, "Status"), "missing");
  EXPECT_EQ(word(model, id, set, "MissingInFrame"), "frame-9");
  EXPECT_EQ(word(model, id, set, "CenterSigmaY"), "0.002"); // what was known stays

  gone.box = boxAt(50, 50, 50);
  gone.key = "z";
  EXPECT_EQ(update(third.bytes, {gone}).outcomes.at(0).outcome, "unknown");
}

TEST(IfcObserve, OthersAreRecordedAndMovedOnlyWhenAsked)
{
  const IfcModel before = modelOf(exportedModel());
  const IfcElement& column = before.elements()[0];
  hoist::OrientedBox box = *column.box;
  box.center.x() += 0.1;
  const Updated recorded = update(exportedModel(), {seen("a", box)});
  EXPECT_EQ(recorded.outcomes.at(0).outcome, "deviates");
  EXPECT_EQ(recorded.outcomes[0].global_id, column.global_id);
  EXPECT_NE(recorded.outcomes[0].detail.find("0.1 m"), std::string::npos);
  IfcModel model = modelOf(recorded.bytes);
  const char* const set = hoist::ifc_deviation_set;
  EXPECT_EQ(word(model, column.global_id, set, "Status"), "deviates");
  EXPECT_EQ(word(model, column.global_id, set, "OffsetX"), "0.1");
  EXPECT_LT(cornerDistance(*model.find(column.global_id)->box, *column.box), 1e-12);
  EXPECT_EQ(model.elements().size(), before.elements().size());

  IfcObserveSettings settings;
  settings.move_others = true;
  const Updated moved = update(recorded.bytes, {seen("a", box)}, settings);
  EXPECT_EQ(moved.outcomes.at(0).outcome, "moved");
  model = modelOf(moved.bytes);
  EXPECT_LT(cornerDistance(*model.find(column.global_id)->box, box), 1e-4);

  // where it should be: nothing to say
  const Updated fine = update(exportedModel(), {seen("a", *column.box)});
  EXPECT_EQ(fine.outcomes.at(0).outcome, "as modelled");
  EXPECT_EQ(fine.bytes, exportedModel());
  // a sigma that covers the distance is no deviation either
  IfcObservation unsure = seen("a", box);
  unsure.center_sigma = Eigen::Vector3d(0.05, 0.05, 0.05);
  EXPECT_EQ(update(exportedModel(), {unsure}).outcomes.at(0).outcome, "as modelled");
}

TEST(IfcObserve, SeenTwiceIsOneThing)
{
  IfcObservation better = seen("b", boxAt(8.01, 8, 1));
  better.score = 0.95;
  const Updated out = update(
      exportedModel(), {seen("a", boxAt(8, 8, 1)), better, seen("c", boxAt(9, 8, 1))});
  EXPECT_EQ(out.outcomes.at(0).outcome, "merged");
  EXPECT_EQ(out.outcomes.at(1).outcome, "added");
  EXPECT_EQ(out.outcomes.at(2).outcome, "added");
  EXPECT_EQ(modelOf(out.bytes).elements().size(), 5u);
}

TEST(IfcObserve, OneElementIsOneThing)
{
  // Two crates where one was modelled: the one that overlaps more is it.
  const Updated first = update(hoist::newIfcModel(), {seen("a", boxAt(0, 0, 1))});
  const Updated second =
      update(first.bytes,
             {seen("far", boxAt(-0.3, 0, 1)), seen("near", boxAt(0.1, 0, 1))},
             [] {
               IfcObserveSettings settings;
               settings.min_overlap = 0.25;
               return settings;
             }());
  EXPECT_EQ(second.outcomes.at(0).outcome, "added");
  EXPECT_EQ(second.outcomes.at(1).outcome, "moved");
}

} // namespace
