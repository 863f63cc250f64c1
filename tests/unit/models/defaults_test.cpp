// A default stands once, in the struct. A file wins over it, and a shipped rig that does says why at the
// line.
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/schema/schema.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/temporary_folder.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
const std::string kShipped = tests::source_dir() + "/models";

std::map<std::string, std::string> values_of(const Setup& setup) {
  std::map<std::string, std::string> values;
  for (const Parameter& p : parameters(setup)) values[p.name] = p.value;
  return values;
}

// The same parts as `like` has, with the numbers of the structs.
models::Setup in_code(const Setup& like) {
  models::Setup code;
  RigSpec& rig = code.rig;
  rig.manipulator.driver = like.rig.manipulator.driver;
  rig.arm.driver = like.rig.arm.driver;
  rig.arm.machine.kind = like.rig.arm.machine.kind;
  rig.force.driver = like.rig.force.driver;
  rig.tracker.driver = like.rig.tracker.driver;
  rig.camera.driver = like.rig.camera.driver;
  rig.display.driver = like.rig.display.driver;
  rig.gripper.driver = like.rig.gripper.driver;
  code.twin.arm.there = like.twin.arm.there;
  code.twin.arm.machine.kind = like.twin.arm.machine.kind;
  return code;
}

std::string write(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

TEST(Defaults, AFileThatNamesNothingHasThoseOfTheStructs) {
  const test::TemporaryFolder folder;
  const std::string rig = write(folder.file("rig.toml"), R"(format = 1
[manipulator]
driver = "sim"
[arm]
driver = "sim"
[arm.machine]
[force]
driver = "sim"
[tracker]
driver = "sim"
[display]
driver = "sim"
[gripper]
driver = "sim"
[truth.arm]
[truth.arm.machine]
)");
  const models::Setup file = load_rig_setup(rig);
  EXPECT_GT(values_of(file).size(), 200U);
  EXPECT_EQ(values_of(file), values_of(in_code(file)));

  const std::string scene = write(folder.file("scene.toml"), R"(format = 1
[[object]]
name = "ball"
shape = "sphere"
radius_mm = 33
position_mm = [0, 0, -20]
behaviour = "tennis_ball"
[[tool]]
name = "stylus"
markers_mm = [[0, 0, 0], [52, 0, 0], [0, 41, 0]]
tip_mm = [0, 0, -120]
[manipulator]
[force]
[tracker]
[display]
[user]
)");
  const models::Setup loaded = load(scene, "");
  models::Setup code = loaded;
  code.scene = SceneSpec{};
  code.scene.behaviours = loaded.scene.behaviours;
  ObjectSpec& ball = code.scene.objects.emplace_back();
  ball.name = "ball";
  ball.radius = 0.033;
  ball.position = {0, 0, -0.02};
  ball.behaviour = "tennis_ball";
  ToolSpec& stylus = code.scene.tools.emplace_back();
  stylus.name = "stylus";
  stylus.markers = {{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}};
  stylus.tip = {0, 0, -0.12};
  code.scene.manipulator.emplace();
  code.scene.force.emplace();
  code.scene.tracker.emplace();
  code.scene.display.emplace();
  code.scene.user.emplace();
  round_to_text(code);
  EXPECT_EQ(values_of(loaded), values_of(code));
}

// "models/rigs/vishap.toml:14:1" -> its line.
std::string line_at(const std::string& place) {
  const auto column = place.rfind(':'), line = place.rfind(':', column - 1);
  std::ifstream in(place.substr(0, line));
  std::string text;
  for (int i = std::stoi(place.substr(line + 1)); i > 0; --i) std::getline(in, text);
  return text;
}

TEST(Defaults, ARigThatNamesAnotherValueSaysWhy) {
  int others = 0;
  for (const std::string& name : files_in(kShipped, "rigs")) {
    const models::Setup rig = load_rig_setup(kShipped + "/rigs/" + name + ".toml");
    const std::map<std::string, std::string> defaults = values_of(in_code(rig));
    for (const auto& [key, value] : values_of(rig)) {
      const auto place = rig.places.find(key);
      const auto is = defaults.find(key);
      const bool title = key == "rig.title";  // every rig has its own
      if (place == rig.places.end() || is == defaults.end() || is->second == value || title) continue;
      ++others;
      EXPECT_NE(line_at(place->second).find('#'), std::string::npos)
          << place->second << ": '" << key << "' is " << value << " and the struct has " << is->second
          << "; say why in a comment at this line, or leave the line out";
    }
  }
  EXPECT_GT(others, 40);
}

// An arm is first of all the one of [VisHap]: the struct has its gains.
TEST(Defaults, OfAnArmAreThoseOfVisHap) {
  const models::Setup rig = load_rig_setup(kShipped + "/rigs/vishap.toml");
  models::Setup code = in_code(rig);
  code.rig.arm.loop.emplace();  // there only where a rig says it
  const std::map<std::string, std::string> defaults = values_of(code);
  for (const auto& [key, value] : values_of(rig)) {
    const bool rounded = key.starts_with("rig.arm.machine.") || key == "rig.arm.winding_share";
    if (!key.starts_with("rig.arm.") || rounded) continue;
    EXPECT_EQ(value, defaults.at(key)) << key;
  }
}

}  // namespace
}  // namespace enc::models
