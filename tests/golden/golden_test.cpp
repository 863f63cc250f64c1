// This version reproduces the committed files: resolved scenes, recorded presses, outcomes, responses, and
// the hare. An unintended change shows here.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "core/record/replay.h"
#include "core/shape/response/response.h"
#include "models/identify/response/loop_fit.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/response_file.h"
#include "models/setup/scene_file.h"
#include "models/shapes/shapes.h"
#include "sim/truth/truth.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "trial/measure/record_table.h"
#include "trial/trial.h"

namespace enc {
namespace {

namespace fs = std::filesystem;

// ---- Resolved scenes and the output of step() for a recorded press, kept as files: an unintended change
// shows here.

const std::string kResolved = tests::source_dir() + "/tests/golden/tennis_ball.resolved.toml";
const std::string kData = tests::source_dir() + "/tests/data/";
// Writes the new text to a file; the failure message says how to take it over.
std::string resolve_again(const std::string& text) {
  const std::string path = testing::TempDir() + "tennis_ball.resolved.toml";
  std::ofstream(path, std::ios::binary) << text;
  return "If the change is meant, take the new text, look at the difference, and commit it (from the root):\n"
         "  cp " +
         path + " tests/golden/tennis_ball.resolved.toml\n";
}

// A press that touches and lets go within 1.2 s. Its 500 Hz keep it within 620 kB.
struct Press {
  const char* record;
  const char* options;
  double depth, force;  // both exceed this, in m and N
};
void PrintTo(const Press& press, std::ostream* out) { *out << press.record; }

const Press kHexapod{
    "press.encrec",
    "models/scenes/tennis_ball.toml --set user.approach_mm_s=[50] --set user.approach_from_mm=6 "
    "--set user.approach_tilt_deg=0 --set user.press_s=0.25 --set user.hold_s=0.02 "
    "--set user.release_s=0.15 --set user.depth_mm=2",
    1e-3, 1.0};
const Press kArm{
    "arm_press.encrec",
    "models/scenes/wall.toml --set user.approach_mm_s=[200] --set user.approach_from_mm=40 "
    "--set user.press_s=0.4 --set user.hold_s=0.02 --set user.release_s=0.2 --set user.depth_mm=5",
    2e-3, 1.0};

std::string record_again(const Press& press) {
  return std::string(
             "If the change is meant (of the layout, or of what step() computes), record anew and commit it "
             "(from "
             "the root):\n  build/release/encounter run --for-s 1.2 --set rig.loop.rate_hz=500 --force "
             "--record "
             "tests/data/") +
         press.record + " " + press.options + "\n";
}

TEST(ResolvedGolden, TennisBall) {
  const std::string committed = test::bytes_of(kResolved);
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "sim");
  const std::string text = models::resolved(setup);
  EXPECT_TRUE(text == committed) << resolve_again(text);
  EXPECT_THAT(committed, testing::StartsWith("format = 1\n"));
}

// The committed text needs no other file and has the meaning of the files that it came from.
TEST(ResolvedGolden, TheCommittedTextStandsAlone) {
  const std::string committed = test::bytes_of(kResolved);
  const models::Setup setup = models::parse_resolved(committed, kResolved);
  EXPECT_EQ(models::resolved(setup), committed);
  ASSERT_EQ(setup.scene.objects.size(), 1U);
  EXPECT_EQ(setup.scene.objects[0].radius, 0.033);
  EXPECT_EQ(setup.rig.loop.rate, 1000.0);
}

class StepGolden : public ::testing::TestWithParam<Press> {
 protected:
  // Null, with an explanation, if the layout differs.
  std::unique_ptr<RecordReader> open() {
    try {
      return std::make_unique<RecordReader>(kData + GetParam().record);
    } catch (const Error& e) {
      ADD_FAILURE() << e.what() << "\n" << record_again(GetParam());
      return nullptr;
    }
  }
};

TEST_P(StepGolden, TheRecordedPressGivesTheSameBits) {
  const auto record = open();
  ASSERT_TRUE(record);
  const models::Setup setup = models::parse_resolved(record->texts().at("resolved"), GetParam().record);
  const ReplayResult result = replay(trial::prepare_setup(setup), *record);
  EXPECT_EQ(result.first_difference, -1) << result.what << "\n" << record_again(GetParam());
  EXPECT_EQ(result.ticks, 601);  // tick 0 and 1.2 s of 500 Hz
  RecordedTick frame;
  record->rewind();
  while (record->next(frame)) {
  }
  EXPECT_EQ(result.hash, frame.hash) << record_again(GetParam());
}

// The record is worth replaying: the tool approaches and presses, and the record is small.
TEST_P(StepGolden, TheRecordHoldsAPress) {
  const auto record = open();
  ASSERT_TRUE(record);
  EXPECT_LT(std::filesystem::file_size(kData + GetParam().record), 620'000U);
  std::map<Mode, int> ticks;
  double deepest = 0.0;
  double strongest = 0.0;
  RecordedTick frame;
  while (record->next(frame)) {
    ++ticks[frame.out.mode];
    deepest = std::max(deepest, frame.out.deflection);
    strongest = std::max(strongest, std::fabs(frame.out.force.xyz[2]));
  }
  EXPECT_GT(ticks[Mode::follow], 100);
  EXPECT_GT(ticks[Mode::contact], 100);
  EXPECT_EQ(ticks[Mode::hold], 0);
  EXPECT_EQ(frame.out.contacts, 1);
  EXPECT_GT(deepest, GetParam().depth);
  EXPECT_GT(strongest, GetParam().force);
}

INSTANTIATE_TEST_SUITE_P(Machines, StepGolden, testing::Values(kHexapod, kArm),
                         [](const auto& press) { return press.index == 0 ? "Hexapod" : "Arm"; });

// ---- Behaviour of every shipped scene, tick by tick: one hash over outputs and ground truth, and the state
// hash. No hash covers memory, whose layout may change. A change that must not alter behaviour leaves the
// table as it is.

const fs::path kScenes = tests::source_dir() + "/models/scenes";
const fs::path kTable = tests::source_dir() + "/tests/golden/outcomes.csv";
constexpr const char* kHeader = "scene,seed,length,ticks,state_hash,outcome_hash";
constexpr double kShort = 1.5;  // s

// length is "whole", or "short" for the first kShort seconds.
std::string row_of(const std::string& scene, std::uint64_t seed, const std::string& length) {
  StateHash outcome;
  trial::TrialOptions options;
  options.seed = seed;
  if (length == "short") options.seconds = kShort;
  options.watch = [&](const trial::Glance& glance) {
    Outputs out = glance.out;
    sim::Truth truth = glance.truth;
    fields(outcome, out);
    fields(outcome, truth);
  };
  trial::Trial trial(models::load((kScenes / (scene + ".toml")).string(), {}, {}), options);
  const trial::TrialResult result = trial.run();
  return fmt::format("{},{},{},{},{:016x},{:016x}", scene, seed, length, result.ticks, result.hash,
                     outcome.value);
}

std::vector<std::string> table() {
  std::vector<std::string> rows;
  std::ifstream file(kTable);
  for (std::string line; std::getline(file, line);) rows.push_back(line);
  return rows;
}

std::vector<std::string> words_of(const std::string& row) {
  std::vector<std::string> words{""};
  for (const char c : row) {
    if (c == ',')
      words.emplace_back();
    else
      words.back().push_back(c);
  }
  return words;
}

void expect_rows(const std::string& length) {
  for (const std::string& row : table()) {
    const std::vector<std::string> words = words_of(row);
    if (words.size() < 3 || words[2] != length) continue;
    EXPECT_EQ(row_of(words[0], std::stoull(words[1]), length), row)
        << "if the change is meant, look at what moved, write the table anew with\n  "
           "ENCOUNTER_WRITE_OUTCOMES=1 build/release/test_golden --gtest_filter=Outcome.TheTable*\n"
           "and say in the commit why";
  }
}

TEST(Outcome, TheTableHasEverySceneTwice) {
  std::set<std::string> scenes, expected;
  for (const auto& entry : fs::directory_iterator(kScenes))
    if (entry.path().extension() == ".toml") scenes.insert(entry.path().stem());
  for (const std::string& scene : scenes)
    for (const char* end : {",1,short", ",2,short", ",1,whole", ",2,whole"}) expected.insert(scene + end);
  if (std::getenv("ENCOUNTER_WRITE_OUTCOMES") != nullptr) {
    std::ofstream file(kTable);
    file << kHeader << "\n";
    for (const std::string& scene : scenes)
      for (const char* length : {"short", "whole"})
        for (const std::uint64_t seed : {1U, 2U}) file << row_of(scene, seed, length) << "\n";
    FAIL() << kTable << " was written anew: look at the difference";
  }
  const std::vector<std::string> rows = table();
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows.front(), kHeader);
  std::set<std::string> found;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::vector<std::string> words = words_of(rows[i]);
    ASSERT_EQ(words.size(), 6U) << rows[i];
    found.insert(words[0] + "," + words[1] + "," + words[2]);
  }
  EXPECT_EQ(found, expected);
}

// The hash must include each new member: a new one stops this from compiling until somebody has looked.
struct Count {
  int leaves = 0;
  template <class T>
  void operator()(std::string_view, const T&) {
    ++leaves;
  }
};
TEST(Outcome, EveryMemberOfTheTruthIsNamed) {
  const sim::Truth truth;
  const auto& [t, tool_tip, tool_velocity, tip, tip_velocity, tip_acceleration, contact_force, hand_force,
               leg_force, joints, motor_torque, warmth, touching, penetration, tool_radius, tip_radius, press,
               aim, phase, approach_speed, aborted, tool, work] = truth;
  EXPECT_EQ(&t, &truth.t);
  EXPECT_EQ(&tool, &truth.tool);
  EXPECT_EQ(&work, &truth.work);  // belongs to the energy balance alone, and follows from the rest
  Count count;
  sim::Truth copy = truth;
  fields(count, copy);
  EXPECT_EQ(count.leaves, 1 + 7 * 3 + 6 + 3 * 3 + 1 + 4 + 3 + 2);
}

TEST(OutcomeLong, TheFirstSecondsOfEveryScene) { expect_rows("short"); }

TEST(OutcomeLong, EverySceneToItsEnd) { expect_rows("whole"); }

// ---- `encounter fit` reproduces the committed responses from the loops that they name, byte for byte.

constexpr double kLimit = 6e-3;
const std::string kResponses = tests::source_dir() + "/models/responses/";

double floor_of_rig() {
  return models::fit_floor(loop_of(models::load_rig(tests::source_dir() + "/models/rigs/sim.toml")));
}

// Does the work of run, export and fit in one process.
void expect_fitted(const std::string& scene, const std::string& ball, const std::string& response) {
  const std::string committed = test::bytes_of(kResponses + response);
  ASSERT_FALSE(committed.empty());
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "sim",
                                           {"truth.ball.set=" + ball});
  const models::LoopData loop = models::parse_loop(trial::table_of_run(setup, 1), scene + ".csv", kLimit);
  const models::LoopFit fit = models::fit_loop(loop, {kLimit, floor_of_rig(), kUnset});
  EXPECT_EQ(models::response_text(fit.response, fit.source), committed)
      << "if that is as it should be:\n  build/release/encounter run models/scenes/" << scene
      << ".toml --set truth.ball.set=" << ball
      << " --force --record out/a.encrec && build/release/encounter export out/a.encrec --force --csv "
         "out/a.csv && "
      << "build/release/encounter fit out/a.csv --force --out models/responses/" << response;
}

TEST(ResponseGoldenLong, TennisBallIsReproduced) { expect_fitted("rig_A", "nominal", "tennis_ball.toml"); }
TEST(ResponseGoldenLong, TennisBallOffItsAxisIsReproduced) {
  expect_fitted("rig_B", "nominal", "tennis_ball_B.toml");
}
TEST(ResponseGoldenLong, TennisBallBesideTheVerticalIsReproduced) {
  expect_fitted("rig_C", "nominal", "tennis_ball_C.toml");
}
TEST(ResponseGoldenLong, RegulationBallIsReproduced) {
  expect_fitted("rig_A", "regulation", "regulation_ball.toml");
}

// The file's response after reading, for either model: 12 +- 1 N where the true deflection first comes within
// 0.05 mm of the limit (sources/hand 3). The fit's own floor accepts it although its coefficients are
// rounded.
TEST(ResponseGoldenLong, TennisBallFileIsAcceptedAndTwelveNewton) {
  const ResponseSpec spec = models::load_response(kResponses + "tennis_ball.toml");
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii}) {
    const Response ball(spec, floor_of_rig(), reversal);
    EXPECT_EQ(ball.limit(), kLimit);
    EXPECT_NEAR(ball.press(5.95e-3), 12.0, 1.0);
    EXPECT_GT(ball.largest_gap(), 1.0);  // a loop of about 19 % (sources/ball 4)
    EXPECT_LT(ball.largest_gap(), 2.5);
  }
}

// A regulation ball is four times as hard (sources/ball 3).
TEST(ResponseGoldenLong, RegulationBallFileIsAcceptedAndFiftyNewton) {
  const ResponseSpec spec = models::load_response(kResponses + "regulation_ball.toml");
  for (const Reversal reversal : {Reversal::energy_stop, Reversal::prandtl_ishlinskii})
    EXPECT_NEAR(Response(spec, floor_of_rig(), reversal).press(5.95e-3), 50.0, 6.0);
}

// ---- The generator reproduces the committed hare byte for byte, and it is a sound solid.

TEST(HareGoldenLong, IsReproducedAndSound) {
  const std::string path = tests::source_dir() + "/models/meshes/hare.glb";
  const std::string committed = test::bytes_of(path);
  ASSERT_FALSE(committed.empty());
  EXPECT_LT(committed.size(), 600'000U);
  EXPECT_TRUE(models::mesh_bytes(models::hare_mesh(), ".glb") == committed);
  const models::CheckedMesh solid = models::load_solid(path);
  EXPECT_TRUE(solid.notes.empty()) << solid.notes.front();
  EXPECT_EQ(solid.mesh.triangles.size(), 19824U);
  // Euler: a closed surface without handles.
  EXPECT_EQ(solid.mesh.vertices.size(), solid.mesh.triangles.size() / 2 + 2);
}

}  // namespace
}  // namespace enc
