#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/track/markers.h"
#include "sim/bodies/model.h"

namespace enc::sim {
namespace {

const ToolSpec* held_tool(const SceneSpec& scene) {
  if (!scene.user || scene.tools.empty()) return nullptr;
  const auto named = std::find_if(scene.tools.begin(), scene.tools.end(),
                                  [&](const ToolSpec& t) { return t.name == scene.user->tool; });
  return named == scene.tools.end() ? &scene.tools.front() : &*named;
}

std::vector<std::vector<Vec3>> markers_of(const std::vector<ToolSpec>& tools) {
  std::vector<std::vector<Vec3>> all;
  all.reserve(tools.size());
  for (const ToolSpec& tool : tools) all.push_back(tool.markers);
  return all;
}

// From the tool's tip to the middle of its markers, in T.
Vec3 shaft_of(const ToolSpec& tool) { return middle_of(tool.markers) - tool.tip; }

// The person points the tool along the surface normal: tip towards the surface, markers away from it.
Quat pointed(const Vec3& shaft_T, const Vec3& normal) {
  return shaft_T.norm() > 1e-9 ? rotation_between(shaft_T, normal) : Quat::Identity();
}
Quat tool_orientation(const ToolSpec& tool, const Vec3& normal) { return pointed(shaft_of(tool), normal); }

// The hand's grip holds a tool by a force that stays for a step: on a lighter one it diverges at once,
// whatever the integrator. A first-order step is at its limit where 4 m = 2 b h + k h^2.
void check_weight(const WorldSpec& spec, const ToolSpec& tool) {
  const double h = spec.twin.stepping(spec.scene).timestep;
  const double least = h * (2.0 * spec.twin.hand.grip_damping + h * spec.twin.hand.grip_stiffness) / 4.0;
  if (tool.mass > least) return;
  throw Error(
      fmt::format("tool '{}' weighs {:g} kg, which the simulated hand cannot hold at a time step of {:g} "
                  "us; expected more than {:.2g} kg; make it heavier, or the step shorter",
                  tool.name, tool.mass, 1e6 * h, least),
      "tool." + tool.name + ".mass");
}

std::optional<User> make_user(const WorldSpec& spec, const ToolSpec* tool) {
  if (tool == nullptr) return std::nullopt;
  for (const ToolSpec& one : spec.scene.tools) check_weight(spec, one);
  return User(spec.scene, spec.prepared, spec.twin.hand, spec.seed);
}

// A clamped tool stands on the haptic-tip: its tip at H, its shaft along z.
Pose<'H', 'T'> clamped_pose(const ToolSpec* tool) {
  if (tool == nullptr) return Pose<'H', 'T'>::identity();
  const Quat q = tool_orientation(*tool, Vec3::UnitZ());
  return {q, Vec3(-(q * tool->tip))};
}

SpecPtr model_of(const WorldSpec& spec, const ToolSpec* tool, const std::optional<User>& user,
                 const Quat& q_WT, const Pose<'W', 'R'>& X_WR) {
  const ToolSpec* clamped = clamped_tool(spec.scene);
  const std::int32_t other = user ? user->other_tool() : -1;
  // A finger points to where it comes from.
  const Vec3 finger =
      user ? (user->start() - enc::press_point(spec.scene, *spec.scene.user).point).e().normalized()
           : Vec3(Vec3::UnitZ());
  return build_model({spec.scene, spec.prepared, spec.twin, tool, q_WT, clamped, clamped_pose(clamped), X_WR,
                      spec.mjcf_dir, spec.draw_all,
                      other < 0 ? nullptr : &spec.scene.tools[static_cast<std::size_t>(other)], finger});
}

int whole_steps(const WorldSpec& spec) {
  const Stepping stepping = spec.twin.stepping(spec.scene);
  const int steps = stepping.steps_per_tick(spec.rig.loop.rate);
  if (steps == 0)
    throw Error("the physics time step does not divide the haptic period; expected a whole share of it",
                stepping.table + ".timestep");
  return steps;
}

}  // namespace

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

World::World(const WorldSpec& spec)
    : steps_(kMachines.of(spec.scene)),
      twin_(spec.twin),
      prepared_(spec.prepared),
      dt_(1.0 / spec.rig.loop.rate),
      steps_per_tick_(whole_steps(spec)),
      clamped_(spec.prepared.clamped_tool),
      X_WR_(steps_.base(spec.twin)),
      X_HF_(pose_of<'H', 'F'>(spec.twin.frames.H_F)),
      q_WT_(held_tool(spec.scene) == nullptr
                ? Quat::Identity()
                : tool_orientation(*held_tool(spec.scene),
                                   enc::press_point(spec.scene, *spec.scene.user).normal.e())),
      X_HT_(clamped_pose(clamped_tool(spec.scene))),
      user_(make_user(spec, held_tool(spec.scene))),
      physics_(model_of(spec, held_tool(spec.scene), user_, q_WT_, X_WR_)) {
  if (spec.scene.force) force.emplace(spec.twin.force, spec.seed);
  if (spec.scene.tracker && !spec.scene.camera)
    tracker.emplace(spec.twin.tracker, pose_of<'W', 'C'>(spec.twin.frames.W_C), spec.seed,
                    markers_of(spec.scene.tools));
  if (spec.scene.display) display.emplace(spec.twin.display, spec.prepared, spec.seed);
  if (user_) programme_time_ = user_->duration();
  if (spec.scene.gripper) gripper.emplace(spec.twin.gripper, spec.seed);
  next_.dt = from_seconds(dt_);
  if (user_) find_tools(spec.scene);
  (this->*steps_.set_up)(spec);
  mj_forward(physics_.model(), physics_.data());
  observe(next_.t);
}

void World::find_tools(const SceneSpec& scene) {
  const mjModel* m = physics_.model();
  const auto find = [&](std::int32_t index, const char* name, const Point<'W'>& at) {
    const ToolSpec& tool = scene.tools[static_cast<std::size_t>(index)];
    HeldTool held{index, physics_.id(mjOBJ_BODY, name), 0, 0, tool.tip, shaft_of(tool), tool.tip_radius};
    held.qpos = m->jnt_qposadr[m->body_jntadr[held.body]];
    held.qvel = m->jnt_dofadr[m->body_jntadr[held.body]];
    std::copy_n(at.xyz.begin(), 3, physics_.data()->qpos + held.qpos);
    tools_.push_back(held);
  };
  find(user_->tool(), "tool", user_->start());
  if (user_->other_tool() >= 0) find(user_->other_tool(), "other_tool", user_->spot(1));
  truth_.tool_radius = tools_.front().radius;
}

void World::physics_step(double t) {
  const double h = physics_.model()->opt.timestep;
  if (user_) hold_tools(t, h);
  (this->*steps_.drive)(t, h);
  try {
    if (step_work_) (this->*steps_.begin_work)();
    if (!physics_.step() && diverged_at_ < 0) diverged_at_ = next_.index;
  } catch (const Error& e) {  // MuJoCo gave up on this step
    diverged_at_ = next_.index;
    fatal_ = e.what();
  }
  if (!by_own_law()) truth_.contact_force = contact_force(truth_.touching);
  // A step leaves the bodies where its last stage had them.
  if (arm) mj_kinematics(physics_.model(), physics_.data());
  if (step_work_) (this->*steps_.count_work)(h);
}

// The tool in the hand, which weighs what pushes it back.
Scale World::scale() const {
  if (!user_) return {};
  const std::int32_t held = user_->tool();
  for (const HeldTool& tool : tools_)
    if (tool.index == held) return {tool.qvel, physics_.model()->body_mass[tool.body], tool.radius};
  return {};
}

// The hand carries the tool that it holds; the other one lies still.
void World::hold_tools(double t, double h) {
  mjData* d = physics_.data();
  const std::int32_t held = user_->tool();
  Point<'W'> at = user_->state().hand;  // an empty hand feels nothing
  Vec<'W'> moving = user_->state().hand_velocity;
  for (const HeldTool& tool : tools_) {
    if (tool.index != held) continue;
    const double* q = d->qpos + tool.qpos;
    const double* v = d->qvel + tool.qvel;
    at = Point<'W'>(q[0], q[1], q[2]);
    moving = Vec<'W'>(v[0], v[1], v[2]);
  }
  truth_.hand_force = user_->act(t, h, at, moving, truth_.touching);
  for (const HeldTool& tool : tools_) {
    double* applied = d->qfrc_applied + tool.qvel;  // its slides are the axes of W
    const bool carried = tool.index == held;
    for (std::size_t i = 0; i < 3; ++i) applied[i] = carried ? truth_.hand_force.xyz[i] : 0.0;
    applied[2] += kStandardGravity * physics_.model()->body_mass[tool.body];
    if (!carried) std::fill_n(d->qvel + tool.qvel, 3, 0.0);
  }
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

void World::observe(Time t) {
  truth_.t = t;
  (this->*steps_.observe)();
  if (pusher) {
    truth_.press = pusher->state().push;
    truth_.phase = pusher->state().phase;
  }
  if (!user_) return;
  truth_.press = user_->press();
  truth_.phase = user_->phase();
  truth_.aim = user_->object();
  truth_.approach_speed = user_->approach_speed();
  truth_.aborted = user_->aborted();
  truth_.tool = user_->tool();
  truth_.tool_tip = user_->state().hand;
  truth_.tool_velocity = user_->state().hand_velocity;
  const auto in_hand = std::find_if(tools_.begin(), tools_.end(),
                                    [&](const HeldTool& tool) { return tool.index == truth_.tool; });
  in_hand_ = in_hand == tools_.end() ? nullptr : &*in_hand;
  if (in_hand_ == nullptr) return;
  const double* q = physics_.data()->qpos + in_hand_->qpos;
  const double* v = physics_.data()->qvel + in_hand_->qvel;
  truth_.tool_tip = Point<'W'>(q[0], q[1], q[2]) + twin_.contact.compliance * truth_.contact_force;
  truth_.tool_velocity = Vec<'W'>(v[0], v[1], v[2]);
  truth_.tool_radius = in_hand_->radius;
  if (user_->turns()) q_WT_ = pointed(in_hand_->shaft_T, user_->shaft(seconds(t.time_since_epoch())).e());
}

void World::steer(const Point<'W'>& place) {
  if (user_) user_->steer(place, truth_.tool_tip);
}

void World::change_tool() {
  if (user_) user_->change_tool(truth_.tool_tip);
}

Vec<'W'> World::pointing() const {
  if (!user_) return Vec<'W'>(0, 0, -1);
  return Vec<'W'>(Vec3(-user_->shaft(seconds(truth_.t.time_since_epoch())).e().normalized()));
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
  if (arm) arm->measure(t, arm_body_->joints(physics_.data()));
  if (force) measure_force(t);
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
    steps_.begin_cycle(*this);
    truth_.work = Work{};
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
