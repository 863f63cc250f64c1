// `encounter fit` and `fit --ball` as a person uses them: their output, a response that a scene plays, and
// mistakes, one line each.
#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/input/app/program.h"
#include "tests/support/files.h"
#include "tests/support/plant_loop.h"
#include "tests/support/run_program.h"
#include "trial/identify/ball/ball_fit.h"

namespace enc::tests {
namespace {

using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// ---- `encounter fit` as a person uses it: a response that a scene plays, and mistakes in loops, one line
// each.

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

// The force has an offset, contact begins at 2 mm and the way out is fast: the output states all three, and
// prints no missing number.
TEST_F(Program, FitSaysWhatItPutRight) {
  write("off.csv",
        test::law_loop_csv(
            {.out_mm_s = 80.0, .hold_s = 0.5, .zero_N = 0.6, .begin_mm = 2.0, .marks_all = true}, 1));
  const Result fit = run_program({"fit", path("off.csv"), "--out", path("off.toml")});
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out,
              AllOf(HasSubstr("\nnote        before contact the force is 0.60 N: subtracted\n"),
                    HasSubstr("\nnote        contact begins at 2.00 mm: shifted\n"),
                    testing::ContainsRegex(" 11\\.8[789]\\+-0\\.0[0-9]+ N at 1, 2"),
                    testing::ContainsRegex(" 8\\.7[0-3]\\+-0\\.0[0-9]+ N at 1, 2"), Not(HasSubstr("nan"))));
  EXPECT_THAT(bytes_of(path("off.toml")),
              HasSubstr("the force is 0.60 N: subtracted; contact begins at 2.00 mm: shifted; to 6 mm"));
}

// A rig that renders at least 0.125 N/mm cannot render an object of 0.04 N/mm: the fit would return three
// times as much.
TEST_F(Program, FitDoesNotBelieveACurveThatItHadToRaise) {
  const auto of = [&](double newtons_per_mm, const std::string& name) {
    std::string text = "time_s,deflection_mm,force_N,repeat\n";
    for (int i = 1; i < 3000; ++i) {
      const double d = 0.004 * std::min(i, 3000 - i);
      text +=
          fmt::format("{:.3f},{:.3f},{:.5f},1\n", i * 1e-3, d, (i < 1500 ? 1.0 : 0.9) * newtons_per_mm * d);
    }
    write(name, text);
    return run_program({"fit", path(name), "--force", "--out", path("soft.toml")});
  };
  const Result soft = of(0.04, "soft.csv");
  EXPECT_EQ(soft.code, 1);
  EXPECT_THAT(
      soft.out,
      AllOf(HasSubstr("\nnote        at 6.00 mm the release is 0.216 N by the readings and 0.750 N by "
                      "the curve"),
            HasSubstr("softer than this rig renders, 0.125 N/mm; give another --rig\n"),
            HasSubstr("\nnot written ")));
  EXPECT_EQ(bytes_of(path("soft.toml")), "");
  EXPECT_THAT(of(0.001, "kn.csv").out, HasSubstr("or, if force_N is in kN, multiply it by 1000"));
  const Result good = of(0.2, "good.csv");
  EXPECT_EQ(good.code, 0) << good.out;
  EXPECT_THAT(good.out, Not(HasSubstr("note")));
  EXPECT_NE(bytes_of(path("soft.toml")), "");
}

TEST_F(Program, ABallNeedsSecondsInItsLoop) {
  std::string slow = "time_s,deflection_mm,force_N,repeat\n";
  for (int i = 1; i < 3000; ++i)
    slow +=
        fmt::format("{},{:.3f},{:.3f},1\n", i, 0.004 * std::min(i, 3000 - i), 0.008 * std::min(i, 3000 - i));
  write("slow.csv", slow);
  EXPECT_EQ(run_program({"fit", path("slow.csv")}).code, 0) << "a response does not ask for time";
  const Result ball = run_program({"fit", path("slow.csv"), "--ball"});
  EXPECT_EQ(ball.code, 2);
  EXPECT_THAT(ball.err, HasSubstr("slow.csv:1:1: rows are 1 s apart: milliseconds?"));
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

// ---- `fit --ball` as a person uses it: its output, and every mistake in one line.

using Words = std::vector<std::string>;

class FitBall : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (temporary_.path() / name).string();
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

 private:
  test::TemporaryFolder temporary_;
};

std::string csv_of(const test::PushProgramme& programme) {
  trial::Pushes pushes = test::ball_pushes({}, programme);
  test::add_noise(pushes, 1);
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  for (std::size_t push = 0; push < pushes.size(); ++push)
    for (const models::LoopPoint& p : pushes[push])
      text += fmt::format("{:.3f},{:.6f},{:.3f},{}\n", p.time, p.deflection * 1e3, p.force, push + 1);
  return text;
}

TEST_F(FitBall, TellsTheBallAndWhatItDoesNotKnow) {
  write("fast.csv", csv_of({20e-3, 6e-3, 0.0, 1.0, 2}));
  write("dwell.csv", csv_of({20e-3, 6e-3, 3.0, 1.0, 1}));
  const Result r = run_program({"fit", path("fast.csv"), path("dwell.csv"), "--ball"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(
      r.out,
      AllOf(HasSubstr("3 pushes"), HasSubstr("rubber_modulus_MPa"), HasSubstr("held        wall_mm = 3.5"),
            HasSubstr("set         truth.ball.rubber_modulus_MPa=2."), HasSubstr("tied most to")));
  const Result one = run_program(
      {"fit", path("fast.csv"), "--ball", "--json", "--hold", "pressure_kPa=10", "--free", "felt_mm"});
  ASSERT_EQ(one.code, 0) << one.err;
  const nlohmann::json json = nlohmann::json::parse(one.out);
  EXPECT_EQ(json.at("pushes"), 2);
  EXPECT_FALSE(json.at("numbers").contains("pressure_kPa"));
  EXPECT_EQ(json.at("held").at("pressure_kPa"), 10.0);
  EXPECT_EQ(json.at("numbers").at("felt_mm").at("known"), "poorly");
  EXPECT_EQ(json.at("numbers").at("rubber_modulus_MPa").at("known"), "well");
  const double modulus = json.at("numbers").at("rubber_modulus_MPa").at("value");
  EXPECT_NEAR(modulus, 2.6, 0.3);
}

// docs/guide/identification.md. The felt is soft at first, so the fit detects contact 0.3 mm too late; that
// is no shift.
TEST_F(FitBall, TheGuidesExampleFitsWithEverySeed) {
  for (const char* seed : {"1", "2", "3", "5", "8"}) {
    SCOPED_TRACE(seed);
    const Result run =
        run_program({"run", "rig_identify", "--seed", seed, "--record", path("ball.encrec"), "--force"});
    ASSERT_EQ(run.code, 0) << run.err;
    const Result csv = run_program({"export", path("ball.encrec"), "--csv", path("ball.csv"), "--force"});
    ASSERT_EQ(csv.code, 0) << csv.err;
    const Result r = run_program({"fit", path("ball.csv"), "--ball", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, Not(HasSubstr("shifted")));
    EXPECT_NEAR(nlohmann::json::parse(r.out).at("numbers").at("nearer_mm").at("value"), 0.0, 0.03);
  }
}

TEST_F(FitBall, RefusesInOneLine) {
  const test::PushProgramme quick{20e-3, 6e-3, 0.0, 1.0, 1};
  write("good.csv", csv_of(quick));
  write("deep.csv", csv_of({20e-3, 9e-3, 0.0, 1.0, 1}));
  write("shallow.csv", csv_of({20e-3, 3e-3, 0.0, 1.0, 1}));
  const std::string good = path("good.csv");
  const std::vector<std::pair<Words, std::string>> cases{
      {{"fit", good, good}, "one file; give --ball"},
      {{"fit", good, "--hold", "wall_mm=3"}, "expected them with --ball"},
      {{"fit", good, "--ball", "--hold", "wall_cm=3"}, "did you mean 'wall_mm'?"},
      {{"fit", good, "--ball", "--free", "walls"}, "--free: unknown number 'walls'"},
      {{"fit", good, "--ball", "--hold", "wall_mm=thick"}, "--hold: wall_mm is 'thick'"},
      {{"fit", good, "--ball", "--hold", "wall_mm=-1"}, "expected a positive number"},
      {{"fit", good, "--ball", "--out", path("a.toml")}, "without --ball"},
      {{"fit", good, "--ball", "--limit-mm", "9"}, "--limit-mm"},
      {{"fit", path("none.csv"), "--ball"}, "cannot read this loop"},
      {{"fit", path("shallow.csv"), "--ball"}, path("shallow.csv") + ":"},
      {{"fit", path("deep.csv"), "--ball"}, path("deep.csv") + ":1:1: at "}};
  for (const auto& [args, says] : cases) {
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 2) << args.back();
    EXPECT_EQ(r.out, "");
    EXPECT_THAT(r.err, HasSubstr(says));
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  }
}

}  // namespace
}  // namespace enc::tests
