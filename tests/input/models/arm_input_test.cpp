// Mistakes in the files of an arm, its ground truth, its gains and its objects: each test expects one line
// with the place of the mistake.
#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"
#include "tests/support/twin.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// ---- Mistakes in the files of an arm, its ground truth and its objects: one line refuses each, with the
// place of the key.

// The message as `encounter run` prints it.
std::string said(const std::vector<std::string>& set, const std::string& scene = "wall",
                 const std::string& rig = "") {
  try {
    const trial::Trial trial(models::load(scene_file(scene), rig, set), {});
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
    EXPECT_EQ(e.kind(), ErrorKind::input);
    return e.what();
  }
  return {};
}

TEST(ArmInput, LimitsOfAJointGoUpAndHaveHomeBetweenThem) {
  for (const char* machine : {"rig", "truth"}) {
    const std::string key = std::string(machine) + ".arm.machine.joint_low=";
    EXPECT_THAT(
        said({key + "[2, 0, 0]"}),
        AllOf(StartsWith("--set " + key), HasSubstr("joint 1 goes from 2 to 1.5708"), HasSubstr("expected")));
    EXPECT_THAT(said({key + "[0, 1, 0]"}), HasSubstr("joint 2 goes from 1 to 2.077"));
  }
  EXPECT_THAT(said({"rig.arm.machine.joint_high=[1, 1, -0.1]"}),
              AllOf(StartsWith("--set"), HasSubstr("joint 3 goes from -0.506 to -0.1")));
  EXPECT_THAT(said({"rig.arm.machine.coupled_low_deg=0", "rig.arm.machine.coupled_high_deg=0"}),
              HasSubstr("expected a range"));
}

// Limits are in the key's own unit, so a slip by a factor of a thousand is refused.
TEST(ArmInput, AnAgeHasAnEndOfBothKinds) {
  for (const auto& [key, scene] :
       {std::pair{"rig.arm.stale_ms=", "wall"}, {"rig.force.stale_ms=", "tennis_ball"}}) {
    EXPECT_EQ(said({key + std::string("0.1")}, scene), "");
    EXPECT_EQ(said({key + std::string("1000")}, scene), "");
    for (const char* wrong : {"0", "-1", "0.05", "1001", "5000"})
      EXPECT_THAT(said({std::string(key) + wrong}, scene),
                  HasSubstr("expected a number from 0.1 to 1000 in ms"))
          << key << wrong;
  }
}

TEST(ArmInput, FrictionSetsInWithinTwoTimeStepsOrLater) {
  EXPECT_EQ(said({"truth.arm.friction_time_ms=2"}), "");
  EXPECT_THAT(
      said({"truth.arm.friction_time_ms=1.9"}),
      AllOf(StartsWith("--set truth.arm.friction_time_ms=1.9: "),
            HasSubstr("expected at least two time steps, 2 ms"), HasSubstr("'timestep_us = 500' or less")));
  EXPECT_EQ(said({"truth.arm.friction_time_ms=1.9", "truth.arm.timestep_us=500"}), "");
  EXPECT_THAT(said({"truth.arm.friction_time_ms=0.1"}), HasSubstr("'timestep_us = 50' or less"));
  EXPECT_EQ(said({"truth.arm.friction_time_ms=0.1", "truth.arm.timestep_us=50"}), "");
  EXPECT_EQ(said({"truth.arm.friction_time_ms=0.1", "truth.arm.friction_form=smooth"}), "")
      << "of the dry form";
}

TEST(ArmInput, AStopThatMuJoCoTakesForALongerOneIsSaid) {
  const auto notes = [](const std::string& scene, const std::string& set) {
    return models::load(scene_file(scene), "", {set}).notes;
  };
  EXPECT_THAT(notes("wall", "truth.arm.contact_time_ms=1"),
              ElementsAre(AllOf(StartsWith("--set truth.arm.contact_time_ms=1: warning: "),
                                HasSubstr("two time steps, 2 ms"))));
  EXPECT_THAT(notes("drum", "truth.arm.belt_time_ms=1"), ElementsAre(HasSubstr("'belt_time_ms' is 1")));
  EXPECT_THAT(notes("tennis_ball", "truth.world.contact_time_ms=1"),
              ElementsAre(HasSubstr("shorten 'truth.world.timestep_us'")));
  EXPECT_THAT(notes("wall", "truth.arm.contact_time_ms=2"), ElementsAre());
}

TEST(ArmInput, APyramidalConeIsWarnedOf) {
  const auto notes = [](const std::string& scene, const std::vector<std::string>& set) {
    return models::load(scene_file(scene), "", set).notes;
  };
  for (const char* scene : {"wall", "offset_press"}) {
    EXPECT_THAT(notes(scene, {"truth.solver.cone=pyramidal"}),
                ElementsAre(AllOf(StartsWith("--set truth.solver.cone=pyramidal: warning: "),
                                  HasSubstr("here 20"), HasSubstr("use 'impratio = 1'"))));
    EXPECT_THAT(notes(scene, {"truth.solver.cone=pyramidal", "truth.solver.impratio=1"}), ElementsAre());
  }
  EXPECT_THAT(notes("stiffness", {"truth.solver.cone=pyramidal"}), ElementsAre())
      << "pushed by a law of its own";
}

// The finger would touch this wall at its nearest point and feel no force.
TEST(ArmInput, AWallThatTheMachineDoesNotMoveAlongIsRefused) {
  EXPECT_EQ(said({}, "wall", "stage"), "");
  EXPECT_THAT(said({"object.wall.normal=[0, 1, 0]"}, "wall", "stage"),
              AllOf(StartsWith("--set object.wall.normal=[0, 1, 0]: object 'wall' faces a way"),
                    HasSubstr("2 joints"), HasSubstr("expected a normal")));
  EXPECT_EQ(said({"object.wall.normal=[0, 0.8, 0.6]"}, "wall", "stage"), "");
  EXPECT_EQ(said({"object.wall.normal=[0, 1, 0]"}), "") << "the PHANToM goes there";
}

TEST(ArmInput, TheSolversStepsAreWholeNumbers) {
  EXPECT_THAT(said({"truth.solver.iterations=10.5"}),
              AllOf(HasSubstr("is a number with a fraction"), HasSubstr("a whole number from 1 to 10000")));
  EXPECT_THAT(said({"truth.solver.noslip_iterations=0.5"}), HasSubstr("a whole number from 0 to 1000"));
  EXPECT_EQ(said({"truth.solver.iterations=10", "truth.solver.noslip_iterations=3"}), "");
  EXPECT_EQ(said({"truth.solver.noslip_iterations=unset"}), "");
}

TEST(ArmInput, ChainsHaveOneToThreeLinksAndTheTruthAsMany) {
  EXPECT_THAT(said({"rig.arm.machine.kind=chain"}),
              AllOf(HasSubstr("vishap.toml"), HasSubstr("has 0 links"), HasSubstr("'[[arm.machine.link]]'")));
  models::Setup setup = models::load(scene_file("wall"), "stage");
  setup.twin.arm.machine.links.pop_back();
  EXPECT_THAT(error_of([&] { models::check(setup); }),
              AllOf(HasSubstr("stage.toml"), HasSubstr("has 1 joints; expected 2")));
}

TEST(ArmInput, AxesAndWaysThatHaveNoLengthOfOneAreNamed) {
  EXPECT_THAT(said({"rig.arm.machine.link.x.axis=[0.5, 0, 0]"}, "wall", "stage"),
              AllOf(HasSubstr("'axis' has length 0.5; expected length 1"), HasSubstr("'axis = [1, 0, 0]'")));
  EXPECT_THAT(said({"behaviour.tile.interaction.way=[0, 0, 0]"}, "tiles"),
              HasSubstr("'way' has length 0 and no direction"));
}

TEST(ArmInput, ANormalOfAnyLengthIsMended) {
  for (const char* normal : {"[0, 3e150, 4e200]", "[0, 0, 1e-5]"}) {
    const models::Setup setup =
        models::load(scene_file("wall"), "", {std::string("object.wall.normal=") + normal});
    EXPECT_THAT(setup.notes, ElementsAre(HasSubstr("taken as [0, ")));
    EXPECT_DOUBLE_EQ(setup.scene.objects[0].normal.z(), 1.0);
  }
}

TEST(ArmInput, NumbersThatAMachineCannotHave) {
  EXPECT_THAT(said({"rig.arm.continuous_N=14"}), HasSubstr("expected at most 'peak_N', 8.5"));
  EXPECT_THAT(said({"truth.arm.continuous_torque_Nm=[0.01, 0.2, 0.01]"}),
              HasSubstr("'continuous_torque_Nm' is 0.2; expected at most 'peak_torque_Nm', 0.129"));
  EXPECT_THAT(said({"truth.arm.counts=[0.5, 1, 1]"}), HasSubstr("a number of at least 1 in every place"));
  EXPECT_THAT(said({"truth.arm.mass_scale=1e9"}), HasSubstr("expected a number from 0.01 to 100"));
  EXPECT_THAT(said({"truth.arm.velocity_window_ms=100"}), HasSubstr("expected at most 63"));
}

TEST(ArmInput, AFilterThatLetsMoreThroughThanTheLoopCarries) {
  EXPECT_EQ(said({"rig.arm.filter_hz=500"}), "");
  EXPECT_THAT(said({"rig.arm.filter_hz=501"}), HasSubstr("expected at most 500, half of the loop's rate"));
}

TEST(ArmInput, ATimeStepThatNeverEnds) {
  EXPECT_EQ(said({"truth.arm.timestep_us=10"}), "");
  for (const char* step : {"1e-9", "0.001", "0.5"})
    EXPECT_THAT(said({std::string("truth.arm.timestep_us=") + step}),
                HasSubstr("expected at least a thousandth of the haptic period, 1;"));
}

TEST(ArmInput, AWorldThatDoesNotCompileIsOneLineWithItsPlace) {
  EXPECT_THAT(said({"truth.arm.machine.m_be_kg=1e-30"}),
              AllOf(HasSubstr("vishap.toml:"), HasSubstr("does not compile")));
}

TEST(ArmInput, KeysThatOnlyTheOtherMachineReads) {
  EXPECT_THAT(said({"object.wall.limit_mm=3"}),
              HasSubstr("'limit_mm' limits a deflection, which an arm does not"));
  EXPECT_THAT(said({"object.wall.limits_mm=[3, 2]"}), HasSubstr("'limits_mm' limits a deflection"));
  EXPECT_THAT(said({"behaviour.phantom_wall.limit_mm=3"}), HasSubstr("'limit_mm' limits a deflection"));
  EXPECT_THAT(said({"behaviour.phantom_wall.tangential=spring",
                    "behaviour.phantom_wall.tangential_stiffness_N_per_mm=1"}),
              HasSubstr("expected 'stick'"));
}

// The message gives the place of the key that names the other machine's behaviour.
TEST(ArmInput, ABehaviourOfTheOtherMachine) {
  EXPECT_THAT(said({"object.wall.behaviour=wall"}),
              AllOf(StartsWith("--set object.wall.behaviour=wall: "), HasSubstr("\"phantom_wall\"")));
  EXPECT_THAT(
      said({"object.wall.behaviour=phantom_wall"}, "plane"),
      AllOf(StartsWith("--set object.wall.behaviour=phantom_wall: "), HasSubstr("without [interaction]")));
  EXPECT_THAT(
      said({"object.wall.behaviour="}),
      AllOf(HasSubstr("has no 'behaviour'"), Not(HasSubstr("[probe]")), HasSubstr("\"phantom_wall\"")));
}

TEST(ArmInput, OneFingerOfAFingersSize) {
  EXPECT_THAT(said({"tool.finger.tip_radius_mm=60"}), HasSubstr("a positive radius of at most 50 mm"));
  models::Setup setup = models::load(scene_file("wall"), "");
  setup.scene.tools.push_back(setup.scene.tools[0]);
  setup.scene.tools.back().name = "thumb";
  EXPECT_THAT(error_of([&] { models::check(setup); }), HasSubstr("tool 'thumb' is another"));
}

TEST(ArmInput, APressOutOfReach) {
  EXPECT_THAT(said({"user.offset_mm=5000"}),
              AllOf(HasSubstr("wall.toml:"), HasSubstr("the arm does not get")));
  // The prop presents the middle of a key, wherever the finger touches its face.
  EXPECT_THAT(said({"object.key.position_mm=[0, 0, -400]"}, "room"),
              HasSubstr("does not get to object 'key'"));
}

TEST(ArmInput, ButtonsSayWhichDepthAndStiffness) {
  const std::string at = "behaviour.phantom_button.interaction.";
  EXPECT_THAT(said({at + "trigger_mm=5"}, "button"), HasSubstr("4 mm deep; expected more than 5.5"));
  EXPECT_THAT(said({at + "after_N_per_mm=0.7"}, "button"), HasSubstr("from 0.4 to 0.7 N/mm"));
  EXPECT_THAT(said({at + "floor_N_per_mm=0.1"}, "button"), HasSubstr("0.1 N/mm; expected more than 0.2"));
}

TEST(ArmInput, TheRigThatIsOfferedHasAnArm) {
  EXPECT_THAT(said({}, "wall", "sim"), EndsWith("or use '--rig vishap'"));
  EXPECT_THAT(said({}, "plane", "vishap"), EndsWith("or use '--rig sim'"));
}

TEST(ArmInput, MadeForARigThatIsNotThere) {
  const TemporaryFolder folder;
  std::string text = bytes_of(scene_file("wall"));
  const std::string path = folder.file("wall.toml");
  std::ofstream(path) << text.replace(text.find("\"vishap\""), 8, "\"vishp\"");
  for (const char* rig : {"", "vishap"}) {
    EXPECT_THAT(error_of([&] { (void)models::load(path, rig); }),
                AllOf(StartsWith(path + ":4:1: "), HasSubstr("'vishp'"), EndsWith("did you mean 'vishap'?")));
  }
}

// Notes are for scenes that run.
TEST(ArmInput, OfARefusedSceneOneLineIsSaid) {
  const tests::Result result =
      tests::run_program({"run", scene_file("hit_ball"), "--set", "object.ball.behaviour=phantom_button"});
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("cannot click"));
}

TEST(ArmReport, CheckSaysWhatAnArmRenders) {
  const tests::Result result = tests::run_program({"check", scene_file("room")});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("object 'key': passive, 0.6 N/mm"), HasSubstr("damping ratio 1.19"),
                                HasSubstr("pushes with up to 8.5 N"), Not(HasSubstr("nan")),
                                Not(HasSubstr("not rendered"))));
}

// Without a measurable touch the report prints no nan. Figures of a deflection are for hexapods only.
TEST(ArmReport, WhatWasNotMeasuredIsSaid) {
  const std::vector<std::string> args{"run",     scene_file("wall"),
                                      "--for-s", "5",
                                      "--set",   "truth.arm.peak_torque_Nm=[1e-9, 1e-9, 1e-9]",
                                      "--set",   "truth.arm.continuous_torque_Nm=[1e-9, 1e-9, 1e-9]"};
  const tests::Result weak = tests::run_program(args);
  EXPECT_EQ(weak.code, 4) << weak.err;  // the arm falls, and the run detects it
  EXPECT_THAT(weak.out, AllOf(HasSubstr("sideways    not measured"),
                              HasSubstr("machine does not follow its commands"), Not(HasSubstr("nan"))));
  const tests::Result json = tests::run_program({"run", scene_file("wall"), "--for-s", "0.2", "--json"});
  EXPECT_THAT(json.out, AllOf(HasSubstr("\"meetings\""), Not(HasSubstr("\"rmse_press_N\""))));
  // The report fits a spring if one spring is pressed, not over reaches for several objects.
  EXPECT_THAT(tests::run_program({"run", scene_file("reaching"), "--for-s", "6"}).out,
              Not(HasSubstr("spring ")));
}

// ---- Impossible gains of an arm's law: one line with the wrong number.

std::string said_gains(const std::string& set) {
  return error_of([&] {
    (void)trial::prepare_setup(models::load(tests::source_dir() + "/models/scenes/wall.toml", "", {set}));
  });
}

TEST(GainsInput, UnderDampedIsRefusedWithTheRatio) {
  EXPECT_EQ(said_gains("rig.arm.damping_Ns_per_m=11.5"), "");
  EXPECT_THAT(said_gains("rig.arm.damping_Ns_per_m=5"),
              AllOf(HasSubstr("under-damped: ratio 0.4"), HasSubstr("expected 1 or more"),
                    HasSubstr("damping_Ns_per_m")));
  EXPECT_THAT(said_gains("rig.arm.stiffness_N_per_m=1200"), HasSubstr("under-damped: ratio 0.5"));
}

TEST(GainsInput, NegativeOrZeroIsRefused) {
  for (const char* key : {"stiffness_N_per_m", "damping_Ns_per_m", "filter_hz"})
    for (const char* value : {"-1", "0", "nan"})
      EXPECT_THAT(said_gains(std::string("rig.arm.") + key + "=" + value), HasSubstr(key)) << key << value;
}

}  // namespace
}  // namespace enc::test
