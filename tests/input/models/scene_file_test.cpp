// Bad scenes, rigs, behaviours and responses: one line each, with file, line and column, the expectation and
// the nearest valid name. Also files that are right alone but do not fit together.
#include "models/setup/scene_file.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using test::replaced;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// ---- A folder with one scene, its behaviours, a response and the simulator's rig, each of which a test may
// break.

// Line numbers count from the opening quotes, so the first line is "format = 1".
constexpr const char* kScene = R"(format = 1
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
constexpr const char* kBehaviours = R"([[behaviour]]
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
constexpr const char* kResponse = R"(format = 1
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

  // The error message of load(), without the folder.
  [[nodiscard]] std::string said(const std::vector<std::string>& overrides = {},
                                 const std::string& scene = "scenes/ball.toml",
                                 const std::string& rig = "sim") const;
  // The error message after one replacement in the scene.
  [[nodiscard]] std::string scene_said(const std::string& from, const std::string& to) const;
  [[nodiscard]] std::string rig_said(const std::string& from, const std::string& to) const;

  std::filesystem::path folder_;
  std::optional<test::Variable> models_;  // ENCOUNTER_MODELS: the folder
  std::string rig_;
};

void SceneFile::SetUp() {
  folder_ = fs::temp_directory_path() / ("enc_scene_file_" + std::to_string(getpid()));
  models_.emplace("ENCOUNTER_MODELS", folder_.string());
  for (const char* sub : {"scenes", "rigs", "responses"}) fs::create_directories(folder_ / sub);
  rig_ = test::bytes_of(tests::source_dir() + "/models/rigs/sim.toml");
  write("rigs/sim.toml", rig_);
  write("behaviours.toml", kBehaviours);
  write("responses/tennis_ball.toml", kResponse);
  write("scenes/ball.toml", kScene);
}

void SceneFile::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name) << text;
}

std::string SceneFile::said(const std::vector<std::string>& overrides, const std::string& scene,
                            const std::string& rig) const {
  try {
    models::load(path(scene), rig, overrides);
  } catch (const Error& e) {
    std::string what = e.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << "one line: " << what;
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_TRUE(e.key().empty()) << "the place is in the text already";
    for (auto at = what.find(folder_.string()); at != std::string::npos; at = what.find(folder_.string())) {
      what.erase(at, folder_.string().size() + 1);
    }
    return what;
  }
  return "(no error)";
}

std::string SceneFile::scene_said(const std::string& from, const std::string& to) const {
  write("rigs/sim.toml", rig_);
  write("scenes/ball.toml", replaced(kScene, from, to));
  return said();
}

std::string SceneFile::rig_said(const std::string& from, const std::string& to) const {
  write("scenes/ball.toml", kScene);
  write("rigs/sim.toml", replaced(rig_, from, to));
  return said();
}

// ---- Bad scenes, rigs, behaviours and responses: one line each, with file, line and column, the expectation
// and the remedy.

TEST_F(SceneFile, is_fine_as_it_stands) {
  EXPECT_EQ(said(), "(no error)");
  const models::Setup s = load(path("scenes/ball.toml"), "sim");
  EXPECT_EQ(s.scene.objects[0].radius, 0.033);
  ASSERT_EQ(s.scene.behaviours.size(), 1U);
  EXPECT_EQ(s.scene.behaviours[0].curves.press[1], 0.1e6);
  EXPECT_EQ(s.scene.behaviours[0].curves.limit, 0.006);
  EXPECT_FALSE(s.scene.display.has_value());
}

TEST_F(SceneFile, unknown_key) {
  EXPECT_EQ(scene_said("radius_mm", "radus_mm"),
            "scenes/ball.toml:6:1: unknown key 'radus_mm'; expected a key of [[object]] 'ball'; did you mean "
            "'radius_mm'?");
  EXPECT_THAT(scene_said("depth_mm = 6.3", "  colour = 3"),
              AllOf(StartsWith("scenes/ball.toml:17:3: unknown key 'colour'; expected a key of [user]; the "
                               "names here are 'kind', 'object', 'tool', 'azimuth_deg', "),
                    HasSubstr("'release_s', 'rest_s', 'approach_mm_s', "), Not(HasSubstr("..."))));
  EXPECT_EQ(scene_said("[force]", "[forces]"),
            "scenes/ball.toml:14:2: unknown key 'forces'; expected a key of the file; did you mean 'force'?");
  EXPECT_THAT(rig_said("filter_hz = 5", "filtre_hz = 5"),
              EndsWith("unknown key 'filtre_hz'; expected a key of [force]; did you mean 'filter_hz'?"));
}

TEST_F(SceneFile, wrong_unit_suffix) {
  EXPECT_EQ(scene_said("radius_mm", "radius_cm"),
            "scenes/ball.toml:6:1: unknown key 'radius_cm'; expected the unit mm; did you mean 'radius_mm'? "
            "then multiply by 10");
  EXPECT_EQ(scene_said("depth_mm", "depth"),
            "scenes/ball.toml:17:1: unknown key 'depth'; expected the unit mm; did you mean 'depth_mm'?");
  EXPECT_THAT(rig_said("speed_mm_s", "speed_m_s"),
              HasSubstr("expected the unit mm/s; did you mean 'speed_mm_s'?"));
}

TEST_F(SceneFile, missing_key) {
  EXPECT_EQ(scene_said("radius_mm = 33\n", ""),
            "scenes/ball.toml:3:1: [[object]] 'ball' has no 'radius_mm'; expected a positive number in mm "
            "(radius of the sphere); "
            "add 'radius_mm = 1.5'");
  EXPECT_THAT(scene_said("name = \"stylus\"\n", ""),
              StartsWith("scenes/ball.toml:9:1: [[tool]] '0' has no 'name'; expected"));
  EXPECT_THAT(scene_said("format = 1\n", ""),
              StartsWith("scenes/ball.toml:1:1: the file has no 'format'; expected"));
  EXPECT_THAT(rig_said("driver = \"sim\"\n", ""),
              HasSubstr(": [manipulator] has no 'driver'; expected a text that is not empty"));
}

TEST_F(SceneFile, wrong_type) {
  EXPECT_EQ(scene_said("radius_mm = 33", "radius_mm = \"33\""),
            "scenes/ball.toml:6:13: 'radius_mm' is a text; expected a positive number in mm (radius of the "
            "sphere); "
            "write it like 'radius_mm = 1.5'");
  EXPECT_THAT(scene_said("\"stylus\"", "7"),
              StartsWith("scenes/ball.toml:10:8: 'name' is a whole number; expected a text"));
  EXPECT_THAT(scene_said("depth_mm = 6.3", "repeats = 2.0"),
              StartsWith("scenes/ball.toml:17:11: 'repeats' is a number with a fraction; expected a whole "
                         "number from 1 to"));
  std::string scene = replaced(kScene, "[force]\n", "");
  write("scenes/ball.toml", replaced(scene, "title = \"test\"", "force = 1"));
  EXPECT_EQ(said(),
            "scenes/ball.toml:2:1: 'force' is a whole number; expected a table; write '[force]' on a line of "
            "its own");
  EXPECT_THAT(scene_said("[[tool]]", "[tool]"),
              StartsWith("scenes/ball.toml:9:2: 'tool' is a table; expected a list of tables"));
  EXPECT_THAT(scene_said("title = \"test\"", "title = 1979-05-27"),
              HasSubstr("is a date or time; expected a text"));
}

TEST_F(SceneFile, wrong_array_length) {
  EXPECT_EQ(scene_said("[0, 0, -20]", "[0, 0]"),
            "scenes/ball.toml:7:15: 'position_mm' has 2 elements; expected 3 numbers in mm (position of its "
            "origin O in W); "
            "write it like 'position_mm = [0, 0, 1]'");
  EXPECT_THAT(scene_said("[52, 0, 0]", "[52, 0]"),
              StartsWith("scenes/ball.toml:11:14: 'markers_mm[1]' has 2 elements; expected 3"));
  EXPECT_THAT(scene_said("[52, 0, 0]", "[52, \"0\", 0]"),
              StartsWith("scenes/ball.toml:11:14: 'markers_mm[1][1]' is a text; expected a number"));
  EXPECT_THAT(scene_said("depth_mm = 6.3", "approach_mm_s = []"),
              HasSubstr("17:17: 'approach_mm_s' is empty; expected one or more"));
  write("responses/tennis_ball.toml", replaced(kResponse, "[1, 0.1, 0, 0]", "[1, 0.1, 0]"));
  write("scenes/ball.toml", kScene);
  EXPECT_THAT(said(), StartsWith("responses/tennis_ball.toml:4:20: 'press_N_per_mm_k' has 3 elements; "
                                 "expected 4 numbers in N/mm^k"));
}

TEST_F(SceneFile, number_that_is_not_finite_or_out_of_range) {
  EXPECT_THAT(scene_said("= 33", "= nan"),
              StartsWith("scenes/ball.toml:6:13: 'radius_mm' is nan; expected a finite number"));
  EXPECT_THAT(scene_said("= 33", "= inf"),
              StartsWith("scenes/ball.toml:6:13: 'radius_mm' is inf; expected a finite number"));
  EXPECT_THAT(scene_said("= 33", "= 0"),
              StartsWith("scenes/ball.toml:6:13: 'radius_mm' is 0; expected a positive number in mm"));
  EXPECT_THAT(scene_said("tip_mm", "mass_kg = -0.05\ntip_mm"),
              StartsWith("scenes/ball.toml:12:11: 'mass_kg' is -0.05; expected a number of at least 1e-06"));
  EXPECT_THAT(scene_said("-20]", "-inf]"), HasSubstr("'position_mm[2]' is -inf; expected a finite number"));
  write("scenes/ball.toml", kScene);
  EXPECT_THAT(rig_said("rate_hz = 1000 ", "rate_hz = -1000 "),
              StartsWith("rigs/sim.toml:7:11: 'rate_hz' is -1000; expected a number from 200"));
  EXPECT_THAT(rig_said("mass_kg = 0.91", "mass_kg = nan"),
              HasSubstr("'mass_kg' is nan; expected a finite number"));
  EXPECT_THAT(rig_said("timestep_us = 1000", "timestep_us = 5001"),
              HasSubstr("'timestep_us' is 5001; expected a number above 0 and at most 5000 in us"));
  EXPECT_THAT(rig_said("[0.0166, ", "[-0.0166, "),
              HasSubstr("'noise_mm[0]' is -0.0166; expected a not negative number"));
  write("rigs/sim.toml", rig_);
  write("behaviours.toml", replaced(kBehaviours, "= 2", "= -2"));
  EXPECT_THAT(
      said(),
      StartsWith("behaviours.toml:6:22: 'stiffness_N_per_mm' is -2; expected a positive number in N/mm"));
  write("behaviours.toml", replaced(kBehaviours, "= 2", "= 1e307"));  // finite in N/mm, not in N/m
  EXPECT_THAT(said(), HasSubstr("expected a finite number"));
}

TEST_F(SceneFile, unknown_word_or_version) {
  EXPECT_EQ(scene_said("\"sphere\"", "\"spere\""),
            "scenes/ball.toml:5:9: 'shape' is 'spere'; expected 'plane' or 'sphere' or 'mesh' or 'button' or "
            "'box' (shape of the undeformed surface); did you mean 'sphere'?");
  EXPECT_THAT(scene_said("format = 1", "format = 2"),
              StartsWith("scenes/ball.toml:1:10: 'format' is 2; expected a whole number that is 1 (version "
                         "of the scene format; "
                         "this program reads version 1)"));
  EXPECT_THAT(scene_said("[manipulator]", "[manipulator]\nkind = \"hexpod\""),
              HasSubstr("did you mean 'hexapod'?"));
}

TEST_F(SceneFile, not_toml) {
  EXPECT_THAT(scene_said("radius_mm = 33", "radius_mm = "), StartsWith("scenes/ball.toml:6:"));
  EXPECT_THAT(scene_said("radius_mm = 33", "radius_mm 33"), HasSubstr("this is not TOML: "));
  EXPECT_THAT(scene_said("radius_mm = 33", "radius_mm = 33\nradius_mm = 34"),
              StartsWith("scenes/ball.toml:7:"));
  EXPECT_THAT(scene_said("title = \"test\"", "title = \"te\nst\""), StartsWith("scenes/ball.toml:2:"));
  EXPECT_THAT(scene_said("test", "te\xff\xfest"), StartsWith("scenes/ball.toml:2:"));
  write("scenes/ball.toml", std::string("\0\1\2", 3));
  EXPECT_THAT(said(), StartsWith("scenes/ball.toml:1:"));
}

TEST_F(SceneFile, empty_scene) {
  write("scenes/ball.toml", "format = 1\n");
  EXPECT_EQ(said(),
            "scenes/ball.toml:1:1: the scene has no object; expected at least one [[object]]; add one, as in "
            "models/scenes/plane.toml");
  write("scenes/ball.toml", "");
  EXPECT_THAT(said(), StartsWith("scenes/ball.toml:1:1: the file has no 'format'; expected"));
}

TEST_F(SceneFile, two_of_one_name) {
  const std::string object =
      "[[object]]\nname = \"ball\"\nshape = \"plane\"\nposition_mm = [0, 0, 0]\nbehaviour = \"wall\"\n";
  EXPECT_EQ(scene_said("[[tool]]", object + "[[tool]]"),
            "scenes/ball.toml:9:1: there are two [[object]] named 'ball' (the other is at "
            "scenes/ball.toml:3:1); expected different "
            "names; rename one");
  const std::string tool =
      "[[tool]]\nname = \"stylus\"\nmarkers_mm = [[0, 0, 0], [60, 0, 0], [0, 30, 0]]\ntip_mm = [0, 0, 0]\n";
  EXPECT_THAT(scene_said("[manipulator]", tool + "[manipulator]"),
              StartsWith("scenes/ball.toml:13:1: there are two [[tool]] named 'stylus'"));
  write("scenes/ball.toml", kScene);
  write("behaviours.toml", replaced(kBehaviours, "\"wall\"", "\"tennis_ball\""));
  EXPECT_THAT(said(), StartsWith("behaviours.toml:4:1: there are two [[behaviour]] named 'tennis_ball'"));
}

TEST_F(SceneFile, name_that_does_not_exist) {
  EXPECT_EQ(scene_said("behaviour = \"tennis_ball\"", "behaviour = \"tenis_ball\""),
            "scenes/ball.toml:8:1: there is no behaviour 'tenis_ball'; expected an entry of behaviours.toml "
            "or a [[behaviour]] of this scene; "
            "did you mean 'tennis_ball'?");
  EXPECT_EQ(scene_said("depth_mm", "object = \"bal\"\ndepth_mm"),
            "scenes/ball.toml:17:1: there is no object 'bal'; expected the name of a [[object]]; did you "
            "mean 'ball'?");
  EXPECT_THAT(scene_said("depth_mm", "tool = \"pen\"\ndepth_mm"),
              StartsWith("scenes/ball.toml:17:1: there is no tool 'pen'; expected the name of a [[tool]]; "
                         "the names here are 'stylus'"));
}

TEST_F(SceneFile, missing_response_file) {
  EXPECT_EQ(scene_said("behaviour = \"tennis_ball\"", "behaviour = \"lost\""),
            "behaviours.toml:10:1: there is no response file 'responses/tenis_ball.toml'; expected a file in "
            "responses; did you mean "
            "'tennis_ball'?");
}

TEST_F(SceneFile, file_that_cannot_be_read) {
  EXPECT_EQ(said({}, "scenes/bal.toml"),
            "scenes/bal.toml:1:1: cannot read this scene: No such file or directory; expected a TOML file; "
            "did you mean "
            "'scenes/ball.toml'?");
  EXPECT_THAT(said({}, "scenes"), HasSubstr("cannot read this scene: it is a folder"));
  EXPECT_EQ(said({}, "scenes/ball.toml", "sin"),
            "rigs/sin.toml:1:1: cannot read this rig: No such file or directory; expected a TOML file; did "
            "you mean 'sim'?");
  fs::remove(folder_ / "behaviours.toml");
  EXPECT_THAT(
      said(),
      StartsWith("behaviours.toml:1:1: cannot read this list of behaviours: No such file or directory"));
}

// ---- Scenes and the files that they name, each right by itself, that do not fit together. Also messages
// about --set, and places.

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
  EXPECT_THAT(tip("tip_edge_mm = 20"), HasSubstr("'tip_edge_mm'"));  // a sphere has no edge
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

// prepare() of core throws errors with stems as keys; the program looks up their places.
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

// Every committed scene loads. (A scene that needs its measured curve is skipped until that is generated.)
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
