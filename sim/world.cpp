#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/track/markers.h"
#include "sim/bodies/model.h"

namespace enc::sim {
namespace {

// The tool of the user; null without a user.
const ToolSpec* users_tool(const SceneSpec& scene) {
  if (!scene.user || scene.tools.empty()) return nullptr;
  return &scene.tools[static_cast<std::size_t>(held_tool(scene))];
}

std::vector<std::vector<Vec3>> markers_of(const std::vector<ToolSpec>& tools) {
  std::vector<std::vector<Vec3>> all;
  all.reserve(tools.size());
  for (const ToolSpec& tool : tools) all.push_back(tool.markers);
  return all;
}

// Vector from the tool's tip to the middle of its markers, in T.
Vec3 shaft_of(const ToolSpec& tool) { return middle_of(tool.markers) - tool.tip; }

// The person points the tool along the surface normal: tip towards the surface, markers away from it.
Quat pointed(const Vec3& shaft_T, const Vec3& normal) {
  return shaft_T.norm() > 1e-9 ? rotation_between(shaft_T, normal) : Quat::Identity();
}
Quat tool_orientation(const ToolSpec& tool, const Vec3& normal) { return pointed(shaft_of(tool), normal); }

// The grip's force on a tool is constant for a step, so a lighter tool diverges at once, whatever the
// integrator. A first-order step is at its limit at 4 m = 2 b h + k h^2.
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
  // A finger points back to its origin.
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

World::World(const WorldSpec& spec)
    : steps_(kMachines.of(spec.scene)),
      twin_(spec.twin),
      prepared_(spec.prepared),
      dt_(1.0 / spec.rig.loop.rate),
      steps_per_tick_(whole_steps(spec)),
      clamped_(spec.prepared.clamped_tool),
      X_WR_(steps_.base(spec.twin)),
      X_HF_(pose_of<'H', 'F'>(spec.twin.frames.H_F)),
      q_WT_(users_tool(spec.scene) == nullptr
                ? Quat::Identity()
                : tool_orientation(*users_tool(spec.scene),
                                   enc::press_point(spec.scene, *spec.scene.user).normal.e())),
      X_HT_(clamped_pose(clamped_tool(spec.scene))),
      user_(make_user(spec, users_tool(spec.scene))),
      physics_(model_of(spec, users_tool(spec.scene), user_, q_WT_, X_WR_)) {
  if (spec.scene.force) force.emplace(spec.twin.force, spec.seed);
  if (spec.scene.tracker && !spec.scene.camera)
    tracker.emplace(spec.twin.tracker, pose_of<'W', 'C'>(spec.twin.frames.W_C), spec.seed,
                    markers_of(spec.scene.tools));
  if (spec.scene.display) display.emplace(spec.twin.display, spec.prepared, spec.seed);
  if (user_) programme_time_ = user_->duration();
  if (spec.scene.gripper) gripper.emplace(spec.twin.gripper, spec.seed);
  if (spec.scene.hand_tracker)
    hand.emplace(spec.twin.hand_tracker,
                 pose_of<'W', 'S'>(spec.rig.frames.W_S) * Pose<'S', 'G'>::shift(0, 0, 0) *
                     pose_of<'G', 'L'>(spec.rig.frames.G_L),
                 spec.seed);
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
  } catch (const Error& e) {  // MuJoCo aborted this step
    diverged_at_ = next_.index;
    fatal_ = e.what();
  }
  if (!by_own_law()) truth_.contact_force = contact_force(truth_.touching);
  // After a step the bodies are at the poses of its last stage.
  if (arm) mj_kinematics(physics_.model(), physics_.data());
  if (step_work_) (this->*steps_.count_work)(h);
}

// The tool in the hand, whose mass measures the force that pushes it back.
Scale World::scale() const {
  if (!user_) return {};
  const std::int32_t held = user_->tool();
  for (const HeldTool& tool : tools_)
    if (tool.index == held) return {tool.qvel, physics_.model()->body_mass[tool.body], tool.radius};
  return {};
}

// The hand moves the tool that it holds; the second tool lies still.
void World::hold_tools(double t, double h) {
  mjData* d = physics_.data();
  const std::int32_t held = user_->tool();
  Point<'W'> at = user_->state().hand;  // the force on an empty hand is zero
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

// The tool tilts about its tip. Under load its markers move on after its tip has stopped.
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
  if (hand)
    hand->advance(
        t, in_hand_ == nullptr ? HandPlace{} : holding(truth_.tool_tip, pointing(), in_hand_->tip_T.norm()));
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

// ---- Save and restore: each part's plain state, in a fixed order, after its size.

namespace {

class Saver {
 public:
  template <class T>
  void put(const T& part) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&part, sizeof(T));
  }
  void put_bytes(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(from);
    const auto* length = reinterpret_cast<const std::byte*>(&size);
    bytes.insert(bytes.end(), length, length + sizeof(size));
    bytes.insert(bytes.end(), first, first + size);
  }
  std::vector<std::byte> bytes;
};

class Restorer {
 public:
  explicit Restorer(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T part;
    take_bytes(&part, sizeof(T));
    return part;
  }
  void take_bytes(void* to, std::size_t size) {
    std::size_t length = 0;
    if (at_ + sizeof(length) > bytes_.size()) throw Error("this saved world is cut short");
    std::memcpy(&length, bytes_.data() + at_, sizeof(length));
    at_ += sizeof(length);
    if (length != size || at_ + length > bytes_.size())
      throw Error("this saved world is of another scene or another build");
    std::memcpy(to, bytes_.data() + at_, length);
    at_ += length;
  }

  void end() const {
    if (at_ != bytes_.size()) throw Error("this saved world is of another scene or another build");
  }

 private:
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<std::byte> World::save() const {
  Saver saver;
  const std::vector<double> physics = physics_.save();
  saver.put_bytes(physics.data(), physics.size() * sizeof(double));
  if (machine) saver.put(machine->state());
  if (arm) saver.put(arm->state());
  if (force) saver.put(force->state());
  if (tracker) saver.put(tracker->state());
  if (display) saver.put(display->state());
  if (ball) saver.put(ball->state());
  if (pusher) saver.put(pusher->state());
  if (gripper) saver.put(gripper->state());
  if (hand) saver.put(hand->state());
  if (user_) saver.put(user_->state());
  saver.put(next_);
  saver.put(truth_);
  saver.put(diverged_at_);
  return saver.bytes;
}

void World::restore(const std::vector<std::byte>& saved) {
  Restorer from(saved);
  std::vector<double> physics = physics_.save();
  from.take_bytes(physics.data(), physics.size() * sizeof(double));
  if (machine) machine->restore(from.take<HexapodPlant::State>());
  if (arm) arm->restore(from.take<ArmPlant::State>());
  if (force) force->restore(from.take<ForcePlant::State>());
  if (tracker) tracker->restore(from.take<TrackerPlant::State>());
  if (display) display->restore(from.take<DisplayPlant::State>());
  if (ball) ball->restore(from.take<BallContact::State>());
  if (pusher) pusher->restore(from.take<Pusher::State>());
  if (gripper) gripper->restore(from.take<GripperPlant::State>());
  if (hand) hand->restore(from.take<HandPlant::State>());
  if (user_) user_->restore(from.take<User::State>());
  next_ = from.take<Tick>();
  truth_ = from.take<Truth>();
  diverged_at_ = from.take<std::int64_t>();
  from.end();
  fatal_.clear();
  physics_.restore(physics);
  if (arm) mj_kinematics(physics_.model(), physics_.data());  // the arm's pose determines the prop's
}

// ---- The roles of a simulated rig: small views of one world.

namespace {

class SimClock final : public Clock {
 public:
  explicit SimClock(World& world) : world_(world) {}
  Tick next() override { return world_.advance(); }

 private:
  World& world_;
};

class SimManipulator final : public Manipulator {
 public:
  SimManipulator(World& world, const HexapodTruth& truth) : world_(world), truth_(truth) {}
  [[nodiscard]] Reach reach() const override {
    return {truth_.speed, truth_.acceleration, world_.machine->machine()};
  }
  Measurement<TipSample> read(Time) noexcept override {
    const HexapodPlant::State& s = world_.machine->state();
    return {{s.pose, s.velocity, s.acceleration}, world_.truth().t, s.health};
  }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override { world_.machine->command(X_RH); }
  void stop() noexcept override { world_.machine->command(world_.machine->state().pose); }

 private:
  World& world_;
  HexapodTruth truth_;
};

class SimArm final : public HapticArm {
 public:
  SimArm(World& world, const ArmAbility& ability) : world_(world), ability_(ability) {}
  [[nodiscard]] ArmAbility ability() const override { return ability_; }
  Measurement<ArmSample> read(Time) noexcept override { return world_.arm->state().sample; }
  void command(const Vec<'R'>& force) noexcept override { world_.arm->command(force); }
  void stop() noexcept override {
    command(Vec<'R'>::zero());
    move_prop({});
  }
  void move_prop(const PropCommand& prop) noexcept override { world_.arm->move_prop(prop); }

 private:
  World& world_;
  ArmAbility ability_;
};

class SimForceSensor final : public ForceSensor {
 public:
  explicit SimForceSensor(World& world) : world_(world) {}
  Measurement<Wrench> read(Time) noexcept override { return world_.force->sample(); }

 private:
  World& world_;
};

class SimTracker final : public PoseTracker {
 public:
  explicit SimTracker(World& world) : world_(world) {}
  bool poll(Time, Measurement<TrackedTool>& newest) noexcept override { return world_.tracker->poll(newest); }

 private:
  World& world_;
};

class SimDisplay final : public Display {
 public:
  explicit SimDisplay(World& world) : world_(world) {}
  void show(const View& view) noexcept override { world_.display->show(view); }
  bool poll(Time, Measurement<DentSample>& newest) noexcept override { return world_.display->poll(newest); }

 private:
  World& world_;
};

class SimGripper final : public Gripper {
 public:
  explicit SimGripper(World& world) : world_(world) {}
  Measurement<GripSample> read(Time) noexcept override { return world_.gripper->sample(); }
  void command(const Grip& grip) noexcept override { world_.gripper->command(grip); }
  void stop() noexcept override {}  // without a command it keeps its state

 private:
  World& world_;
};

class SimHandTracker final : public HandTracker {
 public:
  explicit SimHandTracker(World& world) : world_(world) {}
  bool poll(Time, Measurement<HandSample>& newest) noexcept override { return world_.hand->poll(newest); }

 private:
  World& world_;
};

}  // namespace

Rig World::rig() {
  Rig rig;
  rig.clock = std::make_unique<SimClock>(*this);
  if (arm) rig.arm = std::make_unique<SimArm>(*this, arm_ability_);
  if (machine) rig.manipulator = std::make_unique<SimManipulator>(*this, twin_.hexapod);
  if (force) rig.force = std::make_unique<SimForceSensor>(*this);
  if (tracker) rig.tracker = std::make_unique<SimTracker>(*this);
  if (display) rig.display = std::make_unique<SimDisplay>(*this);
  if (gripper) rig.gripper = std::make_unique<SimGripper>(*this);
  if (hand) rig.hand_tracker = std::make_unique<SimHandTracker>(*this);
  return rig;
}

}  // namespace enc::sim
