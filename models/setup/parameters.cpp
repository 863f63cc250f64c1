// Visitors over all parameters: list them, set one, round them, leave out those that a scene does not use.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/toml_writer.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/calibration_files.h"
#include "models/setup/scene_file.h"
#include "models/setup/unread.h"

namespace enc::models {
namespace {

void walk(Visitor& visitor, Setup& setup) { describe_all(visitor, setup.scene, setup.rig, setup.twin); }

// Walks all existing values and tracks each value's full name.
class NameVisitor : public Visitor {
 public:
  void value(const Key& key, const Target& target) final {
    named(paths_.empty() ? std::string(key.name) : fmt::format("{}.{}", paths_.back(), key.name), key,
          target);
  }
  bool open(std::string_view table, bool present) final {
    if (present) push(table);
    return present;
  }
  std::size_t open_list(std::string_view, std::size_t size) final { return size; }
  void open_entry(std::string_view list, std::size_t, std::string_view name) final {
    push(fmt::format("{}.{}", list, name));
  }
  void close() final { paths_.pop_back(); }
  void drivers(std::string_view name, std::vector<DriverTable>& tables) final {
    driver_tables(fmt::format("{}.{}", paths_.back(), name), tables);
  }

 protected:
  // path: "rig.driver"
  virtual void driver_tables(const std::string&, std::vector<DriverTable>&) {}
  virtual void named(const std::string& name, const Key& key, const Target& target) = 0;

 private:
  void push(std::string_view name) {
    paths_.push_back(paths_.empty() ? std::string(name) : fmt::format("{}.{}", paths_.back(), name));
  }
  std::vector<std::string> paths_;
};

// The form that --set accepts: texts without unnecessary quotes, "unset" for an unset value.
std::string shown(const Key& key, const Target& target) {
  const auto* const* text = std::get_if<std::string*>(&target);
  const bool plain = text != nullptr && !(*text)->starts_with('"') && !(*text)->starts_with('\'');
  if (plain && std::none_of((*text)->begin(), (*text)->end(),
                            [](char c) { return static_cast<unsigned char>(c) < ' '; }))
    return **text;
  if (const auto* choice = std::get_if<Choice>(&target)) return std::string(choice->words[*choice->index]);
  const std::string value = value_text(key, target);
  return value.empty() ? "unset" : value;
}

class List final : public NameVisitor {
 public:
  std::vector<Parameter> found;

 private:
  void named(const std::string& name, const Key& key, const Target& target) override {
    if (key.fixed) return;
    found.push_back({name, std::string(unit_of(key.name).label), shown(key, target), std::string(key.source),
                     std::string(word_of(key.confidence)), std::string(key.meaning)});
  }
  void driver_tables(const std::string& path, std::vector<DriverTable>& tables) override {
    for (const DriverTable& table : tables)
      for (const DriverValue& v : table.values) {
        const bool quoted = v.text.size() > 1 && v.text.starts_with('"') && v.text.find('\\') == v.text.npos;
        found.push_back({fmt::format("{}.{}.{}", path, table.name, v.key), std::string(unit_of(v.key).label),
                         quoted ? v.text.substr(1, v.text.size() - 2) : v.text,
                         v.source.empty() ? "driver" : v.source, "chosen",
                         v.meaning.empty() ? "known to its driver alone" : v.meaning});
      }
  }
};

// The value of a key; adds the key if it is missing.
std::string& text_in(std::vector<DriverTable>& tables, const std::string& driver, const std::string& key) {
  const auto of = [](auto& items, const auto& name, auto member) {
    const auto after = [&](const auto& item) { return item.*member >= name; };
    auto at = std::find_if(items.begin(), items.end(), after);
    if (at == items.end() || (*at).*member != name) {
      at = items.emplace(at);
      (*at).*member = name;
    }
    return at;
  };
  return of(of(tables, driver, &DriverTable::name)->values, key, &DriverValue::key)->text;
}

class Set final : public NameVisitor {
 public:
  Set(std::string name, std::string value, std::string place)
      : name_(std::move(name)), value_(std::move(value)), place_(std::move(place)) {}

  void check_found() const {
    if (found_) return;
    std::string advised;
    for (const std::string& name : names_) {
      if (advised.empty() && name.ends_with("." + name_)) advised = fmt::format("did you mean '{}'?", name);
    }
    if (advised.empty() && !nearest_name(name_, names_).empty()) advised = advice(name_, names_);
    if (advised.empty()) advised = "'encounter params' lists them";
    throw Error(fmt::format("{}: unknown parameter {}; expected one of this scene and rig; {}", place_,
                            quoted(name_), advised));
  }

 private:
  void named(const std::string& name, const Key& key, const Target& target) override {
    if (!key.fixed) names_.push_back(name);
    if (key.fixed || name != name_) return;
    found_ = true;
    read_value(value_, place_, key, target);
  }
  // The driver reads its table later and reports its faults.
  void driver_tables(const std::string& path, std::vector<DriverTable>& tables) override {
    const std::string start = path + ".";
    const auto dot = name_.rfind('.');
    if (!name_.starts_with(start) || dot < start.size() || dot + 1 == name_.size()) return;
    found_ = true;
    text_in(tables, name_.substr(start.size(), dot - start.size()), name_.substr(dot + 1)) = value_;
  }
  std::string name_, value_, place_;
  std::vector<std::string> names_;
  bool found_ = false;
};

class RoundToText final : public NameVisitor {
  void named(const std::string&, const Key& key, const Target& target) override {
    const bool word = std::holds_alternative<std::string*>(target) ||
                      std::holds_alternative<Choice>(target) || std::holds_alternative<std::int64_t*>(target);
    const std::string text = word ? "" : value_text(key, target);
    if (!text.empty()) read_value(text, std::string(key.name), key, target);
  }
};

}  // namespace

std::vector<Parameter> parameters(const Setup& setup) {
  Setup copy = setup;  // visitors may write; this one does not
  if (!setup.calibration.empty()) copy.rig.camera.calibration = setup.calibration;
  if (!setup.measured.empty()) copy.rig.calibration.file = setup.measured;
  List list;
  walk(list, copy);
  if (!setup.calibration.empty())
    for (Parameter& p : list.found)
      if (of_calibration(p.name)) {
        p.source = setup.calibration;
        p.confidence = word_of(Confidence::derived);
      }
  if (!setup.measured.empty())
    for (Parameter& p : list.found)
      if (of_rig_calibration(p.name) && !place_of(setup, p.name).starts_with("--set")) {
        p.source = setup.measured;
        p.confidence = word_of(Confidence::derived);
      }
  return list.found;
}

void set(Setup& setup, const std::string& override_text) {
  const std::string place = "--set " + printable(override_text);
  const auto equals = override_text.find('=');
  const std::string name = override_text.substr(0, equals);
  if (equals == std::string::npos || name.empty()) {
    throw Error(fmt::format(
        "{}: there is no value; expected name=value; write it like '--set object.ball.radius_mm=30'", place));
  }
  Set one(name, override_text.substr(equals + 1), place);
  walk(one, setup);
  one.check_found();
  setup.places[name] = place;
}

void round_to_text(Setup& setup) {
  RoundToText visitor;
  walk(visitor, setup);
}

std::string resolved(const Setup& setup) {
  Setup copy = setup;
  return write_toml([&](Visitor& visitor) { walk(visitor, copy); });
}

Setup parse_resolved(const std::string& text, const std::string& name) {
  Setup setup;
  setup.scene_path = setup.rig_path = name;
  setup.places = read_toml(text, name, [&](Visitor& visitor) { walk(visitor, setup); });
  check(setup);
  return setup;
}

// ---- The scene with only the parts that it builds, as a scene file that needs no other file.

std::vector<std::string> unread_tables(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  std::vector<std::string> tables;
  const auto without = [&](bool part, std::initializer_list<const char*> its) {
    if (!part) tables.insert(tables.end(), its.begin(), its.end());
  };
  // [rig.force] also limits the softness of objects in the loop of a hexapod without [force].
  without(s.manipulator.has_value(),
          {"rig.manipulator", "rig.force", "rig.admittance", "truth.hexapod", "truth.structure"});
  if (s.manipulator && !setup.twin.structural()) tables.emplace_back("truth.structure");
  without(s.arm.has_value(), {"rig.arm", "truth.arm"});
  without(s.force.has_value(), {"truth.force", "rig.frames.H_F", "truth.frames.H_F"});
  without(s.tracker.has_value(), {"rig.tracker", "truth.tracker", "rig.frames.W_C", "truth.frames.W_C"});
  without(s.camera.has_value(), {"rig.camera", "rig.vision", "truth.camera"});
  if (s.camera) tables.emplace_back("truth.tracker");
  without(s.display.has_value(), {"rig.display", "truth.display", "rig.frames.W_S", "rig.frames.G_L"});
  without(s.gripper.has_value(), {"rig.gripper", "truth.gripper"});
  without(s.hand_tracker.has_value(), {"rig.hand_tracker", "truth.hand_tracker"});
  without(s.user.has_value(), {"truth.hand", "truth.contact"});
  without(s.probe.has_value(), {"truth.ball"});
  without(s.pusher.has_value(), {"truth.pusher"});
  return tables;
}

namespace {

// Passes all but some tables to another visitor.
class TableFilter final : public Visitor {
 public:
  TableFilter(Visitor& to, std::vector<std::string> tables) : to_(to), tables_(std::move(tables)) {}

  void value(const Key& key, const Target& target) override { to_.value(key, target); }
  bool open(std::string_view table, bool present) override {
    const std::string path = paths_.empty() ? std::string(table) : fmt::format("{}.{}", paths_.back(), table);
    if (std::find(tables_.begin(), tables_.end(), path) != tables_.end()) return false;
    if (!to_.open(table, present)) return false;
    paths_.push_back(path);
    return true;
  }
  std::size_t open_list(std::string_view list, std::size_t size) override {
    return to_.open_list(list, size);
  }
  void open_entry(std::string_view list, std::size_t index, std::string_view name) override {
    to_.open_entry(list, index, name);
    paths_.emplace_back(list);
  }
  void drivers(std::string_view name, std::vector<DriverTable>& tables) override {
    to_.drivers(name, tables);
  }
  void close() override {
    to_.close();
    paths_.pop_back();
  }

 private:
  Visitor& to_;
  std::vector<std::string> tables_, paths_;
};

}  // namespace

// A person who sets a number wants it to have an effect.
void note_unread(Setup& setup) {
  for (const std::string& table : unread_tables(setup)) {
    const std::string below = table + ".";
    for (auto i = setup.places.lower_bound(below); i != setup.places.end() && i->first.starts_with(below);
         ++i) {
      if (!i->second.starts_with("--set")) continue;
      const bool through_camera = setup.scene.camera && table == "truth.tracker";
      setup.notes.push_back(
          fmt::format("{}: warning: nothing in this scene reads [{}]{}; leave it out", i->second, table,
                      through_camera ? ", as its tracker is vision: see [truth.camera]" : ""));
    }
  }
}

void walk_built(Visitor& visitor, Setup& setup) {
  TableFilter built(visitor, unread_tables(setup));
  describe_all(built, setup.scene, setup.rig, setup.twin);
}

std::string built_scene(const Setup& setup) {
  Setup copy = setup;  // visitors may write; this one does not
  return write_toml([&](Visitor& visitor) { walk_built(visitor, copy); });
}

}  // namespace enc::models
