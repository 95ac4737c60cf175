#include "viewer/live_settings.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace hoist {
namespace {

const std::vector<TunedSetting>&
allTuned()
{
  static const std::vector<TunedSetting> all = {
      {"min-score", 0.05, false, 0.0, 1.0, false, "full"},
      {"min-side", 1.25, true, 0.001, 5.0, false, "full"},
      {"max-side", 1.25, true, 0.05, 100.0, false, "full"},
      {"max-cuboids", 1.0, false, 0.0, 1000.0, true, "full"},
      {"cluster-distance", 1.25, true, 0.001, 1.0, false, "paper"},
      {"tolerance", 1.25, true, 0.001, 1.0, false, "paper"},
      {"hough-threshold", 1.25, true, 1.0, 1000.0, true, "paper"},
      {"hough-min-length", 1.25, true, 1.0, 1000.0, false, "paper"},
      {"hough-max-gap", 1.25, true, 1.0, 1000.0, false, "paper"},
      {"canny-edge-share", 1.25, true, 0.001, 0.9, false, "paper"},
  };
  return all;
}

bool
isFlag(const CLI::Option& option)
{
  return option.get_expected_max() == 0;
}

std::string
joined(const std::vector<std::string>& values)
{
  std::string text;
  for (const std::string& value : values)
    text += (text.empty() ? "" : ",") + value;
  return text;
}

double
numberOf(const std::string& text)
{
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

// Shortest of at most four digits: steps of a factor need no more.
std::string
textOf(double number)
{
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, number, std::chars_format::general, 4);
  return {text, end.ptr};
}

} // namespace

LiveSettings::LiveSettings(CLI::App& command, RecognizeSettings& settings)
: command_(command), settings_(settings), at_start_(settings)
{
  for (const TunedSetting& one : allTuned())
    results_at_start_.emplace_back(one.name,
                                   command.get_option("--" + one.name)->results());
  results_at_start_.emplace_back("mode", command.get_option("--mode")->results());
  if (settings.mode == "paper")
    chosen_ = "cluster-distance";
}

std::vector<TunedSetting>
LiveSettings::tuned() const
{
  std::vector<TunedSetting> some;
  for (const TunedSetting& one : allTuned())
    if (one.modes.empty() || one.modes == settings_.mode)
      some.push_back(one);
  return some;
}

void
LiveSettings::set(const std::string& name, const std::string& value)
{
  CLI::Option* option = command_.get_option("--" + name);
  option->clear();
  option->add_result(value);
  option->run_callback();
}

void
LiveSettings::toggleMode()
{
  set("mode", settings_.mode == "full" ? "paper" : "full");
  chosen_ = tuned().front().name;
}

void
LiveSettings::choose(int by)
{
  const std::vector<TunedSetting> some = tuned();
  const auto at = std::find_if(some.begin(), some.end(), [&](const TunedSetting& one) {
    return one.name == chosen_;
  });
  const auto n = static_cast<int>(some.size());
  chosen_ = some[(static_cast<int>(at - some.begin()) + by + n) % n].name;
}

bool
LiveSettings::step(int by)
{
  for (const TunedSetting& one : tuned()) {
    if (one.name != chosen_)
      continue;
    const double old = numberOf(value(one.name));
    double next = one.factor ? old * std::pow(one.step, by) : old + by * one.step;
    if (one.whole)
      next = by > 0 ? std::max(std::round(next), old + 1)
                    : std::min(std::round(next), old - 1);
    next = numberOf(textOf(std::clamp(next, one.low, one.high)));
    if (one.name == "min-side")
      next = std::min(next, settings_.full.max_side);
    if (one.name == "max-side")
      next = std::max(next, settings_.full.min_side);
    if ((next - old) * by <= 0) // already there, or beyond what keys reach
      return false;
    set(one.name, textOf(next));
    return true;
  }
  return false;
}

void
LiveSettings::reset()
{
  settings_ = at_start_;
  for (const auto& [name, results] : results_at_start_) {
    CLI::Option* option = command_.get_option("--" + name);
    option->clear();
    for (const std::string& result : results)
      option->add_result(result);
  }
  chosen_ = tuned().front().name;
}

std::string
LiveSettings::chosen() const
{
  return chosen_ + " " + value(chosen_);
}

std::string
LiveSettings::value(const std::string& name) const
{
  const CLI::Option* option = command_.get_option("--" + name);
  std::string text = option->get_default_str();
  if (option->count() > 0)
    text = isFlag(*option) ? "true" : joined(option->results());
  if (text.size() > 1 && text.front() == '[' && text.back() == ']')
    text = text.substr(1, text.size() - 2); // how CLI11 shows a list's default
  return text;
}

std::string
LiveSettings::yaml() const
{
  YAML::Emitter out;
  out << YAML::Comment("For hoist recognize --config and hoist_viewer --config");
  out << YAML::BeginMap;
  for (const CLI::Option* option : command_.get_options()) {
    if (!option->get_configurable() || option->get_lnames().empty() ||
        option->get_lnames().front() == "help")
      continue;
    const std::string& name = option->get_lnames().front();
    const std::string text = value(name);
    if (!text.empty())
      out << YAML::Key << name << YAML::Value << text;
  }
  out << YAML::EndMap << YAML::Newline;
  return out.c_str();
}

} // namespace hoist
