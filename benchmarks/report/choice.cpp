#include "benchmarks/report/choice.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "benchmarks/kit/entry.h"
#include "core/base/error.h"
#include "models/schema/wording.h"

namespace enc::bench {
namespace {

const Benchmark* named(const std::string& name) {
  const std::span<const Benchmark> all = benchmarks();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Benchmark& b) { return name == b.name; });
  return found == all.end() ? nullptr : &*found;
}

// A benchmark that is named as a whole keeps all of its figures.
void add(std::vector<Choice>& list, const Benchmark* benchmark, const std::string& id) {
  const auto same =
      std::find_if(list.begin(), list.end(), [&](const Choice& c) { return c.benchmark == benchmark; });
  if (same == list.end())
    list.push_back({benchmark, id.empty() ? std::vector<std::string>{} : std::vector<std::string>{id}});
  else if (id.empty())
    same->ids.clear();
  else if (!same->ids.empty())
    same->ids.push_back(id);
}

[[noreturn]] void refuse(const std::string& word) {
  std::vector<std::string> names;
  for (const Group& g : groups()) names.emplace_back(g.name);
  for (const Benchmark& b : benchmarks()) names.emplace_back(b.name);
  const std::string first = word.substr(0, word.find('.'));
  throw Error("unknown benchmark " + models::quoted(first) + "; " + models::advice(first, names) +
              " (all: encounter bench --list)");
}

bool begins(const std::string& id, const std::string& with) {
  return id.starts_with(with) && (id.size() == with.size() || id[with.size()] == '.');
}

}  // namespace

std::span<const Group> groups() {
  static const std::vector<Group> kAll{
      {"paper-2020",
       "what VHMR (2020) measured, in the paper's order",
       {"tracking", "stiffness", "indentation", "deformation", "synchrony", "session", "workspace"}},
      {"paper-2003",
       "what VisHap (2003) measured, and what it needs",
       {"plane_button", "vishap", "reaching", "switching", "segmentation", "fingertip", "registration",
        "registration_images", "gravity"}},
  };
  return kAll;
}

std::vector<Choice> chosen(const std::vector<std::string>& words) {
  std::vector<Choice> list;
  if (words.empty())
    for (const Benchmark& b : benchmarks()) list.push_back({&b, {}});
  for (const std::string& word : words) {
    const auto group =
        std::find_if(groups().begin(), groups().end(), [&](const Group& g) { return word == g.name; });
    if (group != groups().end()) {
      for (const std::string& member : group->members)
        if (const Benchmark* benchmark = named(member)) add(list, benchmark, {});
      continue;
    }
    const std::size_t dot = word.find('.');
    const Benchmark* benchmark = named(word.substr(0, dot));
    if (benchmark == nullptr) refuse(word);
    add(list, benchmark, dot == std::string::npos ? std::string{} : word);
  }
  if (list.empty()) throw Error(words.front() + " has no benchmark here; see encounter bench --list");
  return list;
}

std::vector<Choice> settable(std::vector<Choice> choices, const std::vector<std::string>& set, bool named,
                             const std::string& models, std::vector<std::string>& left) {
  std::vector<std::string> sceneless;
  const auto takes = [&](const Choice& choice) {
    if (scenes_read(*choice.benchmark, models).empty()) {
      sceneless.emplace_back(choice.benchmark->name);
      left.emplace_back(choice.benchmark->name);
      return false;
    }
    try {
      check_settings(*choice.benchmark, models, set);
    } catch (const Error&) {
      if (named) throw;
      left.emplace_back(choice.benchmark->name);
      return false;
    }
    return true;
  };
  std::vector<Choice> kept;
  std::copy_if(choices.begin(), choices.end(), std::back_inserter(kept), takes);
  if (named && !sceneless.empty())
    throw Error(fmt::format(
        "--set: {} read{} no scene that it could change; expected it with others; leave out --set or {}",
        fmt::join(sceneless, ", "), sceneless.size() == 1 ? "s" : "", sceneless.size() == 1 ? "it" : "them"));
  if (kept.empty() && !choices.empty()) check_settings(*choices.front().benchmark, models, set);
  return kept;
}

std::vector<Choice> over_devices(std::vector<Choice> choices, bool named) {
  std::vector<std::string> can, cannot;
  for (const Benchmark& b : benchmarks())
    if (b.over_rig != nullptr) can.emplace_back(b.name);
  for (const Choice& choice : choices)
    if (choice.benchmark->over_rig == nullptr) cannot.emplace_back(choice.benchmark->name);
  if (named && !cannot.empty())
    throw Error(
        fmt::format("--rig: {} measure{} in the twin alone; expected {}; leave out --rig or the others",
                    fmt::join(cannot, ", "), cannot.size() == 1 ? "s" : "", fmt::join(can, " or ")));
  std::erase_if(choices, [](const Choice& choice) { return choice.benchmark->over_rig == nullptr; });
  return choices;
}

bool wanted(const Choice& choice, const Figure& figure) {
  return choice.ids.empty() || std::any_of(choice.ids.begin(), choice.ids.end(),
                                           [&](const std::string& id) { return begins(figure.id, id); });
}

void check_ids(const Choice& choice, const BenchResult& result) {
  std::vector<std::string> there;
  for (const Figure& f : result.figures) there.push_back(f.id);
  for (const std::string& id : choice.ids) {
    if (std::any_of(there.begin(), there.end(), [&](const std::string& f) { return begins(f, id); }))
      continue;
    throw Error("unknown figure " + models::quoted(id) + "; " + models::advice(id, there));
  }
}

}  // namespace enc::bench
