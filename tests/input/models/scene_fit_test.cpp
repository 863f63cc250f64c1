// Scenes and what they name, each right by itself, that do not fit together; and what --set and the places
// say.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/input/models/scene_folder.h"
#include "tests/support/built.h"
#include "tests/support/replaced.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using test::kBehaviours;
using test::kResponse;
using test::kScene;
using test::replaced;
using test::SceneFile;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(SceneFile, behaviour_that_says_too_little_or_too_much) {
  write("behaviours.toml", replaced(kBehaviours, "response = \"tennis_ball\"\n", ""));
  EXPECT_THAT(
      said(),
      StartsWith("behaviours.toml:1:1: behaviour 'tennis_ball' says nothing about its force; expected"));
  write("behaviours.toml", replaced(kBehaviours, "response = ", "stiffness_N_per_mm = 1\nresponse = "));
  EXPECT_THAT(said(), StartsWith("behaviours.toml:3:1: behaviour 'tennis_ball' has both"));
  write("behaviours.toml", replaced(kBehaviours, "limit_mm = 6\n", ""));
  EXPECT_THAT(said({"object.ball.behaviour=wall"}),
              StartsWith("behaviours.toml:4:1: behaviour 'wall' has no 'limit_mm'; expected"));
  write("behaviours.toml", replaced(kBehaviours, "response = ", "limit_mm = 6.5\nresponse = "));
  EXPECT_THAT(said(), StartsWith("behaviours.toml:3:1: 'limit_mm' is 6.5; expected at most 6 mm, where "
                                 "response 'tennis_ball' ends"));
  write("behaviours.toml", replaced(kBehaviours, "response = ", "tangential = \"spring\"\nresponse = "));
  EXPECT_THAT(said(),
              HasSubstr("[[behaviour]] 'tennis_ball' has no 'tangential_stiffness_N_per_mm'; expected"));
}

TEST_F(SceneFile, tips_that_are_none) {
  const auto tip = [&](const std::string& keys) { return scene_said("tip_mm", keys + "\ntip_mm"); };
  EXPECT_THAT(tip("tip_shape = \"spheer\""), HasSubstr("expected 'sphere' or 'cone' or 'edge'"));
  EXPECT_THAT(tip("tip_shape = \"cone\"\ntip_axis = [0, 0, 1]"),
              HasSubstr("has no 'tip_half_angle_deg'; expected"));
  EXPECT_THAT(tip("tip_shape = \"cone\"\ntip_half_angle_deg = 20"), HasSubstr("has no 'tip_axis'; expected"));
  EXPECT_THAT(tip("tip_shape = \"cone\"\ntip_axis = [0, 0, 1]\ntip_half_angle_deg = 90"),
              StartsWith("scenes/ball.toml:14:22: 'tip_half_angle_deg' is 90; expected"));
  EXPECT_THAT(tip("tip_shape = \"edge\"\ntip_axis = [1, 0, 0]"), HasSubstr("has no 'tip_edge_mm'; expected"));
  EXPECT_THAT(tip("tip_shape = \"edge\"\ntip_axis = [1, 0, 0]\ntip_edge_mm = 0"),
              StartsWith("scenes/ball.toml:14:15: 'tip_edge_mm' is 0; expected"));
  EXPECT_THAT(
      tip("tip_shape = \"edge\"\ntip_axis = [0.6, 0, 0.6]\ntip_edge_mm = 20"),
      StartsWith("scenes/ball.toml:13:1: 'tip_axis' has length 0.848528; expected length 1; write it like "
                 "'tip_axis = [0.7"));
  EXPECT_THAT(tip("tip_edge_mm = 20"), HasSubstr("'tip_edge_mm'"));  // a sphere has none
}

TEST_F(SceneFile, things_that_do_not_fit_together) {
  EXPECT_EQ(scene_said("[user]", "[follow]\nresume_mm = 110\n[user]"),
            "scenes/ball.toml:17:1: 'resume_mm' is 110; expected at most 'pause_mm', 100 mm; lower it");
  EXPECT_THAT(scene_said("[[tool]]", "limit_mm = 7\n[[tool]]"),
              StartsWith("scenes/ball.toml:9:1: 'limit_mm' is 7; expected at most 6 mm"));
  EXPECT_THAT(scene_said("radius_mm = 33", "radius_mm = 3\nlimit_mm = 4"),
              HasSubstr(":7:1: 'limit_mm' is 4; expected less than the radius"));
  EXPECT_THAT(scene_said("shape = \"sphere\"\nradius_mm = 33", "shape = \"plane\"\nnormal = [0, 0, 0]"),
              StartsWith("scenes/ball.toml:6:1: 'normal' has length 0 and no direction; expected length 1; "
                         "write it like 'normal = [0, 0, 1]'"));
  EXPECT_THAT(scene_said(", [0, 41, 0]", ""),
              StartsWith("scenes/ball.toml:11:1: tool 'stylus' has 2 markers; expected at least 3"));
  EXPECT_THAT(scene_said("[0, 41, 0]", "[20, 0, 0]"),
              StartsWith("scenes/ball.toml:11:1: the markers of tool 'stylus' are on a line"));
  EXPECT_THAT(
      scene_said("[0, 41, 0]", "[0, 50, 0]"),
      StartsWith("scenes/ball.toml:11:1: the markers of tool 'stylus' look the same in another order, so "
                 "that it has two poses; expected distances that differ by 4 mm; move one"));
  // The same triangle, turned and with its markers in another order.
  const std::string twin =
      "[[tool]]\nname = \"pen\"\nmarkers_mm = [[0, 0, 41], [52, 0, 0], [0, 0, 0]]\ntip_mm = [0, 0, 0]\n";
  EXPECT_THAT(
      scene_said("[manipulator]", twin + "[manipulator]"),
      StartsWith("scenes/ball.toml:15:1: tools 'stylus' and 'pen' have the same marker geometry; expected"));
  std::string no_tool = kScene;
  no_tool.erase(no_tool.find("[[tool]]"), no_tool.find("[manipulator]") - no_tool.find("[[tool]]"));
  write("scenes/ball.toml", no_tool);
  EXPECT_THAT(said(),
              StartsWith("scenes/ball.toml:12:1: the user has no tool; expected at least one [[tool]]"));
}

TEST_F(SceneFile, rig_without_what_the_scene_names) {
  write("rigs/lab.toml",
        "format = 1\n[manipulator]\ndriver = \"pi_hexapod\"\n[force]\ndriver = \"ati_force\"\n");
  EXPECT_EQ(said({}, "scenes/ball.toml", "lab"),
            "scenes/ball.toml:15:1: the scene names [tracker] and rig 'rigs/lab.toml' has none; expected a "
            "[tracker] with a driver; add "
            "it to the rig, or use '--rig sim'");
  write("rigs/lab.toml",
        "format = 1\n[manipulator]\ndriver = \"pi_hexapod\"\n[force]\ndriver = "
        "\"ati_force\"\n[tracker]\ndriver = \"sim\"\n");
  const models::Setup s = load(path("scenes/ball.toml"), path("rigs/lab.toml"));
  EXPECT_EQ(s.rig.manipulator.driver, "pi_hexapod");
  EXPECT_EQ(s.rig.display.driver, "none");
  EXPECT_EQ(resolved(parse_resolved(resolved(s), "record")), resolved(s));
}

TEST_F(SceneFile, overrides) {
  EXPECT_EQ(said({"object.ball.radius_mm=30", "behaviour.tennis_ball.limit_mm=4"}), "(no error)");
  const models::Setup s = load(path("scenes/ball.toml"), "sim",
                               {"object.ball.behaviour=wall", "behaviour.wall.stiffness_N_per_mm=0.3"});
  EXPECT_EQ(s.scene.behaviours.at(0).curves.press[0], 300.0);
  EXPECT_THAT(said({"object.ball.behaviour=wal"}),
              StartsWith("--set object.ball.behaviour=wal: there is no behaviour 'wal'; expected"));
  EXPECT_THAT(said({"follow.pause_mm=50"}),
              StartsWith("scenes/ball.toml:1:1: 'resume_mm' is 90; expected at most 'pause_mm', 50 mm"));
  EXPECT_THAT(said({"behaviour.wall.limit_mm=3"}),
              StartsWith("--set behaviour.wall.limit_mm=3: unknown parameter"));
}

// What core's prepare() throws has stems for keys; the program looks up where they stand.
TEST_F(SceneFile, places) {
  const models::Setup s = load(path("scenes/ball.toml"), "sim");
  const auto at = [&](const char* key) { return place_of(s, key).substr(folder_.string().size() + 1); };
  EXPECT_EQ(at("object.ball.radius_mm"), "scenes/ball.toml:6:1");
  EXPECT_EQ(at("object.ball.radius"), "scenes/ball.toml:6:1");
  EXPECT_EQ(at("object.ball.limit"), "scenes/ball.toml:3:1");  // absent: the object
  EXPECT_EQ(at("user.depth"), "scenes/ball.toml:17:1");
  EXPECT_EQ(at("user.polar"), "scenes/ball.toml:16:1");
  EXPECT_EQ(at("follow.inset"), "scenes/ball.toml:1:1");
  EXPECT_EQ(at("behaviour.tennis_ball.response"), "behaviours.toml:3:1");
  EXPECT_EQ(at("rig.loop.rate"), "rigs/sim.toml:7:1");
  EXPECT_THAT(at("truth.hexapod.geometry.stroke"), StartsWith("rigs/sim.toml:"));
  EXPECT_EQ(at("nothing"), "scenes/ball.toml:1:1");
}

// Every committed scene loads. (What needs its measured curve is skipped until that is generated.)
TEST(Scenes, all_load) {
  const std::string models = tests::source_dir() + "/models";
  EXPECT_GE(files_in(models, "scenes").size(), 3U);
  const bool curves = fs::exists(models + "/responses/tennis_ball.toml");
  for (const std::string& name : files_in(models, "scenes")) {
    if (!curves && name != "plane") continue;
    EXPECT_NO_THROW(load(models + "/scenes/" + name + ".toml", "")) << name;
  }
}

}  // namespace
}  // namespace enc::models
