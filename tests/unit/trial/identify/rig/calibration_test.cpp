// A machine that carries a clamped tool through the poses of a calibration, in the twin: it gets there, it
// rests, and the result equals the input.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/step.h"
#include "models/identify/rig/turn.h"
#include "tests/support/built.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/runs.h"
#include "trial/identify/camera/registration_rig.h"
#include "trial/identify/rig/machine_calibration.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using testing::AllOf, testing::HasSubstr;

models::Setup clamped(const std::vector<std::string>& set = {}) { return test::shipped("clamped_tool", set); }

class CountedStops final : public Manipulator {
 public:
  CountedStops(std::unique_ptr<Manipulator> machine, int& stopped)
      : machine_(std::move(machine)), stopped_(stopped) {}
  [[nodiscard]] Reach reach() const override { return machine_->reach(); }
  Measurement<TipSample> read(Time now) noexcept override { return machine_->read(now); }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override { machine_->command(X_RH); }
  void stop() noexcept override {
    ++stopped_;
    machine_->stop();
  }

 private:
  std::unique_ptr<Manipulator> machine_;
  int& stopped_;
};

const Pose<'W', 'H'> kAside(rotation_xyz(Vec3(0.10, -0.05, 0.2)), Vec3(0.008, -0.004, 0.003));

TEST(CarriedTool, GoesThereRestsAndMeasures) {
  CarriedTool tool(clamped(), {});
  tool.go(kAside);
  const CarriedStand stand = tool.stand();
  EXPECT_LT((stand.X_WH.p() - kAside.p()).norm(), 5e-6);
  EXPECT_LT(stand.X_WH.q().angularDistance(kAside.q()), 1e-4);
  EXPECT_NEAR(static_cast<double>(stand.readings), 1000.0, 2.0);
  EXPECT_NEAR(static_cast<double>(stand.packets), 100.0, 3.0);
  const Mat3 R_FW = (stand.X_WH.q() * pose_of<'H', 'F'>(tool.trial().setup().rig.frames.H_F).q())
                        .toRotationMatrix()
                        .transpose();
  const double mass = tool.trial().scene().force.mass;
  const Vec3 weight = R_FW * Vec3(0, 0, -mass * kStandardGravity);
  const Vec3 zero = tool.trial().world().force->zero().e();
  EXPECT_LT((stand.wrench.force.e() - weight - zero).norm(), 0.005);
}

TEST(CarriedTool, SaysWhatKeepsItFromGoing) {
  const auto said = [](const auto& act) { return test::refusal(act); };
  EXPECT_THAT(said([] {
                CarriedTool tool(clamped(), {});
                tool.go(Pose<'W', 'H'>::shift(0, 0, 0.080));
              }),
              HasSubstr("out of the machine's reach"));
  EXPECT_THAT(said([] {
                CarriedTool tool(clamped({"truth.gripper.width_mm=0"}), {});
                tool.go(kAside);
              }),
              AllOf(HasSubstr("hold"), HasSubstr("calibrate again")));
  EXPECT_THAT(said([] { CarriedTool tool(test::shipped("plane"), {}); }),
              HasSubstr("no tool is clamped in this scene"));
  // A machine that does not follow its commands.
  EXPECT_THAT(said([] {
                CarriedTool tool(clamped({"truth.hexapod.servo_hz=0.3"}), {});
                tool.go(kAside);
              }),
              HasSubstr("in hold"));
}

// Any fault on the way ends the motion at once, and it does not resume by itself.
TEST(CarriedTool, AnyTroubleOnTheWayEndsIt) {
  const auto said = [](const std::function<void(double, Inputs&)>& spoil) -> std::string {
    TrialOptions options;
    double t = 0.0;
    options.disturb = [&](Inputs& in) { spoil(t += 1e-3, in); };
    CarriedTool tool(clamped(), options);
    try {
      tool.go(kAside);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::device);
      EXPECT_LT(tool.now(), 4.0) << e.what();
      return e.what();
    }
    return "done";
  };
  EXPECT_EQ(said([](double, Inputs&) {}), "done");
  EXPECT_THAT(said([](double t, Inputs& in) {
                if (t > 2.0 && t < 2.004) in.wrench.health = Health::fault;
              }),
              HasSubstr("in hold: force invalid"));
  EXPECT_THAT(said([](double t, Inputs& in) {
                if (t > 2.0) in.wrench.value.force = in.wrench.value.force + Vec<'F'>(0, 20, 0);
              }),
              HasSubstr("something is in the way"));
  // Twice the force that a tilt and a pulling cable explain, at any load.
  EXPECT_THAT(said([](double t, Inputs& in) {
                if (t > 2.0) in.wrench.value.force = in.wrench.value.force + Vec<'F'>(0, 14, 0);
              }),
              HasSubstr("something is in the way"));
  EXPECT_THAT(said([](double t, Inputs& in) {
                if (t > 2.0) in.grip.value = {GripPhase::opening, 0.006, 100.0, false};
              }),
              HasSubstr("the jaws do not hold the tool any more"));
  // A machine that does not turn, and one that was turned before.
  EXPECT_THAT(said([](double, Inputs& in) {
                in.tip.value.X_RH = {Quat::Identity(), Vec3(in.tip.value.X_RH.p())};
              }),
              AllOf(HasSubstr("degrees from where it was sent"), HasSubstr("turn it back to zero")));
  EXPECT_THAT(
      said([](double, Inputs& in) {
        in.tip.value.X_RH = {Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX())), Vec3(in.tip.value.X_RH.p())};
      }),
      HasSubstr("the machine stands turned by 5.7 degrees"));
}

// No tick turns it faster than the stated rate, and no path begins or ends with a leap.
TEST(CarriedTool, TurnsSlowlyAndWithoutALeap) {
  TrialOptions options;
  Quat before = Quat::Identity();
  double fastest = 0.0, slowest_change = 0.0, speed = 0.0;
  options.watch = [&](const Glance& glance) {
    if (!glance.out.manipulator.tip.valid()) return;
    const double now = glance.out.manipulator.tip.q().angularDistance(before) / 1e-3;
    before = Quat(glance.out.manipulator.tip.q());
    fastest = std::max(fastest, now);
    slowest_change = std::max(slowest_change, std::abs(now - speed));
    speed = now;
  };
  CarriedTool tool(clamped(), options);
  tool.go(kAside);
  tool.go(Pose<'W', 'H'>::identity());
  EXPECT_LT(fastest, 0.101);
  EXPECT_GT(fastest, 0.05);
  EXPECT_LT(slowest_change, 1e-3) << "rad/s from one tick to the next";
}

// The speed of a first run beside the machine: all of it is slow.
TEST(CarriedTool, GoesAndTurnsAsSlowlyAsItsRig) {
  TrialOptions options;
  Pose<'R', 'H'> before;
  double turning = 0.0, speed = 0.0;
  options.watch = [&](const Glance& glance) {
    if (glance.out.manipulator.tip.valid() && before.valid()) {
      turning = std::max(turning, glance.out.manipulator.tip.q().angularDistance(before.q()) / 1e-3);
      speed = std::max(speed, (glance.out.manipulator.tip.p() - before.p()).norm() / 1e-3);
    }
    before = glance.out.manipulator.tip;
  };
  CarriedTool tool(clamped({"rig.manipulator.speed_mm_s=5"}), options);
  tool.go(kAside);
  EXPECT_LT(turning, 0.0201);
  EXPECT_GT(turning, 0.015);
  EXPECT_LT(speed, 0.00401);
}

TEST(CarriedTool, StopsWhereItIsWhenItIsToldTo) {
  int asked = 0, stopped = 0;
  TrialOptions options;
  options.stop = [&] { return ++asked > 700; };
  options.fit_out = [&](Rig& rig) {
    rig.manipulator = std::make_unique<CountedStops>(std::move(rig.manipulator), stopped);
  };
  {
    CarriedTool tool(clamped(), options);
    EXPECT_THROW(tool.go(kAside), MotionInterrupt);
    EXPECT_LT(tool.now(), 0.8);
  }
  EXPECT_GT(stopped, 0);
}

TEST(CalibrationPoses, AreInReachAndSoAreTheWaysBetween) {
  const Hexapod machine{HexapodGeometry{}};
  const Reach reach{0.05, 0.41, machine, {}};
  const Pose<'W', 'R'> X_WR = Pose<'W', 'H'>::identity() * machine.zero().inverse();
  for (const std::size_t count : {kFewestPoses, kUsualPoses, std::size_t{200}}) {
    const auto poses = calibration_poses(reach, X_WR, count);
    ASSERT_EQ(poses.size(), count);
    Pose<'W', 'H'> from = Pose<'W', 'H'>::identity();
    Vec3 sides = Vec3::Zero();
    double most = 0.0;
    for (const Pose<'W', 'H'>& to : poses) {
      for (int i = 0; i <= 30; ++i) {
        const double share = i / 30.0;
        const Pose<'W', 'H'> at(from.q().slerp(share, to.q()), Vec3(from.p() + share * (to.p() - from.p())));
        ASSERT_TRUE(reach.contains(X_WR.inverse() * at));
      }
      const Vec3 up = to.q() * Vec3::UnitZ();
      sides += Vec3(up.x(), up.y(), 0.0) / static_cast<double>(count);
      most = std::max(most, std::acos(up.z()));
      from = to;
    }
    EXPECT_GT(most, 8.0 * M_PI / 180.0);
    EXPECT_LT(sides.norm(), 0.05) << "tilts lean to one side";
  }
}

// The poses of a machine with half the stroke are smaller, and still in reach.
TEST(CalibrationPoses, FitASmallerMachine) {
  HexapodGeometry small{.stroke = 0.008};
  const Hexapod machine{small};
  const Reach reach{0.05, 0.41, machine, {}};
  const Pose<'W', 'R'> X_WR = Pose<'W', 'H'>::identity() * machine.zero().inverse();
  double most = 0.0;
  for (const Pose<'W', 'H'>& pose : calibration_poses(reach, X_WR)) {
    EXPECT_TRUE(reach.contains(X_WR.inverse() * pose));
    most = std::max(most, std::acos((pose.q() * Vec3::UnitZ()).z()));
  }
  EXPECT_GT(most, 1.5 * M_PI / 180.0);
}

// The rest: tests/benchmarks/tracking/calibration_test.cpp.
TEST(MachineCalibration, FindsWhatTheRigDoesNotKnow) {
  models::Setup setup =
      clamped({"truth.frames.W_C.position_mm=[3, -896, 599]", "truth.force.turned_deg=[1, 1, -1.4]",
               "truth.frames.W_C.rotation_deg=[1, -1, 1.4]", "truth.hexapod.mass_kg=1.11",
               "truth.tracker.bias_mm=[0, 0, 0]"});
  CarriedTool tool(setup, {});
  std::vector<double> told;
  const MachineCalibration made = calibrate_machine(tool, 12, [&](double share) { told.push_back(share); });
  EXPECT_EQ(made.stands.size(), 12U);
  EXPECT_EQ(made.unseen, 0U);
  EXPECT_EQ(told.size(), 12U);
  ASSERT_TRUE(made.weight && made.hand_eye);
  EXPECT_NEAR(made.weight->mass.value, 1.11 + made.tool_mass, 3.0 * made.weight->mass.half);
  EXPECT_LT(made.weight->mass.half, 0.02);
  const Quat turned = rotation_xyz(M_PI / 180.0 * Vec3(1, 1, -1.4));
  EXPECT_LT(made.weight->R_HF.angularDistance(turned), 0.01);
  EXPECT_LT((made.weight->zero.value - tool.trial().world().force->zero().e()).norm(), 0.1);
  const Pose<'W', 'C'> X_WC = pose_of<'W', 'C'>(setup.twin.frames.W_C);
  const Point<'W'> seen = made.hand_eye->X_WC * (X_WC.inverse() * Point<'W'>(0, 0, 0));
  EXPECT_LT(seen.e().norm(), 0.02e-3);
  EXPECT_LT(made.hand_eye->X_WC.q().angularDistance(X_WC.q()), 5e-4);
  // The machine is at its zero again.
  const Pose<'W', 'H'> end = tool.trial().scene().X_WR * tool.trial().inputs().tip.value.X_RH;
  EXPECT_LT(end.p().norm(), 0.2e-3);
}

TEST(MachineCalibration, WeighsWhatTheSceneDoesNotAskForAndMissesAToolThatNobodySees) {
  const auto found = [](const std::vector<std::string>& set) {
    CarriedTool tool(test::shipped("tracking", set), {});
    return calibrate_machine(tool, 12);
  };
  EXPECT_TRUE(found({}).weight) << "the scene names no force sensor, and the rig has one";
  EXPECT_THAT(test::refusal([&] { (void)found({"truth.tracker.loss=1"}); }),
              HasSubstr("the tool was seen in 0 stands"));
}

std::string refused_calibration(const std::vector<std::string>& set, double& gone,
                                const TrialOptions& options = {}) {
  CarriedTool tool(clamped(set), options);
  std::string why = test::refusal([&] { (void)calibrate_machine(tool, 12); });
  gone = tool.now();
  return why;
}

TEST(MachineCalibration, RefusesWhatWouldHideInItsNumbers) {
  double gone = 0.0;
  // 2 mm of the tip: clamped so, or a lever of the machine. A view from the tracker's place could not show
  // it.
  TrialOptions lower;
  lower.disturb = [seen = Time::min()](Inputs& in) mutable {
    if (in.tool.t == seen || !in.tool.value.X_CT.valid()) return;
    seen = in.tool.t;
    in.tool.value.X_CT = in.tool.value.X_CT * Pose<'T', 'T'>::shift(0, 0, 0.002);
  };
  EXPECT_THAT(refused_calibration({}, gone, lower),
              AllOf(HasSubstr("the tool's tip stands at ["), HasSubstr("tip_height_mm")));
  // All axes in pounds look like a light load.
  EXPECT_THAT(refused_calibration({"rig.force.mass_kg=4.0"}, gone),
              AllOf(HasSubstr("put on a scale"), HasSubstr("unit and gain")));
}

TEST(MachineCalibration, PosesThatTellNothingAreRefusedBeforeAnythingMoves) {
  double gone = 1.0;
  EXPECT_THAT(
      refused_calibration({"rig.manipulator.geometry.tilt_limit_deg=4"}, gone),
      AllOf(HasSubstr("degrees rms to one side in the poses that it reaches"), HasSubstr("tilt_limit_deg")));
  EXPECT_EQ(gone, 0.0);
}

// Jaws that only report a clamp, and a tool that somebody holds still beside them.
TEST(MachineCalibration, AToolThatIsNotCarriedEndsItAtTheSecondStand) {
  TrialOptions options;
  Pose<'C', 'T'> still;
  options.disturb = [&](Inputs& in) {
    if (!in.tool.value.X_CT.valid()) return;
    if (!still.valid()) still = in.tool.value.X_CT;
    in.tool.value.X_CT = still;
  };
  CarriedTool tool(clamped(), options);
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { (void)calibrate_machine(tool, 24); }),
              HasSubstr("the tool is seen turned by 0.0"));
  EXPECT_LT(tool.now(), 30.0);
}

// The arm of the guided registration, driven through the twin: it reaches its target and rests there, the
// camera sees the truth and the device reports its belief.

models::Setup vishap(const std::vector<std::string>& set = {}) {
  return models::load_rig_setup(tests::source_dir() + "/models/rigs/vishap.toml", set);
}
const Point<'W'> kPlace(0.020, 0.060, -0.030);

// The core alone, under an arm that stays at home.
struct ArmCore {
  ArmCore() {
    models::Setup setup = vishap();
    setup.scene.arm.emplace();
    setup.scene.tracker.emplace();
    scene = prepare_setup(setup);
    in.arm.value.tip = scene.impedance()->arm.tip(scene.impedance()->arm.zero());
    in.arm.value.velocity = Vec<'R'>::zero();
    in.arm.health = Health::ok;
    in.withheld = true;
    tick.dt = from_seconds(scene.dt);
  }
  void next() {
    ++tick.index;
    tick.t += tick.dt;
    in.arm.t = tick.t;
  }
  Scene scene;
  Tick tick;
  Inputs in;
  Outputs out;
  State state;
};

TEST(Guide, TheTargetGoesWhereItIsSentWithinItsLimits) {
  ArmCore core;
  const ArmRig& rig = core.scene.impedance()->rig;
  Vec3 before = Vec3::Zero(), speed = Vec3::Zero();
  for (int i = 0; i < 1000; ++i) {
    core.next();
    guide(core.scene, core.tick, core.in, kPlace, core.state, core.out);
    const Vec3 velocity = (core.out.arm.target.e() - before) / core.scene.dt;
    EXPECT_LE(velocity.norm(), rig.speed * 1.001);
    EXPECT_LE((velocity - speed).norm() / core.scene.dt, rig.acceleration * 1.001);
    before = core.out.arm.target.e();
    speed = velocity;
  }
  EXPECT_LT((core.out.arm.target - kPlace).norm(), 1e-6);
  EXPECT_EQ(core.out.mode, Mode::away);
}

TEST(Guide, WhoIsSentNowhereWaitsAsStepDoes) {
  ArmCore guided, stepped;
  for (int i = 0; i < 100; ++i) {
    guided.next();
    stepped.next();
    guide(guided.scene, guided.tick, guided.in, Point<'W'>(), guided.state, guided.out);
    step(stepped.scene, stepped.tick, stepped.in, stepped.state, stepped.out);
  }
  EXPECT_EQ(guided.out.arm.force.xyz, stepped.out.arm.force.xyz);
  EXPECT_EQ(guided.out.arm.target.xyz, stepped.out.arm.target.xyz);
  EXPECT_LT(guided.out.arm.target.e().norm(), 1e-12);
}

TEST(DrivenArm, RestsWhereItIsSent) {
  DrivenArm arm(vishap());
  EXPECT_GT(arm.go(kPlace), 0.5);
  const TipStand first = arm.read(0.05);
  for (int i = 0; i < 20; ++i) {
    const TipStand tip = arm.read(0.05);
    EXPECT_LT((tip.truth - first.truth).norm(), 0.1e-3);
    EXPECT_LT((tip.truth - tip.reading).norm(), 0.05e-3);  // half a count of each encoder
    EXPECT_LT((tip.reading - kPlace).norm(), 1e-3);
  }
}

TEST(DrivenArm, SaysWhatItBelievesAndIsWhereItIs) {
  DrivenArm misplaced(vishap({"truth.arm.misplaced_mm=[1,2,-3]"}));
  misplaced.go(kPlace);
  const TipStand off = misplaced.read(0.05);
  EXPECT_LT(((off.truth - off.reading).e() - Vec3(0.001, 0.002, -0.003)).norm(), 0.05e-3);
  DrivenArm longer(vishap({"truth.arm.machine.l2_mm=114.13"}));  // and its own zero is at W
  longer.go(Point<'W'>(0.060, 0, 0.060));
  const TipStand tip = longer.read(0.05);
  EXPECT_GT((tip.truth - tip.reading).norm(), 0.3e-3);
  DrivenArm coarse(vishap({"truth.arm.counts=[1024,1024,1024]"}));
  coarse.go(kPlace);
  const TipStand counted = coarse.read(0.05);
  EXPECT_GT((counted.truth - counted.reading).norm(), 0.02e-3);  // a count is 0.12 mm
}

TEST(DrivenArm, TheSameToTheBit) {
  DrivenArm one(vishap()), other(vishap());
  EXPECT_EQ(one.go(kPlace), other.go(kPlace));
  const TipStand a = one.read(0.05), b = other.read(0.05);
  EXPECT_EQ(a.truth.xyz, b.truth.xyz);
  EXPECT_EQ(a.reading.xyz, b.reading.xyz);
}

// The joints cannot go straight ahead there: the path goes over the arm's zero.
TEST(DrivenArm, GoesRoundWhatTheJointsDoNotAllow) {
  const models::Setup setup = vishap();
  const RegistrationRig rig = registration_rig(setup);
  const Arm believed(rig.believed);
  const std::vector<Point<'W'>> all = places_of(rig, 120).visited;
  DrivenArm arm(setup);
  int around = 0;
  for (std::size_t i = 1; i < all.size() && around < 3; ++i) {
    PerJoint q{};
    const Point<'W'> middle = all[i - 1] + 0.5 * (all[i] - all[i - 1]);
    if (believed.inverse(base_of(believed).inverse() * middle, q)) continue;
    ++around;
    arm.go(all[i - 1]);
    arm.go(all[i]);
    EXPECT_LT((arm.read(0.05).reading - all[i]).norm(), 10e-3) << i;
  }
  EXPECT_EQ(around, 3);
}

std::string refusal(const std::vector<std::string>& set, const Point<'W'>& place) {
  return test::refusal([&] {
    DrivenArm arm(vishap(set));
    arm.go(place);
  });
}

TEST(DrivenArm, GivesUpWithAReason) {
  EXPECT_THAT(refusal({}, Point<'W'>(0.5, 0, 0)),
              AllOf(HasSubstr("vishap.toml:15:1: the tip did not come to rest for place 1, at "),
                    HasSubstr(" mm away"), HasSubstr("expected it within 10 mm")));
  EXPECT_THAT(refusal({"truth.arm.peak_torque_Nm=[0.001,0.001,0.001]"}, kPlace),
              HasSubstr("raise rig.arm.stiffness_N_per_m, or see rig.arm.gravity"));
  EXPECT_THAT(refusal({"truth.arm.counts=[64,64,64]"}, kPlace),
              AllOf(HasSubstr("still moves, "), HasSubstr("friction and counts")));
  EXPECT_THAT(refusal({"rig.arm.stiffness_N_per_m=3000"}, kPlace), HasSubstr("under-damped"));
  EXPECT_THAT(refusal({"truth.arm.timestep_us=700"}, kPlace), HasSubstr("does not divide the haptic period"));
}

// The result contains the arm's own errors. A displaced base is an error in W, but not between camera and
// arm; a longer forearm is an error in both.
TEST(DrivenArm, TheRegistrationShowsWhatIsWrongWithTheArm) {
  struct Errors {
    double in_W, apart;
  };
  const auto errors = [](const std::vector<std::string>& set) {
    const models::Setup setup = vishap(set);
    RegistrationRig rig = registration_rig(setup);
    rig.camera.matching = rig.camera.pointing = rig.camera.standing = rig.camera.disparity_step = 0.0;
    const RegistrationPlaces places = places_of(rig, 6);
    DrivenArm arm(setup);
    const GuidedRun run =
        see_visits(visit_places(arm, places.visited, rig.camera.rate, 2), rig.X_WC, rig.camera, 1);
    const models::Registration found = models::register_points(averages(run.points));
    const Point<'W'>& middle = places.targets.front();
    return Errors{target_error(found.X_WC, rig.X_WC, middle).norm(),
                  target_error(found.X_WC, arm.as_it_believes(rig.X_WC), middle).norm()};
  };
  const Errors right = errors({});
  EXPECT_LT(right.in_W, 0.03e-3);
  EXPECT_EQ(right.in_W, right.apart);
  const Errors misplaced = errors({"truth.arm.misplaced_mm=[0,2,0]"});
  EXPECT_NEAR(misplaced.in_W, 2e-3, 0.05e-3);
  EXPECT_LT(misplaced.apart, 0.05e-3);
  EXPECT_GT(errors({"truth.arm.machine.l2_mm=114.13"}).apart, 0.2e-3);
}

}  // namespace
}  // namespace enc::trial
