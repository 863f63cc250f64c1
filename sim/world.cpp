#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "sim/model.h"

namespace enc::sim {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2; MuJoCo's own is set to it

const ToolSpec* held_tool(const SceneSpec& scene) {
  if (!scene.user || scene.tools.empty()) return nullptr;
  const auto named = std::find_if(scene.tools.begin(), scene.tools.end(),
                                  [&](const ToolSpec& t) { return t.name == scene.user->tool; });
  return named == scene.tools.end() ? &scene.tools.front() : &*named;
}

// From the tool's tip to the middle of its markers, in T.
Vec3 shaft_of(const ToolSpec& tool) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& marker : tool.markers) middle += marker / static_cast<double>(tool.markers.size());
  return middle - tool.tip;
}

// The person points the tool along the surface normal: tip towards the surface, markers away from it.
Quat pointed(const Vec3& shaft_T, const Vec3& normal) {
  return shaft_T.norm() > 1e-9 ? Quat::FromTwoVectors(shaft_T, normal) : Quat::Identity();
}
Quat tool_orientation(const ToolSpec& tool, const Vec3& normal) { return pointed(shaft_of(tool), normal); }

std::optional<User> make_user(const WorldSpec& spec, const ToolSpec* tool) {
  if (tool == nullptr) return std::nullopt;
  return User(spec.scene, spec.prepared, spec.twin.hand, spec.seed);
}

// Built so that H would be W at the machine's zero, then put wrong: about W, so that a turn alone moves
// nothing there.
Pose<'W', 'R'> true_base(const WorldSpec& spec) {
  const Hexapod machine(spec.twin.hexapod.geometry);
  const Quat turned = rotation_xyz(spec.twin.hexapod.turned);
  return {turned, Vec3(spec.twin.hexapod.misplaced - turned * machine.zero().p())};
}

// A clamped tool stands on the haptic-tip: its tip at H, its shaft along z.
Pose<'H', 'T'> clamped_pose(const ToolSpec* tool) {
  if (tool == nullptr) return Pose<'H', 'T'>::identity();
  const Quat q = tool_orientation(*tool, Vec3::UnitZ());
  return {q, Vec3(-(q * tool->tip))};
}

BallContact probed_ball(const WorldSpec& spec) {
  const ObjectSpec& object = probed_object(spec.scene);
  if (object.shape != ShapeKind::sphere)
    throw Error("the simulated rig has a real ball and nothing else to press; expected shape = \"sphere\"",
                "object." + object.name + ".shape");
  constexpr double kDeepest = 8e-3;  // m: the end of the plant's table
  if (spec.prepared.probe->depth > kDeepest)
    throw Error("the law of the simulated ball ends at 8 mm; lower depth_mm", "probe.depth");
  return {spec.twin.ball, Point<'W'>(object.position), object.radius, spec.prepared.tip_radius};
}

SpecPtr model_of(const WorldSpec& spec, const ToolSpec* tool, std::int32_t other, const Quat& q_WT,
                 const Pose<'W', 'R'>& X_WR) {
  const ToolSpec* clamped = clamped_tool(spec.scene);
  return build_model({spec.scene, spec.prepared, spec.twin, tool, q_WT, clamped, clamped_pose(clamped), X_WR,
                      spec.mjcf_dir, spec.draw_all,
                      other < 0 ? nullptr : &spec.scene.tools[static_cast<std::size_t>(other)]});
}

int whole_steps(const WorldSpec& spec) {
  const int steps = spec.twin.steps_per_tick(spec.rig.loop.rate);
  if (steps == 0)
    throw Error("the physics time step must divide the haptic period",
                spec.twin.structural() ? "truth.structure.timestep" : "truth.world.timestep");
  return steps;
}

}  // namespace

World::World(const WorldSpec& spec)
    : machine(spec.twin.hexapod, spec.seed),
      twin_(spec.twin),
      dt_(1.0 / spec.rig.loop.rate),
      steps_per_tick_(whole_steps(spec)),
      clamped_(spec.prepared.clamped_tool),
      X_WR_(true_base(spec)),
      X_HF_(pose_of<'H', 'F'>(spec.twin.frames.H_F)),
      q_WT_(held_tool(spec.scene) == nullptr
                ? Quat::Identity()
                : tool_orientation(*held_tool(spec.scene),
                                   enc::press_point(spec.scene, *spec.scene.user).normal.e())),
      X_HT_(clamped_pose(clamped_tool(spec.scene))),
      user_(make_user(spec, held_tool(spec.scene))),
      physics_(model_of(spec, held_tool(spec.scene), user_ ? user_->other_tool() : -1, q_WT_, X_WR_)) {
  if (spec.scene.force) force.emplace(spec.twin.force, spec.seed);
  if (spec.scene.tracker)
    tracker.emplace(spec.twin.tracker, pose_of<'W', 'C'>(spec.twin.frames.W_C), spec.seed);
  if (spec.scene.display) display.emplace(spec.twin.display, spec.prepared, spec.seed);
  if (spec.prepared.probe) ball.emplace(probed_ball(spec));
  if (spec.scene.pusher)
    pusher.emplace(*spec.scene.pusher, spec.twin.pusher, pushed_point(spec.scene, spec.prepared),
                   spec.prepared.tip_radius, spec.seed);
  if (user_) programme_time_ = user_->duration();
  if (pusher) programme_time_ = pusher->duration();
  if (ball) programme_time_ = enc::programme_time(spec.prepared);
  if (spec.prepared.travel) programme_time_ = spec.prepared.travel->duration();
  if (spec.scene.gripper) gripper.emplace(spec.twin.gripper, spec.seed);
  const mjModel* m = physics_.model();
  const int platform = physics_.id(mjOBJ_JOINT, "platform");
  platform_qpos_ = m->jnt_qposadr[platform];
  platform_qvel_ = m->jnt_dofadr[platform];
  const int platform_body = physics_.id(mjOBJ_BODY, "platform");
  if (spec.twin.structural())
    legs.emplace(spec.twin.structure, machine.machine(), physics_, X_WR_);
  else
    physics_.data()->xfrc_applied[6 * platform_body + 2] =
        kGravity * m->body_subtreemass[platform_body];  // it floats
  tip_geom_ = physics_.id(mjOBJ_GEOM, "haptic_tip");
  tip_body_ = m->geom_bodyid[tip_geom_];
  mass_behind_ = m->body_subtreemass[physics_.id(mjOBJ_BODY, "behind_sensor")];
  next_.dt = from_seconds(dt_);
  truth_.tip_radius = m->geom_size[3 * tip_geom_];
  if (user_) find_tools(spec.scene);
  place_machine(machine.true_pose());
  if (legs) legs->drive(physics_.data(), leg_motion(), leg_motion(), dt_);
  mj_forward(physics_.model(), physics_.data());
  observe(next_.t);
}

void World::find_tools(const SceneSpec& scene) {
  const mjModel* m = physics_.model();
  const auto find = [&](std::int32_t index, const char* name, const Point<'W'>& at) {
    const ToolSpec& tool = scene.tools[static_cast<std::size_t>(index)];
    Held held{index, physics_.id(mjOBJ_BODY, name), 0, 0, tool.tip, shaft_of(tool), tool.tip_radius};
    held.qpos = m->jnt_qposadr[m->body_jntadr[held.body]];
    held.qvel = m->jnt_dofadr[m->body_jntadr[held.body]];
    std::copy_n(at.xyz.begin(), 3, physics_.data()->qpos + held.qpos);
    tools_.push_back(held);
  };
  find(user_->tool(), "tool", user_->start());
  if (user_->other_tool() >= 0) find(user_->other_tool(), "other_tool", user_->spot(1));
  truth_.tool_radius = tools_.front().radius;
}

// The platform's pose and velocity are prescribed. Not a mocap body: that has no velocity, so a contact with
// a tip that moves away at 1 mm/s was damped as if the tip stood still, and was lost for single steps.
void World::place_machine(const Pose<'R', 'H'>& from) {
  const HexapodPlant::State& to = machine.state();
  const Pose<'W', 'H'> X_WH = X_WR_ * from;
  mjData* d = physics_.data();
  std::copy_n(X_WH.xyz.begin(), 3, d->qpos + platform_qpos_);
  double* q = d->qpos + platform_qpos_ + 3;
  q[0] = X_WH.xyzw[3];
  std::copy_n(X_WH.xyzw.begin(), 3, q + 1);
  const Vec3 velocity = X_WR_.q() * to.velocity.e();
  const Vec3 turning = from.q().conjugate() * to.turning.e();  // MuJoCo wants it in the body's axes
  std::copy_n(velocity.data(), 3, d->qvel + platform_qvel_);
  std::copy_n(turning.data(), 3, d->qvel + platform_qvel_ + 3);
}

LegMotion World::leg_motion() const {
  return legs->at(machine.true_pose(), machine.state().velocity, machine.state().turning);
}

void World::physics_step(double t) {
  const double h = physics_.model()->opt.timestep;
  mjData* d = physics_.data();
  if (user_) hold_tools(t, h);
  const Pose<'W', 'H'> from = true_tip();
  if (legs) {
    const LegMotion wanted = leg_motion();
    machine.move(h);
    legs->drive(d, wanted, leg_motion(), h);
  } else {
    const Pose<'R', 'H'> placed = machine.true_pose();
    machine.move(h);
    place_machine(placed);
  }
  // Placed, the probe gets to the machine's new pose in this step; carried by legs it is where physics has
  // it.
  if (by_own_law()) {
    const Point<'W'> to = legs ? from.origin() : X_WR_ * machine.true_pose().origin();
    ball ? press_ball(from, to, h) : push_tip(from, to, t, h);
  }
  try {
    if (!physics_.step() && diverged_at_ < 0) diverged_at_ = next_.index;
  } catch (const Error& e) {  // MuJoCo gave up on this step
    diverged_at_ = next_.index;
    fatal_ = e.what();
  }
  if (!by_own_law()) truth_.contact_force = contact_force(truth_.touching);
}

// The hand carries the tool that it holds; the other one lies still.
void World::hold_tools(double t, double h) {
  mjData* d = physics_.data();
  const std::int32_t held = user_->tool();
  Point<'W'> at = user_->state().hand;  // an empty hand feels nothing
  Vec<'W'> moving = user_->state().hand_velocity;
  for (const Held& tool : tools_) {
    if (tool.index != held) continue;
    const double* q = d->qpos + tool.qpos;
    const double* v = d->qvel + tool.qvel;
    at = Point<'W'>(q[0], q[1], q[2]);
    moving = Vec<'W'>(v[0], v[1], v[2]);
  }
  truth_.hand_force = user_->act(t, h, at, moving, truth_.touching);
  for (const Held& tool : tools_) {
    double* applied = d->xfrc_applied + 6 * tool.body;
    const bool carried = tool.index == held;
    for (std::size_t i = 0; i < 3; ++i) applied[i] = carried ? truth_.hand_force.xyz[i] : 0.0;
    applied[2] += kGravity * physics_.model()->body_mass[tool.body];
    if (!carried) std::fill_n(d->qvel + tool.qvel, 3, 0.0);
  }
}

// The ball pushes where the probe gets to in this step, so that force and pose of a tick belong together.
void World::press_ball(const Pose<'W', 'H'>& X_WH, const Point<'W'>& to, double h) {
  ball->move(to, h);
  const BallContact::State& pressed = ball->state();
  apply(pressed.force, pressed.touched, X_WH, to);
  truth_.penetration = pressed.penetration;
}

// Likewise what pushes from outside.
void World::push_tip(const Pose<'W', 'H'>& X_WH, const Point<'W'>& to, double t, double h) {
  if (force && pusher->near(t, h, twin_.force.drift_ahead)) force->begin_push();
  const Vec<'W'> velocity(Vec3(Eigen::Map<const Vec3>(physics_.data()->qvel + platform_qvel_)));
  const Vec<'W'> pushed = pusher->act(t, h, to, velocity);
  apply(pushed, to + truth_.tip_radius * pusher->normal(), X_WH, to);
}

// A force on the haptic-tip, whose centre gets to `to` in this step.
void World::apply(const Vec<'W'>& pushed, const Point<'W'>& touched, const Pose<'W', 'H'>& X_WH,
                  const Point<'W'>& to) {
  const mjModel* m = physics_.model();
  // MuJoCo wants force and torque at the body's centre of mass, which in this step is still where it was.
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

Vec<'W'> World::contact_force(bool& touching) const {
  const mjModel* m = physics_.model();
  const mjData* d = physics_.data();
  Vec3 total = Vec3::Zero();
  touching = false;
  for (int i = 0; i < d->ncon; ++i) {
    const mjContact& contact = d->contact[i];
    if (contact.efc_address < 0) continue;
    double local[6];
    mj_contactForce(m, d, i, local);
    // Rows of the frame are its axes in the world; the force is on geom[1].
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(contact.frame);
    const Vec3 pushed = axes.transpose() * Vec3(local[0], local[1], local[2]);
    total += contact.geom[1] == tip_geom_ ? pushed : Vec3(-pushed);
    touching = touching || local[0] > 0.0;
  }
  return Vec<'W'>(total);
}

// Control form: where the servo put it. Structural form: where the physics has it; what a step leaves behind
// belongs to its last stage, so all is evaluated once more at this very time.
void World::observe_machine() {
  if (!legs) {
    truth_.tip = X_WR_ * machine.true_pose().origin();
    truth_.tip_velocity = X_WR_ * machine.state().velocity;
    truth_.tip_acceleration = X_WR_ * machine.state().acceleration;
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
  if (!legs) return X_WR_ * machine.true_pose();
  const double* q = physics_.data()->qpos + platform_qpos_;
  return {Quat(q[3], q[4], q[5], q[6]), Vec3(q[0], q[1], q[2])};
}

void World::observe(Time t) {
  truth_.t = t;
  observe_machine();
  if (pusher) {
    truth_.press = pusher->state().push;
    truth_.phase = pusher->state().phase;
  }
  if (!user_) return;
  truth_.press = user_->press();
  truth_.phase = user_->phase();
  truth_.approach_speed = user_->approach_speed();
  truth_.aborted = user_->aborted();
  truth_.tool = user_->tool();
  truth_.tool_tip = user_->state().hand;
  truth_.tool_velocity = user_->state().hand_velocity;
  const auto in_hand =
      std::find_if(tools_.begin(), tools_.end(), [&](const Held& tool) { return tool.index == truth_.tool; });
  in_hand_ = in_hand == tools_.end() ? nullptr : &*in_hand;
  if (in_hand_ == nullptr) return;
  const double* q = physics_.data()->qpos + in_hand_->qpos;
  const double* v = physics_.data()->qvel + in_hand_->qvel;
  truth_.tool_tip = Point<'W'>(q[0], q[1], q[2]) + twin_.contact.compliance * truth_.contact_force;
  truth_.tool_velocity = Vec<'W'>(v[0], v[1], v[2]);
  truth_.tool_radius = in_hand_->radius;
  if (user_->turns()) q_WT_ = pointed(in_hand_->shaft_T, user_->shaft(seconds(t.time_since_epoch())).e());
}

// The tool tilts about its tip. Under load its markers go on where its tip stops.
Pose<'W', 'T'> World::held_tool_pose(double t) const {
  const Vec3 tip_T = in_hand_ != nullptr ? in_hand_->tip_T : Vec3(Vec3::Zero());
  Quat q = q_WT_;
  if (twin_.hand.tilt != 0.0) {
    const double angle = twin_.hand.tilt * std::sin(2.0 * M_PI * twin_.hand.tilt_rate * t);
    q = Quat(Eigen::AngleAxisd(angle, (q_WT_ * tip_T).unitOrthogonal())) * q_WT_;
  }
  const Vec3 bent = twin_.contact.flexure * truth_.contact_force.e();
  return {q, Vec3(truth_.tool_tip.e() - q * tip_T + bent)};
}

void World::sense(Time t) {
  const mjData* d = physics_.data();
  if (force) {
    // MuJoCo gives what the parent puts on the child, in the site's axes; we want what the tip's side puts on
    // the sensor: contact plus weight. In the control form inertia is missing, because the platform is placed
    // and not accelerated.
    const Pose<'R', 'F'> X_RF = machine.true_pose() * X_HF_;
    const Vec<'F'> inertia =
        legs ? Vec<'F'>::zero() : X_RF.inverse() * (mass_behind_ * machine.state().acceleration);
    const Wrench raw{Vec<'F'>(-d->sensordata[0], -d->sensordata[1], -d->sensordata[2]),
                     Vec<'F'>(-d->sensordata[3], -d->sensordata[4], -d->sensordata[5])};
    force->measure(t, dt_, raw, inertia);
  }
  if (tracker && user_) {
    tracker->advance(t, truth_.tool, held_tool_pose(seconds(t.time_since_epoch())));
  } else if (tracker && clamped_ >= 0) {
    tracker->advance(t, clamped_, true_tip() * X_HT_);
  }
  if (gripper) gripper->advance(t, dt_);
  if (display) display->advance(t);
}

Tick World::advance() {
  const Tick tick = next_;
  if (tick.index > 0) {
    machine.begin_cycle();
    const double from = seconds((tick.t - tick.dt).time_since_epoch());
    for (int i = 0; i < steps_per_tick_; ++i) physics_step(from + i * physics_.model()->opt.timestep);
  }
  observe(tick.t);
  sense(tick.t);
  ++next_.index;
  next_.t = Time(Duration(next_.index * next_.dt.count()));
  return tick;
}

}  // namespace enc::sim
