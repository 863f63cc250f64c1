// The twin: one MuJoCo world with the plants of a scene's devices. It owns time; the roles are views of it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/devices/rig.h"
#include "sim/bodies/arm_model.h"
#include "sim/bodies/ball_plant.h"
#include "sim/bodies/legs.h"
#include "sim/bodies/mujoco.h"
#include "sim/bodies/pusher.h"
#include "sim/bodies/step_work.h"
#include "sim/hand/user.h"
#include "sim/plants/arm_plant.h"
#include "sim/plants/device_plants.h"
#include "sim/plants/hand_plant.h"
#include "sim/plants/hexapod_plant.h"
#include "sim/plants/tracker_plant.h"
#include "sim/truth/truth.h"
#include "sim/world_spec.h"

namespace enc::sim {

class World {
 public:
  explicit World(const WorldSpec& spec);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // The devices that the scene names. The rig must not outlive the world.
  [[nodiscard]] Rig rig();
  // Advances to the next tick: n physics steps under the last command.
  Tick advance();

  [[nodiscard]] const Truth& truth() const { return truth_; }
  void steer(const Point<'W'>& place);  // see User; ignored without a hand, as is change_tool()
  void change_tool();
  [[nodiscard]] bool user_done() const { return !user_ || user_->done(); }
  [[nodiscard]] double programme_time() const { return programme_time_; }  // s
  // Tick after which the physics is unreliable, -1 while it is sound; and MuJoCo's own message.
  [[nodiscard]] std::int64_t diverged_at() const { return diverged_at_; }
  [[nodiscard]] std::string divergence() const { return fatal_.empty() ? physics_.warning_text() : fatal_; }
  [[nodiscard]] Physics& physics() { return physics_; }
  [[nodiscard]] const Pose<'W', 'R'>& X_WR() const { return X_WR_; }
  [[nodiscard]] const Quat& q_WT() const { return q_WT_; }  // held tool, true
  [[nodiscard]] Vec<'W'> pointing() const;  // unit, hand's finger or tool; down without a user
  // All moving state: physics, plants, queues, random streams.
  [[nodiscard]] std::vector<std::byte> save() const;
  void restore(const std::vector<std::byte>& saved);
  void ask_for_work() { step_work_.emplace(); }  // truth includes work from the next step on

  std::optional<HexapodPlant> machine;  // set if the scene has no arm
  std::optional<ArmPlant> arm;
  std::optional<ForcePlant> force;
  std::optional<TrackerPlant> tracker;
  std::optional<DisplayPlant> display;
  std::optional<BallContact> ball;  // set if the scene presses one with a probe
  std::optional<Pusher> pusher;
  std::optional<GripperPlant> gripper;
  std::optional<HandPlant> hand;
  std::optional<Legs> legs;  // structural form only

 private:
  static const PerMachine<MachineSteps> kMachines;
  void physics_step(double t);
  void find_tools(const SceneSpec& scene);
  void hold_tools(double t, double h);
  void set_up_hexapod(const WorldSpec& spec);  // world_machines.cpp
  void move_hexapod(double t, double h);
  void begin_hexapod_work(), count_hexapod_work(double h);
  void place_machine(const Pose<'R', 'H'>& from);  // keeps the pose; the state has its motion
  [[nodiscard]] LegMotion leg_motion() const;      // target of the servo
  void observe_hexapod();
  [[nodiscard]] Pose<'W', 'H'> true_tip() const;
  void measure_force(Time t);
  void press_ball(const Pose<'W', 'H'>& X_WH, const Point<'W'>& to, double h);
  void push_tip(const Pose<'W', 'H'>& X_WH, const Point<'W'>& to, double t, double h);
  void apply(const Vec<'W'>& force, const Point<'W'>& at, const Pose<'W', 'H'>& X_WH, const Point<'W'>& to);
  void set_up_arm(const WorldSpec& spec);
  void face_prop(double h), drive_arm(double t, double h);
  void begin_arm_work(), count_arm_work(double h);
  void observe_arm(), observe(Time t);
  [[nodiscard]] Pose<'W', 'T'> held_tool_pose(double t) const;  // s; as its markers stand
  void sense(Time t);
  [[nodiscard]] bool by_own_law() const { return ball || pusher; }  // without MuJoCo's contact
  [[nodiscard]] Vec<'W'> contact_force(bool& touching) const;
  [[nodiscard]] Scale scale() const;
  [[nodiscard]] Vec<'W'> felt_by_sensor() const;  // without weight and errors

  const MachineSteps& steps_;  // steps of the scene's machine
  TwinSpec twin_;
  const Scene& prepared_;
  double dt_, mass_behind_ = 0.0;  // s; behind the sensor, kg
  int steps_per_tick_;
  std::int32_t clamped_ = -1;  // tool in the gripper
  Pose<'W', 'R'> X_WR_;        // true
  Pose<'H', 'F'> X_HF_;
  Quat q_WT_ = Quat::Identity();
  Pose<'H', 'T'> X_HT_;  // pose of the clamped tool
  std::optional<User> user_;
  Physics physics_;
  std::optional<ArmBody> arm_body_;
  ArmAbility arm_ability_;             // figures of the data sheet
  std::optional<StepWork> step_work_;  // set if work was requested; only observes
  Point<'W'> work_from_;               // a hexapod's tip as the step begins
  std::vector<HeldTool> tools_;        // the first tool, and the one to change to
  const HeldTool* in_hand_ = nullptr;  // one of these; null: the hand is empty
  int tip_geom_ = -1, tip_body_ = -1, platform_qpos_ = 0, platform_qvel_ = 0;
  double programme_time_ = 10.0;  // s, of user, probe, pusher or travel, if any
  Tick next_;
  Truth truth_;
  std::int64_t diverged_at_ = -1;
  std::string fatal_;
};

}  // namespace enc::sim
