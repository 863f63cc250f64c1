// What export writes as MCAP against the reader of those who made the format (mcap of PyPI), in a program of
// its own: that readers we have not written find all of it.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/record/record.h"
#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kMcap = tests::source_dir() + "/.deps/mcap";
const std::string kMcapScript = tests::source_dir() + "/tests/conformance/foreign/mcap_reader.py";
const std::string kPress = tests::source_dir() + "/tests/data/press.encrec";
const std::string kArmPress = tests::source_dir() + "/tests/data/arm_press.encrec";

class McapForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kMcap)) GTEST_SKIP() << "no " << kMcap << ": ./check fetches it";
  }
  [[nodiscard]] std::string file() const { return folder_.file("r.mcap"); }
  void written(const std::string& record) const {
    const tests::Result r = tests::run_program({"export", record, "--mcap", file()});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out + r.err, "");
  }
  [[nodiscard]] tests::Result judged() const {
    return tests::run({"/usr/bin/python3", "-B", kMcapScript, kMcap, file()});
  }
  TemporaryFolder folder_;
};

std::string of_each_tick(const std::string& topic, std::int64_t ticks, const std::string& schema) {
  return topic + " " + std::to_string(ticks) + " " + schema + "\n";
}

// A machine that carries a tip: all of its ticks are there, and a viewer finds names of schemas that it
// knows.
TEST_F(McapForeign, ItsReaderFindsEachTickOfAPress) {
  RecordReader record(kPress);
  const std::int64_t ticks = record.ticks();
  written(kPress);
  const tests::Result said = judged();
  ASSERT_EQ(said.code, 0) << said.out << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr("/frames 1 foxglove.FrameTransforms\n"),
                              HasSubstr(of_each_tick("/tip", ticks, "foxglove.PoseInFrame")),
                              HasSubstr(of_each_tick("/command", ticks, "foxglove.PoseInFrame")),
                              HasSubstr(of_each_tick("/wrench", ticks, "encounter.Wrench")),
                              HasSubstr(of_each_tick("/core", ticks, "encounter.Core")),
                              Not(HasSubstr("/arm ")), Not(HasSubstr("/gripper "))));
  EXPECT_THAT(said.out, AllOf(HasSubstr("\nticks = " + std::to_string(ticks) + "\n"),
                              HasSubstr("\nmissed_cycles = 0\n"), HasSubstr("\nstate = whole\n"),
                              HasSubstr("\nversion = " + record.texts().at("version") + "\n"),
                              HasSubstr("attached resolved.toml " +
                                        std::to_string(record.texts().at("resolved").size()) + "\n")));
}

// An arm pushes and carries no pose: other channels, the joints by their own names.
TEST_F(McapForeign, ItsReaderFindsEachTickOfAnArm) {
  const std::int64_t ticks = RecordReader(kArmPress).ticks();
  written(kArmPress);
  const tests::Result said = judged();
  ASSERT_EQ(said.code, 0) << said.out << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr(of_each_tick("/arm", ticks, "encounter.Arm")),
                              HasSubstr(of_each_tick("/core", ticks, "encounter.Core")),
                              Not(HasSubstr("/tip ")), Not(HasSubstr("/wrench "))));
  EXPECT_THAT(bytes_of(file()), HasSubstr("\"joint_1_rad\":"));
}

// A run long enough for several chunks, with packets of a tracker and a gripper.
TEST_F(McapForeign, ItsReaderFindsTheChunksOfALongRun) {
  const std::string record = folder_.file("long.encrec");
  const tests::Result ran =
      tests::run_program({"run", tests::shipped_scene("tracking"), "--for-s", "5", "--record", record});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::int64_t ticks = RecordReader(record).ticks();
  written(record);
  EXPECT_GT(std::filesystem::file_size(file()), 3U << 20U);
  const tests::Result said = judged();
  ASSERT_EQ(said.code, 0) << said.out << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr(of_each_tick("/core", ticks, "encounter.Core")),
                              HasSubstr(of_each_tick("/gripper", ticks, "encounter.Gripper")),
                              HasSubstr("/tool 498 foxglove.PoseInFrame\n")))
      << "its tracker has 100 Hz and its first packet comes late";
}

// The judge must be able to say no: a byte of a message that is another.
TEST_F(McapForeign, ItsReaderRefusesAChangedByte) {
  written(kPress);
  std::string bytes = bytes_of(file());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(file(), std::ios::binary) << bytes;
  const tests::Result said = judged();
  EXPECT_NE(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("crc validation failed"));
}

}  // namespace
}  // namespace enc::test
