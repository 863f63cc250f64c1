// Runs of the ball with poses from a tracker's own server, over TCP.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/devices/mode.h"
#include "tests/conformance/laboratory.h"
#include "tests/support/temporary_folder.h"

namespace enc::test {
namespace {

using testing::HasSubstr;
using tests::Result;
using tests::run_program;

// The first touch, with poses from a tracker's own server over TCP in each of the two forms that are asked
// for.
TEST(TrackerRun, InLockstepATrackersOwnServerGivesTheSameCommands) {
  const TemporaryFolder folder;
  const std::string none = folder.file("none.encrec");
  const std::vector<std::string> how{"--for-s", "9", "--json", "--record"};
  std::vector<std::string> pure{"run", kBall};
  pure.insert(pure.end(), how.begin(), how.end());
  pure.push_back(none);
  EXPECT_EQ(json_of(run_program(pure))["contacts"], 1);
  for (const std::string message : {"TRANSFORM", "TDATA"}) {
    const Laboratory there(true, {"rig.driver.igtl.transport=tcp", "rig.driver.igtl.message=" + message});
    std::vector<std::string> words = how;
    words.insert(words.end(), {folder.file(message), "--armed", "--lockstep"});
    EXPECT_EQ(json_of(run_program(there.words(words), {}, 400))["contacts"], 1) << message;
    expect_same_commands(folder.file(message), none);
  }
}

// The tracker's server hangs up in the middle of a run: it holds and says why, and the record has each of its
// ticks, to the last.
TEST(TrackerRun, ARecordOfARunWithAFaultIsWhole) {
  const Laboratory there(false, {"rig.driver.igtl.transport=tcp"}, {"igtl:disconnect@1500ms"});
  const TemporaryFolder folder;
  const std::string record = folder.file("fault.encrec");
  const Result run =
      run_program(there.words({"--armed", "--yes", "--for-s", "3", "--json", "--record", record}));
  EXPECT_EQ(run.code, 4) << run.err;
  const nlohmann::json report = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << run.out;
  EXPECT_THAT(run.out, HasSubstr("then it hung up"));
  RecordReader reader(record);
  EXPECT_TRUE(reader.sealed());
  EXPECT_EQ(reader.ticks(), report["ticks"].get<std::int64_t>());
  RecordedTick last;
  std::int64_t before = -1;
  while (reader.next(last)) {
    ASSERT_GT(last.tick.index, before);
    before = last.tick.index;
  }
  EXPECT_EQ(last.out.mode, Mode::hold);
  EXPECT_NE(last.out.why & kTrackerFault, 0U);
}

}  // namespace
}  // namespace enc::test
