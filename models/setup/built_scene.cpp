// The scene with only what it builds, as a scene file that stands alone.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "models/schema/toml_writer.h"
#include "models/setup/scene_file.h"

namespace enc::models {
namespace {

// The tables of rig and truth that nothing in this scene reads.
std::vector<std::string> unread(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  std::vector<std::string> tables;
  const auto without = [&](bool part, std::initializer_list<const char*> its) {
    if (!part) tables.insert(tables.end(), its.begin(), its.end());
  };
  // Also without [force] the loop of a hexapod is judged by [rig.force]: how soft an object may be.
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
  without(s.user.has_value(), {"truth.hand", "truth.contact"});
  without(s.probe.has_value(), {"truth.ball"});
  without(s.pusher.has_value(), {"truth.pusher"});
  return tables;
}

// Shows another visitor all but some tables.
class Without final : public Visitor {
 public:
  Without(Visitor& to, std::vector<std::string> tables) : to_(to), tables_(std::move(tables)) {}

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

// Whoever sets a number wants it to do something.
void note_unread(Setup& setup) {
  for (const std::string& table : unread(setup)) {
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
  Without built(visitor, unread(setup));
  describe_all(built, setup.scene, setup.rig, setup.twin);
}

std::string built_scene(const Setup& setup) {
  Setup copy = setup;  // visitors may write, this one does not
  return write_toml([&](Visitor& visitor) { walk_built(visitor, copy); });
}

}  // namespace enc::models
