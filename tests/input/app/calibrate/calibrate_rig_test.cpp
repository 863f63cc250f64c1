// `encounter calibrate rig` as a person uses it: what it says, the file that it
// writes and that the rig reads; and mistakes, one line each.
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/input/app/calibrate/calibrate_files.h"
#include "tests/support/built.h"
#include "tests/support/replaced.h"

namespace enc::tests {
namespace {

using test::replaced;
using testing::AllOf;
using testing::HasSubstr;

class CalibrateRig : public CalibrateFiles {
 protected:
  static std::string text_of(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(CalibrateRig, WritesWhatTheRigReads) {
  const std::string out = path("measured.toml");
  const Result r = run_program({"calibrate", "rig", "sim", "--poses", "12", "--out", out, "--set",
                                "truth.frames.W_C.position_mm=[3, -896, 600]", "--set",
                                "truth.tracker.bias_mm=[0, 0, 0]", "--set", "truth.hexapod.mass_kg=1.11"},
                               kShipped);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("12 poses in "), HasSubstr("force       mass_kg = 1.1"),
                           HasSubstr("the rig believes 0.91"), HasSubstr("tracker     position_mm = ["),
                           HasSubstr("mm from what the rig believes"), HasSubstr("tool        tip_mm = ["),
                           HasSubstr("intervals   99 % for each number")));
  const std::string file = text_of(out);
  EXPECT_THAT(file, AllOf(HasSubstr("# 12 poses in "), HasSubstr("\n[of]\nmanipulator = \"sim\"\n"),
                          HasSubstr("[frames.W_C]"), HasSubstr("[frames.H_F]"), HasSubstr("mass_kg = 1.1")));
  // It is not written over.
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--poses", "12", "--out", out}), HasSubstr("--force"));
  // The rig that names it believes it, and says so.
  write("rig.toml", replaced(text_of(tests::source_dir() + "/models/rigs/sim.toml"), "\n[loop]\n",
                             "\n[calibration]\nfile = \"measured.toml\"\n\n[loop]\n"));
  const std::string scene = tests::source_dir() + "/models/scenes/tracking.toml";
  const Result params = run_program({"params", scene, "--rig", path("rig.toml")}, kShipped);
  ASSERT_EQ(params.code, 0) << params.err;
  EXPECT_THAT(params.out, testing::ContainsRegex("rig.force.mass_kg,kg,1.1[^\n]*measured.toml"));
}

TEST_F(CalibrateRig, TellsTheSameInJson) {
  const Result r =
      run_program({"calibrate", "rig", "sim", "--poses", "12", "--json", "--seed", "3"}, kShipped);
  ASSERT_EQ(r.code, 0) << r.err;
  const auto told = nlohmann::json::parse(r.out);
  EXPECT_EQ(told["poses"], 12);
  EXPECT_NEAR(told["force"]["mass_kg"].get<double>(), 0.91, 3 * told["force"]["mass_half_kg"].get<double>());
  // The twin's tracker has a constant error, which goes into its position.
  EXPECT_NEAR(told["tracker"]["position_mm"][1].get<double>(), -900.0, 1.0);
  EXPECT_LT(told["tracker"]["origin_half_mm"][2].get<double>(), 0.05);
  EXPECT_NEAR(told["tracker"]["tip_mm"][2].get<double>(), -120.0, 0.2);
  EXPECT_EQ(run_program({"calibrate", "rig", "sim", "--poses", "12", "--json", "--seed", "3"}, kShipped).out,
            r.out)
      << "the same seed tells the same";
}

TEST_F(CalibrateRig, RefusesInALineWhatCannotBe) {
  EXPECT_THAT(line({"calibrate", "rig", "fakes"}), AllOf(HasSubstr("fakes.toml:"), HasSubstr("--armed")));
  // Nothing is connected to, and nothing would feel what is in the way.
  EXPECT_THAT(line({"calibrate", "rig", "fakes", "--armed", "--set", "rig.force.driver=sim"}),
              AllOf(HasSubstr("--set rig.force.driver=sim: "), HasSubstr("needs a force sensor"),
                    HasSubstr("here it is 'sim'")));
  const std::string tracked = tests::source_dir() + "/models/scenes/tracking.toml";
  EXPECT_THAT(
      line({"calibrate", "rig", "fakes", "--armed", "--scene", tracked, "--set", "rig.force.driver=none"}),
      HasSubstr("here it is 'none'"));
  write("bare.toml", replaced(text_of(tests::source_dir() + "/models/scenes/clamped_tool.toml"),
                              "[force]\n[tracker]\n", ""));
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--scene", path("bare.toml"), "--set", "rig.force.driver=none",
                    "--set", "rig.tracker.driver=none"}),
              HasSubstr("neither a force sensor nor a tracker"));
  for (const char* option :
       {"--pairs=8", "--frames=2", "--through-images", "--rate-Hz=100", "--square-mm=25"})
    EXPECT_THAT(line({"calibrate", "rig", "sim", option}), HasSubstr("not expected: " + std::string(option)));
  EXPECT_THAT(line({"calibrate", "rig", "vishap"}),
              AllOf(HasSubstr("vishap: has an arm; expected a rig with a hexapod"),
                    HasSubstr("run: encounter calibrate camera vishap\n")));
  EXPECT_THAT(line({"calibrate", "rig", write("log.csv", "time_s\n")}),
              HasSubstr("log.csv: is no rig; expected a name in models/rigs or a TOML file"));
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--scene", tests::source_dir() + "/models/scenes/plane.toml"}),
              HasSubstr("no tool is clamped"));
  EXPECT_NE(run_program({"calibrate", "rig", "sim", "--poses", "3"}, kShipped).code, 0);
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--poses", "12", "--set", "truth.tracker.loss=1"}),
              HasSubstr("the tool was seen in 0 stands"));
}

}  // namespace
}  // namespace enc::tests
