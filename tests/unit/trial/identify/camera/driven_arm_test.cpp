// The arm of the guided registration, driven through the twin: it gets where it is sent and rests there, the
// camera sees what is true and the device says what it believes.
#include "trial/identify/camera/driven_arm.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/control/guide.h"
#include "tests/support/built.h"
#include "trial/identify/camera/registration_rig.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using testing::AllOf;
using testing::HasSubstr;

models::Setup vishap(const std::vector<std::string>& set = {}) {
  return models::load_rig_setup(tests::source_dir() + "/models/rigs/vishap.toml", set);
}
const Point<'W'> kPlace(0.020, 0.060, -0.030);

// The core alone, under an arm that stays at home.
struct Alone {
  Alone() {
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
  Alone core;
  const ArmRig& rig = core.scene.impedance()->rig;
  Vec3 before = Vec3::Zero(), speed = Vec3::Zero();
  for (int i = 0; i < 1000; ++i) {
    core.next();
    guide(core.scene, core.tick, core.in, kPlace, core.state, core.out);
    const Vec3 velocity = (core.out.wanted.e() - before) / core.scene.dt;
    EXPECT_LE(velocity.norm(), rig.speed * 1.001);
    EXPECT_LE((velocity - speed).norm() / core.scene.dt, rig.acceleration * 1.001);
    before = core.out.wanted.e();
    speed = velocity;
  }
  EXPECT_LT((core.out.wanted - kPlace).norm(), 1e-6);
  EXPECT_EQ(core.out.mode, Mode::away);
}

TEST(Guide, WhoIsSentNowhereWaitsAsStepDoes) {
  Alone guided, stepped;
  for (int i = 0; i < 100; ++i) {
    guided.next();
    stepped.next();
    guide(guided.scene, guided.tick, guided.in, Point<'W'>(), guided.state, guided.out);
    step(stepped.scene, stepped.tick, stepped.in, stepped.state, stepped.out);
  }
  EXPECT_EQ(guided.out.arm_force.xyz, stepped.out.arm_force.xyz);
  EXPECT_EQ(guided.out.wanted.xyz, stepped.out.wanted.xyz);
  EXPECT_LT(guided.out.wanted.e().norm(), 1e-12);
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
  DrivenArm longer(vishap({"truth.arm.machine.l2_mm=114.13"}));  // and W is where its own zero is
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

// Straight ahead there is where no joints get: it goes over its zero.
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
  try {
    DrivenArm arm(vishap(set));
    arm.go(place);
  } catch (const Error& error) {
    return error.what();
  }
  return "got there";
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

// What is wrong with the arm is in what is found. A base that stands elsewhere is an error in W, and none
// between camera and arm; a longer forearm is one of both.
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
