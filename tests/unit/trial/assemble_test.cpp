// Which devices a trial is made of: the twin where a slot is simulated, drivers where the rig names them, and
// no simulated world where nothing asks for one.
#include "trial/assemble/assemble.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "core/base/error.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

const std::vector<std::string> kUncalibrated{"rig.manipulator.driver=\"sample\"",
                                             "rig.force.driver=\"sample\""};
const std::vector<std::string> kSample{kUncalibrated[0], kUncalibrated[1],
                                       "rig.calibration.date=\"2026-11-27\"",
                                       "rig.calibration.valid_days=36500"};

models::Setup scene(const std::string& name, const std::vector<std::string>& set = {}) {
  return models::load(tests::source_dir() + "/models/scenes/" + name + ".toml", {}, set);
}

class Assemble : public testing::Test {
 protected:
  Assemble() { setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1); }
  ~Assemble() override { unsetenv("ENCOUNTER_MODULES"); }
  static TrialOptions options() {
    TrialOptions options;
    options.drivers = app::load_module;
    options.seconds = 0.05;
    return options;
  }
  // What an armed trial of it is refused with; or "armed".
  static std::string said_when_armed(const models::Setup& setup) {
    TrialOptions made = options();
    made.armed = true;
    try {
      Trial(setup, made);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::input) << e.what();
      return e.what();
    }
    return "armed";
  }
};

TEST_F(Assemble, SlotsAreThoseThatTheSceneNames) {
  const Slots all = slots_of(scene("tennis_ball"));
  EXPECT_TRUE(all.simulated);
  EXPECT_FALSE(all.real);
  const Slots mixed = slots_of(scene("tennis_ball", kSample));
  EXPECT_TRUE(mixed.simulated);
  EXPECT_TRUE(mixed.real);
  // A probe needs neither tracker nor display, so what drives those does not count.
  const Slots real = slots_of(scene("rig_A", kSample));
  EXPECT_FALSE(real.simulated);
  EXPECT_TRUE(real.real);
}

// sources/choices 15: what a simulated machine only says, a real one does not begin.
TEST_F(Assemble, AnArmedMachineIsNotGivenWhatItCannotHoldStill) {
  models::Setup soft = scene("stiffness", {"behaviour.spring.stiffness_N_per_mm=0.15"});
  soft.rig.manipulator.driver = soft.rig.force.driver = "sample";
  soft.scene.pusher.reset();
  EXPECT_NO_THROW(Trial(soft, options()));
  EXPECT_THAT(said_when_armed(soft),
              testing::AllOf(testing::HasSubstr("object 'wall'"), testing::HasSubstr("not armed")));
}

// Frames that nobody measured put the tip where nobody expects it. A dry run is how they are looked at.
TEST_F(Assemble, ARigThatNobodyCalibratedIsNotArmed) {
  const TrialResult dry = Trial(scene("rig_A", kUncalibrated), options()).run();
  EXPECT_EQ(dry.withheld, dry.ticks);
  EXPECT_THAT(
      said_when_armed(scene("rig_A", kUncalibrated)),
      testing::AllOf(
          testing::StartsWith("--set rig.manipulator.driver=\"sample\": this rig has no day of calibration"),
          testing::HasSubstr("[calibration]"), testing::HasSubstr("not armed")));
  EXPECT_EQ(said_when_armed(scene("rig_A", kSample)), "armed");
  // A gripper has force, too; a sensor that is real moves nothing.
  struct Jaws final : Gripper {
    void command(const Grip&) noexcept override {}
    void stop() noexcept override {}
    Stamped<GripSample> read(Time) noexcept override { return {}; }
  };
  Rig rig;
  rig.gripper = std::make_unique<Jaws>();
  EXPECT_EQ(real_machine(rig, scene("clamped_tool", {"rig.gripper.driver=\"sample\""})),
            "rig.gripper.driver");
  EXPECT_EQ(said_when_armed(scene("rig_A", {"rig.force.driver=\"sample\""})), "armed");
}

// What was measured once may have been moved since; a day to come is a clock that is wrong.
TEST_F(Assemble, ACalibrationThatIsTooOldOrYetToComeIsRefused) {
  const auto dated = [](const std::string& date, const std::string& days) {
    std::vector<std::string> set = kUncalibrated;
    set.push_back("rig.calibration.date=\"" + date + "\"");
    set.push_back("rig.calibration.valid_days=" + days);
    return said_when_armed(scene("rig_A", set));
  };
  EXPECT_THAT(dated("2020-01-31", "30"),
              testing::AllOf(testing::HasSubstr("calibrated on 2020-01-31"), testing::HasSubstr("days ago"),
                             testing::HasSubstr("expected 30 at most"), testing::HasSubstr("not armed")));
  EXPECT_EQ(dated("2020-01-31", "36500"), "armed");
  EXPECT_THAT(dated("9999-01-01", "30"),
              testing::AllOf(testing::HasSubstr("days from now"), testing::HasSubstr("clock of this PC")));
  // A calibration itself needs none.
  TrialOptions calibrating = options();
  calibrating.armed = calibrating.calibrates = true;
  EXPECT_NO_THROW(Trial(scene("rig_A", kUncalibrated), calibrating));
}

// What leads to the machine may be a relay on this PC: a fake says on its wire that it is one.
TEST_F(Assemble, AnAddressMakesNoFake) {
  for (const char* address : {"127.0.0.1", "localhost", "::1", "192.168.0.20"}) {
    std::vector<std::string> set = kUncalibrated;
    set.push_back(std::string("rig.driver.sample.address=\"") + address + "\"");
    EXPECT_THAT(said_when_armed(scene("rig_A", set)), testing::HasSubstr("no day of calibration")) << address;
  }
}

TEST_F(Assemble, AnArmIsNotArmedForWhatItDoesNotHoldOrMayNot) {
  const auto refused = [](models::Setup setup) {
    setup.rig.arm.driver = "sample";
    return said_when_armed(setup);
  };
  EXPECT_THAT(refused(scene("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=5"})),
              testing::AllOf(testing::HasSubstr("object 'wall'"), testing::HasSubstr("make it softer"),
                             testing::HasSubstr("not armed")));
  models::Setup silent = scene("wall");
  silent.rig.arm.loop.reset();
  EXPECT_THAT(refused(silent),
              testing::AllOf(testing::HasSubstr("no damping"), testing::HasSubstr("not armed")));
  EXPECT_THAT(refused(scene("wall")), testing::HasSubstr("cold motors"))
      << "its certificate is none in the way";
}

TEST_F(Assemble, WithoutASimulatedSlotThereIsNoWorldAndTimeIsTheWalls) {
  int looks = 0;
  TrialOptions made = options();
  made.watch = [&](const Glance& glance) {
    ++looks;
    EXPECT_FALSE(glance.truth.tip.finite());
    EXPECT_FALSE(glance.truth.tool_tip.finite());
  };
  Trial trial(scene("rig_A", kSample), made);
  EXPECT_FALSE(trial.has_world());
  const TrialResult result = trial.run();
  EXPECT_GE(result.ticks + result.missed, 51);  // on a busy machine some are lost
  EXPECT_EQ(looks, result.ticks);
  EXPECT_GE(result.wall, 0.05);
  EXPECT_GE(trial.now().index, 50);
  EXPECT_EQ(result.diverged_at, -1);
}

TEST_F(Assemble, OneSimulatedSlotBringsTheWorld) {
  Trial trial(scene("tennis_ball", kSample), options());
  EXPECT_TRUE(trial.has_world());
  const TrialResult result = trial.run();
  EXPECT_GE(result.ticks + result.missed, 51);
  EXPECT_GE(result.wall, 0.05);  // real devices live in wall time
  EXPECT_TRUE(trial.truth().tip.finite());
}

TEST_F(Assemble, ARealDeviceKeepsWallPace) {
  TrialOptions fast = options();
  fast.pace = 10.0;
  EXPECT_THROW(Trial(scene("tennis_ball", kSample), fast), Error);
}

// A machine that is another one than the rig says, or does not know what it can do.
class Claims final : public Manipulator {
 public:
  explicit Claims(Reach reach) : reach_(std::move(reach)) {}
  [[nodiscard]] Reach reach() const override { return reach_; }
  Stamped<TipSample> read(Time) noexcept override { return {}; }
  void command(const Pose<'R', 'H'>&) noexcept override {}
  void stop() noexcept override {}

 private:
  Reach reach_;
};
class ArmClaims final : public HapticArm {
 public:
  explicit ArmClaims(ArmAbility ability) : ability_(std::move(ability)) {}
  [[nodiscard]] ArmAbility ability() const override { return ability_; }
  Stamped<ArmSample> read(Time) noexcept override { return {}; }
  void command(const Vec<'R'>&) noexcept override {}
  void stop() noexcept override {}

 private:
  ArmAbility ability_;
};

std::string refusal(const Rig& rig, const RigSpec& spec) {
  try {
    check_devices(rig, spec);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::device);
    return error.what();
  }
  return {};
}

TEST_F(Assemble, AMachineIsAskedForAllThatTheRigPromises) {
  const RigSpec spec;
  const auto refused = [&](const auto& change) {
    HexapodGeometry geometry = spec.manipulator.geometry;
    Reach reach = reach_of(spec);
    change(reach, geometry);
    reach.machine = Hexapod(geometry);
    Rig rig;
    rig.manipulator = std::make_unique<Claims>(reach);
    return refusal(rig, spec);
  };
  EXPECT_EQ(refused([](Reach&, HexapodGeometry&) {}), "");
  EXPECT_THAT(refused([](Reach& r, HexapodGeometry&) { r.speed = kUnset; }),
              testing::HasSubstr("speed_mm_s"));
  EXPECT_THAT(refused([](Reach& r, HexapodGeometry&) { r.speed *= 0.5; }), testing::HasSubstr("speed_mm_s"));
  EXPECT_THAT(refused([](Reach& r, HexapodGeometry&) { r.acceleration = kUnset; }),
              testing::HasSubstr("acceleration_m_s2"));
  EXPECT_THAT(refused([](Reach&, HexapodGeometry& g) { g.stroke *= 0.9; }), testing::HasSubstr("stroke_mm"));
  EXPECT_THAT(refused([](Reach&, HexapodGeometry& g) { g.tilt_limit *= 0.5; }),
              testing::HasSubstr("tilt_limit_deg"));
  EXPECT_THAT(refused([](Reach&, HexapodGeometry& g) { g.yaw_limit = kUnset; }),
              testing::HasSubstr("yaw_limit_deg"));
  for (double HexapodGeometry::*side : {&HexapodGeometry::base_radius, &HexapodGeometry::platform_radius,
                                        &HexapodGeometry::height, &HexapodGeometry::tip_height}) {
    EXPECT_THAT(refused([&](Reach&, HexapodGeometry& g) { g.*side += 1e-3; }),
                testing::HasSubstr("another one than the rig file says"));
    EXPECT_EQ(refused([&](Reach&, HexapodGeometry& g) { g.*side += 1e-6; }), "");
  }
  EXPECT_THAT(refused([&](Reach&, HexapodGeometry& g) { g.base_half_angle += 1e-3; }),
              testing::HasSubstr("base_half_angle_deg"));
}

TEST_F(Assemble, AnArmIsAskedToo) {
  const RigSpec spec = scene("wall").rig;
  const auto refused = [&](const auto& change) {
    ArmAbility ability{spec.arm.machine, spec.arm.peak, spec.arm.continuous};
    change(ability);
    Rig rig;
    rig.arm = std::make_unique<ArmClaims>(ability);
    return refusal(rig, spec);
  };
  EXPECT_EQ(refused([](ArmAbility&) {}), "");
  EXPECT_THAT(refused([](ArmAbility& a) { a.peak = kUnset; }), testing::HasSubstr("rig.arm.peak_N"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.peak *= 0.9; }), testing::HasSubstr("rig.arm.peak_N"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.continuous = 0.0; }), testing::HasSubstr("rig.arm.continuous_N"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.machine.kind = ArmKind::chain; }),
              testing::HasSubstr("another one than the rig file says"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.machine.phantom.l1 += 0.01; }), testing::HasSubstr("l1"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.machine.phantom.coupled_high = 0.01; }),
              testing::HasSubstr("coupled_high_deg"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.machine.phantom.m_a = 5.0; }),
              testing::HasSubstr("a mass in kg"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.machine.drives[1].high -= 0.5; }),
              testing::HasSubstr("rig.arm.machine.joint_high"));
  EXPECT_THAT(refused([](ArmAbility& a) { a.machine.drives[2].low += 0.1; }),
              testing::HasSubstr("rig.arm.machine.joint_low"));
}

TEST_F(Assemble, ADryRunCountsWhatItWithholds) {
  TrialOptions made = options();
  Trial dry(scene("rig_A", kSample), made);
  const TrialResult result = dry.run();
  EXPECT_EQ(result.withheld, result.ticks);
  EXPECT_TRUE(dry.inputs().withheld);
  made.armed = true;
  Trial armed(scene("rig_A", kSample), made);
  EXPECT_EQ(armed.run().withheld, 0);
  EXPECT_FALSE(armed.inputs().withheld);
}

// The sample machine is at the next read where it was told to be: dry, it is never told.
TEST_F(Assemble, OnlyAnArmedMachineIsSentCommands) {
  const auto moved = [](bool armed) {
    TrialOptions made = options();
    made.armed = armed;
    made.law = [](const Scene& s, const Tick&, const Inputs&, State&, Outputs& out) {
      const Pose<'R', 'H'> zero = s.reach.machine.zero();
      out.tip = {zero.q(), Vec3(zero.p() + Vec3(0, 0, 1e-3))};
    };
    Trial trial(scene("rig_A", kSample), made);
    trial.run();
    return (trial.inputs().tip.value.X_RH.p() - trial.scene().reach.machine.zero().p()).norm();
  };
  EXPECT_EQ(moved(false), 0.0);
  EXPECT_NEAR(moved(true), 1e-3, 1e-9);
}

TEST_F(Assemble, WithoutDriversEverythingIsSimulated) {
  TrialOptions made;
  made.seconds = 0.01;
  for (const char* name : {"tennis_ball", "rig_A"}) {
    Trial trial(scene(name, kSample), made);
    EXPECT_TRUE(trial.has_world()) << name;
    EXPECT_EQ(trial.run().ticks, 11) << name;
  }
}

}  // namespace
}  // namespace enc::trial
