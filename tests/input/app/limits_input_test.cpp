// What is beyond a limit: said before, said afterwards with exit code 1, and refused where a real machine is
// armed.
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

Words with(Words args, const Words& set) {
  for (const std::string& one : set) {
    args.emplace_back("--set");
    args.push_back(one);
  }
  return args;
}

const Words kSoft{"behaviour.spring.stiffness_N_per_mm=0.15", "truth.pusher.stiffness_N_per_mm=0.7",
                  "truth.pusher.damping_Ns_per_m=4"};

TEST(Limits, ALimitCycleIsNamed) {
  const Result run = run_program(with({"run", shipped_scene("stiffness")}, kSoft));
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("stability   object 'wall': locally stable, at 0.15 N/mm"),
                             HasSubstr("beyond      object 'wall', pushed"),
                             HasSubstr("LIMIT       object 'wall' swung")));
  const Result damped = run_program(
      with(with({"run", shipped_scene("stiffness")}, kSoft), {"rig.admittance.damping=observed"}));
  EXPECT_EQ(damped.code, 0) << damped.out;
}

TEST(Limits, CheckNamesTheSoftestSpringAndWhatIsSofter) {
  const Result check = run_program(with({"check", shipped_scene("stiffness")}, kSoft));
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.out, AllOf(HasSubstr("BEYOND: object 'wall', pushed"),
                               HasSubstr("softest spring that stands still: 0.36"), HasSubstr(", 0.59"),
                               ContainsRegex("admittance +from 0.106 ")));
  EXPECT_THAT(run_program({"check", shipped_scene("tennis_ball")}).out, Not(HasSubstr("BEYOND")));
}

TEST(Limits, APressBeyondTheMotorsIsSaidBeforeAndAfter) {
  const Words deep{"behaviour.phantom_wall.stiffness_N_per_mm=0.7", "user.depth_mm=10", "user.hold_s=20"};
  const Result check = run_program(with({"check", shipped_scene("wall")}, deep));
  EXPECT_THAT(check.out, AllOf(HasSubstr("for hours"), HasSubstr("BEYOND: object")));
  const Result run = run_program(with({"run", shipped_scene("wall")}, deep));
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("beyond      object"), HasSubstr("LIMIT       the motors were warm")));
  const Words deeper{"behaviour.phantom_wall.stiffness_N_per_mm=1.2", "user.depth_mm=14", "user.hold_s=1"};
  const Result peak = run_program(with({"run", shipped_scene("wall")}, deeper));
  EXPECT_EQ(peak.code, 1) << peak.out;
  EXPECT_THAT(peak.out,
              AllOf(HasSubstr("there the motors push with at most"), HasSubstr("LIMIT       a motor")));
}

TEST(Limits, AWallThatNoLawHoldsIsNamed) {
  const Words hard{"behaviour.phantom_wall.stiffness_N_per_mm=1000"};
  const Result run = run_program(with({"run", shipped_scene("wall"), "--json"}, hard));
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, AllOf(HasSubstr("rendered beyond what is stable: object 'wall' asks for 1e+03 N/mm"),
                             HasSubstr("\"class\": \"unstable\"")));
  EXPECT_THAT(run.err, HasSubstr("beyond what is stable: object 'wall'")) << "before it moves";
  const Result check = run_program(with({"check", shipped_scene("wall")}, hard));
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.out, AllOf(HasSubstr("BEYOND: object 'wall' asks for 1e+03 N/mm and is unstable"),
                               HasSubstr("make it softer")));
}

// What rings by itself needs no contact to be beyond its bound.
TEST(Limits, AFreeTipThatIsUnstableIsNamedUntouched) {
  const Words late{"rig.arm.loop.delay_ms=20"};
  const Result run = run_program(with({"run", shipped_scene("wall"), "--for-s", "0.1"}, late));
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_THAT(
      run.out,
      AllOf(HasSubstr("LIMIT       rendered beyond what is stable: the tip that nobody touches is held by"),
            HasSubstr("the loop without a hand is stable from"),
            Not(HasSubstr("LIMIT       rendered beyond what is stable: object"))));
}

TEST(Limits, ASolverThatStopsShortOfItsToleranceIsNamed) {
  const Words few{"truth.solver.iterations=1"};
  const Result run = run_program(with({"run", shipped_scene("wall"), "--for-s", "8"}, few));
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_THAT(run.out,
              ContainsRegex("LIMIT       the contact solver stopped at its 1 iterations, short of its "
                            "tolerance, in [0-9]+ of 8000 steps"));
  const Result json = run_program(with({"run", shipped_scene("wall"), "--for-s", "8", "--json"}, {}));
  EXPECT_THAT(json.out, AllOf(HasSubstr("\"unsolved_steps\": 0"), HasSubstr("\"mujoco_steps\": 8000")));
}

TEST(Limits, CheckTellsTheClassAndEachBound) {
  const Result check = run_program({"check", shipped_scene("wall")});
  EXPECT_THAT(check.out, AllOf(HasSubstr("object 'wall': stable alone, at 0.6 N/mm"),
                               ContainsRegex("colgate_schenkel +to [0-9.]+ "),
                               ContainsRegex("exact_with_hand +to [0-9.]+ "),
                               Not(HasSubstr("BEYOND: object 'wall' asks"))));
  const Result run = run_program({"run", shipped_scene("wall"), "--for-s", "0.1"});
  EXPECT_THAT(run.out, HasSubstr("stability   the tip that nobody touches"));
  EXPECT_EQ(run.code, 0) << run.out;
}

TEST(Limits, ARigThatDoesNotSayWhatItLosesHasNoCertificate) {
  const test::TemporaryFolder folder;
  const std::string rig = folder.file("rig.toml");
  std::ifstream shipped(tests::source_dir() + "/models/rigs/vishap.toml");
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  const std::size_t from = text.find("[arm.loop]");
  text.erase(from, text.find("[arm.machine]") - from);
  std::ofstream(rig) << text;
  const Result check = run_program({"check", shipped_scene("wall"), "--rig", rig});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, AllOf(HasSubstr("unknown: no damping"), HasSubstr("write [arm.loop] into the rig")));
  EXPECT_EQ(run_program({"run", shipped_scene("wall"), "--rig", rig}).code, 0) << "a twin runs";
}

TEST(Limits, WhatALoopCannotBeIsRefused) {
  for (const char* set : {"rig.arm.loop.delay_ms=-1", "rig.arm.loop.delay_ms=nan", "rig.loop.rate_hz=0",
                          "rig.arm.loop.viscous_Nms=[0, -1, 0]", "rig.arm.loop.counts=[0, 0, 0]"}) {
    const Result check = run_program(with({"check", shipped_scene("wall")}, {set}));
    EXPECT_EQ(check.code, 2) << set;
    EXPECT_THAT(check.err, HasSubstr("expected")) << set;
  }
}

TEST(Limits, ContactsInWhichNothingIsFeltAreNamed) {
  const Result pressed =
      run_program(with({"run", shipped_scene("tennis_ball")}, {"truth.tracker.bias_mm=[0, 0, -5]"}));
  EXPECT_EQ(pressed.code, 1) << pressed.out;
  EXPECT_THAT(pressed.out, HasSubstr("LIMIT       nothing was felt in 3 of 5 contacts"));
  const Result met = run_program(with({"run", shipped_scene("wall")}, {"truth.tracker.bias_mm=[60, 0, 0]"}));
  EXPECT_EQ(met.code, 1) << met.out;
  EXPECT_THAT(met.out, HasSubstr("LIMIT       nothing was touched in 3 of 3 contacts"));
}

}  // namespace
}  // namespace enc::tests
