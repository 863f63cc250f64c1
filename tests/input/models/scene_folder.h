// A folder with one scene, its behaviours, a response and the simulator's rig, each of which a test may
// break.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/variable.h"

namespace enc::test {

// Line numbers count from the opening quotes, so the first line is "format = 1".
inline constexpr const char* kScene = R"(format = 1
title = "test"
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
[user]
depth_mm = 6.3
)";
inline constexpr const char* kBehaviours = R"([[behaviour]]
name = "tennis_ball"
response = "tennis_ball"
[[behaviour]]
name = "wall"
stiffness_N_per_mm = 2
limit_mm = 6
[[behaviour]]
name = "lost"
response = "tenis_ball"
)";
inline constexpr const char* kResponse = R"(format = 1
source = "test"
limit_mm = 6
press_N_per_mm_k = [1, 0.1, 0, 0]
release_N_per_mm_k = [0.5, 0.1, 0, 0]
)";

class SceneFile : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const;

  // What load() says, without the folder.
  [[nodiscard]] std::string said(const std::vector<std::string>& overrides = {},
                                 const std::string& scene = "scenes/ball.toml",
                                 const std::string& rig = "sim") const;
  // After one replacement in the scene.
  [[nodiscard]] std::string scene_said(const std::string& from, const std::string& to) const;
  [[nodiscard]] std::string rig_said(const std::string& from, const std::string& to) const;

  std::filesystem::path folder_;
  std::optional<Variable> models_;  // ENCOUNTER_MODELS: the folder
  std::string rig_;
};

}  // namespace enc::test
