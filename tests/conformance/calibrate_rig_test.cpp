// `encounter calibrate rig` over the wires of the laboratory: the machine that is sent from pose to pose is
// behind its own, and so are force sensor and tracker.
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/conformance/laboratory.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::test {
namespace {

using testing::HasSubstr;
using tests::Result;
using tests::run_program;

const std::string kClamped = tests::source_dir() + "/models/scenes/clamped_tool.toml";
const std::vector<std::string> kWrong{
    "truth.frames.W_C.position_mm=[3, -896, 600]", "truth.frames.W_C.rotation_deg=[1, -1, 1.4]",
    "truth.force.turned_deg=[1, 1, -1.4]", "truth.hexapod.mass_kg=1.11", "truth.tracker.bias_mm=[0, 0, 0]"};

std::vector<std::string> calibrating(const Laboratory& there, const std::vector<std::string>& more) {
  std::vector<std::string> all{"calibrate", "rig", "fakes", "--armed", "--lockstep"};
  for (const std::string& set : there.ports) all.insert(all.end(), {"--set", set});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(CalibrateRig, FindsBehindItsWiresWhatTheRigDoesNotKnow) {
  const Laboratory there(true, kWrong, {}, kClamped);
  const TemporaryFolder folder;
  const std::string file = folder.file("measured.toml");
  const Result r = run_program(
      calibrating(there, {"--poses", "12", "--json", "--scene", kClamped, "--out", file}), {}, 400);
  ASSERT_EQ(r.code, 0) << r.err;
  const auto told = nlohmann::json::parse(r.out);
  const auto force = told["force"], tracker = told["tracker"];
  EXPECT_NEAR(force["mass_kg"].get<double>(), 1.11, 3 * force["mass_half_kg"].get<double>());
  EXPECT_LT(force["mass_half_kg"].get<double>(), 0.05);
  const std::vector<double> place{3, -896, 600};
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(tracker["position_mm"][a].get<double>(), place[a],
                3 * tracker["position_half_mm"][a].get<double>());
  EXPECT_LT(tracker["origin_half_mm"][0].get<double>(), 0.05);
  EXPECT_EQ(told["unseen"], 0);
  EXPECT_TRUE(std::filesystem::exists(file));
}

// A force sensor that falls silent: it ends at once, and no file is made.
TEST(CalibrateRig, WhatFailsOnTheWayEndsItAndLeavesNoFile) {
  const Laboratory there(true, {}, {"netft:stall@4s"}, kClamped);
  const TemporaryFolder folder;
  const std::string file = folder.file("measured.toml");
  const Result r =
      run_program(calibrating(there, {"--poses", "12", "--scene", kClamped, "--out", file}), {}, 400);
  EXPECT_EQ(r.code, 3) << r.out << r.err;
  EXPECT_THAT(r.err, HasSubstr("the machine is in hold"));
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

}  // namespace
}  // namespace enc::test
