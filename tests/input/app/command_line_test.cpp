// Words that are wrong, each refused in one line before anything has run; and the help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/input/app/program.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

TEST_F(Program, SetThatCannotBe) {
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radus_mm=30"}),
              AllOf(StartsWith("--set object.ball.radus_mm=30: unknown parameter"),
                    HasSubstr("did you mean 'object.ball.radius_mm'?")));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_cm=3"}), HasSubstr("radius_mm"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_mm=wide"}), HasSubstr("expected a"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_mm=nan"}), HasSubstr("expected a finite"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_mm"}), HasSubstr("expected name=value"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "user.polar_deg=170"}),
              StartsWith("--set user.polar_deg=170: the user presses where the machine does not reach"));
}

TEST_F(Program, PaceThatIsRubbish) {
  for (const char* pace : {"rubbish", "10x", "0", "-1", "nan", "inf", "1e999", "free ", "1,5"})
    EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--record", path("never.encrec"),
                         std::string("--pace=") + pace}),
                HasSubstr("expected free, wall, or a positive number"))
        << "pace '" << pace << "'";
  EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--pace="}), HasSubstr("--pace"));
}

TEST_F(Program, LengthThatIsNotPositive) {
  for (const char* length : {"-1", "0", "-0.0", "-inf", "inf", "1e300"})
    EXPECT_THAT(refused({"run", ball(), std::string("--for-s=") + length, "--record", path("never.encrec")}),
                HasSubstr("--for-s: expected a positive number"))
        << length;
  EXPECT_THAT(refused({"run", ball(), "--for-s=soon"}), HasSubstr("--for-s"));
}

// NaN is how "not given" is said inside; given by a person it is bad input all the same.
TEST_F(Program, LengthThatIsNaN) {
  EXPECT_THAT(refused({"run", plane(), "--for-s=nan", "--record", path("never.encrec")}),
              HasSubstr("--for-s: expected a positive number"));
}

TEST_F(Program, SeedThatIsNoWholeNumber) {
  for (const char* seed : {"x", "1.5", ""})
    EXPECT_THAT(refused({"run", ball(), "--for-s=0.1", std::string("--seed=") + seed}), HasSubstr("--seed"))
        << seed;
}

// Of every command that has one.
TEST_F(Program, SeedThatIsNegativeOrTooLarge) {
  for (const char* seed : {"-1", "99999999999999999999999"})
    for (const Words& words :
         {Words{"run", ball(), "--for-s=0.1"}, Words{"fake", "fakes"}, Words{"bench"},
          Words{"calibrate", "camera", "vishap"}, Words{"calibrate", "rig", "sim"}, Words{"view", ball()}}) {
      Words all = words;
      all.push_back(std::string("--seed=") + seed);
      const bool two = words.front() == "calibrate";
      EXPECT_EQ(refused(all),
                "--seed: expected a whole number from 0 to 18446744073709551615; see encounter " +
                    words.front() + (two ? " " + words[1] : "") + " --help\n");
    }
}

TEST_F(Program, OptionsThatDoNotExist) {
  EXPECT_THAT(refused({"run", ball(), "--recrd", path("never.encrec")}), HasSubstr("--recrd"));
  EXPECT_THAT(refused({"check", ball(), "--pace", "free"}), HasSubstr("--pace"));
  EXPECT_THAT(refused({"run", ball(), "superfluous"}), HasSubstr("superfluous"));
  EXPECT_THAT(refused({"run"}), HasSubstr("scene"));
  EXPECT_THAT(refused({"replay"}), HasSubstr("record"));
  EXPECT_THAT(refused({}), HasSubstr("see encounter --help"));
}

TEST_F(Program, SubcommandThatDoesNotExistIsNamedWithTheNearest) {
  EXPECT_THAT(refused({"rn", ball()}), AllOf(HasSubstr("'rn'"), HasSubstr("'run'")));
}

TEST_F(Program, EverySubcommandHasHelp) {
  for (const char* command :
       {"run", "check", "replay", "view", "params", "bench", "fit", "doctor", "fake", "devices"}) {
    const Result r = run_program({command, "--help"});
    EXPECT_EQ(r.code, 0) << command;
    EXPECT_EQ(r.err, "") << command;
    EXPECT_THAT(r.out, HasSubstr("Usage:")) << command;
  }
  EXPECT_EQ(run_program({"--help"}).code, 0);
  EXPECT_THAT(run_program({"--version"}).out,
              MatchesRegex("Encounter [0-9]+\\.[0-9]+\\.[0-9]+, commit .+ of .+\n"));
}

}  // namespace
}  // namespace enc::tests
