// Our fakes, drivers and files against programs by other authors, each in a program of its own.
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/record/record.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/netft/fake/server.h"
#include "hw_drivers/netft/wire/messages.h"
#include "tests/conformance/gcs_bench.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// ---- The fake C-887 and the driver against PI's own client and server of GCS (PIPython), each in a program
// of its own.

const std::string kPipython = tests::source_dir() + "/.deps/pipython";
const std::string kScripts = tests::source_dir() + "/tests/conformance/foreign/";

class GcsForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPipython)) GTEST_SKIP() << "no " << kPipython << ": ./check fetches it";
  }
  static std::vector<std::string> script(const std::string& name) {
    return {"/usr/bin/python3", "-B", kScripts + name, kPipython};
  }
};

// Connects, references, moves, waits on target, meets limits, stops in three ways, sends two commands in one
// segment and one byte at a time.
TEST_F(GcsForeign, PipythonDrivesTheFake) {
  const GcsPort there({.referenced = false});
  std::vector<std::string> words = script("pipython_client.py");
  words.push_back(std::to_string(there.server.port()));
  const tests::Result result = tests::run(words);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
}

TEST_F(GcsForeign, TheDriverSpeaksToPipythonsServer) {
  tests::PipedChild child(script("pipython_replies.py"));
  std::array<char, 64> line{};
  const std::string port(line.data(), child.read(line, 20'000));
  ASSERT_NE(port, "");
  GcsPort other;
  other.table.port = std::stoi(port);
  {
    const auto driver = gcs::connected(other.offer());
    EXPECT_THAT(driver->describe(), testing::EndsWith(", firmware 2.3.0.1, referenced"));
    const auto there = Pose<'R', 'H'>::shift(0.0015, 0, driver->reach().machine.zero().p().z());
    for (int i = 0; i < 500; ++i) {
      tell(*driver, there);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const auto sample = driver->read(Time{});
    EXPECT_EQ(sample.health, Health::ok);
    EXPECT_LT((sample.value.X_RH.p() - there.p()).norm(), 1e-12);
  }
  EXPECT_EQ(child.end(), 0);
}

// ---- The fake Net F/T against a foreign client (pynetft), in a program of its own.

const std::string kPynetft = tests::source_dir() + "/.deps/pynetft";
const std::string kPynetftScript = tests::source_dir() + "/tests/conformance/foreign/pynetft_client.py";

// As in pynetft_client.py. All axes differ, so that their order, their signs and their bytes count.
struct PressedTwoWays final : ForceSensor {
  Measurement<Wrench> read(Time now) noexcept override {
    const Wrench one{Vec<'F'>(1.234567, -23.456789, -123.456789), Vec<'F'>(0.345678, -4.567891, 9.876543)};
    const Wrench other{Vec<'F'>(-7.654321, 31.415926, -60.5), Vec<'F'>(-1.25, 2.718281, -8.000001)};
    return {second ? other : one, now, health};
  }
  std::atomic<bool> second = false;
  std::atomic<Health> health = Health::ok;
};

// A newton metre has more counts than a newton, so that the test detects a mix-up.
netft::Configuration gamma_of_two_scales() {
  netft::Configuration of = netft::gamma();
  of.per_newton_metre = 2e6;
  return of;
}

// A box with its own clock of a millisecond per record: its numbers do not depend on this machine's load.
class PacedBox {
 public:
  ~PacedBox() { end(); }
  PacedBox() = default;
  PacedBox(const PacedBox&) = delete;
  PacedBox& operator=(const PacedBox&) = delete;
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void turn() {
    server.box().fail(status);
    server.serve(now_);
    now_ += Duration(1'000'000);
    server.publish(now_);
  }

  PressedTwoWays sensor;
  std::atomic<std::uint32_t> status = 0;
  netft::Server server{sensor, gamma_of_two_scales(), "127.0.0.1", netft::Ports{}};

 private:
  Time now_{};
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] {
    while (!end_) {
      turn();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }};
};

// Reads its scales over HTTP, one record, a stream with its numbers, a bias, and a second bias, which stays
// for the next client. Then a warning, which does not end the stream, and a saturated sensor, which does.
TEST(NetftForeign, PynetftDrivesTheFake) {
  if (!std::filesystem::exists(kPynetft)) GTEST_SKIP() << "no " << kPynetft << ": ./check fetches it";
  PacedBox there;
  tests::PipedChild child({"/usr/bin/python3", "-B", kPynetftScript, kPynetft,
                           std::to_string(there.server.port()), std::to_string(there.server.http_port())});
  const auto said = [&] {  // reads a line, in any pieces
    std::string line;
    std::array<char, 64> bytes{};
    while (!line.ends_with('\n')) {
      const std::size_t got = child.read(bytes, 30'000);
      if (got == 0) break;
      line.append(bytes.data(), got);
    }
    return line;
  };
  ASSERT_EQ(said(), "biased\n");
  there.sensor.second = true;
  ASSERT_EQ(said(), "biased again\n");
  there.sensor.second = false;
  ASSERT_EQ(said(), "started again\n");
  there.status = netft::kError | netft::kMonitor;
  ASSERT_EQ(said(), "warned\n");
  there.sensor.health = Health::saturated;
  EXPECT_EQ(child.end(), 0);
  there.end();
  there.turn();  // handles the last message
  EXPECT_FALSE(there.server.box().streams()) << "its stop is not heard";
}

// ---- The MCAP files of export against the reader of the format's authors (mcap of PyPI), in a program of
// its own: a foreign reader finds the whole content.

const std::string kMcap = tests::source_dir() + "/.deps/mcap";
const std::string kMcapScript = tests::source_dir() + "/tests/conformance/foreign/mcap_reader.py";
const std::string kRos2 = tests::source_dir() + "/.deps/mcap_ros2";
const std::string kRos2Script = tests::source_dir() + "/tests/conformance/foreign/mcap_ros2_reader.py";
const std::string kRosbags = tests::source_dir() + "/.deps/rosbags";
const std::string kRosbagsScript = tests::source_dir() + "/tests/conformance/foreign/rosbags_reader.py";
const std::string kPress = tests::source_dir() + "/tests/data/press.encrec";
const std::string kArmPress = tests::source_dir() + "/tests/data/arm_press.encrec";

class McapForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kMcap)) GTEST_SKIP() << "no " << kMcap << ": ./check fetches it";
  }
  [[nodiscard]] std::string file() const { return folder_.file("r.mcap"); }
  void written(const std::string& record, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"export", record, "--mcap", file()};
    words.insert(words.end(), more.begin(), more.end());
    const tests::Result r = tests::run_program(words);
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

// A machine that carries a tip: the file has all of its ticks, and a viewer finds names of schemas that it
// supports.
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

// An arm pushes and carries no pose: other channels, the joints with their own names.
TEST_F(McapForeign, ItsReaderFindsEachTickOfAnArm) {
  const std::int64_t ticks = RecordReader(kArmPress).ticks();
  written(kArmPress, {"--uncompressed"});
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
  written(record, {"--uncompressed"});
  const std::uintmax_t plain = std::filesystem::file_size(file());
  EXPECT_GT(plain, 3U << 20U);
  written(record, {"--force"});
  EXPECT_LT(4 * std::filesystem::file_size(file()), plain);
  const tests::Result said = judged();
  ASSERT_EQ(said.code, 0) << said.out << said.err;
  EXPECT_THAT(said.out, AllOf(HasSubstr(of_each_tick("/core", ticks, "encounter.Core")),
                              HasSubstr(of_each_tick("/gripper", ticks, "encounter.Gripper")),
                              HasSubstr("/tool 498 foxglove.PoseInFrame\n")))
      << "its tracker has 100 Hz and its first packet comes late";
}

// The judge must be able to fail: one byte of a message differs.
TEST_F(McapForeign, ItsReaderRefusesAChangedByte) {
  written(kPress, {"--uncompressed"});
  std::string bytes = bytes_of(file());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(file(), std::ios::binary) << bytes;
  const tests::Result said = judged();
  EXPECT_NE(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("crc validation failed"));
}

// The reader of ROS 2 messages finds in them what the JSON messages say, on both machines and with a gripper.
TEST_F(McapForeign, Ros2MessagesSayWhatJsonSays) {
  if (!std::filesystem::exists(kRos2)) GTEST_SKIP() << "no " << kRos2 << ": ./check fetches it";
  const std::string carried = folder_.file("carried.encrec"), ros2 = folder_.file("ros2.mcap");
  ASSERT_EQ(
      tests::run_program({"run", tests::shipped_scene("tracking"), "--for-s", "1", "--record", carried}).code,
      0);
  const auto compared = [&](const std::string& record) {
    written(record, {"--force"});
    EXPECT_EQ(tests::run_program({"export", record, "--mcap", ros2, "--ros2", "--force"}).code, 0);
    const tests::Result said =
        tests::run({"/usr/bin/python3", "-B", kRos2Script, kMcap, kRos2, file(), ros2});
    EXPECT_EQ(said.code, 0) << said.out << said.err;
    return said.out;
  };
  EXPECT_THAT(compared(kPress), AllOf(HasSubstr("/tf_static 1 tf2_msgs/msg/TFMessage\n"),
                                      HasSubstr(of_each_tick("/wrench", RecordReader(kPress).ticks(),
                                                             "geometry_msgs/msg/WrenchStamped")),
                                      HasSubstr(" geometry_msgs/msg/PoseStamped\n"), HasSubstr("/surface ")));
  EXPECT_THAT(compared(kArmPress),
              HasSubstr(of_each_tick("/arm", RecordReader(kArmPress).ticks(), "encounter_msgs/msg/Arm")));
  EXPECT_THAT(compared(carried), HasSubstr(" encounter_msgs/msg/Gripper\n"));
}

// ---- A run that is served live, against a viewer over websockets of PyPI.

const std::string kWebsockets = tests::source_dir() + "/.deps/websockets";

class LiveForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kWebsockets)) GTEST_SKIP() << "no " << kWebsockets << ": ./check fetches it";
  }
  // The viewer starts `run SCENE --live 0` with these words more.
  static tests::Result watched(const std::string& way, const std::string& scene,
                               const std::vector<std::string>& more) {
    std::vector<std::string> words{"/usr/bin/python3",
                                   "-B",
                                   kScripts + "live_viewer.py",
                                   kWebsockets,
                                   way,
                                   tests::program_file(),
                                   "run",
                                   scene,
                                   "--live",
                                   "0"};
    words.insert(words.end(), more.begin(), more.end());
    return tests::run(words);
  }
};

TEST_F(LiveForeign, AViewerGetsEachTickFromItsFirstOn) {
  for (const char* scene : {"tennis_ball", "wall"}) {
    const tests::Result said = watched("all", scene, {"--for-s", "4"});
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_THAT(said.out,
                AllOf(HasSubstr("\n/core "), HasSubstr(" 4000000000\nGAPS 0\n"), HasSubstr("ended 0 \n")))
        << scene;
    EXPECT_THAT(said.out, HasSubstr(scene == std::string("wall") ? "\n/arm " : "/frames 1 0 0\n"));
  }
}

TEST_F(LiveForeign, AViewerThatReadsNothingDelaysNothing) {
  // In 6 s no message is left out, but the last of them are never taken.
  for (const char* seconds : {"60", "6"}) {
    const tests::Result said = watched("stall", "tennis_ball", {"--for-s", seconds, "--pace", "20"});
    EXPECT_THAT(said.out, HasSubstr("a viewer was too slow for ")) << seconds;
    EXPECT_THAT(said.out, HasSubstr("ended 0 ")) << seconds;
  }
}

TEST_F(LiveForeign, ARequestThatIsNoneIsAnswered) {
  const tests::Result said = watched("mistakes", "tennis_ball", {"--for-s", "2"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out,
              AllOf(HasSubstr("HTTP/1.1 404 "), HasSubstr("expected a whole number of 32 bits, not -1\n"),
                    HasSubstr("of 32 bits, not 4294967296\n"), HasSubstr("of 32 bits, not 1.5\n"),
                    HasSubstr("'advertise' is not supported\n"), HasSubstr("there is no channel 99\n"),
                    HasSubstr("GAPS 0\n"), HasSubstr("ended 0 \n")));
}

// A second reader of ROS 2 bags, which takes its types from the file alone.
TEST_F(McapForeign, RosbagsReadsEachMessage) {
  if (!std::filesystem::exists(kRosbags)) GTEST_SKIP() << "no " << kRosbags << ": ./check fetches it";
  const auto read = [&](const std::string& record, const std::vector<std::string>& more) {
    written(record, more);
    return tests::run({"/usr/bin/python3", "-B", kRosbagsScript, kRosbags, file()});
  };
  for (const char* form : {"--force", "--uncompressed"}) {
    const tests::Result press = read(kPress, {"--ros2", "--force", form});
    EXPECT_EQ(press.code, 0) << press.err;
    const std::int64_t ticks = RecordReader(kPress).ticks();
    EXPECT_THAT(press.out, AllOf(HasSubstr("/tf_static 1 tf2_msgs/msg/TFMessage\n"),
                                 HasSubstr(of_each_tick("/wrench", ticks, "geometry_msgs/msg/WrenchStamped")),
                                 HasSubstr(of_each_tick("/core", ticks, "encounter_msgs/msg/Core"))));
    const tests::Result arm = read(kArmPress, {"--ros2", "--force", form});
    EXPECT_EQ(arm.code, 0) << arm.err;
    EXPECT_THAT(arm.out,
                HasSubstr(of_each_tick("/arm", RecordReader(kArmPress).ticks(), "encounter_msgs/msg/Arm")));
  }
  EXPECT_NE(read(kPress, {"--force"}).code, 0) << "JSON is no message of ROS 2";
}

}  // namespace
}  // namespace enc::test
