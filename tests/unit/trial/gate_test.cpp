// The gate between the core and the machine: it stops however a run ends, sends nothing while dry, and holds
// after a lost link until somebody resumes.
#include "trial/gate.h"

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "tests/unit/trial/runs.h"
#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using test::shipped;

// The commands that a device received, in order.
struct CommandLog {
  std::int64_t commands = 0, stops = 0;
  bool stopped_last = false, linked = true;
  void command() {
    ++commands;
    stopped_last = false;
  }
  void stop() {
    ++stops;
    stopped_last = true;
  }
};

// A device of a role with an observer.
template <class Role>
class RecordingRole : public Role {
 public:
  RecordingRole(std::unique_ptr<Role> device, CommandLog& seen) : device_(std::move(device)), seen_(seen) {}
  [[nodiscard]] bool linked() const noexcept override { return seen_.linked; }

 protected:
  std::unique_ptr<Role> device_;
  CommandLog& seen_;
};
class WatchedMachine final : public RecordingRole<Manipulator> {
 public:
  using RecordingRole::RecordingRole;
  [[nodiscard]] Reach reach() const override { return device_->reach(); }
  Measurement<TipSample> read(Time now) noexcept override { return device_->read(now); }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override {
    seen_.command();
    device_->command(X_RH);
  }
  void stop() noexcept override {
    seen_.stop();
    device_->stop();
  }
};
class WatchedArm final : public RecordingRole<HapticArm> {
 public:
  using RecordingRole::RecordingRole;
  [[nodiscard]] ArmAbility ability() const override { return device_->ability(); }
  Measurement<ArmSample> read(Time now) noexcept override { return device_->read(now); }
  void command(const Vec<'R'>& force) noexcept override {
    seen_.command();
    device_->command(force);
  }
  void stop() noexcept override {
    seen_.stop();
    device_->stop();
  }
};
class Jaws final : public RecordingRole<Gripper> {
 public:
  using RecordingRole::RecordingRole;
  Measurement<GripSample> read(Time now) noexcept override { return device_->read(now); }
  void command(const Grip& grip) noexcept override {
    seen_.command();
    device_->command(grip);
  }
  void stop() noexcept override {
    seen_.stop();
    device_->stop();
  }
};
class Tracker final : public RecordingRole<PoseTracker> {
 public:
  using RecordingRole::RecordingRole;
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    return device_->poll(now, newest);
  }
};
class Screen final : public RecordingRole<Display> {
 public:
  using RecordingRole::RecordingRole;
  void show(const View& view) noexcept override { device_->show(view); }
  bool poll(Time now, Measurement<DentSample>& newest) noexcept override {
    return device_->poll(now, newest);
  }
};
class Sensor final : public RecordingRole<ForceSensor> {
 public:
  using RecordingRole::RecordingRole;
  Measurement<Wrench> read(Time now) noexcept override { return device_->read(now); }
};

struct Watchers {
  CommandLog machine, arm, gripper, tracker, display, force;

  void fit(Rig& rig) {
    const auto over = [](auto& slot, auto make) {
      if (slot) slot = make(std::move(slot));
    };
    over(rig.manipulator, [&](auto d) { return std::make_unique<WatchedMachine>(std::move(d), machine); });
    over(rig.arm, [&](auto d) { return std::make_unique<WatchedArm>(std::move(d), arm); });
    over(rig.gripper, [&](auto d) { return std::make_unique<Jaws>(std::move(d), gripper); });
    over(rig.tracker, [&](auto d) { return std::make_unique<Tracker>(std::move(d), tracker); });
    over(rig.display, [&](auto d) { return std::make_unique<Screen>(std::move(d), display); });
    over(rig.force, [&](auto d) { return std::make_unique<Sensor>(std::move(d), force); });
  }
  TrialOptions options(double seconds) {
    TrialOptions options{.seconds = seconds};
    options.fit_out = [this](Rig& rig) { fit(rig); };
    return options;
  }
};

// ---- stop
// ---------------------------------------------------------------------------------------------------

enum class End { whole, thrown, signal, hold, ticks };

// Run a scene to an end, and return the observations of its devices.
Watchers ended(const std::string& name, End end) {
  Watchers seen;
  TrialOptions options = seen.options(0.3);
  std::int64_t ticks = 0;
  options.stop = [&] { return end == End::signal && ticks == 100; };
  options.disturb = [&](Inputs& in) {
    if (end != End::hold || ticks < 100) return;
    in.wrench.health = in.tip.health = in.tool.health = Health::fault;
  };
  options.watch = [&](const Glance&) {
    if (++ticks == 100 && end == End::thrown) throw Error("a measure that gives up");
  };
  Trial trial(shipped(name), options);
  if (end == End::ticks) {
    for (int i = 0; i < 100; ++i) trial.tick();
    return seen;
  }
  try {
    EXPECT_EQ(trial.run().last_mode == Mode::hold, end == End::hold);
    EXPECT_NE(end, End::thrown);
  } catch (const Error&) {
    EXPECT_EQ(end, End::thrown);
  }
  // The device is stopped before the trial is gone, and not once more by its end.
  EXPECT_EQ(seen.machine.stops + seen.arm.stops, 1) << name;
  return seen;
}

TEST(Gate, WhatMovesIsStoppedHoweverARunEnds) {
  for (const End end : {End::whole, End::thrown, End::signal, End::hold, End::ticks}) {
    for (const char* name : {"tennis_ball", "clamped_tool"}) {
      const Watchers seen = ended(name, end);
      EXPECT_GE(seen.machine.commands, 99) << name;
      EXPECT_TRUE(seen.machine.stopped_last) << name << " " << static_cast<int>(end);
      EXPECT_EQ(seen.machine.stops, 1) << name << " " << static_cast<int>(end);
      EXPECT_EQ(seen.gripper.stops, seen.gripper.commands == 0 ? 0 : 1) << name;
    }
    const Watchers arm = ended("wall", end);
    EXPECT_GE(arm.arm.commands, 99);
    EXPECT_TRUE(arm.arm.stopped_last) << static_cast<int>(end);
    EXPECT_EQ(arm.arm.stops, 1) << static_cast<int>(end);
  }
}

TEST(Gate, AStoppedArmPushesNoMore) {
  Watchers seen;
  Trial trial(shipped("wall"), seen.options(1.0));
  for (int i = 0; i < 500; ++i) trial.tick();
  EXPECT_GT(trial.world().arm->state().wanted.norm(), 0.0);
  for (int times = 0; times < 2; ++times) {
    trial.rig().arm->stop();
    trial.rig().clock->next();
    EXPECT_EQ(trial.world().arm->state().wanted.norm(), 0.0);
    EXPECT_EQ(trial.world().arm->motor_torque(), PerJoint{});
  }
}

// ---- a link that was lost
// -----------------------------------------------------------------------------------

// Loses a link in a press and restores it.
struct LinkLoss {
  explicit LinkLoss(CommandLog Watchers::*device, const std::string& name = "tennis_ball")
      : trial(shipped(name), seen.options(30.0)), linked((seen.*device).linked) {
    while (trial.outputs().mode != Mode::contact) EXPECT_TRUE(trial.tick());
    for (int i = 0; i < 500; ++i) trial.tick();
    EXPECT_EQ(trial.outputs().mode, Mode::contact);
    linked = false;
    for (int i = 0; i < 300; ++i) trial.tick();
    EXPECT_EQ(trial.outputs().mode, Mode::hold);
    linked = true;
  }
  Point<'W'> tip() { return trial.truth().tip; }

  Watchers seen;
  Trial trial;
  bool& linked;
};

TEST(Gate, AMachineWhoseLinkComesBackByItselfMovesNothing) {
  LinkLoss run(&Watchers::machine);
  const std::int64_t told = run.seen.machine.commands;
  const Point<'W'> stood = run.tip();
  for (int i = 0; i < 3000; ++i) {
    run.trial.tick();
    ASSERT_EQ(run.trial.outputs().mode, Mode::hold);
    ASSERT_LT((run.tip() - stood).norm(), 10e-6);  // its step and its play
  }
  EXPECT_EQ(run.seen.machine.commands, told);
  ASSERT_EQ(run.trial.gate().links().size(), 1U);
  EXPECT_STREQ(run.trial.gate().links()[0].role, "manipulator");

  run.trial.resume();
  for (int i = 0; i < 1000; ++i) run.trial.tick();
  EXPECT_EQ(run.seen.machine.commands, told + 1000);
  EXPECT_NE(run.trial.outputs().mode, Mode::hold);
  EXPECT_EQ(run.trial.run().links.size(), 1U);
}

// Somebody homes the machine while its link is lost: the next command is at its present place, so there is no
// leap.
TEST(Gate, AResumedMachineBeginsWhereItIs) {
  Watchers seen;
  TrialOptions options = seen.options(30.0);
  bool moved = false;
  options.disturb = [&](Inputs& in) {
    if (!moved) return;
    in.tip.value.X_RH.xyz[0] += 0.020;
    in.tip.value.X_RH.xyz[2] -= 0.010;
  };
  Trial trial(shipped("tennis_ball"), options);
  while (trial.outputs().mode != Mode::contact) EXPECT_TRUE(trial.tick());
  seen.machine.linked = false;
  for (int i = 0; i < 300; ++i) trial.tick();
  moved = seen.machine.linked = true;
  trial.resume();
  trial.tick();
  EXPECT_LT((trial.outputs().manipulator.tip.p() - trial.inputs().tip.value.X_RH.p()).norm(), 1e-6);
  const double most = trial.scene().reach.speed * trial.scene().dt * (1.0 + 1e-9);
  Vec3 before = trial.outputs().manipulator.tip.p();
  for (int i = 0; i < 100; ++i) {
    trial.tick();
    ASSERT_LE((trial.outputs().manipulator.tip.p() - before).norm(), most);
    before = trial.outputs().manipulator.tip.p();
  }
}

// A tracker without new data after its link returned still holds its earlier sample, which was valid.
TEST(Gate, WhatWasSaidBeforeALossIsBelievedAfterIt) {
  struct SilentTracker final : PoseTracker {
    bool there = true;
    bool poll(Time, Measurement<TrackedTool>&) noexcept override { return false; }
    [[nodiscard]] bool linked() const noexcept override { return there; }
  };
  Gate gate;
  Rig rig;
  rig.tracker = std::make_unique<SilentTracker>();
  auto& tracker = static_cast<SilentTracker&>(*rig.tracker);
  Inputs in;
  in.tool.health = Health::ok;
  const auto tick = [&] {
    gate.unmark(in);
    gate.mark(rig, {}, in);
    return in.tool.health;
  };
  EXPECT_EQ(tick(), Health::ok);
  tracker.there = false;
  EXPECT_EQ(tick(), Health::fault);
  EXPECT_EQ(tick(), Health::fault);
  tracker.there = true;
  EXPECT_EQ(tick(), Health::fault) << "nobody resumed";
  gate.resume();
  EXPECT_EQ(tick(), Health::ok);
}

TEST(Gate, WithoutALostLinkNothingIsHeld) {
  Watchers seen;
  Trial trial(shipped("tennis_ball"), seen.options(4.0));
  const TrialResult result = trial.run();
  EXPECT_TRUE(result.links.empty());
  EXPECT_EQ(seen.machine.commands, result.ticks);
  EXPECT_EQ(result.mode_time[static_cast<std::size_t>(Mode::hold)], 0.0);
}

TEST(Gate, ALinkThatIsStillLostCannotBeResumed) {
  LinkLoss run(&Watchers::machine);
  run.linked = false;
  const std::int64_t told = run.seen.machine.commands;
  for (int i = 0; i < 100; ++i) {
    run.trial.resume();
    run.trial.tick();
    ASSERT_EQ(run.trial.outputs().mode, Mode::hold);
  }
  EXPECT_EQ(run.seen.machine.commands, told);
  EXPECT_LE(run.trial.gate().links().size(), 16U);  // nothing is allocated
}

// The machine receives the core's hold command and stands still.
TEST(Gate, AnyOtherDeviceHoldsTheMachineToo) {
  for (CommandLog Watchers::*device : {&Watchers::force, &Watchers::tracker, &Watchers::display}) {
    LinkLoss run(device);
    for (int i = 0; i < 300; ++i) run.trial.tick();
    const Point<'W'> stood = run.tip();
    for (int i = 0; i < 2000; ++i) {
      run.trial.tick();
      ASSERT_EQ(run.trial.outputs().mode, Mode::hold);
      ASSERT_LT((run.tip() - stood).norm(), 10e-6);
    }
    run.trial.resume();
    for (int i = 0; i < 1000; ++i) run.trial.tick();
    EXPECT_NE(run.trial.outputs().mode, Mode::hold);
  }
}

// An arm without force falls. If the tracker is lost, the arm is commanded to carry itself; if the arm is
// lost, it gets no command.
TEST(Gate, AnArmCarriesItselfOrIsToldNothing) {
  LinkLoss blind(&Watchers::tracker, "wall");
  std::int64_t told = blind.seen.arm.commands;
  for (int i = 0; i < 500; ++i) {
    blind.trial.tick();
    ASSERT_EQ(blind.trial.outputs().mode, Mode::hold);
  }
  EXPECT_EQ(blind.seen.arm.commands, told + 500);

  LinkLoss deaf(&Watchers::arm, "wall");
  told = deaf.seen.arm.commands;
  for (int i = 0; i < 500; ++i) deaf.trial.tick();
  EXPECT_EQ(deaf.seen.arm.commands, told);
  deaf.trial.resume();
  for (int i = 0; i < 500; ++i) deaf.trial.tick();
  EXPECT_EQ(deaf.seen.arm.commands, told + 500);
}

// The gate holds after the loss of a device that the core does not hold for, such as a display that is not in
// use yet.
TEST(Gate, OnlyWhatIsSaidInHoldIsSentAfterALostLink) {
  Watchers seen;
  Trial trial(shipped("tennis_ball"), seen.options(30.0));
  Rig& rig = trial.rig();
  Gate gate;
  Inputs in;
  Outputs out;
  out.manipulator.tip = rig.manipulator->reach().machine.zero();
  const auto sent = [&](Mode mode) {
    out.mode = mode;
    gate.mark(rig, Time{}, in);
    const std::int64_t before = seen.machine.commands;
    gate.write(rig, out);
    return seen.machine.commands - before;
  };
  EXPECT_EQ(sent(Mode::follow), 1);
  EXPECT_FALSE(gate.lost());
  seen.display.linked = false;
  EXPECT_EQ(sent(Mode::follow), 0);
  EXPECT_TRUE(gate.lost());
  EXPECT_EQ(in.dent.health, Health::fault);
  EXPECT_EQ(sent(Mode::hold), 1);
  seen.display.linked = true;
  EXPECT_EQ(sent(Mode::follow), 0);
  gate.resume();
  EXPECT_EQ(sent(Mode::follow), 1);
}

// The time for which a prop has been at its target, also after more ticks than the buffer keeps.

constexpr double kWithin = 2e-3;  // m

TEST(Way, CountsTheLastTicksAtAPlace) {
  const Point<'W'> place(0.1, 0.2, 0.3), beside(0.1, 0.2, 0.31);
  Way way;
  EXPECT_EQ(way.there(place, kWithin), 0U);
  for (int i = 0; i < 5; ++i) way.add(place);
  way.add(beside);
  EXPECT_EQ(way.there(place, kWithin), 0U);
  EXPECT_EQ(way.there(beside, kWithin), 1U);
  for (int i = 0; i < 3; ++i) way.add(place);
  EXPECT_EQ(way.there(place, kWithin), 3U);
  way.clear();
  EXPECT_EQ(way.there(place, kWithin), 0U);
}

TEST(Way, KeepsTheLastTicksAlone) {
  const Point<'W'> place(0.1, 0.2, 0.3), beside(0.1, 0.2, 0.31);
  Way way;
  for (std::size_t i = 0; i < Way::kMost + 7; ++i) way.add(place);
  EXPECT_EQ(way.there(place, kWithin), Way::kMost);
  way.add(beside);
  for (int i = 0; i < 9; ++i) way.add(place);
  EXPECT_EQ(way.there(place, kWithin), 9U);
}

}  // namespace
}  // namespace enc::trial
