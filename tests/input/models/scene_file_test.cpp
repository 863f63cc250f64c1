// Bad scenes, rigs, behaviours and responses: one line each, with file, line and column, what was expected
// and what to do.
#include "models/setup/scene_file.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/input/models/scene_folder.h"
#include "tests/support/replaced.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using test::kBehaviours;
using test::kResponse;
using test::kScene;
using test::replaced;
using test::SceneFile;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

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
            "scenes/ball.toml:7:15: 'position_mm' has 2 elements; expected 3 numbers in mm (where its origin "
            "O is in W); "
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
            "'box' (its undeformed surface); did you mean 'sphere'?");
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

}  // namespace
}  // namespace enc::models
