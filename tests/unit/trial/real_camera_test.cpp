// A scene with [camera] beside a real device: vision gets its own thread.
#include <cstdlib>

#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/runs.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

// An arm that stays at home, and a camera that shows grey walls at the rig's rate.
class Arm final : public HapticArm {
 public:
  explicit Arm(const Offer& offer)
      : ability_{offer.rig.arm.machine, offer.rig.arm.peak, offer.rig.arm.continuous},
        arm_(offer.rig.arm.machine) {}
  [[nodiscard]] ArmAbility ability() const override { return ability_; }
  Measurement<ArmSample> read(Time now) noexcept override {
    return {{arm_.zero(), {}, arm_.tip(arm_.zero()), Vec<'R'>::zero()}, now, Health::ok};
  }
  void command(const Vec<'R'>&) noexcept override {}
  void stop() noexcept override {}

 private:
  ArmAbility ability_;
  ::enc::Arm arm_;
};
class GreyCamera final : public StereoCamera {
 public:
  explicit GreyCamera(const Offer& offer)
      : wall_(offer.rig.camera.width, offer.rig.camera.height), exposures_{offer.rig.camera.rate} {
    std::fill(wall_.rgb.begin(), wall_.rgb.end(), std::uint8_t{90});
  }
  [[nodiscard]] std::string describe() const override { return "grey walls"; }
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
    bool due = false;
    while (exposures_.due(now)) due = true;
    if (due) newest = {{wall_.view(), wall_.view()}, now, Health::ok};
    return due;
  }

 private:
  Image wall_;
  DueTimes exposures_;
};

const ModuleInfo& modules(const std::string& name) {
  static const DriverModule kLive{.arm = make<HapticArm, Arm>, .camera = make<StereoCamera, GreyCamera>};
  static const DriverModule kPlayed{.camera = make<StereoCamera, GreyCamera>, .plays = true};
  static const ModuleInfo kLiveInfo{.name = "live", .driver = &kLive};
  static const ModuleInfo kPlayedInfo{.name = "played", .driver = &kPlayed};
  return name == "live" ? kLiveInfo : name == "played" ? kPlayedInfo : app::load_module(name);
}

class RealCamera : public testing::Test {
 protected:
  RealCamera() { setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1); }
  ~RealCamera() override { unsetenv("ENCOUNTER_MODULES"); }
  static models::Setup wall(const std::string& arm, const std::string& camera) {
    return test::shipped(
        "camera/wall",
        {"user.depth_mm=2", "rig.arm.driver=\"" + arm + "\"", "rig.camera.driver=\"" + camera + "\"",
         "rig.calibration.date=\"2026-11-27\"", "rig.calibration.valid_days=36500"},
        tests::source_dir() + "/models/rigs/vishap.toml");
  }
  static TrialOptions options(bool armed) {
    TrialOptions options{.seconds = 0.5, .drivers = modules, .armed = armed};
    return options;
  }
  static std::string refusal(const std::string& arm, const std::string& camera) {
    return test::refusal(ErrorKind::input, [&] { Trial(wall(arm, camera), options(true)); });
  }
};

TEST_F(RealCamera, HasAThreadOfItsOwnBesideAnArmedArm) {
  Trial trial(wall("live", "live"), options(true));
  const TrialResult result = trial.run();
  EXPECT_TRUE(result.vision.threaded);
  EXPECT_GE(result.vision.frames, 3);  // half a second at 20 Hz, on a busy machine
  EXPECT_EQ(static_cast<std::int64_t>(result.vision.ages.size()), result.vision.frames);
  for (const double age : result.vision.ages) EXPECT_GE(age, 0.0);
  EXPECT_EQ(static_cast<std::int64_t>(result.period_ns.size()), result.ticks - 1);
  EXPECT_EQ(result.withheld, 0);
  ASSERT_EQ(result.devices.size(), 2U);
  EXPECT_EQ(result.devices[1].words, "fingertip of grey walls, in a thread of its own");
}

// The run then keeps wall time, whatever the camera can do.
TEST_F(RealCamera, OneThatPlaysHasAThreadBesideARealArmAlone) {
  EXPECT_EQ(refusal("live", "played"), "");
  TrialOptions free = options(false);
  const TrialResult once = Trial(wall("sim", "played"), free).run();
  EXPECT_FALSE(once.vision.threaded);
  // Within the loop and in virtual time, rate and age are exact: 20 Hz, and 50 ms [models/rigs/vishap.toml].
  EXPECT_EQ(once.vision.frames, 10);
  EXPECT_NEAR(once.vision.rate(), 20.0, 1e-9);
  for (const double age : once.vision.ages) EXPECT_NEAR(age, 0.050, 1e-9);
  for (const double interval : once.vision.intervals) EXPECT_NEAR(interval, 0.050, 1e-9);
  EXPECT_TRUE(once.period_ns.empty());
  free.pace = 1.0;  // a pace changes the time, never the result
  const TrialResult paced = Trial(wall("sim", "played"), free).run();
  EXPECT_FALSE(paced.vision.threaded);
  EXPECT_EQ(paced.hash, once.hash);
}

TEST_F(RealCamera, ASimulatedOneHasAThreadBesideARealArm) {
  const Trial* running = nullptr;
  TrialOptions until_seen = options(true);
  until_seen.seconds = 30.0;  // a busy machine draws slowly
  until_seen.stop = [&running] { return running != nullptr && running->result().vision.frames >= 3; };
  Trial trial(wall("live", "sim"), until_seen);
  running = &trial;
  const TrialResult result = trial.run();
  EXPECT_TRUE(result.vision.threaded);
  EXPECT_GE(result.vision.frames, 3);
  for (const double age : result.vision.ages) EXPECT_GT(age, 0.0);
  EXPECT_EQ(result.withheld, 0);
}

}  // namespace
}  // namespace enc::trial
