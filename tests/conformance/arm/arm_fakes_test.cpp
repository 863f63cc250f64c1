// `encounter fake` with an arm and a finger's tracker on one side, `encounter run` with the driver and the
// fake libHD.so on the other.
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/laboratory/fakes.h"
#include "app/modules/modules.h"
#include "hw_drivers/net/socket.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using ::testing::HasSubstr;

const std::string kWallScene = tests::source_dir() + "/models/scenes/wall.toml";

// vishap.toml with the arm and the tracker over their drivers, at free ports, and a press that no real arm
// would be too warm for.
struct ArmLaboratory {
  ArmLaboratory(bool lockstep, const std::vector<std::string>& more, const std::string& driver = "phantom") {
    setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
    std::string text = bytes_of(tests::source_dir() + "/models/rigs/vishap.toml");
    replace(text, "[arm]\ndriver = \"sim\"", "[arm]\ndriver = \"" + driver + "\"");
    replace(text, "[VisHap 2.1]\ndriver = \"sim\"", "[VisHap 2.1]\ndriver = \"igtl\"");
    const std::string port = std::to_string(free_port());
    std::ofstream(rig) << text << "\n[driver." << driver << "]\nlibrary = \"fake\"\n"
                       << (driver == "phantom" ? "device = \"127.0.0.1:" + port + "\"" : "serial = " + port)
                       << "\n[driver.igtl]\nport = " << free_port() << "\n";
    set.insert(set.end(), more.begin(), more.end());
    fakes = std::make_unique<app::Fakes>(models::load(kWallScene, rig, set),
                                         app::FakesOptions{app::load_module, 1, lockstep, {}});
    thread = std::jthread([this](const std::stop_token& end) {
      while (!end.stop_requested()) {
        fakes->turn();
        const PerJoint& torque = fakes->world().arm->state().torque;
        pushes = torque != PerJoint{};
        if (pushes) pushed = seconds(fakes->world().truth().t.time_since_epoch());
      }
    });
  }
  static void replace(std::string& text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
  }
  static std::uint16_t free_port() { return net::bind_udp("127.0.0.1", 0).port(); }
  [[nodiscard]] nlohmann::json run(const std::string& with, const std::vector<std::string>& more) const {
    std::vector<std::string> words{"run", kWallScene, "--rig", with, "--json", "--for-s", "6"};
    for (const std::string& one : set) words.insert(words.end(), {"--set", one});
    words.insert(words.end(), more.begin(), more.end());
    const tests::Result result = tests::run_program(words, {}, 200);
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }

  TemporaryFolder folder;
  std::string rig = folder.file("fakes_arm.toml");
  std::vector<std::string> set{"user.depth_mm=5", "user.press_s=0.5", "user.hold_s=0", "user.release_s=0.5",
                               "user.rest_s=6"};
  std::unique_ptr<app::Fakes> fakes;
  std::atomic<bool> pushes = false;  // a motor has torque now
  std::atomic<double> pushed = 0.0;  // s, world time at which one last had
  std::jthread thread;
};

// The finger's pose crosses the tracker's protocol in millimetres, which rounds its last digit, so the runs
// differ by less than an encoder count. The arm alone is the twin's to the bit (phantom_test.cpp).
TEST(ArmFakes, InLockstepAPressOverTheFakeLibraryIsTheTwins) {
  const ArmLaboratory there(true, {});
  const nlohmann::json first = there.run(there.rig, {"--armed", "--lockstep"}),
                       again = there.run(there.rig, {"--armed", "--lockstep"}),
                       pure = there.run("vishap", {});
  EXPECT_EQ(first["state_hash"], again["state_hash"]);
  EXPECT_EQ(first["contacts"], 1);
  EXPECT_EQ(pure["contacts"], 1);
  for (const auto& [mode, time] : pure["modes_s"].items())
    EXPECT_NEAR(first["modes_s"].value(mode, 0.0), time.get<double>(), 0.002) << mode;
}

// SIGKILL while the arm carries its prop, and as a rule presses: nothing of the program is left to end the
// force.
void expect_no_force_when_killed(const ArmLaboratory& there) {
  std::vector<std::string> words{
      tests::program_file(), "run", kWallScene, "--rig", there.rig, "--armed", "--yes"};
  for (const std::string& one : there.set) words.insert(words.end(), {"--set", one});
  const auto until = [](const auto& condition) {
    for (int i = 0; i < 3000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  };
  {
    const tests::PipedChild child(words);
    ASSERT_TRUE(until([&] { return there.pushes && there.pushed > 0.1; }));
  }  // killed
  EXPECT_TRUE(until([&] { return !there.pushes; }));
  const double last = there.pushed;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(there.pushed, last);
}

// The electronics of a PHANToM end it, whose watchdog HD cannot set.
TEST(ArmFakes, AKilledProgramLeavesNoForce) {
  expect_no_force_when_killed(ArmLaboratory(
      false, {"rig.loop.late_cycles=200", "rig.arm.stale_ms=200", "rig.driver.phantom.silent_ms=200",
              "rig.driver.phantom.watchdog_periods=200", "truth.arm.watchdog_ms=200"}));
}

// The firmware of a Force Dimension device ends it, by the watchdog that the driver has set: the twin's own
// electronics would go on for an hour.
TEST(ArmFakes, AKilledProgramLeavesNoForceByTheWatchdogThatTheDriverHasSet) {
  expect_no_force_when_killed(ArmLaboratory(
      false,
      {"rig.loop.late_cycles=200", "rig.arm.stale_ms=200", "rig.driver.forcedimension.silent_ms=200",
       "rig.driver.forcedimension.watchdog_periods=200", "rig.driver.forcedimension.device_watchdog_ms=31",
       "truth.arm.watchdog_ms=3600000"},
      "forcedimension"));
}

}  // namespace
}  // namespace enc::test
