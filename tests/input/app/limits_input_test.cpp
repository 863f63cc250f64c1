// What is beyond a limit: said before, said afterwards with exit code 1, and refused where a real machine is
// armed.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

std::string scene(const std::string& name) {
  return std::string(ENCOUNTER_SOURCE_DIR) + "/models/scenes/" + name + ".toml";
}

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
  const Result run = run_program(with({"run", scene("stiffness")}, kSoft));
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("unsteady    object 'wall'"), HasSubstr("LIMIT       object 'wall' swung")));
  const Result damped =
      run_program(with(with({"run", scene("stiffness")}, kSoft), {"rig.admittance.damping=observed"}));
  EXPECT_EQ(damped.code, 0) << damped.out;
}

TEST(Limits, CheckNamesTheSoftestSpringAndWhatIsSofter) {
  const Result check = run_program(with({"check", scene("stiffness")}, kSoft));
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.out, AllOf(HasSubstr("UNSTEADY: object 'wall'"),
                               HasSubstr("softest spring that stands still: 0.36"), HasSubstr(", 0.59")));
  EXPECT_THAT(run_program({"check", scene("tennis_ball")}).out, Not(HasSubstr("UNSTEADY")));
}

TEST(Limits, APressBeyondTheMotorsIsSaidBeforeAndAfter) {
  const Words deep{"behaviour.phantom_wall.stiffness_N_per_mm=0.7", "user.depth_mm=10", "user.hold_s=20"};
  const Result check = run_program(with({"check", scene("wall")}, deep));
  EXPECT_THAT(check.out, AllOf(HasSubstr("for hours"), HasSubstr("BEYOND: object")));
  const Result run = run_program(with({"run", scene("wall")}, deep));
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("beyond      object"), HasSubstr("LIMIT       the motors were warm")));
  const Words deeper{"behaviour.phantom_wall.stiffness_N_per_mm=1.2", "user.depth_mm=14", "user.hold_s=1"};
  const Result peak = run_program(with({"run", scene("wall")}, deeper));
  EXPECT_EQ(peak.code, 1) << peak.out;
  EXPECT_THAT(peak.out,
              AllOf(HasSubstr("there the motors push with at most"), HasSubstr("LIMIT       a motor")));
}

TEST(Limits, AWallThatNoLawHoldsIsNamed) {
  const Result run =
      run_program(with({"run", scene("wall"), "--json"}, {"behaviour.phantom_wall.stiffness_N_per_mm=1000"}));
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, HasSubstr("the law rings from"));
}

TEST(Limits, ContactsInWhichNothingIsFeltAreNamed) {
  const Result pressed =
      run_program(with({"run", scene("tennis_ball")}, {"truth.tracker.bias_mm=[0, 0, -5]"}));
  EXPECT_EQ(pressed.code, 1) << pressed.out;
  EXPECT_THAT(pressed.out, HasSubstr("LIMIT       nothing was felt in 3 of 5 contacts"));
  const Result met = run_program(with({"run", scene("wall")}, {"truth.tracker.bias_mm=[60, 0, 0]"}));
  EXPECT_EQ(met.code, 1) << met.out;
  EXPECT_THAT(met.out, HasSubstr("LIMIT       nothing was touched in 3 of 3 contacts"));
}

}  // namespace
}  // namespace enc::tests
