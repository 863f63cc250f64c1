#include "trial/assemble.h"

#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace enc::trial {
namespace {

// The module's maker of a role, or one clear line.
template <class Make>
Make maker(const DriverSource& drivers, const std::string& driver, const char* role,
           Make DriverModule::*member) {
  const ModuleInfo& module = drivers(driver);
  if (module.driver == nullptr || module.driver->*member == nullptr)
    throw Error(fmt::format("module '{}' drives no {}; choose another driver in the rig file", driver, role),
                {}, ErrorKind::device);
  return module.driver->*member;
}

// A real machine is shown its commands only when armed; until then it is read and stays where it is.
class Dry final : public Manipulator {
 public:
  explicit Dry(std::unique_ptr<Manipulator> machine) : machine_(std::move(machine)) {}
  [[nodiscard]] Reach reach() const override { return machine_->reach(); }
  Stamped<TipSample> read() noexcept override { return machine_->read(); }
  void command(const Pose<'R', 'H'>&) noexcept override {}

 private:
  std::unique_ptr<Manipulator> machine_;
};

// Likewise a real arm.
class DryArm final : public HapticArm {
 public:
  explicit DryArm(std::unique_ptr<HapticArm> arm) : arm_(std::move(arm)) {}
  Stamped<ArmSample> read() noexcept override { return arm_->read(); }
  void command(const Vec<'R'>&) noexcept override {}

 private:
  std::unique_ptr<HapticArm> arm_;
};

// Likewise a real gripper.
class DryGripper final : public Gripper {
 public:
  explicit DryGripper(std::unique_ptr<Gripper> gripper) : gripper_(std::move(gripper)) {}
  Stamped<GripSample> read() noexcept override { return gripper_->read(); }
  void command(const Grip&) noexcept override {}

 private:
  std::unique_ptr<Gripper> gripper_;
};

}  // namespace

Slots slots_of(const models::Setup& setup) {
  const SceneSpec& scene = setup.scene;
  const RigSpec& rig = setup.rig;
  Slots slots;
  const auto slot = [&](bool named, const std::string& driver) {
    slots.simulated = slots.simulated || (named && driver == "sim");
    slots.real = slots.real || (named && driver != "sim");
  };
  slot(scene.manipulator.has_value(), rig.manipulator.driver);
  slot(scene.arm.has_value(), rig.arm.driver);
  slot(scene.force.has_value(), rig.force.driver);
  slot(scene.tracker.has_value(), rig.tracker.driver);
  slot(scene.display.has_value(), rig.display.driver);
  slot(scene.gripper.has_value(), rig.gripper.driver);
  return slots;
}

std::unique_ptr<sim::World> make_world(const models::Setup& setup, const Scene& prepared, std::uint64_t seed,
                                       bool draw_all) {
  const std::string mjcf = models::models_dir(setup.scene_path) + "/mjcf";
  try {
    return std::make_unique<sim::World>(
        sim::WorldSpec{setup.scene, setup.rig, setup.twin, prepared, mjcf, seed, draw_all});
  } catch (const Error& e) {
    if (e.key().empty()) throw;
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

void put_drivers(Rig& rig, const models::Setup& setup, const DriverSource& drivers, bool armed) {
  const SceneSpec& scene = setup.scene;
  const RigSpec& spec = setup.rig;
  if (scene.manipulator && spec.manipulator.driver != "sim") {
    auto machine =
        maker(drivers, spec.manipulator.driver, "manipulator", &DriverModule::manipulator)(reach_of(spec));
    if (armed)
      rig.manipulator = std::move(machine);
    else
      rig.manipulator = std::make_unique<Dry>(std::move(machine));
  }
  if (scene.arm && spec.arm.driver != "sim") {
    auto arm = maker(drivers, spec.arm.driver, "arm", &DriverModule::arm)();
    if (armed)
      rig.arm = std::move(arm);
    else
      rig.arm = std::make_unique<DryArm>(std::move(arm));
  }
  if (scene.force && spec.force.driver != "sim")
    rig.force = maker(drivers, spec.force.driver, "force sensor", &DriverModule::force)();
  if (scene.tracker && spec.tracker.driver != "sim")
    rig.tracker = maker(drivers, spec.tracker.driver, "tracker", &DriverModule::tracker)();
  if (scene.display && spec.display.driver != "sim")
    rig.display = maker(drivers, spec.display.driver, "display", &DriverModule::display)();
  if (scene.gripper && spec.gripper.driver != "sim") {
    auto gripper = maker(drivers, spec.gripper.driver, "gripper", &DriverModule::gripper)();
    if (armed)
      rig.gripper = std::move(gripper);
    else
      rig.gripper = std::make_unique<DryGripper>(std::move(gripper));
  }
}

void check_devices(const Rig& rig, const RigSpec& spec) {
  if (!rig.manipulator) return;
  const Reach reach = rig.manipulator->reach();
  if (reach.speed < spec.manipulator.speed * (1 - 1e-9) ||
      reach.acceleration < spec.manipulator.acceleration * (1 - 1e-9))
    throw Error(
        "the machine is slower than the rig file promises; lower rig.manipulator.speed_mm_s or "
        "acceleration_mm_s2",
        {}, ErrorKind::device);
}

CountingClock::CountingClock(double rate) { next_.dt = from_seconds(1.0 / rate); }

Tick CountingClock::next() {
  const Tick tick = next_;
  ++next_.index;
  next_.t = Time(Duration(next_.index * next_.dt.count()));
  return tick;
}

}  // namespace enc::trial
