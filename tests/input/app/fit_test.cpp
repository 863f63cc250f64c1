// `encounter fit` as a person uses it: a response that a scene plays, and mistakes in loops, one line each.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/input/app/program.h"
#include "tests/support/bytes_of.h"

namespace enc::tests {
namespace {

using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Program, FitWritesAResponseThatAScenePlays) {
  write("loop.csv", loop_text());
  const Result fit = run_program({"fit", path("loop.csv"), "--out", path("models/responses/mine.toml")});
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out, AllOf(HasSubstr("1 presses"), HasSubstr("without constraints"), HasSubstr("95 %"),
                             HasSubstr("condition"), HasSubstr("no weight")));
  EXPECT_THAT(bytes_of(path("models/responses/mine.toml")),
              AllOf(HasSubstr("Of unknown origin."), Not(HasSubstr(path("")))));
  edit("models/behaviours.toml", "response = \"tennis_ball\"", "response = \"mine\"");
  for (const char* reversal : {"energy_stop", "prandtl_ishlinskii"}) {
    const Result check = run_program(
        {"check", ball(), "--resolved", "--set", std::string("behaviour.tennis_ball.reversal=") + reversal});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_THAT(check.out, HasSubstr(reversal));
  }
}

TEST_F(Program, FitRefusesBadLoopsInOneLine) {
  const std::string good = loop_text();
  write("loop.csv", good);
  write("text.csv", replaced(good, "0.024000", "much"));
  write("column.csv", replaced(good, "force_N", "force"));
  write("short.csv", good.substr(0, good.size() / 4).substr(0, good.rfind('\n', good.size() / 4) + 1));
  write("empty.csv", "");
  const std::vector<std::pair<Words, std::string>> cases{
      {{"fit", path("text.csv")}, path("text.csv") + ":4:"},
      {{"fit", path("column.csv")}, path("column.csv") + ":1:1: there is no column 'force_N'"},
      {{"fit", path("short.csv")}, "the deepest deflection is"},
      {{"fit", path("empty.csv")}, path("empty.csv") + ":1:1:"},
      {{"fit", path("none.csv")}, "cannot read this loop"},
      {{"fit", path("models")}, "cannot read this loop"},
      {{"fit", path("loop.csv"), "--limit-mm", "7"}, "--limit-mm 6"},
      {{"fit", path("loop.csv"), "--limit-mm", "-1"}, "--limit-mm"},
      {{"fit", path("loop.csv"), "--ceiling-N-per-mm", "0.1"}, "--ceiling-N-per-mm"},
      {{"fit", path("loop.csv"), "--rig", "simm"}, "did you mean 'sim'"},
      {{"fit", path("loop.csv"), "--out", path("none/f.toml")}, "cannot be written"}};
  for (const auto& [args, says] : cases) {
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 2) << args[1];
    EXPECT_THAT(r.err, HasSubstr(says));
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  }
}

TEST_F(Program, StopsThatAFileDoesNotHaveAreMissed) {
  const std::string file = bytes_of(path("models/responses/tennis_ball.toml"));
  write("models/responses/tennis_ball.toml", file.substr(0, file.find("\n[")) + "\n");
  const Result r =
      run_program({"check", ball(), "--set", "behaviour.tennis_ball.reversal=prandtl_ishlinskii"});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, AllOf(HasSubstr("no [stops]"), HasSubstr("encounter fit"), HasSubstr("tennis_ball")));
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
}

}  // namespace
}  // namespace enc::tests
