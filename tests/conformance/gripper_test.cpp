// The driver of a gripper on a Modbus TCP coupler, and the fake coupler, over loopback; each against
// pymodbus, too.
#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/gripper/drive/jaws.h"
#include "hw_drivers/gripper/fake/coupler_image.h"
#include "tests/conformance/gripper_bench.h"
#include "tests/conformance/laboratory.h"
#include "tests/support/built.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using testing::HasSubstr;

constexpr Grip kClose{true, 100.0}, kOpen{};

bool is_closed(const Measurement<GripSample>& sample) { return sample.value.phase == GripPhase::closed; }
bool is_open(const Measurement<GripSample>& sample) { return sample.value.phase == GripPhase::open; }
bool is_bad(const Measurement<GripSample>& sample) { return sample.health == Health::fault; }
bool is_good(const Measurement<GripSample>& sample) { return sample.health == Health::ok; }

TEST(GripperDriver, ClosesHoldsOpensAndSaysSo) {
  GripperPort there;
  const FakeServer served(there.server);
  const auto driver = there.driver();
  EXPECT_TRUE(driver->is_fake());
  EXPECT_THAT(driver->describe(), HasSubstr("8 digital outputs, 8 inputs, watchdog 1000 ms, answered"));
  const GripLoop loop;
  auto sample = driver->read(loop.now());
  EXPECT_EQ(sample.health, Health::ok) << "the first reading waits for the inputs";
  EXPECT_EQ(sample.value.phase, GripPhase::open);
  EXPECT_LE(sample.t, loop.now());
  sample = loop.until(*driver, &kClose, [](const auto& s) { return s.value.phase == GripPhase::closing; });
  EXPECT_EQ(sample.value.phase, GripPhase::closing);
  EXPECT_FALSE(sample.value.holding);
  sample = loop.until(*driver, &kClose, is_closed);
  EXPECT_TRUE(sample.value.holding);
  EXPECT_EQ(sample.value.force, 100.0);
  EXPECT_EQ(sample.value.opening, 0.006);
  EXPECT_EQ(sample.health, Health::ok);
  sample = loop.until(*driver, &kOpen, is_open);
  EXPECT_FALSE(sample.value.holding);
  EXPECT_EQ(sample.value.opening, 0.016);
  EXPECT_TRUE(driver->linked());
}

// Both outputs are off for 20 ms between the directions, so a gripper never gets both.
TEST(GripperDriver, RestsBetweenTwoDirections) {
  GripperPort there;
  const FakeServer served(there.server);
  const auto driver = there.driver();
  const GripLoop loop;
  static_cast<void>(loop.until(*driver, &kClose, is_closed));
  static_cast<void>(loop.until(*driver, &kOpen, is_open));
  const std::string words = there.jaws.words();
  EXPECT_EQ(words, "cso");
  const auto& told = there.jaws.told;
  EXPECT_GE(told[2].at - told[1].at, Duration(19'000'000));
}

// Between the driver and the fake: the request that switches an output off arrives 60 ms later.
class SlowLine {
 public:
  explicit SlowLine(std::uint16_t to) : fake_(net::connect_tcp("127.0.0.1", to, Duration(1'000'000'000))) {}
  ~SlowLine() {
    end_ = true;
    thread_.join();
  }
  SlowLine(const SlowLine&) = delete;
  SlowLine& operator=(const SlowLine&) = delete;
  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }

 private:
  static bool switches_off(std::span<const std::byte> request) {
    const gripper::Request one = gripper::request_of(request);
    return one.function == static_cast<std::uint8_t>(gripper::Function::write_coil) && one.values[0] == 0;
  }
  void pass() {
    std::array<std::byte, 512> bytes{};
    while (!end_) {
      if (!client_.is_open()) client_ = listener_.accept();
      if (client_.is_open()) {
        const auto request = std::span(bytes).first(client_.receive(bytes));
        if (!request.empty() && switches_off(request))
          std::this_thread::sleep_for(std::chrono::milliseconds(60));
        if (!request.empty()) fake_.send(request);
        const auto answer = std::span(bytes).first(fake_.receive(bytes));
        if (!answer.empty()) client_.send(answer);
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  net::Socket fake_, client_, listener_ = net::listen_tcp("127.0.0.1", 0);
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] { pass(); }};
};

TEST(GripperDriver, RestsBetweenTwoDirectionsOfASlowCoupler) {
  GripperPort there;
  const FakeServer served(there.server);
  const SlowLine slow(there.server.port());
  there.table.port = slow.port();
  const auto driver = there.driver();
  const GripLoop loop;
  static_cast<void>(loop.until(*driver, &kClose, is_closed));
  static_cast<void>(loop.until(*driver, &kOpen, is_open));
  ASSERT_EQ(there.jaws.words(), "cso");
  EXPECT_GE(there.jaws.told[2].at - there.jaws.told[1].at, Duration(19'000'000))
      << "from the output's going off";
}

TEST(GripperDriver, WritesNothingBeforeTheFirstCommand) {
  GripperPort there;
  there.table.watchdog = 0.3;
  const FakeServer served(there.server);
  auto driver = there.driver();
  const GripLoop loop;
  for (int i = 0; i < 100; ++i) {
    static_cast<void>(driver->read(loop.now()));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  driver->stop();
  EXPECT_EQ(there.jaws.words(), "");
  EXPECT_EQ(there.server.image().switched(), 0);
  driver.reset();
  EXPECT_THAT(there.driver()->describe(), HasSubstr("watchdog 1000 ms")) << "its time is not set, either";
}

TEST(GripperDriver, AnotherForceThanThatOfTheSwitchIsSaid) {
  GripperPort there;
  const FakeServer served(there.server);
  const auto driver = there.driver();
  const GripLoop loop;
  const Grip strong{true, 150.0}, none{true, kUnset};
  EXPECT_TRUE(loop.until(*driver, &strong, is_closed).value.holding);
  const auto sample = driver->read(loop.now());
  EXPECT_EQ(sample.health, Health::out_of_range);
  EXPECT_EQ(sample.value.force, 100.0);
  driver->command(none);
  EXPECT_EQ(driver->read(loop.now()).health, Health::fault);
  EXPECT_TRUE(driver->read(loop.now()).value.holding);
  driver->command(kClose);
  EXPECT_EQ(driver->read(loop.now()).health, Health::ok);
}

// A finger may be between the jaws; a grip holds a tool.
TEST(GripperDriver, AStopEndsAMotionAndKeepsAGrip) {
  GripperPort there;
  const FakeServer served(there.server);
  const auto driver = there.driver();
  const GripLoop loop;
  there.jaws.jammed = true;
  static_cast<void>(loop.until(*driver, &kClose, [&](const auto&) { return there.jaws.words() == "c"; }));
  driver->stop();
  EXPECT_EQ(there.jaws.words(), "cs");
  there.jaws.jammed = false;
  EXPECT_TRUE(loop.until(*driver, &kClose, [](const auto& s) { return s.value.holding; }).value.holding);
  const std::string before = there.jaws.words();
  driver->stop();
  driver->stop();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(there.jaws.words(), before);
  EXPECT_TRUE(driver->read(loop.now()).value.holding);
}

TEST(GripperDriver, JawsThatCloseOnNothingOrDoNotMoveAreSaid) {
  GripperPort there;
  const FakeServer served(there.server);
  const auto driver = there.driver();
  const GripLoop loop;
  there.jaws.tool = false;
  auto sample = loop.until(*driver, &kClose, is_closed);
  EXPECT_EQ(sample.value.phase, GripPhase::closed);
  EXPECT_FALSE(sample.value.holding);
  EXPECT_EQ(sample.health, Health::ok);
  static_cast<void>(loop.until(*driver, &kOpen, is_open));
  there.jaws.jammed = true;
  sample = loop.until(*driver, &kClose, is_bad);
  EXPECT_EQ(sample.health, Health::fault);
  EXPECT_THAT(there.log.lines().back(), HasSubstr("its sensors do not fit to the command"));
}

// ---- faults

struct GripperFaults : testing::Test {
  // Closes the jaws, then has the fault; the sample that says so.
  Measurement<GripSample> after(const Trouble& trouble) {
    static_cast<void>(loop.until(*driver, &kClose, [](const auto& s) { return s.value.holding; }));
    EXPECT_TRUE(there.server.knows(trouble));
    served.end();
    there.server.suffer(trouble);
    again = std::make_unique<FakeServer>(there.server);
    return loop.until(*driver, &kClose, is_bad);
  }
  void heal(Trouble::Kind kind) {
    again->end();
    there.server.heal(kind);
    again = std::make_unique<FakeServer>(there.server);
  }
  // The driver's words and the fake's, which come in either order.
  std::string said() { return fmt::format("{}", fmt::join(there.log.lines(), "\n")); }
  GripperPort there;
  FakeServer served{there.server};
  std::unique_ptr<FakeServer> again;
  std::unique_ptr<Gripper> driver = there.driver();
  GripLoop loop;
};

TEST_F(GripperFaults, AnExceptionIsAFaultWhileItLasts) {
  EXPECT_EQ(after({Trouble::Kind::error_code, 4}).health, Health::fault);
  EXPECT_TRUE(driver->linked());
  EXPECT_THAT(said(), HasSubstr("exception 4 (it cannot do that now)"));
  heal(Trouble::Kind::error_code);
  EXPECT_EQ(loop.until(*driver, &kClose, is_good).health, Health::ok);
  EXPECT_EQ(there.jaws.words(), "c");
}

TEST_F(GripperFaults, ARefusedWriteIsAFaultAndTheGripStays) {
  static_cast<void>(loop.until(*driver, &kClose, [](const auto& s) { return s.value.holding; }));
  served.end();
  there.server.suffer({Trouble::Kind::error_code, gripper::kWriteLock});
  again = std::make_unique<FakeServer>(there.server);
  const auto sample = loop.until(*driver, &kOpen, is_bad);
  EXPECT_EQ(sample.health, Health::fault);
  EXPECT_TRUE(sample.value.holding);
  EXPECT_THAT(said(), HasSubstr("its write lock (register 0x1124)"));
  EXPECT_EQ(there.jaws.words(), "c");
  heal(Trouble::Kind::error_code);
  EXPECT_EQ(loop.until(*driver, &kOpen, is_open).health, Health::ok);
}

// The terminals are cut off: the coupler answers, with inputs that stand still.
TEST_F(GripperFaults, AStaleImageIsAFault) {
  EXPECT_EQ(after({Trouble::Kind::error_code, gripper::kBusStatus}).health, Health::fault);
  EXPECT_TRUE(driver->linked());
  EXPECT_THAT(said(), HasSubstr("reaches its terminals no more (register 0x1040)"));
  heal(Trouble::Kind::error_code);
  EXPECT_EQ(loop.until(*driver, &kClose, is_good).health, Health::ok);
}

TEST_F(GripperFaults, ALostLinkStaysLost) {
  EXPECT_EQ(after({Trouble::Kind::stall}).health, Health::fault);
  EXPECT_FALSE(driver->linked());
  EXPECT_THAT(said(), HasSubstr("lost: no answer in time; see to it, then begin a new run"));
  heal(Trouble::Kind::stall);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(driver->read(loop.now()).health, Health::fault);
  EXPECT_FALSE(driver->linked());
}

TEST_F(GripperFaults, AClosedConnectionIsLost) {
  EXPECT_EQ(after({Trouble::Kind::disconnect}).health, Health::fault);
  EXPECT_FALSE(driver->linked());
  EXPECT_THAT(said(), HasSubstr("lost: it hung up"));
}

TEST_F(GripperFaults, BytesThatAreNoModbusAreALostLink) {
  EXPECT_EQ(after({Trouble::Kind::garbage, 1.0}).health, Health::fault);
  EXPECT_FALSE(driver->linked());
}

TEST_F(GripperFaults, HalfAnAnswerIsALostLink) {
  EXPECT_EQ(after({Trouble::Kind::half_message, 1.0}).health, Health::fault);
  EXPECT_FALSE(driver->linked());
}

// The driver ends without a word, as after SIGKILL: the coupler's watchdog, whose time the driver has set,
// switches both outputs off. The jaws rest, and what they hold stays held. The next run resets the watchdog.
TEST(GripperWatchdog, JawsRestWithinItsTimeWhenTheDriverIsGone) {
  GripperPort there;
  there.table.watchdog = 0.3;
  const FakeServer served(there.server);
  auto driver = there.driver();
  const GripLoop loop;
  static_cast<void>(loop.until(*driver, &kClose, [](const auto& s) { return s.value.holding; }));
  EXPECT_EQ(there.jaws.words(), "c");
  driver.reset();
  const Duration gone = net::steady_now();
  while (there.jaws.words() == "c" && net::steady_now() - gone < Duration(2'000'000'000))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_EQ(there.jaws.words(), "cs");
  const Duration after = there.jaws.told[1].at - gone;
  EXPECT_GT(after, Duration(250'000'000));
  EXPECT_LT(after, Duration(500'000'000));
  driver = there.driver();
  EXPECT_TRUE(driver->read(loop.now()).value.holding);
  EXPECT_EQ(loop.until(*driver, &kOpen, is_open).health, Health::ok);
}

// A process that stands for longer than the watchdog's time has lost its outputs: its run cannot go on.
TEST(GripperWatchdog, ARunWhoseOutputsWereSwitchedOffIsLost) {
  GripperPort there;
  std::atomic<bool> end = false;
  std::atomic<std::int64_t> ahead = 0;  // s, of the fake's time
  std::thread serving([&] {
    while (!end) {
      const Time now(net::steady_now() + Duration(1'000'000'000) * ahead.load());
      there.server.serve(now);
      there.server.publish(now);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  {
    const auto driver = there.driver();
    const GripLoop loop;
    static_cast<void>(loop.until(*driver, &kClose, [](const auto& s) { return s.value.holding; }));
    ahead = 5;
    EXPECT_EQ(loop.until(*driver, &kClose, is_bad).health, Health::fault);
    for (int i = 0; i < 100 && driver->linked(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_FALSE(driver->linked());
    EXPECT_EQ(there.jaws.words(), "cs");
  }
  end = true;
  serving.join();
  EXPECT_THAT(there.log.lines(), testing::Contains(HasSubstr("its watchdog has switched the outputs off")));
}

// ---- refused before a run

std::string refusal_of(GripperPort& there) {
  return error_of([&] { static_cast<void>(there.driver()); }, ErrorKind::device);
}

TEST(GripperRefusal, AnotherUnitDeviceOrWiringIsSaid) {
  GripperPort there;
  const FakeServer served(there.server);
  there.table.unit = 7;
  EXPECT_THAT(refusal_of(there),
              HasSubstr("exception 11 (no such unit); correct driver.gripper.unit or the address"));
  there.table.unit = 250;
  EXPECT_THAT(refusal_of(there), HasSubstr("driver.gripper.unit; expected 0 to 247, or 255"));
  there.table.unit = 1;
  there.defaults.rig.force.stale = 0.001;
  EXPECT_THAT(refusal_of(there), HasSubstr("stale_ms of [force] is 1, and poll_ms is 2"));
  there.defaults.rig.force.stale = 0.05;
  EXPECT_EQ(refusal_of(there), "");
}

TEST(GripperRefusal, TerminalsThatDoNotAnswerAreSaid) {
  GripperPort there;
  there.server.suffer({Trouble::Kind::error_code, gripper::kBusStatus});
  const FakeServer served(there.server);
  EXPECT_THAT(refusal_of(there), HasSubstr("its terminals do not answer it (register 0x1040)"));
}

TEST(GripperRefusal, ASilentOrAbsentCouplerIsSaid) {
  GripperPort there;
  EXPECT_THAT(refusal_of(there), HasSubstr("no answer in time within 300 ms"));
  there.table.port = 1;
  EXPECT_THAT(refusal_of(there), HasSubstr("127.0.0.1:1"));
}

// An answer of which each byte is in time, and the last one late.
TEST(GripperRefusal, AnAnswerThatTricklesInIsSaid) {
  GripperPort there;
  net::Socket listener = net::listen_tcp("127.0.0.1", 0);
  there.table.port = listener.port();
  std::thread serving([&] {
    listener.wait(Duration(5'000'000'000));
    net::Socket client = listener.accept();
    gripper::Requests requests;
    std::optional<gripper::Request> request;
    while (!request && !client.closed()) {
      client.wait(Duration(100'000'000));
      requests.came(client.receive(requests.room()));
      request = requests.next();
    }
    if (!request) return;
    const auto bytes = gripper::answer(*request, gripper::identity_words("EK9000"));
    for (std::size_t i = 0; i < bytes.size() && !client.closed(); ++i) {
      client.send(std::span(bytes).subspan(i, 1));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      std::array<std::byte, 256> none{};
      client.receive(none);
    }
  });
  EXPECT_THAT(refusal_of(there), HasSubstr("no answer in time within 300 ms"));
  serving.join();
}

// Codes of the fake are exceptions of Modbus or the registers of its two other faults.
TEST(GripperRefusal, TheFakeKnowsItsCodes) {
  const GripperPort there;
  for (const double code : {1.0, 11.0, static_cast<double>(gripper::kBusStatus),
                            static_cast<double>(gripper::kWriteLock), kUnset})
    EXPECT_TRUE(there.server.knows({Trouble::Kind::error_code, code})) << code;
  for (const double code : {0.0, 12.0, 1e9})
    EXPECT_FALSE(there.server.knows({Trouble::Kind::error_code, code}));
  EXPECT_FALSE(there.server.knows({Trouble::Kind::saturate}));
  EXPECT_FALSE(there.server.knows({Trouble::Kind::loss}));
}

// ---- over the program

// A run in lockstep is the same each time, and the machine does what it does without sockets, a cycle later
// at most: the outputs are written in the cycle after the command.
TEST(GripperRun, InLockstepARunIsTheSameEachTimeAndMovesAsWithout) {
  const std::string tracking = tests::shipped_scene("tracking");
  const Laboratory there(true, {}, {}, tracking);
  const TemporaryFolder folder;
  std::vector<std::string> words = there.words({"--armed", "--lockstep", "--for-s", "4", "--json"});
  words[1] = tracking;
  std::vector<std::string> recorded = words;
  recorded.insert(recorded.end(), {"--record", folder.file("wires.encrec")});
  const nlohmann::json first = json_of(tests::run_program(recorded, {}, 400)),
                       again = json_of(tests::run_program(words, {}, 400));
  EXPECT_EQ(first["state_hash"], again["state_hash"]);
  const nlohmann::json pure = json_of(tests::run_program(
      {"run", tracking, "--for-s", "4", "--json", "--record", folder.file("none.encrec")}));
  const auto held = [&](const char* file) {
    RecordReader record(folder.file(file));
    RecordedTick tick;
    while (record.next(tick))
      if (tick.in.grip.value.holding) return tick.tick.index;
    return std::int64_t{-1};
  };
  const std::int64_t without = held("none.encrec");
  EXPECT_GT(without, 100);
  EXPECT_EQ(held("wires.encrec"), without + 21) << "a cycle, and a rest of 20 ms before the first direction";
  EXPECT_EQ(first["modes_s"], pure["modes_s"]);
}

// On a busy computer a fake may get no processor for a while. Its world stands meanwhile, so no answer is
// late.
TEST(GripperRun, InLockstepAFakeThatStandsForAWhileLosesNoLink) {
  const std::string tracking = tests::shipped_scene("tracking");
  Laboratory there(true, {}, {}, tracking);
  std::vector<std::string> words = there.words({"--armed", "--lockstep", "--for-s", "2", "--json"});
  words[1] = tracking;
  std::thread pauses([&there] {
    for (int i = 0; i < 60'000 && there.now < 0.5; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    there.pause();
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    there.serve();
  });
  const nlohmann::json result = json_of(tests::run_program(words, {}, 400));
  pauses.join();
  EXPECT_EQ(result["ticks"], 2001);
}

// `encounter fake fakes` and an armed run: the coupler's fake closes the twin's jaws on the tool.
TEST(GripperRun, OnTheWallClockTheShippedRigClampsTheTool) {
  const std::string clamped = tests::shipped_scene("clamped_tool");
  const TemporaryFolder folder;
  std::vector<std::string> fake{tests::program_file(), "fake", "fakes", "--scene", clamped},
      run{"run",
          clamped,
          "--rig",
          "fakes",
          "--armed",
          "--yes",
          "--for-s",
          "2",
          "--json",
          "--record",
          folder.file("r.encrec")};
  for (const std::string& port : wires::free_ports())
    for (std::vector<std::string>* words : {&fake, &run}) words->insert(words->end(), {"--set", port});
  tests::PipedChild fakes(fake);
  std::string said;
  std::array<char, 256> bytes{};
  for (int i = 0; i < 600 && !fakes.closed() && said.find("ends with SIGINT") == std::string::npos; ++i)
    said.append(bytes.data(), fakes.read(bytes, 100));
  EXPECT_THAT(said, HasSubstr("EK9000 with gripper at 127.0.0.1:"));
  const nlohmann::json result = json_of(tests::run_program(run, {}, 100));
  EXPECT_THAT(result["devices"].value("gripper", ""),
              testing::AllOf(testing::StartsWith("coupler Encounter fake at 127.0.0.1:"),
                             HasSubstr("answered (a fake)")));
  RecordReader record(folder.file("r.encrec"));
  RecordedTick tick;
  std::int64_t held = 0;
  while (record.next(tick)) held += tick.in.grip.value.holding ? 1 : 0;
  EXPECT_GT(held, record.ticks() / 2);
  EXPECT_TRUE(tick.in.grip.value.holding);
}

// ---- foreign

const std::string kPymodbus = tests::source_dir() + "/.deps/pymodbus";

class GripperForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPymodbus)) GTEST_SKIP() << "no " << kPymodbus << ": ./check fetches it";
  }
  static std::vector<std::string> script(const std::string& name) {
    return {"/usr/bin/python3", "-B", tests::source_dir() + "/tests/conformance/foreign/" + name, kPymodbus};
  }
  static std::string line_of(tests::PipedChild& child) {
    std::array<char, 64> line{};
    return {line.data(), child.read(line, 20'000)};
  }
};

// Reads its registers, closes and opens, meets each exception, lets its watchdog run out and resets it.
TEST_F(GripperForeign, PymodbusDrivesTheFake) {
  GripperPort there;
  const FakeServer served(there.server);
  std::vector<std::string> words = script("pymodbus_client.py");
  words.push_back(std::to_string(there.server.port()));
  tests::PipedChild child(words);
  ASSERT_THAT(line_of(child), testing::StartsWith("closed"));
  for (int i = 0; i < 1000 && there.jaws.words() != "cs"; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(there.jaws.words(), "cs");
  EXPECT_EQ(child.end(), 0);
  EXPECT_EQ(there.jaws.words(), "cso");
}

TEST_F(GripperForeign, TheDriverSpeaksToPymodbussServer) {
  tests::PipedChild child(script("pymodbus_server.py"));
  const std::string port = line_of(child);
  ASSERT_NE(port, "");
  GripperPort other;
  other.table.port = std::stoi(port);
  other.table.watchdog = 1.0;
  {
    const auto driver = other.driver();
    EXPECT_FALSE(driver->is_fake());
    EXPECT_THAT(driver->describe(), HasSubstr("coupler EK9000 at 127.0.0.1:"));
    const GripLoop loop;
    EXPECT_EQ(driver->read(loop.now()).value.phase, GripPhase::open);
    EXPECT_TRUE(loop.until(*driver, &kClose, [](const auto& s) { return s.value.holding; }).value.holding);
    EXPECT_EQ(driver->read(loop.now()).health, Health::ok);
    driver->stop();
  }
  EXPECT_EQ(child.end(), 0);
}

}  // namespace
}  // namespace enc::test
