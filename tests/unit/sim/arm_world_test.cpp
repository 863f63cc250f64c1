// Whole worlds: with an arm, of a session, and as exported.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/mujoco.h"
#include "sim/world.h"
#include "tests/support/built.h"
#include "tests/support/twin.h"
#include "trial/assemble/assemble.h"

namespace enc::sim {
namespace {

namespace fs = std::filesystem;
using test::scene_file, test::Twin;

constexpr double kSpring = 2000.0, kDamper = 5.0;  // stiff holder, N/m and N s/m

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
    prepared.task = ImpedanceTask();
    Object wall{Surface(Plane{}), Pose<'W', 'O'>::identity(), {},    kUnset,
                kUnset,           TangentialMode::stick,      kUnset};
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
  // A tick with a commanded tip force `force`, plus the force against gravity.
  void tick(const Vec3& force, bool compensate = true) {
    devices.clock->next();
    const PerJoint& q = devices.arm->read({}).value.joints;
    const Arm arm(rig.arm.machine);
    const Vec<'R'> weight = arm.force(arm.jacobian(q), arm.gravity(q, scene.prop->mass, Payload::exact));
    devices.arm->command(Vec<'R'>(Vec3(force + (compensate ? Vec3(weight.e()) : Vec3::Zero()))));
  }
  // A spring and a damper hold the tip at H, in R's axes.
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

// The compensated arm does not drift, with and without prop, in both forms of friction. Only the part below
// the encoders' resolution remains.
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

// Without compensation and without a prop, which nearly balances it, the motors pull the arm over. It comes
// to rest at its fold or at the end of a joint.
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

// The tip pushes straight into a finger that is held still: the commanded force arrives, less friction.
TEST(ArmWorld, WhatIsCommandedIsFelt) {
  Room room(frictionless(), true, 0.020, {}, 1e6);  // a finger that does not move
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

// A session in the twin: the tool changes without a change in force, and the whole state can be saved.

// The change comes after the first press.
std::vector<std::string> early() { return {"user.session.change_share=[0,0]", "user.session.duration_s=30"}; }

// Run until this tool is in the hand; false if that never happens.
bool run_until_held(Twin& twin, std::int32_t tool) {
  for (int i = 0; i < 30000; ++i) {
    twin.tick();
    if (twin.world->truth().tool == tool) return true;
  }
  return false;
}

TEST(SessionWorld, TheOverlayShowsTheNewToolWithItsFirstPose) {
  Twin twin(early(), 1, "session");
  std::int32_t newest = -1;
  double force = 0.0;
  bool hidden = false;
  ASSERT_TRUE(run_until_held(twin, -1));
  for (int i = 0; i < 4000; ++i) {
    twin.tick();
    if (twin.in.tool.health == Health::ok) newest = twin.in.tool.value.tool;
    hidden = hidden || twin.out.view.tool == -1;
    if (newest == 1) {
      EXPECT_EQ(twin.out.view.tool, 1);
    }
    if (twin.world->truth().phase == Phase::change) {
      force = std::max(force, twin.world->truth().contact_force.norm());
      EXPECT_EQ(twin.out.deflection, 0.0);
      EXPECT_NE(twin.out.mode, Mode::hold) << why_text(twin.out.why);
    }
  }
  EXPECT_EQ(newest, 1);
  EXPECT_TRUE(hidden);  // while none was in view
  EXPECT_LE(force, 0.2);
}

TEST(SessionWorld, TheToolLaidDownStaysWhereItIs) {
  Twin twin(early(), 2, "session");
  ASSERT_TRUE(run_until_held(twin, 1));
  const mjModel* model = twin.world->physics().model();
  const mjData* data = twin.world->physics().data();
  const int joint = model->body_jntadr[mj_name2id(model, mjOBJ_BODY, "tool")];
  const double* q = data->qpos + model->jnt_qposadr[joint];
  const Vec3 there(q[0], q[1], q[2]);
  EXPECT_LT((there - twin.setup.scene.user->session->tray).norm(), 2e-3);
  twin.run(2000);
  EXPECT_LT((Vec3(q[0], q[1], q[2]) - there).norm(), 1e-9);
  EXPECT_EQ(twin.world->truth().tool_radius, twin.setup.scene.tools[1].tip_radius);
}

TEST(SessionWorld, GoesOnFromTheMiddleOfAChangeToTheBit) {
  Twin twin(early(), 3, "session");
  ASSERT_TRUE(run_until_held(twin, -1));
  twin.run(300);
  const std::vector<std::byte> saved = twin.world->save();
  const Inputs in = twin.in;
  const State state = twin.state;
  const Outputs out = twin.out;
  const std::uint64_t first = hashed(twin, 4000);
  EXPECT_EQ(twin.world->truth().tool, 1);
  twin.world->restore(saved);
  twin.in = in;
  twin.state = state;
  twin.out = out;
  EXPECT_EQ(hashed(twin, 4000), first);
}

TEST(SessionWorld, IsTheSameForTheSameSeed) {
  Twin a({}, 5, "session"), b({}, 5, "session"), c({}, 6, "session");
  const std::uint64_t first = hashed(a, 5000);
  EXPECT_EQ(hashed(b, 5000), first);
  EXPECT_NE(hashed(c, 5000), first);
}

// The tracker takes the pressing tool for the second one: the tip must neither leap nor let go. The second
// tool's tip is 15 mm farther down the shaft, so it seems deep inside.
TEST(SessionWorld, AToolMistakenWhilePressingIsNotFelt) {
  Twin twin({"user.session.depth_mm=[4,4]", "user.session.press_mm_s=[4,4]", "user.session.hold_s=[3,3]",
             "truth.hand.aborted=0"},
            4, "session");
  while (twin.world->truth().phase != Phase::hold) twin.tick();
  twin.run(1000);  // the hand has settled
  ASSERT_EQ(twin.out.mode, Mode::contact);
  const double force = twin.world->truth().contact_force.norm();
  const double given = twin.out.deflection;
  EXPECT_GT(force, 3.0);
  bool switched = false;
  twin.disturb = [](Inputs& in) { in.tool.value.tool = 1; };
  for (int i = 0; i < 100; ++i) {
    twin.tick();
    switched = switched || twin.out.view.tool == 1;
    EXPECT_NEAR(twin.world->truth().contact_force.norm(), force, 0.2) << i;
    EXPECT_NEAR(twin.out.deflection, given, 0.1e-3) << i;
  }
  EXPECT_TRUE(switched);
  EXPECT_EQ(twin.out.contacts, 1);
}

// `encounter export SCENE world.xml` of each shipped scene: MuJoCo's own programs open it.

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> scenes;
  for (const auto& entry : fs::recursive_directory_iterator(tests::source_dir() + "/models/scenes"))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path().string());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

sim::ModelPtr compiled(const std::string& xml) {
  std::array<char, 500> why{};
  const sim::SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, why.data(), static_cast<int>(why.size())));
  EXPECT_TRUE(spec) << why.data();
  if (!spec) return {};
  sim::ModelPtr model(mj_compile(spec.get(), nullptr));
  EXPECT_TRUE(model) << mjs_getError(spec.get());
  return model;
}

TEST(ShippedExport, OpensInMujocoAsTheWorldThatItIs) {
  const std::vector<std::string> scenes = shipped_scenes();
  ASSERT_GE(scenes.size(), 28U);
  for (const std::string& path : scenes) {
    SCOPED_TRACE(path);
    const models::Setup setup = models::load(path, "");
    const Scene scene = trial::prepare_setup(setup);
    const auto world = trial::make_world(setup, scene, 1, true);
    const sim::ModelPtr opened = compiled(world->physics().xml());
    if (!opened) continue;
    const mjModel& built = *world->physics().model();
    EXPECT_EQ(opened->nbody, built.nbody);
    EXPECT_EQ(opened->njnt, built.njnt);
    EXPECT_EQ(opened->ngeom, built.ngeom);
    EXPECT_EQ(opened->nsensor, built.nsensor);
    EXPECT_EQ(opened->ntendon, built.ntendon);
    for (int i = 0; i < built.nbody && i < opened->nbody; ++i) {
      EXPECT_NEAR(opened->body_mass[i], built.body_mass[i], 1e-5 * built.body_mass[i]) << "body " << i;
      for (int k = 3 * i; k < 3 * i + 3; ++k)
        EXPECT_NEAR(opened->body_inertia[k], built.body_inertia[k], 1e-5 * built.body_inertia[k])
            << "body " << i;
    }
  }
}

}  // namespace
}  // namespace enc::sim
