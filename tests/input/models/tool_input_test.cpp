// Tools of masses that cannot be: refused by name before anything moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Of a whole trial, which builds the twin.
std::string said_tool(const std::string& scene, const std::string& rig, const std::vector<std::string>& set) {
  try {
    trial::TrialOptions options;
    options.seconds = 0.5;
    const trial::TrialResult result = trial::Trial(models::load(scene_file(scene), rig, set), options).run();
    return result.divergence;
  } catch (const Error& e) {
    return e.what();
  }
}

// A milligram is the least that a file may say; what the simulated hand cannot hold is refused where it is
// built.
TEST(ToolInput, AMassThatIsNoneIsRefused) {
  for (const char* mass : {"0", "-1", "1e-20", "1e-9", "9e-7", "nan", "inf"}) {
    EXPECT_THAT(said_tool("wall", "vishap", {std::string("tool.finger.mass_kg=") + mass}),
                AllOf(HasSubstr("'mass_kg'"), HasSubstr("expected"), Not(HasSubstr("\n"))))
        << mass;
    EXPECT_THAT(said_tool("session", "sim", {std::string("tool.probe.mass_kg=") + mass}),
                HasSubstr("'mass_kg'"))
        << mass;
  }
}

TEST(ToolInput, AToolThatTheHandCannotHoldIsRefusedByName) {
  for (const char* mass : {"1e-6", "1e-3", "0.00217"}) {
    EXPECT_THAT(
        said_tool("wall", "vishap", {std::string("tool.finger.mass_kg=") + mass}),
        AllOf(HasSubstr("tool 'finger' weighs"), HasSubstr("expected more than"), Not(HasSubstr("\n"))))
        << mass;
    EXPECT_THAT(said_tool("session", "sim", {std::string("tool.probe.mass_kg=") + mass}),
                HasSubstr("tool 'probe' weighs"))
        << mass;
  }
}

// A tracker cannot tell how a tool is turned about the line that its markers are on. With 0.3 mm noise the
// first of these is turned by almost anything, the second by 3 deg (rms).
TEST(ToolInput, MarkersThatAreAlmostOnALineAreRefused) {
  const auto said = [](const std::string& markers) {
    return said_tool("tennis_ball", "sim", {"tool.stylus.markers_mm=" + markers});
  };
  EXPECT_THAT(
      said("[[0, 0, 0], [60, 0, 0], [130, 0.031, 0]]"),
      AllOf(HasSubstr("the markers of tool 'stylus' are on a line, or almost: they are 0.01 mm rms off "
                      "it; expected at least 3.46 mm, or"),
            HasSubstr("move one of 'markers_mm'"), Not(HasSubstr("\n"))));
  EXPECT_THAT(said("[[0, 0, 0], [60, 7, 0], [130, 0, 0]]"), HasSubstr("are on a line, or almost: they are"));
  EXPECT_EQ(said("[[0, 0, 0], [60, 8, 0], [130, 0, 0]]"), "");
  // Of more markers each may be nearer to the line, and off it in whatever direction.
  EXPECT_THAT(said("[[0, 0, 0], [20, 4, 0], [60, 0, 3], [130, 0, 0]]"), HasSubstr("at least 3.00 mm, or"));
  EXPECT_EQ(said("[[0, 0, 0], [20, 6, 0], [60, 0, 6], [130, 0, 0]]"), "");
  EXPECT_THAT(said("[[0, 0, 0], [0, 0, 0], [0, 0, 0]]"), HasSubstr("they are 0.00 mm rms off"));
}

// 2 b h + k h^2 = 8.7 g at 1 ms: a quarter of that is where the grip diverges. A shorter step holds less.
TEST(ToolInput, WhatIsNotRefusedRuns) {
  EXPECT_EQ(said_tool("wall", "vishap", {"tool.finger.mass_kg=0.0022"}), "");
  EXPECT_EQ(said_tool("tennis_ball", "sim", {"tool.stylus.mass_kg=0.0022"}), "");
  EXPECT_EQ(said_tool("tennis_ball", "sim", {"tool.stylus.mass_kg=0.0011", "truth.world.timestep_us=500"}),
            "");
}

}  // namespace
}  // namespace enc::test
