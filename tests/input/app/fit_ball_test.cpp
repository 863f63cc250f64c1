// `fit --ball` as a person uses it: what it prints, and every mistake in one line.
#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/ball_pushes.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "trial/identify/ball/ball_loops.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
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

// docs/guide/identification.md. The felt begins softly, so contact is found 0.3 mm too late; that is no
// shift.
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
