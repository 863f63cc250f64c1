// The roles of a simulated rig: small views on one world.
#include "sim/world.h"

namespace enc::sim {
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
  Stamped<TipSample> read(Time) noexcept override {
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
  Stamped<ArmSample> read(Time) noexcept override { return world_.arm->state().sample; }
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
  Stamped<Wrench> read(Time) noexcept override { return world_.force->sample(); }

 private:
  World& world_;
};

class SimTracker final : public PoseTracker {
 public:
  explicit SimTracker(World& world) : world_(world) {}
  bool poll(Time, Stamped<TrackedTool>& newest) noexcept override { return world_.tracker->poll(newest); }

 private:
  World& world_;
};

class SimDisplay final : public Display {
 public:
  explicit SimDisplay(World& world) : world_(world) {}
  void show(const View& view) noexcept override { world_.display->show(view); }
  bool poll(Time, Stamped<DentSample>& newest) noexcept override { return world_.display->poll(newest); }

 private:
  World& world_;
};

class SimGripper final : public Gripper {
 public:
  explicit SimGripper(World& world) : world_(world) {}
  Stamped<GripSample> read(Time) noexcept override { return world_.gripper->sample(); }
  void command(const Grip& grip) noexcept override { world_.gripper->command(grip); }
  void stop() noexcept override {}  // without a command it stays as it is

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
  return rig;
}

}  // namespace enc::sim
