// The parts of the world that differ from machine to machine. Arm: its torques, its prop and the observation
// of both. Hexapod: its placement or legs, the bodies that push its tip or are pushed by it, and the readings
// of its force sensor.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "sim/world.h"

namespace enc::sim {

// ---- an arm

namespace {

struct FacingSurface {
  std::size_t object = 0;
  Vec<'W'> normal;
};

// The surface that the prop represents: the one nearest to the finger.
FacingSurface nearest_surface(const Scene& scene, const Point<'W'>& p) {
  FacingSurface faced;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.least_distance(p) >= least) continue;
    const SurfacePoint at = object.surface.nearest(object.X_WO.inverse() * p);
    if (at.distance >= least) continue;
    least = at.distance;
    faced = {i, object.X_WO * at.normal};
  }
  return faced;
}

}  // namespace

Pose<'W', 'R'> arm_base(const ArmTruth& truth) {
  const Quat turned = rotation_xyz(truth.turned);
  return {turned, Vec3(truth.misplaced - turned * Arm(true_machine(truth)).tip({}).e())};
}

void World::set_up_arm(const WorldSpec& spec) {
  arm_ability_ = {spec.rig.arm.machine, spec.rig.arm.peak, spec.rig.arm.continuous};
  const Arm believed(spec.rig.arm.machine);
  arm.emplace(spec.twin.arm, believed, dt_);
  arm_body_.emplace(physics_, believed.joints());
  tip_geom_ = arm_body_->front();
  truth_.tip_radius = 0.0;  // its front is flat
  mj_kinematics(physics_.model(), physics_.data());
  truth_.tip = arm_body_->tip(physics_.data());
  if (user_) truth_.tool_tip = user_->start();
  face_prop(0.0);
}

// The gimbal of the prop keeps its front parallel to the commanded surface. Before the first command, the
// front faces the nearest surface.
void World::face_prop(double h) {
  mjModel* m = physics_.model();
  mjData* d = physics_.data();
  Vec3 running = Vec3::Zero();
  if (!prepared_.objects.empty()) {
    const bool told = twin_.arm.facing == PropFacing::told;
    const Vec<'R'>& wanted = arm->state().facing_wanted;
    const FacingSurface to =
        nearest_surface(prepared_, !told && truth_.tool_tip.finite() ? truth_.tool_tip : truth_.tip);
    const Object& object = prepared_.objects[to.object];
    const Vec<'W'> normal = told && wanted.finite() ? X_WR_ * wanted : to.normal;
    arm->face(normal.e(), h, next_.index == 0);
    running = arm->state().surface_speed * (object.X_WO.q() * object.interaction.way);
  }
  arm_body_->face(m, d, arm->facing(), running);
}

void World::drive_arm(double, double h) {
  mjData* d = physics_.data();
  face_prop(h);
  PerJoint torque = arm->state().torque;
  const PerJoint friction = arm->friction(arm_body_->rates(d));
  for (std::size_t i = 0; i < torque.size(); ++i) torque[i] += friction[i];
  arm_body_->drive(d, torque);
}

void World::begin_arm_work() { step_work_->begin(physics_, scale(), &*arm_body_, arm->state().torque); }

void World::count_arm_work(double h) {
  step_work_->count(physics_, *arm_body_, twin_.arm, arm->state().torque, arm->friction(step_work_->rates()),
                    h, truth_.work);
}

// Forces are those of the step's last stage, which is as good as the present time. Velocities are evaluated
// once more, as positions were after the step.
void World::observe_arm() {
  const mjModel* m = physics_.model();
  mjData* d = physics_.data();
  mj_comPos(m, d);
  mj_comVel(m, d);
  truth_.contact_force = contact_force(truth_.touching);
  truth_.tip = arm_body_->tip(d);
  truth_.tip_velocity = arm_body_->tip_velocity(m, d);
  truth_.joints = arm_body_->joints(d);
  truth_.motor_torque = arm->motor_torque();
  for (std::size_t i = 0; i < kMostJoints; ++i) truth_.warmth[i] = arm->warmth(i);
}

// ---- a hexapod

namespace {

BallContact probed_ball(const WorldSpec& spec) {
  const ObjectSpec& object = probed_object(spec.scene);
  if (object.shape != ShapeKind::sphere)
    throw Error("the simulated rig has a real ball and nothing else to press; expected shape = \"sphere\"",
                "object." + object.name + ".shape");
  constexpr double kDeepest = 8e-3;  // m: end of the plant's table
  if (spec.prepared.indentation()->depth > kDeepest)
    throw Error("the law of the simulated ball ends at 8 mm; lower depth_mm", "probe.depth");
  return {spec.twin.ball, Point<'W'>(object.position), object.radius, spec.prepared.tip_radius};
}

// MuJoCo reports the force of the parent on the child, in the site's axes; the sensor measures the force of
// the tip's side on the sensor: contact plus weight. The control form lacks inertia, because the platform is
// placed and not accelerated.
Wrench raw_wrench(const mjData* d) {
  return {Vec<'F'>(-d->sensordata[0], -d->sensordata[1], -d->sensordata[2]),
          Vec<'F'>(-d->sensordata[3], -d->sensordata[4], -d->sensordata[5])};
}

}  // namespace

Pose<'W', 'R'> hexapod_base(const HexapodTruth& truth) {
  const Hexapod hexapod(truth.geometry);
  const Quat turned = rotation_xyz(truth.turned);
  return {turned, Vec3(truth.misplaced - turned * hexapod.zero().p())};
}

void World::set_up_hexapod(const WorldSpec& spec) {
  machine.emplace(spec.twin.hexapod, spec.seed);
  if (spec.prepared.indentation()) ball.emplace(probed_ball(spec));
  if (spec.scene.pusher)
    pusher.emplace(*spec.scene.pusher, spec.twin.pusher, pushed_point(spec.scene, spec.prepared),
                   spec.prepared.tip_radius, spec.seed);
  if (pusher) programme_time_ = pusher->duration();
  if (const IndentationTask* probe = spec.prepared.indentation())
    programme_time_ = enc::programme_time(spec.prepared, *probe);
  if (spec.prepared.tracking()) programme_time_ = spec.prepared.tracking()->duration();
  const mjModel* m = physics_.model();
  const int platform = physics_.id(mjOBJ_JOINT, "platform");
  platform_qpos_ = m->jnt_qposadr[platform];
  platform_qvel_ = m->jnt_dofadr[platform];
  const int platform_body = physics_.id(mjOBJ_BODY, "platform");
  if (spec.twin.structural())
    legs.emplace(spec.twin.structure, machine->machine(), physics_, X_WR_);
  else
    physics_.data()->xfrc_applied[6 * platform_body + 2] =
        kStandardGravity * m->body_subtreemass[platform_body];  // it floats
  tip_geom_ = physics_.id(mjOBJ_GEOM, "haptic_tip");
  tip_body_ = m->geom_bodyid[tip_geom_];
  mass_behind_ = m->body_subtreemass[physics_.id(mjOBJ_BODY, "behind_sensor")];
  truth_.tip_radius = m->geom_size[3 * tip_geom_];
  place_machine(machine->true_pose());
  if (legs) legs->drive(physics_.data(), leg_motion(), leg_motion(), dt_);
}

// The platform's pose and velocity are prescribed. A mocap body would have no velocity: contacts with a tip
// that moved away at 1 mm/s were damped as if it stood still, and were lost for single steps.
void World::place_machine(const Pose<'R', 'H'>& from) {
  const HexapodPlant::State& to = machine->state();
  const Pose<'W', 'H'> X_WH = X_WR_ * from;
  mjData* d = physics_.data();
  std::copy_n(X_WH.xyz.begin(), 3, d->qpos + platform_qpos_);
  double* q = d->qpos + platform_qpos_ + 3;
  q[0] = X_WH.xyzw[3];
  std::copy_n(X_WH.xyzw.begin(), 3, q + 1);
  const Vec3 velocity = X_WR_.q() * to.velocity.e();
  const Vec3 turning = from.q().conjugate() * to.turning.e();  // MuJoCo stores it in the body's axes
  std::copy_n(velocity.data(), 3, d->qvel + platform_qvel_);
  std::copy_n(turning.data(), 3, d->qvel + platform_qvel_ + 3);
}

LegMotion World::leg_motion() const {
  return legs->at(machine->true_pose(), machine->state().velocity, machine->state().turning);
}

void World::move_hexapod(double t, double h) {
  const Pose<'W', 'H'> from = true_tip();
  work_from_ = from.origin();
  if (legs) {
    const LegMotion wanted = leg_motion();
    machine->move(h);
    legs->drive(physics_.data(), wanted, leg_motion(), h);
  } else {
    const Pose<'R', 'H'> placed = machine->true_pose();
    machine->move(h);
    place_machine(placed);
  }
  // The probe of the control form reaches the machine's new pose in this step; on legs it is where the
  // physics has it.
  if (by_own_law()) {
    const Point<'W'> to = legs ? from.origin() : X_WR_ * machine->true_pose().origin();
    ball ? press_ball(from, to, h) : push_tip(from, to, t, h);
  }
}

// The ball pushes at the probe's position after this step, so that force and pose of a tick belong together.
void World::press_ball(const Pose<'W', 'H'>& X_WH, const Point<'W'>& to, double h) {
  ball->move(to, h);
  const BallContact::State& pressed = ball->state();
  apply(pressed.force, pressed.touched, X_WH, to);
  truth_.penetration = pressed.penetration;
}

// The pusher acts on the tip at its position after this step, too.
void World::push_tip(const Pose<'W', 'H'>& X_WH, const Point<'W'>& to, double t, double h) {
  if (force && pusher->near(t, h, twin_.force.drift_ahead)) force->begin_push();
  const Vec<'W'> velocity(Vec3(Eigen::Map<const Vec3>(physics_.data()->qvel + platform_qvel_)));
  const Vec<'W'> pushed = pusher->act(t, h, to, velocity);
  apply(pushed, to + truth_.tip_radius * pusher->normal(), X_WH, to);
}

// Applies a force to the haptic-tip, whose centre reaches `to` in this step.
void World::apply(const Vec<'W'>& pushed, const Point<'W'>& touched, const Pose<'W', 'H'>& X_WH,
                  const Point<'W'>& to) {
  const mjModel* m = physics_.model();
  // MuJoCo takes force and torque at the body's centre of mass, which does not move before this step.
  const double* middle = m->body_ipos + 3 * tip_body_;
  const Point<'W'> centre = X_WH * Point<'H'>(middle[0], middle[1], middle[2]);
  const Vec3 shift = (to - X_WH.origin()).e();
  const Vec3 torque = ((touched - centre).e() - shift).cross(pushed.e());
  double* applied = physics_.data()->xfrc_applied + 6 * tip_body_;
  std::copy_n(pushed.xyz.begin(), 3, applied);
  std::copy_n(torque.data(), 3, applied + 3);
  truth_.contact_force = pushed;
  truth_.touching = pushed.norm() > 0.0;
}

void World::begin_hexapod_work() { step_work_->begin(physics_, scale(), nullptr, {}); }

void World::count_hexapod_work(double h) {
  const Vec3 way = (true_tip().origin() - work_from_).e();
  Work& work = truth_.work;
  work.contact += way.dot(by_own_law() ? Vec3(truth_.contact_force.e()) : step_work_->pushed(physics_, h));
  if (force) work.sensed += way.dot(felt_by_sensor().e());
}

// Control form: the tip is at the servo's pose. Structural form: the physics has its pose; the data after a
// step belong to its last stage, so everything is evaluated once more for the present time.
void World::observe_hexapod() {
  if (!legs) {
    truth_.tip = X_WR_ * machine->true_pose().origin();
    truth_.tip_velocity = X_WR_ * machine->state().velocity;
    truth_.tip_acceleration = X_WR_ * machine->state().acceleration;
    return;
  }
  mjData* d = physics_.data();
  mj_forward(physics_.model(), d);
  if (!by_own_law()) truth_.contact_force = contact_force(truth_.touching);
  truth_.tip = Point<'W'>(Vec3(Eigen::Map<const Vec3>(d->qpos + platform_qpos_)));
  truth_.tip_velocity = Vec<'W'>(Vec3(Eigen::Map<const Vec3>(d->qvel + platform_qvel_)));
  truth_.tip_acceleration = Vec<'W'>(Vec3(Eigen::Map<const Vec3>(d->qacc + platform_qvel_)));
  const Hexapod::Lengths forces = legs->forces(d);
  std::copy_n(forces.data(), 6, truth_.leg_force.begin());
}

Pose<'W', 'H'> World::true_tip() const {
  if (!legs) return X_WR_ * machine->true_pose();
  const double* q = physics_.data()->qpos + platform_qpos_;
  return {Quat(q[3], q[4], q[5], q[6]), Vec3(q[0], q[1], q[2])};
}

Vec<'W'> World::felt_by_sensor() const {
  const Vec<'W'> raw = true_tip() * (X_HF_ * raw_wrench(physics_.data()).force);
  const Vec<'W'> inertia = legs ? mass_behind_ * truth_.tip_acceleration : Vec<'W'>::zero();
  return raw + Vec<'W'>(0, 0, mass_behind_ * kStandardGravity) + inertia;
}

void World::measure_force(Time t) {
  const Pose<'R', 'F'> X_RF = machine->true_pose() * X_HF_;
  const Vec<'F'> inertia =
      legs ? Vec<'F'>::zero() : X_RF.inverse() * (mass_behind_ * machine->state().acceleration);
  force->measure(t, dt_, raw_wrench(physics_.data()), inertia);
}

const PerMachine<MachineSteps> World::kMachines{
    .hexapod = {.base = [](const TwinSpec& twin) { return hexapod_base(twin.hexapod); },
                .set_up = &World::set_up_hexapod,
                .begin_cycle = [](World& world) { world.machine->begin_cycle(); },
                .drive = &World::move_hexapod,
                .begin_work = &World::begin_hexapod_work,
                .count_work = &World::count_hexapod_work,
                .observe = &World::observe_hexapod},
    .arm = {.base = [](const TwinSpec& twin) { return arm_base(twin.arm); },
            .set_up = &World::set_up_arm,
            .begin_cycle = [](World& world) { world.arm->begin_cycle(); },
            .drive = &World::drive_arm,
            .begin_work = &World::begin_arm_work,
            .count_work = &World::count_arm_work,
            .observe = &World::observe_arm}};

}  // namespace enc::sim
