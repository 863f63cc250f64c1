// The devices of a trial: the twin for simulated slots, drivers for slots that the rig names, and a simulated
// world only on demand.
#include "trial/assemble/assemble.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>

#include "app/modules/modules.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/runs.h"
#include "trial/certificates.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using certificate::Class;
using test::shipped;

const std::vector<std::string> kUncalibrated{"rig.manipulator.driver=\"sample\"",
                                             "rig.force.driver=\"sample\""};
const std::vector<std::string> kSample{kUncalibrated[0], kUncalibrated[1],
                                       "rig.calibration.date=\"2026-11-27\"",
                                       "rig.calibration.valid_days=36500"};

class Assemble : public testing::Test {
 protected:
  Assemble() { setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1); }
  ~Assemble() override { unsetenv("ENCOUNTER_MODULES"); }
  static TrialOptions options() {
    TrialOptions options{.seconds = 0.05, .drivers = app::load_module};
    return options;
  }
  // The reason why an armed trial of the setup is refused; or "armed".
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
  const Slots all = slots_of(shipped("tennis_ball"));
  EXPECT_TRUE(all.simulated);
  EXPECT_FALSE(all.real);
  const Slots mixed = slots_of(shipped("tennis_ball", kSample));
  EXPECT_TRUE(mixed.simulated);
  EXPECT_TRUE(mixed.real);
  // A probe needs neither tracker nor display, so their drivers do not count.
  const Slots real = slots_of(shipped("rig_A", kSample));
  EXPECT_FALSE(real.simulated);
  EXPECT_TRUE(real.real);
}

// sources/choices 15: a swing is only a warning in simulation, but a real machine is not armed for it.
TEST_F(Assemble, AnArmedMachineIsNotGivenWhatItCannotHoldStill) {
  models::Setup soft = shipped("stiffness", {"behaviour.spring.stiffness_N_per_mm=0.15"});
  soft.rig.manipulator.driver = soft.rig.force.driver = "sample";
  soft.scene.pusher.reset();
  EXPECT_NO_THROW(Trial(soft, options()));
  EXPECT_THAT(said_when_armed(soft),
              testing::AllOf(testing::HasSubstr("object 'wall'"), testing::HasSubstr("not armed")));
}

// Unmeasured frames put the tip at an unexpected place. A dry run shows it first.
TEST_F(Assemble, ARigThatNobodyCalibratedIsNotArmed) {
  const TrialResult dry = Trial(shipped("rig_A", kUncalibrated), options()).run();
  EXPECT_EQ(dry.withheld, dry.ticks);
  EXPECT_THAT(
      said_when_armed(shipped("rig_A", kUncalibrated)),
      testing::AllOf(
          testing::StartsWith("--set rig.manipulator.driver=\"sample\": this rig has no day of calibration"),
          testing::HasSubstr("[calibration]"), testing::HasSubstr("not armed")));
  EXPECT_EQ(said_when_armed(shipped("rig_A", kSample)), "armed");
  // A gripper has force, too; a real sensor moves nothing.
  struct Jaws final : Gripper {
    void command(const Grip&) noexcept override {}
    void stop() noexcept override {}
    Measurement<GripSample> read(Time) noexcept override { return {}; }
  };
  Rig rig;
  rig.gripper = std::make_unique<Jaws>();
  EXPECT_EQ(real_machine(rig, shipped("clamped_tool", {"rig.gripper.driver=\"sample\""})),
            "rig.gripper.driver");
  EXPECT_EQ(said_when_armed(shipped("rig_A", {"rig.force.driver=\"sample\""})), "armed");
}

// A device may have moved since its calibration; a day in the future means a wrong clock.
TEST_F(Assemble, ACalibrationThatIsTooOldOrYetToComeIsRefused) {
  const auto dated = [](const std::string& date, const std::string& days) {
    std::vector<std::string> set = kUncalibrated;
    set.push_back("rig.calibration.date=\"" + date + "\"");
    set.push_back("rig.calibration.valid_days=" + days);
    return said_when_armed(shipped("rig_A", set));
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
  EXPECT_NO_THROW(Trial(shipped("rig_A", kUncalibrated), calibrating));
}

// The address of the machine may be a relay on this PC: a fake identifies itself on its wire.
TEST_F(Assemble, AnAddressMakesNoFake) {
  for (const char* address : {"127.0.0.1", "localhost", "::1", "192.168.0.20"}) {
    std::vector<std::string> set = kUncalibrated;
    set.push_back(std::string("rig.driver.sample.address=\"") + address + "\"");
    EXPECT_THAT(said_when_armed(shipped("rig_A", set)), testing::HasSubstr("no day of calibration"))
        << address;
  }
}

TEST_F(Assemble, AnArmIsNotArmedForWhatItDoesNotHoldOrMayNot) {
  const auto refused = [](models::Setup setup) {
    setup.rig.arm.driver = "sample";
    return said_when_armed(setup);
  };
  EXPECT_THAT(refused(shipped("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=5"})),
              testing::AllOf(testing::HasSubstr("object 'wall'"), testing::HasSubstr("make it softer"),
                             testing::HasSubstr("not armed")));
  models::Setup silent = shipped("wall");
  silent.rig.arm.loop.reset();
  EXPECT_THAT(refused(silent),
              testing::AllOf(testing::HasSubstr("no damping"), testing::HasSubstr("not armed")));
  EXPECT_THAT(refused(shipped("wall")), testing::HasSubstr("cold motors"))
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
  Trial trial(shipped("rig_A", kSample), made);
  EXPECT_FALSE(trial.has_world());
  const TrialResult result = trial.run();
  EXPECT_GE(result.ticks + result.missed, 51);  // a busy machine loses some
  EXPECT_EQ(looks, result.ticks);
  EXPECT_GE(result.wall, 0.05);
  EXPECT_GE(trial.now().index, 50);
  EXPECT_EQ(result.diverged_at, -1);
}

TEST_F(Assemble, OneSimulatedSlotBringsTheWorld) {
  Trial trial(shipped("tennis_ball", kSample), options());
  EXPECT_TRUE(trial.has_world());
  const TrialResult result = trial.run();
  EXPECT_GE(result.ticks + result.missed, 51);
  EXPECT_GE(result.wall, 0.05);  // real devices run in wall time
  EXPECT_TRUE(trial.truth().tip.finite());
}

TEST_F(Assemble, ARealDeviceKeepsWallPace) {
  TrialOptions fast = options();
  fast.pace = 10.0;
  EXPECT_THROW(Trial(shipped("tennis_ball", kSample), fast), Error);
}

// A machine that differs from the rig, or does not know its own abilities.
class Claims final : public Manipulator {
 public:
  explicit Claims(Reach reach) : reach_(std::move(reach)) {}
  [[nodiscard]] Reach reach() const override { return reach_; }
  Measurement<TipSample> read(Time) noexcept override { return {}; }
  void command(const Pose<'R', 'H'>&) noexcept override {}
  void stop() noexcept override {}

 private:
  Reach reach_;
};
class ArmClaims final : public HapticArm {
 public:
  explicit ArmClaims(ArmAbility ability) : ability_(std::move(ability)) {}
  [[nodiscard]] ArmAbility ability() const override { return ability_; }
  Measurement<ArmSample> read(Time) noexcept override { return {}; }
  void command(const Vec<'R'>&) noexcept override {}
  void stop() noexcept override {}

 private:
  ArmAbility ability_;
};

std::string refusal(const Rig& rig, const RigSpec& spec) {
  return test::refusal(ErrorKind::device, [&] { check_devices(rig, spec); });
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
  const RigSpec spec = shipped("wall").rig;
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
  Trial dry(shipped("rig_A", kSample), made);
  const TrialResult result = dry.run();
  EXPECT_EQ(result.withheld, result.ticks);
  EXPECT_TRUE(dry.inputs().withheld);
  made.armed = true;
  Trial armed(shipped("rig_A", kSample), made);
  EXPECT_EQ(armed.run().withheld, 0);
  EXPECT_FALSE(armed.inputs().withheld);
}

// The sample machine reaches its commanded place by the next read; a dry run sends it no command.
TEST_F(Assemble, OnlyAnArmedMachineIsSentCommands) {
  const auto moved = [](bool armed) {
    TrialOptions made = options();
    made.armed = armed;
    made.law = [](const Scene& s, const Tick&, const Inputs&, State&, Outputs& out) {
      const Pose<'R', 'H'> zero = s.reach.machine.zero();
      out.manipulator.tip = {zero.q(), Vec3(zero.p() + Vec3(0, 0, 1e-3))};
    };
    Trial trial(shipped("rig_A", kSample), made);
    trial.run();
    return (trial.inputs().tip.value.X_RH.p() - trial.scene().reach.machine.zero().p()).norm();
  };
  EXPECT_EQ(moved(false), 0.0);
  EXPECT_NEAR(moved(true), 1e-3, 1e-9);
}

TEST_F(Assemble, WithoutDriversEverythingIsSimulated) {
  TrialOptions made{.seconds = 0.01};
  for (const char* name : {"tennis_ball", "rig_A"}) {
    Trial trial(shipped(name, kSample), made);
    EXPECT_TRUE(trial.has_world()) << name;
    EXPECT_EQ(trial.run().ticks, 11) << name;
  }
}

// The certificate of each object of a scene: the shipped ones, and objects beyond the bounds of stiffness.

std::vector<ObjectCertificate> of(const std::string& name, const std::vector<std::string>& set = {}) {
  const models::Setup setup = shipped(name, set);
  return certificates_of(setup, prepare_setup(setup));
}

TEST(Certificates, OfTheShippedScenes) {
  for (const char* name : {"wall", "button", "keypad", "drum", "tiles", "plane", "tennis_ball", "session"})
    for (const ObjectCertificate& one : of(name)) {
      EXPECT_FALSE(one.beyond()) << name << ": " << name_of(one) << " " << class_text(one);
      EXPECT_FALSE(one.unknown()) << name << ": " << name_of(one) << " " << class_text(one);
    }
  EXPECT_EQ(of("wall").size(), 2U);  // and the free tip
  EXPECT_EQ(of("tennis_ball").size(), 1U);
  EXPECT_TRUE(of("rig_A").empty()) << "a real ball is pressed";
}

// The wall is stable alone, and no device of 0.02 N s/m renders it passively [Colgate and Schenkel].
TEST(Certificates, TheWallOfThePaperIsNotPassive) {
  const ObjectCertificate wall = of("wall").back();
  EXPECT_EQ(wall.certificate.verdict, Class::alone);
  EXPECT_EQ(wall.asked, 600.0);
  EXPECT_LT(certificate::row_of(wall.certificate, "colgate_schenkel").margin, 0.5);
  EXPECT_GT(certificate::row_of(wall.certificate, "exact_with_hand").margin, 1.0);
}

TEST(Certificates, WhatIsTooStiffOrTooSoftIsBeyond) {
  const double most = certificate::row_of(of("wall").back().certificate, "exact_with_hand").bound;
  const auto wall = [](double stiffness) {
    return of("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=" + std::to_string(1e-3 * stiffness)})
        .back();
  };
  EXPECT_FALSE(wall(0.98 * most).beyond());
  EXPECT_TRUE(wall(1.02 * most).beyond());
  const std::vector<ObjectCertificate> soft =
      of("stiffness", {"behaviour.spring.stiffness_N_per_mm=0.15", "truth.pusher.stiffness_N_per_mm=0.7",
                       "truth.pusher.damping_Ns_per_m=4"});
  ASSERT_EQ(soft.size(), 1U);
  EXPECT_EQ(soft[0].certificate.verdict, Class::local);
  EXPECT_GT(soft[0].swing, 1e-3);
}

// The hand of the scene presses within two seconds; a person at a real device presses freely.
TEST(Certificates, APersonAtARealDevicePushesQuickly) {
  const auto ramp = [](const std::vector<std::string>& set) { return of("tennis_ball", set).back().ramp; };
  EXPECT_EQ(ramp({}), 2.0);
  for (const char* role : {"force", "tracker"})
    EXPECT_EQ(ramp({std::string("rig.") + role + ".driver=\"sample\""}), 0.5) << role;
  EXPECT_EQ(ramp({"rig.manipulator.driver=\"sample\""}), 2.0);
  EXPECT_EQ(ramp({"rig.force.driver=\"sample\"", "user.press_s=0.2"}), 0.2);
}

// A search that ended at its last step has no bound, and reports that; a loop that swings by itself has none
// either.
TEST(Certificates, ALargeSignalBoundIsOneSidedWhereTheSearchEnds) {
  using Side = certificate::Row::Side;
  const auto row = [](const std::string& name, const std::vector<std::string>& set) {
    const models::Setup setup = shipped(name, set);
    return certificate::row_of(certificates_of(setup, prepare_setup(setup), true).back().certificate,
                               "large_signal");
  };
  const certificate::Row stiff = row("stiffness", {"behaviour.spring.stiffness_N_per_mm=2"});
  EXPECT_EQ(stiff.side, Side::below);
  EXPECT_NEAR(stiff.low, 1000.0, 1e-6);
  const certificate::Row gum = row("training", {});
  EXPECT_EQ(gum.side, Side::at);
  EXPECT_LT(gum.low, 500.0);
  const certificate::Row swings =
      row("stiffness", {"behaviour.spring.stiffness_N_per_mm=0.15", "truth.pusher.stiffness_N_per_mm=0.7",
                        "truth.pusher.damping_Ns_per_m=4"});
  EXPECT_EQ(swings.side, Side::above);
  EXPECT_NEAR(swings.low, 150.0, 1e-6);
}

// This many copies of the wall's object, each elsewhere on the arm's plane.
models::Setup tiled(std::size_t count) {
  models::Setup setup = shipped("keypad");
  const ObjectSpec key = setup.scene.objects.front();
  setup.scene.objects.assign(count, key);
  for (std::size_t i = 0; i < count; ++i) {
    ObjectSpec& one = setup.scene.objects[i];
    one.name = "k" + std::to_string(i);
    const std::size_t row = i / 10;
    const auto column = static_cast<double>(i % 10), line = static_cast<double>(row);
    one.position.x() = 4e-3 * (column - 4.5);
    one.position.y() = 2e-3 * (line - 0.05 * static_cast<double>(count));
  }
  setup.scene.user.reset();
  return setup;
}

std::ptrdiff_t whole_ones(const std::vector<ObjectCertificate>& all) {
  return std::count_if(all.begin(), all.end(), [](const ObjectCertificate& one) { return one.like.empty(); });
}

// A whole certificate takes a millisecond.
TEST(Certificates, ManyObjectsThatAreAlikeShareTheWorst) {
  const models::Setup many = tiled(200);
  const std::vector<ObjectCertificate> found = certificates_of(many, prepare_setup(many));
  ASSERT_EQ(found.size(), 201U);
  EXPECT_LE(whole_ones(found), 4) << "the free tip, and one of each class";
  const ObjectCertificate& last = found.back();
  const double shared = certificate::row_of(last.certificate, "exact_with_hand").bound;
  for (const std::size_t i : {0U, 57U, 111U, 199U}) {
    models::Setup single = many;
    single.scene.objects = {many.scene.objects[i]};
    const ObjectCertificate own = certificates_of(single, prepare_setup(single)).back();
    EXPECT_TRUE(own.like.empty());
    EXPECT_EQ(own.certificate.verdict, found[i + 1].certificate.verdict);
    if (own.certificate.verdict == last.certificate.verdict) {
      EXPECT_GE(certificate::row_of(own.certificate, "exact_with_hand").bound, shared * (1.0 - 1e-9)) << i;
    }
  }
}

// The floor of `reaching`, which may be touched anywhere.
TEST(Certificates, AreOfTheWorstOfAFewPlaces) {
  const models::Setup setup = shipped("wall", {"rig.arm.speed_mm_s=600"});
  models::Setup anywhere = setup;
  anywhere.scene.user.reset();
  const ObjectCertificate pressed = certificates_of(setup, prepare_setup(setup)).back();
  const ObjectCertificate worst = certificates_of(anywhere, prepare_setup(anywhere)).back();
  EXPECT_TRUE(pressed.pressed);
  EXPECT_FALSE(worst.pressed);
  EXPECT_NEAR((worst.place.e() - pressed.place.e()).norm(), 0.05, 1e-9);
  EXPECT_LT(certificate::row_of(worst.certificate, "exact_with_hand").bound,
            certificate::row_of(pressed.certificate, "exact_with_hand").bound);
}

// The free tip has no hand on it: a stiffness that only a hand would hold is beyond the bound.
TEST(Certificates, AFreeTipHasNoHandOnIt) {
  const ObjectCertificate tip = of("wall", {"rig.arm.loop.delay_ms=20"}).front();
  ASSERT_TRUE(tip.free_tip());
  EXPECT_TRUE(tip.beyond()) << class_text(tip);
  ObjectCertificate held = tip;
  held.certificate.verdict = Class::held;
  EXPECT_TRUE(held.beyond());
  held.certificate.verdict = Class::unheld;
  EXPECT_FALSE(held.beyond());
}

// The core's belief and the truth are separate numbers: a wrong belief gives exactly its error.

models::Setup still_setup() {
  models::Setup setup = shipped("plane", {}, "sim");
  setup.twin.tracker.bias = setup.twin.tracker.noise = Vec3::Zero();
  setup.twin.tracker.marker_noise = 0.0;
  setup.twin.force.zero = setup.twin.force.drift = setup.twin.force.noise = 0.0;
  setup.twin.hand.tremor = setup.twin.hand.drift = 0.0;  // the hand stands still while it waits: 0.6 s
  return setup;
}

struct Offsets {
  Vec3 tool_error;  // believed minus true position of the tool's tip, in W
  Vec3 force;       // sensor reading at rest, in F
};

Offsets offsets_of(const models::Setup& setup) {
  Offsets seen{Vec3::Constant(kUnset), Vec3::Constant(kUnset)};
  trial::TrialOptions options{.seconds = 0.55};
  options.watch = [&](const trial::Glance& g) {
    if (g.in.tool.health == Health::ok) seen.tool_error = g.out.view.tip.e() - g.truth.tool_tip.e();
    if (g.in.wrench.health == Health::ok) seen.force = g.in.wrench.value.force.e();
  };
  trial::Trial trial(setup, options);
  trial.run();
  return seen;
}

TEST(Calibration, RightBeliefsGiveNoError) {
  const Offsets seen = offsets_of(still_setup());
  EXPECT_LT(seen.tool_error.norm(), 1e-6) << seen.tool_error.transpose();
  // Weight of 0.91 kg: 8.924 N down, in steps of 0.025 N.
  EXPECT_NEAR(seen.force.z(), -8.925, 0.0126);
  EXPECT_NEAR(seen.force.head<2>().norm(), 0.0, 0.0126);
}

TEST(Calibration, ACameraThatStandsElsewhereShiftsTheToolByAsMuchTheOtherWay) {
  // p_believed = X_WC' X_WC^-1 p_true with X_WC = X_WC' shifted by s: p_true - s.
  models::Setup setup = still_setup();
  setup.twin.frames.W_C.position += Vec3(0.001, -0.002, 0.003);
  EXPECT_LT((offsets_of(setup).tool_error - Vec3(-0.001, 0.002, -0.003)).norm(), 1e-6);
}

TEST(Calibration, ASensorThatIsTurnedReadsItsWeightAlongAnotherAxis) {
  // F turned by 90 degrees about y: its x axis points along -z of W, so the weight is along +x.
  models::Setup setup = still_setup();
  setup.twin.frames.H_F.rotation = Vec3(0, M_PI / 2, 0);
  const Offsets seen = offsets_of(setup);
  EXPECT_NEAR(seen.force.x(), 8.925, 0.0126) << seen.force.transpose();
  EXPECT_NEAR(seen.force.z(), 0.0, 0.0126);
}

TEST(Calibration, AMachineThatIsTurnedGoesAlongItsOwnAxes) {
  // The base is turned by 0.02 rad about z of W, H still on W's origin at zero: 10 mm along x of R are (10
  // cos, 10 sin) mm in W.
  models::Setup setup = still_setup();
  setup.scene.user.reset();
  setup.scene.tracker.reset();
  setup.twin.hexapod.turned = Vec3(0, 0, 0.02);
  trial::Trial trial(setup, {});
  sim::World& world = trial.world();
  EXPECT_LT(world.truth().tip.e().norm(), 1e-12);
  const Vec3 zero = world.machine->machine().zero().p();
  for (int i = 0; i < 2000; ++i) {
    world.machine->command(Pose<'R', 'H'>(Quat::Identity(), Vec3(zero + Vec3(0.010, 0, 0))));
    world.advance();
  }
  const Vec3 expected(0.010 * std::cos(0.02), 0.010 * std::sin(0.02), 0.0);
  EXPECT_LT((world.truth().tip.e() - expected).norm(), 2e-6)
      << world.truth().tip.e().transpose();  // 3 um steps
}

}  // namespace
}  // namespace enc::trial
