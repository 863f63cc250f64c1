// The contract of a driver: one call for each role, its own table, a line about itself.
#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/devices/roles.h"
#include "models/setup/driver_table.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/runs.h"
#include "trial/devices/device_log.h"
#include "trial/trackers/frame_times.h"
#include "trial/trackers/threaded_tracker.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using test::replaced;
using testing::AllOf, testing::HasSubstr, testing::StartsWith;

constexpr std::array<std::string_view, 2> kWays{"fast", "exact"};

// A driver of this test, which fills every role of a hexapod's scene.
struct Box {
  std::string address = "10.0.0.1", mode = "exact";
  std::int64_t port = 4711;
  double timeout = 0.1;  // s
  std::vector<double> gains{1.0, 2.0};

  void declare(Settings& table) {
    table.value({.name = "address", .meaning = "of the box", .needed = true}, address);
    table.value({.name = "port", .meaning = "of the box", .low = 1, .high = 65535}, port);
    table.value({.name = "timeout_ms", .meaning = "for an answer", .low = 1, .source = "its manual"},
                timeout);
    table.value({.name = "mode", .meaning = "of the box", .words = kWays}, mode);
    table.value({.name = "gains", .meaning = "of each axis"}, gains);
  }
};
struct DeviceRecord {
  Box box;
  std::int64_t makers = 0, commands = 0, stops = 0;
  double speed = 0.0, grip = 0.0;
  Duration period{};
  bool absent = false;  // the device does not answer
};
DeviceRecord& given() {
  static DeviceRecord g;
  return g;
}
template <class Role>
class Fake : public Role {
 public:
  explicit Fake(const Offer& offer) {
    given().box.declare(offer.table);
    if (given().absent)
      throw Error(given().box.address + ": nobody listens there; switch it on", {}, ErrorKind::device);
    ++given().makers;
    given().speed = offer.reach.speed;
    given().grip = offer.rig.gripper.force;
    given().period = offer.period;
    offer.log.say("connected to " + given().box.address);
  }
  [[nodiscard]] std::string describe() const override { return "box " + given().box.address; }
};
class FakeMachine final : public Fake<Manipulator> {
 public:
  explicit FakeMachine(const Offer& offer) : Fake(offer), reach_(offer.reach) {}
  [[nodiscard]] Reach reach() const override { return reach_; }
  Measurement<TipSample> read(Time now) noexcept override {
    return {{reach_.machine.zero(), Vec<'R'>::zero(), Vec<'R'>::zero()}, now, Health::ok};
  }
  void command(const Pose<'R', 'H'>&) noexcept override { ++given().commands; }
  void stop() noexcept override { ++given().stops; }

 private:
  Reach reach_;
};
class FakeGripper final : public Fake<Gripper> {
 public:
  using Fake::Fake;
  Measurement<GripSample> read(Time now) noexcept override {
    return {{GripPhase::closed, 0.006, 100.0, true}, now, Health::ok};
  }
  void command(const Grip&) noexcept override { ++given().commands; }
  void stop() noexcept override { ++given().stops; }
};

const ModuleInfo& fake_module(const std::string&) {
  static const DriverModule kDriver{.settings = [](Settings& table) { Box{}.declare(table); },
                                    .manipulator = make<Manipulator, FakeMachine>,
                                    .gripper = make<Gripper, FakeGripper>};
  static const ModuleInfo kInfo{.name = "box", .driver = &kDriver};
  return kInfo;
}

// sim.toml, calibrated, with the box for machine and gripper, and its table at the end.
class DriverContract : public testing::Test {
 protected:
  DriverContract() {
    given() = DeviceRecord{};
    text_ = test::bytes_of(tests::source_dir() + "/models/rigs/sim.toml");
    for (const std::string role : {"[manipulator]\n", "[gripper]\n"})
      text_ = replaced(text_, role + "driver = \"sim\"", role + "driver = \"box\"");
    text_ =
        replaced(text_, "[loop]\n", "[calibration]\ndate = \"2026-11-27\"\nvalid_days = 36500\n\n[loop]\n");
    lines_ = static_cast<int>(std::count(text_.begin(), text_.end(), '\n'));
  }
  models::Setup load(const std::string& table, const std::vector<std::string>& set = {}) {
    std::ofstream(rig_) << text_ << table;
    return test::shipped("clamped_tool", set, rig_);
  }
  // lab.toml:LINE:COLUMN, the line counted from the table on.
  [[nodiscard]] std::string at(int line, int column) const {
    return rig_ + ":" + std::to_string(lines_ + line) + ":" + std::to_string(column) + ": ";
  }
  // The place that names the machine's driver.
  [[nodiscard]] std::string named() const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(text_.find("driver = \"box\""));
    return rig_ + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n')) + ":1";
  }
  std::string refusal(const std::string& table, const std::vector<std::string>& set = {}) {
    return test::refusal(ErrorKind::input, [&] {
      models::Setup setup = load(table, set);
      read_driver_tables(setup, [](const std::string& name) { return &fake_module(name); });
    });
  }
  static TrialOptions options(bool armed) {
    TrialOptions options{.seconds = 0.05, .drivers = fake_module, .armed = armed};
    return options;
  }
  test::TemporaryFolder folder_;
  std::string rig_ = folder_.file("lab.toml"), text_;
  int lines_ = 0;
};

const std::string kTable =
    "[driver.box]\naddress = \"10.0.0.7\"\nport = 4712\ntimeout_ms = 250\nmode = \"fast\"\n";

TEST_F(DriverContract, EachRoleIsMadeByOneCallWithTheDriversTableAndTheRig) {
  Trial trial(load(kTable), options(true));
  EXPECT_EQ(given().makers, 2);
  EXPECT_EQ(given().box.address, "10.0.0.7");
  EXPECT_EQ(given().box.port, 4712);
  EXPECT_DOUBLE_EQ(given().box.timeout, 0.25);  // SI
  EXPECT_EQ(given().box.mode, "fast");
  EXPECT_EQ(given().box.gains, (std::vector<double>{1.0, 2.0}));  // not in the file: its default
  EXPECT_DOUBLE_EQ(given().speed, 0.05);
  EXPECT_DOUBLE_EQ(given().grip, 100.0);
  EXPECT_EQ(given().period, Duration(1'000'000));
  const TrialResult result = trial.run();
  ASSERT_EQ(result.devices.size(), 2U);
  EXPECT_EQ(result.devices[0].role, "manipulator");
  EXPECT_EQ(result.devices[0].words, "box 10.0.0.7");
  EXPECT_EQ(result.devices[1].role, "gripper");
  EXPECT_THAT(result.log, testing::Each(std::string("connected to 10.0.0.7")));
  EXPECT_EQ(result.log.size(), 2U);
}

TEST_F(DriverContract, CommandsOfMachineAndGripperAreWithheldUntilArmed) {
  Trial dry(load(kTable), options(false));
  const TrialResult said = dry.run();
  EXPECT_EQ(given().commands, 0);
  EXPECT_EQ(given().stops, 0);  // nor a stop
  EXPECT_EQ(said.withheld, 2 * said.ticks);
  Trial armed(load(kTable), options(true));
  const TrialResult sent = armed.run();
  EXPECT_EQ(given().commands, 2 * sent.ticks);
  EXPECT_EQ(given().stops, 2);
  EXPECT_EQ(sent.withheld, 0);
}

TEST_F(DriverContract, ATableIsReadStrictly) {
  EXPECT_EQ(refusal(kTable), "");
  EXPECT_EQ(refusal(replaced(kTable, "port", "prot")),
            at(3, 1) + "unknown key 'prot'; expected a key of [driver.box]; did you mean 'port'?");
  EXPECT_EQ(
      refusal(replaced(kTable, "timeout_ms", "timeout_s")),
      at(4, 1) +
          "unknown key 'timeout_s'; expected the unit ms; did you mean 'timeout_ms'? then multiply by 1000");
  EXPECT_EQ(refusal(replaced(kTable, "4712", "\"4712\"")),
            at(3, 1) +
                "'port' is a text; expected a whole number from 1 to 65535 (of the box); write it like "
                "'port = 4711'");
  EXPECT_THAT(refusal(replaced(kTable, "4712", "4712.0")),
              StartsWith(at(3, 1) + "'port' is a number with a fraction"));
  EXPECT_THAT(refusal(replaced(kTable, "4712", "70000")), StartsWith(at(3, 1) + "'port' is 70000"));
  EXPECT_THAT(refusal(replaced(kTable, "4712", "true")), StartsWith(at(3, 1) + "'port' is true or false"));
  EXPECT_THAT(refusal(replaced(kTable, "4712", "1979-05-27")), StartsWith(at(3, 1) + "'port' is a "));
  EXPECT_THAT(refusal(replaced(kTable, "\"10.0.0.7\"", "7")),
              StartsWith(at(2, 1) + "'address' is a whole number"));
  EXPECT_THAT(refusal(replaced(kTable, "\"fast\"", "\"fasd\"")),
              AllOf(StartsWith(at(5, 1) + "'mode' is 'fasd'"), HasSubstr("did you mean 'fast'?")));
  EXPECT_THAT(refusal(replaced(kTable, "port = 4712", "[driver.box.port]")),
              StartsWith(at(3, 13) + "'port' is a table"));
}

TEST_F(DriverContract, AMissingKeyIsSaidWhereItBelongs) {
  EXPECT_THAT(refusal("[driver.box]\nport = 1\n"),
              AllOf(StartsWith(at(1, 1) + "[driver.box] has no 'address'; expected a text that is not empty"),
                    HasSubstr("add 'address = ")));
  const std::string none = refusal("");  // no table at all: the place that names the driver
  EXPECT_THAT(none, AllOf(StartsWith(rig_ + ":"), HasSubstr("[driver.box] has no 'address'")));
  EXPECT_THAT(none, testing::Not(StartsWith(rig_ + ":1:1")));
  EXPECT_THAT(refusal("", {"rig.manipulator.driver=sim", "rig.gripper.driver=sim"}), "");
}

TEST_F(DriverContract, ATableOfNobodyIsRefused) {
  EXPECT_EQ(refusal(replaced(kTable, "driver.box", "driver.bax")),
            at(1, 1) +
                "no role of this rig has the driver 'bax'; expected one that a role names; did you mean "
                "'box', as " +
                named() + " says?");
  EXPECT_THAT(refusal(replaced(kTable, "driver.box", "driver.sim")),
              StartsWith(at(1, 1) + "no role of this rig"));
  EXPECT_THAT(refusal(kTable, {"rig.driver.bax.port=1"}), StartsWith("--set rig.driver.bax.port=1: no role"));
}

TEST_F(DriverContract, SetReachesIt) {
  models::Setup setup = load("", {"rig.driver.box.port=99", "rig.driver.box.address=localhost",
                                  "rig.driver.box.timeout_ms=20", "rig.driver.box.gains=[3]"});
  Trial trial(setup, options(false));
  EXPECT_EQ(given().box.port, 99);
  EXPECT_EQ(given().box.address, "localhost");
  EXPECT_DOUBLE_EQ(given().box.timeout, 0.02);
  EXPECT_EQ(given().box.gains, std::vector<double>{3.0});
  EXPECT_EQ(refusal(kTable, {"rig.driver.box.prot=1"}),
            "--set rig.driver.box.prot=1: unknown key 'prot'; expected a key of [driver.box]; did you mean "
            "'port'?");
  EXPECT_THAT(refusal(kTable, {"rig.driver.box.port=x"}),
              StartsWith("--set rig.driver.box.port=x: 'x' is no value"));
}

// A driver keeps its defaults to the bit, also values that no file can express, with or without its module (a
// record needs no module). A key that two of its roles declare stands once.
TEST_F(DriverContract, ADefaultStaysWhatItIs) {
  struct OddSettings {
    double delay = kUnset, third = 1.0 / 3.0, most = std::numeric_limits<double>::infinity();
    std::vector<double> gains{};
    void declare(Settings& table) {
      for (int role = 0; role < 2; ++role) {
        table.value({.name = "patience_ms", .meaning = "of the box"}, delay);
        table.value({.name = "third_deg", .meaning = "of the box"}, third);
        table.value({.name = "most_N", .meaning = "of the box"}, most);
        table.value({.name = "gains", .meaning = "of each axis"}, gains);
      }
    }
  };
  models::Setup setup = load("");
  models::read_driver_table(setup, "box", [](Settings& table) { OddSettings{}.declare(table); });
  ASSERT_EQ(setup.rig.drivers.size(), 1U);
  EXPECT_EQ(setup.rig.drivers[0].values.size(), 4U);
  OddSettings odd;
  models::DriverTableReader reader(setup, "box");
  odd.declare(reader);
  EXPECT_TRUE(std::isnan(odd.delay));
  EXPECT_EQ(odd.third, 1.0 / 3.0);
  EXPECT_EQ(odd.most, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(odd.gains.empty());
  EXPECT_THAT(models::resolved(setup), testing::Not(HasSubstr("patience_ms")));
}

TEST_F(DriverContract, TheResolvedSceneKeepsIt) {
  models::Setup setup = load(kTable, {"rig.driver.box.address=here"});
  for (const bool known : {false, true}) {
    if (known) read_driver_tables(setup, [](const std::string& name) { return &fake_module(name); });
    const std::string text = models::resolved(setup);
    EXPECT_THAT(text,
                HasSubstr(known ? "\n[rig.driver.box]\naddress = \"here\"\ngains = [1, 2]\nmode = \"fast\"\n"
                                  "port = 4712\ntimeout_ms = 250\n"
                                : "\n[rig.driver.box]\naddress = \"here\"\nmode = \"fast\"\nport = 4712\n"
                                  "timeout_ms = 250\n"));
    const models::Setup again = models::parse_resolved(text, "a record");
    EXPECT_EQ(models::resolved(again), text);
  }
  // Another driver has the role, so the table has no owner.
  const models::Setup sim = load(kTable, {"rig.manipulator.driver=sim", "rig.gripper.driver=sim"});
  EXPECT_THAT(models::resolved(sim), testing::Not(HasSubstr("rig.driver")));
}

TEST_F(DriverContract, ParamsListsIt) {
  models::Setup setup = load(kTable);
  read_driver_tables(setup, [](const std::string& name) { return &fake_module(name); });
  int found = 0;
  for (const models::Parameter& p : models::parameters(setup)) {
    if (!p.name.starts_with("rig.driver.box.")) continue;
    ++found;
    if (p.name == "rig.driver.box.timeout_ms") {
      EXPECT_EQ(p.unit, "ms");
      EXPECT_EQ(p.value, "250");
      EXPECT_EQ(p.source, "its manual");
      EXPECT_EQ(p.confidence, "chosen");
      EXPECT_EQ(p.meaning, "for an answer");
    }
    if (p.name == "rig.driver.box.address") {
      EXPECT_EQ(p.value, "10.0.0.7");
    }
  }
  EXPECT_EQ(found, 5);
}

TEST_F(DriverContract, ARoleThatItDoesNotFillIsAMistakeInTheFile) {
  EXPECT_EQ(
      test::refusal(ErrorKind::input,
                    [&] { Trial trial(load(kTable, {"rig.force.driver=box"}), options(false)); }),
      "--set rig.force.driver=box: force: module 'box' drives no force sensor; choose another driver in "
      "the rig file");
}

// A run's error names the device by its role and its place in the file; a list of devices already has the
// role.
TEST_F(DriverContract, ADeviceThatIsNotThereIsNamedByItsRoleAndItsPlaceInTheFile) {
  given().absent = true;
  EXPECT_EQ(test::refusal(ErrorKind::device, [&] { Trial trial(load(kTable), options(false)); }),
            named() + ": manipulator: 10.0.0.7: nobody listens there; switch it on");
  const std::vector<DeviceWords> asked = ask_drivers(load(kTable), fake_module);
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_EQ(asked[0].role, "manipulator");
  EXPECT_EQ(asked[0].words, "10.0.0.7: nobody listens there; switch it on");
  EXPECT_FALSE(asked[0].there);
}

// The error also names role and place if the module cannot be loaded.
TEST_F(DriverContract, AModuleThatIsNotThereIsNamedByItsRoleToo) {
  TrialOptions none = options(false);
  none.drivers = [](const std::string&) -> const ModuleInfo& {
    throw Error("there is no such module; build it", {}, ErrorKind::device);
  };
  EXPECT_THAT(test::refusal(ErrorKind::device,
                            [&] { Trial trial(load(kTable, {"rig.manipulator.driver=sim"}), none); }),
              AllOf(StartsWith(rig_ + ":"), HasSubstr(":1: gripper: there is no such module")));
}

TEST(Roles, HaveEachTheirOwnPlace) {
  std::size_t roles = 0;
  each_role([&](const auto& role) {
    EXPECT_EQ(static_cast<std::size_t>(role.id), roles);
    ++roles;
  });
  EXPECT_EQ(roles, kRoles);
}

// Texts of devices go to a terminal: a line each, whatever bytes a wire brought.

TEST(DeviceLog, ALineOfADeviceIsOneLine) {
  DeviceLog log;
  log.say("serial 7\nstate hash  122d7c00183e94e0\033[2J\x9B");
  EXPECT_EQ(log.lines(), std::vector<std::string>{"serial 7\\nstate hash  122d7c00183e94e0\\x1b[2J\\x9b"});
}

// Results at irregular times: the reported results, their times, and their effect on the force.

Time at_ms(std::int64_t ms) { return Time(Duration(1'000'000) * ms); }
constexpr Duration kPeriod{50'000'000}, kLatency{50'000'000};

// A frame each 50 ms, there as soon as it is exposed; its number is the tool's.
class Frames final : public PoseTracker {
 public:
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    if (!exposures_.due(now)) return false;
    newest = {{static_cast<std::int32_t>(exposures_.n - 1), {}}, now, Health::ok};
    return true;
  }

 private:
  DueTimes exposures_{20.0};
};

struct FrameAge {
  std::int32_t frame;
  double age;  // s
};
std::vector<FrameAge> told(Duration jitter, std::uint64_t seed, int ms = 20'000) {
  JitteredTracker tracker(std::make_unique<Frames>(), {kLatency, jitter, seed});
  std::vector<FrameAge> all;
  Measurement<TrackedTool> newest;
  for (int i = 0; i < ms; ++i) {
    if (!tracker.poll(at_ms(i), newest)) continue;
    EXPECT_EQ(newest.t, Time(kPeriod * newest.value.tool));  // the stamp stays true
    all.push_back({newest.value.tool, age(at_ms(i), newest.t)});
  }
  return all;
}

TEST(JitteredTracker, WithoutJitterEachComesWhenItIsDue) {
  const auto all = told({}, 1);
  ASSERT_EQ(all.size(), 399U);
  for (const FrameAge& t : all) EXPECT_DOUBLE_EQ(t.age, 0.050);
}

// Early at the exposure, late when the next but one is exposed; in order, each equally often.
TEST(JitteredTracker, OneFrameEarlyOrLateInOrderAndRepeatable) {
  const auto all = told(kPeriod, 7), again = told(kPeriod, 7), other = told(kPeriod, 8);
  ASSERT_EQ(all.size(), again.size());
  double least = 1.0, most = 0.0, sum = 0.0, differs = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].age, again[i].age);
    EXPECT_TRUE(i == 0 || all[i].frame > all[i - 1].frame);
    if (i < other.size()) differs += std::abs(all[i].age - other[i].age);
    least = std::min(least, all[i].age);
    most = std::max(most, all[i].age);
    sum += all[i].age;
  }
  EXPECT_LT(least, 0.005);
  EXPECT_GT(most, 0.095);
  EXPECT_LE(most, 0.101);
  EXPECT_NEAR(sum / static_cast<double>(all.size()), 0.055, 0.01);
  EXPECT_GT(differs, 1.0);
}

TEST(FrameTimes, AStaleFrameIsNoFrameAndTheRateIsThatOfTheHandOvers) {
  FrameTimes times;
  times.reserve(10);
  Measurement<TrackedTool> tool;
  times.see(at_ms(0), tool);
  EXPECT_EQ(times.frames, 0);
  for (int i = 0; i < 200; ++i) {
    if (i % 50 == 0) tool = {{}, at_ms(i), i == 150 ? Health::stale : Health::ok};
    if (i == 150) tool.t = at_ms(100);  // reported again
    times.see(at_ms(i + 30), tool);
  }
  EXPECT_EQ(times.frames, 3);
  EXPECT_DOUBLE_EQ(times.rate(), 20.0);
  EXPECT_EQ(times.intervals, (std::vector<double>{0.050, 0.050}));
  EXPECT_EQ(times.ages, (std::vector<double>{0.030, 0.030, 0.030}));
}

}  // namespace
}  // namespace enc::trial
