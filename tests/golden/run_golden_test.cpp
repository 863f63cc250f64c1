// What a scene resolves to, and what step() makes of a recorded press, kept as files: a change that nobody
// meant shows here.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/replay.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc {
namespace {

const std::string kResolved = tests::source_dir() + "/tests/golden/tennis_ball.resolved.toml";
const std::string kData = tests::source_dir() + "/tests/data/";
// Written where it can be taken from: the words of a failure say how.
std::string resolve_again(const std::string& text) {
  const std::string path = testing::TempDir() + "tennis_ball.resolved.toml";
  std::ofstream(path, std::ios::binary) << text;
  return "If the change is meant, take the new text, look at the difference, and commit it (from the root):\n"
         "  cp " +
         path + " tests/golden/tennis_ball.resolved.toml\n";
}

// A press that touches and lets go within 1.2 s. At 500 Hz, so that it fits into 620 kB.
struct Press {
  const char* record;
  const char* options;
  double depth, force;  // both are more than this, in m and N
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
  std::ifstream file(kResolved, std::ios::binary);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "sim");
  const std::string text = models::resolved(setup);
  EXPECT_TRUE(text == committed) << resolve_again(text);
  EXPECT_THAT(committed, testing::StartsWith("format = 1\n"));
}

// The committed text needs no other file and means the same as those it was made from.
TEST(ResolvedGolden, TheCommittedTextStandsAlone) {
  std::ifstream file(kResolved, std::ios::binary);
  const std::string committed((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const models::Setup setup = models::parse_resolved(committed, kResolved);
  EXPECT_EQ(models::resolved(setup), committed);
  ASSERT_EQ(setup.scene.objects.size(), 1U);
  EXPECT_EQ(setup.scene.objects[0].radius, 0.033);
  EXPECT_EQ(setup.rig.loop.rate, 1000.0);
}

class StepGolden : public ::testing::TestWithParam<Press> {
 protected:
  // Null where the layout is another one, with the words for it.
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

// It is worth replaying: the tool comes and presses, and the record is small.
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

}  // namespace
}  // namespace enc
