// The world with an arm: what holds, what falls, what the finger feels.
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "sim/world.h"

namespace enc::sim {
namespace {

constexpr double kSpring = 2000.0, kDamper = 5.0;  // of a stiff holder, N/m and N s/m

// An arm at home with a wall through H that faces upwards, and a fingertip that a person holds above it.
struct Room {
  explicit Room(const TwinSpec& truth = {}, bool finger = false, double prop_mass = 0.020,
                const ArmMachine& machine = {}, double finger_mass = 0.02)
      : twin(truth) {
    scene.arm.emplace();
    scene.prop.emplace().mass = prop_mass;
    scene.objects.push_back({});
    scene.objects[0].shape = ShapeKind::plane;
    rig.arm.machine = machine;
    prepared.task = Meet();
    Object wall{Surface(Plane{}), Pose<'W', 'O'>::identity(), {}, kUnset, kUnset, Tangential::stick, kUnset};
    wall.stiffness = 500.0;
    prepared.objects.push_back(wall);
    if (finger) add_finger(finger_mass);
    world = std::make_unique<World>(WorldSpec{scene, rig, twin, prepared, "", 1, false});
    devices = world->rig();
  }
  void add_finger(double mass) {
    scene.tools.push_back({});
    scene.tools[0].name = "finger";
    scene.tools[0].tip_radius = 0.008;
    scene.tools[0].mass = mass;
    prepared.tools.push_back({});
    prepared.tools[0].tip.radius = 0.008;
    UserSpec user;
    user.approach_from = 0.02;
    user.approach_tilt = 0.0;
    user.depth = 0.0006;  // the holder gives 1.2 N there: motors carry that for hours
    user.press_time = user.release_time = 1.0;
    scene.user = user;
  }
  // A tick in which the tip is told to push with `force` besides what gravity asks for.
  void tick(const Vec3& force, bool compensate = true) {
    devices.clock->next();
    const PerJoint& q = devices.arm->read({}).value.joints;
    const Arm arm(rig.arm.machine);
    const Vec<'R'> weight = arm.force(arm.jacobian(q), arm.gravity(q, scene.prop->mass, Payload::exact));
    devices.arm->command(Vec<'R'>(Vec3(force + (compensate ? Vec3(weight.e()) : Vec3::Zero()))));
  }
  // Held at H by a spring and a damper, in R's axes.
  void hold() {
    const ArmSample s = devices.arm->read({}).value;
    const Vec3 error = -(world->X_WR() * s.tip).e();
    tick(kSpring * error - kDamper * s.velocity.e());
  }
  SceneSpec scene;
  RigSpec rig;
  TwinSpec twin;
  Scene prepared;
  std::unique_ptr<World> world;
  Rig devices;
};

TwinSpec frictionless() {
  TwinSpec twin;
  twin.arm.friction = twin.arm.viscous = {};
  return twin;
}

TEST(ArmWorld, StartsAtHome) {
  const Room room;
  const Truth& truth = room.world->truth();
  EXPECT_LT(truth.tip.e().norm(), 1e-12);
  EXPECT_EQ(truth.tip_velocity.norm(), 0.0);
  EXPECT_FALSE(truth.touching);
  EXPECT_EQ(room.devices.manipulator, nullptr);
  EXPECT_EQ(mj_name2id(room.world->physics().model(), mjOBJ_BODY, "platform"), -1);
}

TEST(ArmWorld, AWrongBaseMovesHome) {
  TwinSpec twin;
  twin.arm.misplaced = {0.001, 0, 0};
  twin.arm.turned = {0, 0, 0.02};
  const Room room(twin);
  EXPECT_LT((room.world->truth().tip.e() - Vec3(0.001, 0, 0)).norm(), 1e-12);
}

// With and without prop, in both forms of friction, and with none: only what the encoders do not see is left.
TEST(ArmWorld, DoesNotDriftWithItsWeightCompensated) {
  for (const double prop : {0.0, 0.020}) {
    for (const ArmFriction form : {ArmFriction::dry, ArmFriction::smooth}) {
      TwinSpec twin;
      twin.arm.friction_form = form;
      Room room(twin, false, prop);
      for (int i = 0; i < 10000; ++i) room.tick(Vec3::Zero());
      EXPECT_LT(room.world->truth().tip.e().norm(), 1e-3) << prop;
    }
  }
}

// Without compensation and without a prop, which nearly balances it, the motors pull it over: it comes to lie
// where its fold or a joint ends.
TEST(ArmWorld, FallsToADegeneratePose) {
  Room room({}, false, 0.0);
  for (int i = 0; i < 5000; ++i) room.tick(Vec3::Zero(), false);
  const Truth& truth = room.world->truth();
  EXPECT_GT(truth.tip.e().norm(), 0.03);
  EXPECT_LT(truth.tip_velocity.norm(), 1e-3);
  const double fold = truth.joints[1] - truth.joints[2];
  EXPECT_TRUE(std::abs(fold - 1.13) < 0.02 || std::abs(fold + 0.96) < 0.02) << fold;
  EXPECT_LT(room.world->diverged_at(), 0);
}

// The tip pushes straight into a finger that is held still: what was commanded arrives, but for friction.
TEST(ArmWorld, WhatIsCommandedIsFelt) {
  Room room(frictionless(), true, 0.020, {}, 1e6);  // nothing moves this finger
  const int tool = room.world->physics().id(mjOBJ_BODY, "tool");
  const mjModel* m = room.world->physics().model();
  room.world->physics().data()->qpos[m->jnt_qposadr[m->body_jntadr[tool]] + 2] = 0.0081;
  for (int i = 0; i < 500; ++i) room.tick({0, 0, 2.0});
  EXPECT_TRUE(room.world->truth().touching);
  EXPECT_NEAR(room.world->truth().contact_force.xyz[2], -2.0, 0.01);
  EXPECT_NEAR(room.world->truth().contact_force.xyz[0], 0.0, 0.02);
}

// A finger that presses on a held prop stays on it: no tick without contact.
TEST(ArmWorld, AFingerThatPressesStaysInContact) {
  Room room({}, true);
  int pressing = 0, lost = 0;
  double most = 0.0;
  while (!room.world->user_done()) {
    room.hold();
    const Truth& truth = room.world->truth();
    most = std::max(most, -truth.contact_force.xyz[2]);
    if (truth.phase != Phase::hold) continue;
    ++pressing;
    lost += truth.touching ? 0 : 1;
  }
  EXPECT_GT(pressing, 300);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(most, 0.5);
}

TEST(ArmWorld, GoesOnFromWhereItWasSaved) {
  Room room({}, true);
  for (int i = 0; i < 1200; ++i) room.hold();
  const std::vector<std::byte> saved = room.world->save();
  const auto run = [&] {
    for (int i = 0; i < 900; ++i) room.hold();
    return room.world->truth();
  };
  const Truth first = run();
  room.world->restore(saved);
  const Truth again = run();
  EXPECT_TRUE(first.touching);
  EXPECT_EQ(first.tip.xyz, again.tip.xyz);
  EXPECT_EQ(first.contact_force.xyz, again.contact_force.xyz);
  EXPECT_EQ(first.joints, again.joints);
  EXPECT_EQ(room.world->save().size(), saved.size());
}

// A driven front drags the finger along: on average the tip feels it backwards.
TEST(ArmWorld, ADrumRunsUnderTheFinger) {
  Room room({}, true);
  room.prepared.objects[0].interaction.way = Vec3::UnitY();
  room.world->arm->move_prop({.surface_speed = 0.05, .facing = {}});
  double sideways = 0.0;
  int ticks = 0;
  while (!room.world->user_done()) {
    room.hold();
    if (room.world->truth().phase != Phase::hold) continue;
    sideways += room.world->truth().contact_force.xyz[1];
    ++ticks;
  }
  EXPECT_LT(sideways / ticks, -0.1);
}

// A slide along x that carries a hinge about y, 100 mm before H. About the hinge: 1e-4 of the link, 0.2 kg at
// 50 mm, 20 g at 100 mm and the rotor, 1e-6 times 10^2: 9e-4 kg m^2.
TEST(ArmWorld, ASlideAndAHingeAreAChain) {
  constexpr double kLength = 0.1;
  ArmMachine stage;
  stage.kind = ArmKind::chain;
  stage.links.resize(2);
  stage.links[0] = {"x", JointKind::slide, Vec3::UnitX(), Vec3::Zero(), 0.3, Vec3::Zero(), Vec3::Ones()};
  stage.links[1] = {"lever", JointKind::hinge, Vec3::UnitY(),      Vec3::Zero(),
                    0.2,     Vec3(0.05, 0, 0), 1e-4 * Vec3::Ones()};
  stage.tip = Vec3(kLength, 0, 0);
  stage.drives[0] = {-0.1, 0.1, 200.0, 1e-6};
  stage.drives[1] = {-1.0, 1.0, 10.0, 1e-6};
  TwinSpec twin = frictionless();
  twin.arm.machine = stage;
  Room room(twin, false, 0.020, stage);
  const auto expect_on_its_circle = [&] {
    const Truth& truth = room.world->truth();
    const double slid = truth.joints[0], turned = truth.joints[1];
    EXPECT_NEAR(truth.tip.xyz[0], slid + kLength * (std::cos(turned) - 1.0), 1e-9);
    EXPECT_NEAR(truth.tip.xyz[1], 0.0, 1e-9);
    EXPECT_NEAR(truth.tip.xyz[2], -kLength * std::sin(turned), 1e-9);
  };
  for (int i = 0; i < 200; ++i) room.tick(Vec3::Zero());
  EXPECT_LT(room.world->truth().tip.e().norm(), 1e-4);
  for (int i = 0; i < 100; ++i) room.tick({0, 0, 0.05});
  expect_on_its_circle();
  // 0.05 N on 0.1 m for 100 ms: half of 5.6 rad/s^2 times 0.01 s^2.
  EXPECT_NEAR(room.world->truth().joints[1], -0.5 * (0.05 * kLength / 9e-4) * 0.01, 1e-3);
  for (int i = 0; i < 100; ++i) room.tick({0.1, 0, 0});
  expect_on_its_circle();
  EXPECT_GT(room.world->truth().joints[0], 1e-4);
}

}  // namespace
}  // namespace enc::sim
