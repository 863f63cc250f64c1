// Whole runs, as `run` and the benchmarks make them: equal to the bit whatever the wall clock does, and from
// any saved state.
#include "trial/trial.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <pthread.h>
#include <sched.h>

#include "app/modules/modules.h"
#include "core/record/state_hash.h"
#include "sim/clock.h"
#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "tests/unit/trial/runs.h"
#include "trial/provenance/provenance.h"
#include "trial/time/real_time.h"

namespace enc::trial {
namespace {

using std::chrono::milliseconds;
using test::Loop, test::kToolRadius, test::kTop, test::quick, test::run, test::scene;
using testing::HasSubstr, testing::Not;

// Sleeps now and then, at random, like a loaded machine.
class StallingClock : public Clock {
 public:
  StallingClock(std::unique_ptr<Clock> clock, int& stalls) : clock_(std::move(clock)), stalls_(stalls) {}
  Tick next() override {
    if (random_() % 40 == 0) {
      ++stalls_;
      std::this_thread::sleep_for(std::chrono::microseconds(random_() % 2000));
    }
    return clock_->next();
  }
  [[nodiscard]] std::int64_t missed() const noexcept override { return clock_->missed(); }

 private:
  std::unique_ptr<Clock> clock_;
  int& stalls_;
  std::mt19937 random_{std::random_device{}()};
};

// 2 s: approach, touch at 1.35 s and the first part of a press.
trial::TrialOptions two_seconds(std::uint64_t seed = 1) {
  trial::TrialOptions options{.seed = seed, .seconds = 2.0};
  return options;
}

TEST(TrialHash, IsTheSameAtAnyPaceAndUnderStalls) {
  const models::Setup setup = scene("tennis_ball", quick());
  const trial::TrialResult free = run(setup, two_seconds());
  EXPECT_EQ(free.ticks, 2001);
  EXPECT_EQ(free.contacts, 1);
  EXPECT_GT(free.mode_time[static_cast<std::size_t>(Mode::contact)], 0.3);
  EXPECT_EQ(run(setup, two_seconds()).hash, free.hash);

  trial::TrialOptions paced = two_seconds();
  paced.pace = 200.0;
  EXPECT_EQ(run(setup, paced).hash, free.hash);
  paced.pace = 20.0;  // slower than the machine could: it does wait
  const trial::TrialResult slow = run(setup, paced);
  EXPECT_EQ(slow.hash, free.hash);
  EXPECT_GT(slow.wall, 0.095);  // 2 s / 20

  int stalls = 0;
  trial::TrialOptions stalled = two_seconds();
  stalled.fit_out = [&](Rig& rig) {
    rig.clock = std::make_unique<StallingClock>(std::move(rig.clock), stalls);
  };
  const trial::TrialResult result = run(setup, stalled);
  EXPECT_GT(stalls, 10);
  EXPECT_EQ(result.hash, free.hash);
  EXPECT_TRUE(result.holds.empty());  // a lockstep clock is never late
}

TEST(TrialHash, AnotherSeedIsAnotherRun) {
  const models::Setup setup = scene("tennis_ball", quick());
  EXPECT_NE(run(setup, two_seconds(2)).hash, run(setup, two_seconds(1)).hash);
}

TEST(TrialHash, LookingOnChangesNothing) {
  const models::Setup setup = scene("tennis_ball", quick());
  int seen = 0;
  trial::TrialOptions watched = two_seconds();
  watched.watch = [&](const trial::Glance&) { ++seen; };
  watched.progress = [](double) {};
  EXPECT_EQ(run(setup, watched).hash, run(setup, two_seconds()).hash);
  EXPECT_EQ(seen, 2001);
}

// Times of ten hours would be 144 MB.
TEST(Trial, HoursTakeNoMoreMemoryThanMinutes) {
  trial::TrialOptions options{.seconds = 36000.0};
  const trial::Trial trial(scene("tennis_ball", quick()), options);
  EXPECT_LE(trial.result().step_ns.capacity(), static_cast<std::size_t>(trial::TrialResult::kMostTimed));
}

// The devices whose samples stay in Inputs between packets, tapped for their state: Trial gives no access to
// it.
class TappedTracker : public PoseTracker {
 public:
  TappedTracker(std::unique_ptr<PoseTracker> tracker, Measurement<TrackedTool>*& at)
      : tracker_(std::move(tracker)), at_(at) {}
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    at_ = &newest;
    return tracker_->poll(now, newest);
  }

 private:
  std::unique_ptr<PoseTracker> tracker_;
  Measurement<TrackedTool>*& at_;
};
class TappedDisplay : public Display {
 public:
  TappedDisplay(std::unique_ptr<Display> display, Measurement<DentSample>*& at)
      : display_(std::move(display)), at_(at) {}
  void show(const View& view) noexcept override { display_->show(view); }
  bool poll(Time now, Measurement<DentSample>& newest) noexcept override {
    at_ = &newest;
    return display_->poll(now, newest);
  }

 private:
  std::unique_ptr<Display> display_;
  Measurement<DentSample>*& at_;
};

// Hash over truth, state and outputs of each of the next ticks.
std::vector<std::uint64_t> trace(trial::Trial& trial, int ticks) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(trial.tick());
    StateHash hash;
    Outputs out = trial.outputs();
    add_tick(hash, trial.state(), out);
    const sim::Truth& truth = trial.world().truth();
    hash.add(leaf_bits(truth.t));
    for (const auto* triple : {&truth.tool_tip.xyz, &truth.tool_velocity.xyz, &truth.tip.xyz,
                               &truth.tip_velocity.xyz, &truth.contact_force.xyz, &truth.hand_force.xyz})
      for (const double x : *triple) hash.add(leaf_bits(x));
    all.push_back(hash.value);
  }
  return all;
}

void goes_on_from(int saved_at) {
  Measurement<TrackedTool>* tool = nullptr;
  Measurement<DentSample>* dent = nullptr;
  trial::TrialOptions options{.seconds = 10.0};
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<TappedTracker>(std::move(rig.tracker), tool);
    rig.display = std::make_unique<TappedDisplay>(std::move(rig.display), dent);
  };
  trial::Trial trial(scene("tennis_ball", quick()), options);
  for (int i = 0; i < saved_at; ++i) ASSERT_TRUE(trial.tick());
  const std::vector<std::byte> world = trial.world().save();
  const State state = trial.state();
  ASSERT_TRUE(tool && dent);
  const Measurement<TrackedTool> tool_then = *tool;
  const Measurement<DentSample> dent_then = *dent;

  const std::vector<std::uint64_t> first = trace(trial, 400);
  for (int i = 0; i < 2; ++i) {  // twice: restoring must not use up the saved state
    trial.world().restore(world);
    trial.state() = state;
    *tool = tool_then;
    *dent = dent_then;
    EXPECT_EQ(trace(trial, 400), first);
  }
}

TEST(TrialSave, GoesOnTheSameFromTheApproach) { goes_on_from(900); }
TEST(TrialSave, GoesOnTheSameFromAPress) { goes_on_from(2200); }
TEST(TrialSave, GoesOnTheSameFromARelease) { goes_on_from(4300); }

// The tracker loses the tool and finds it again: the believed pose equals the seen one at once, and the force
// zero learns nothing in between. Only the command is smoothed.

Point<'W'> at_gap(double gap, double x = 0.0) { return {x, 0, kTop + kToolRadius + gap}; }

// A tool that waits at a gap, with the tip under it and the zero learnt.
Loop waiting(double gap, const RigSpec& rig = {}) {
  Loop loop(prepare(test::plane_scene(), rig));
  loop.tool_tip = at_gap(gap);
  loop.tick(1500);
  return loop;
}

TEST(DropOut, AToolThatPressesAfterItWasUnseenIsInContactAtOnce) {
  for (const double from : {0.040, 0.080}) {
    Loop loop = waiting(from);
    ASSERT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
    loop.tool_seen = false;
    loop.tick(300);
    loop.tool_tip = at_gap(-0.0005);
    loop.force = Vec<'W'>(0, 0, -5.0);
    loop.tick(100);
    EXPECT_EQ(loop.out.mode, Mode::hold);
    loop.tool_seen = true;
    loop.tick(2);
    EXPECT_EQ(loop.out.mode, Mode::contact) << from;
    EXPECT_NEAR(loop.out.gap, -0.0005, 1e-4) << from;
    EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.norm(), 0.0, 1e-6) << from;
    loop.tick(1000);
    EXPECT_NEAR(loop.out.deflection, (5.0 - 0.05) / 2000.0, 1e-5) << from;  // 2 N/mm, threshold 0.05 N
  }
}

// The believed pose leaps, the machine does not: it goes there within its limits.
TEST(DropOut, TheCommandCatchesUpWithoutALeap) {
  Loop loop = waiting(0.040);
  const Point<'W'> before = loop.tip();
  loop.tool_seen = false;
  loop.tick(300);
  loop.tool_tip = at_gap(0.040, 0.012);
  loop.tool_seen = true;
  loop.tick(2);
  EXPECT_NEAR(loop.out.view.tip.xyz[0], 0.012, 1e-4);  // the believed place of the tool
  EXPECT_LT((loop.tip() - before).norm(), 1e-5);
  loop.tick(1000);
  EXPECT_NEAR(loop.tip().xyz[0], 0.012, 1e-6);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
}

// A black-out of 0.3 s while the hand comes down at 200 mm/s: the press after it is felt.
TEST(DropOut, APressAfterABlackOutIsFelt) {
  const auto peak = [](const char* at) {
    const models::Setup setup = test::shipped(
        "tennis_ball",
        {"user.approach_mm_s=[200]", "user.approach_from_mm=100", "user.press_s=1", "user.release_s=1",
         std::string("truth.tracker.blackout_at_s=") + at, "truth.tracker.blackout_for_s=0.3"});
    double most = 0.0;
    trial::TrialOptions options{.seconds = 4.0};
    options.watch = [&](const trial::Glance& glance) {
      most = std::max(most, std::abs(glance.out.force.xyz[2]));
    };
    trial::Trial(setup, options).run();
    return most;
  };
  const double undisturbed = peak("100");
  EXPECT_GT(undisturbed, 8.0);
  EXPECT_GT(peak("0.75"), 0.8 * undisturbed);
}

// ---- the zero of the force ------------------------------------------------------------------------------

TEST(Retare, NotWhileTheToolIsUnseen) {
  for (const Tare tare : {Tare::free, Tare::window}) {
    RigSpec rig;
    rig.force.tare = tare;
    Loop loop = waiting(0.150, rig);  // away
    ASSERT_EQ(loop.out.mode, Mode::away);
    loop.tool_seen = false;
    loop.tick(200);  // the zero is no longer known
    loop.force = Vec<'W'>(0, 0, -5.0);
    loop.tick(5000);
    EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.norm(), 0.0, 1e-6);
    loop.tool_seen = true;
    loop.tool_tip = at_gap(-0.0005);
    loop.tick(1000);
    EXPECT_NEAR(loop.out.deflection, (5.0 - 0.05) / 2000.0, 1e-5);
  }
}

TEST(Retare, NotWhenThePoseIsOldAndNotInAHold) {
  Loop loop = waiting(0.040);
  loop.tool_seen = false;
  loop.tick(46);  // usual_age
  loop.force_zero = Vec<'F'>(0, 0, -1.0);
  loop.tick(500);  // predicted, then lost
  EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.norm(), 0.0, 1e-6);
  loop.tool_seen = true;
  loop.spoil = [](Inputs& in) {
    in.missed = 100;
  };  // a clock that is late each time: a hold with all else well
  loop.tick(500);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.norm(), 0.0, 1e-6);
  loop.spoil = {};
  loop.tick(500);
  EXPECT_LT(recall<CommandState>(loop.state).force_zero.xyz[2], -0.1);  // and then the zero learns
}

// Before the first zero the core also learns nothing from an unseen tool.
TEST(Retare, TheFirstZeroNeedsAToolThatIsSeenToBeClear) {
  Loop loop(prepare(test::plane_scene(), RigSpec{}));
  loop.tool_seen = false;
  loop.force = Vec<'W'>(0, 0, -5.0);
  loop.tick(1000);
  EXPECT_NE(loop.out.why & kTaring, 0U);
  loop.force = Vec<'W'>::zero();
  loop.tool_seen = true;
  loop.tool_tip = at_gap(0.010);
  loop.tick(300);
  EXPECT_EQ(loop.out.why & kTaring, 0U);
  EXPECT_NEAR(recall<CommandState>(loop.state).force_zero.norm(), 0.0, 1e-6);
}

// A clock that keeps wall time and falls behind: real devices lose the cycles, a simulation continues at its
// old time, and neither catches up in a burst.

using Wall = std::chrono::steady_clock;

double seconds_since(Wall::time_point start) {
  return std::chrono::duration<double>(Wall::now() - start).count();
}

std::unique_ptr<Clock> counting() { return std::make_unique<trial::CountingClock>(1000.0); }

// Ticks within 20 ms after a stall of 0.2 s: about 20; in a burst 220.
int ticks_after_a_stall(sim::PacedClock& clock) {
  for (int i = 0; i < 20; ++i) clock.next();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Wall::time_point start = Wall::now();
  int ticks = 0;
  for (; seconds_since(start) < 0.020; ++ticks) clock.next();
  return ticks;
}

TEST(LateClock, RealDevicesLoseTheCyclesOfAStall) {
  sim::PacedClock clock(counting(), 1.0, sim::LatePolicy::skip);
  const Wall::time_point start = Wall::now();
  clock.next();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Tick tick = clock.next();
  const std::int64_t missed = clock.missed();
  EXPECT_GE(missed, 195);
  EXPECT_EQ(tick.index, missed + 1);  // no lost tick is repeated
  EXPECT_NEAR(seconds(tick.t.time_since_epoch()), seconds_since(start), 0.1);
  EXPECT_GE(clock.lateness().longest, 0.19);
  sim::PacedClock again(counting(), 1.0, sim::LatePolicy::skip);
  EXPECT_LE(ticks_after_a_stall(again), 30);
}

TEST(LateClock, ASimulationGoesOnWhereItWas) {
  sim::PacedClock clock(counting(), 1.0, sim::LatePolicy::wait);
  clock.next();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(clock.next().index, 1);
  EXPECT_EQ(clock.missed(), 0);
  EXPECT_GE(clock.lateness().total, 0.19);
  sim::PacedClock again(counting(), 1.0, sim::LatePolicy::wait);
  EXPECT_LE(ticks_after_a_stall(again), 30);
}

// A pace that would last for years can be stopped.
TEST(LateClock, WaitingCanBeStopped) {
  bool stop = false;
  sim::PacedClock clock(counting(), 1e-12, sim::LatePolicy::wait, [&] { return stop; });
  clock.next();
  stop = true;
  const Wall::time_point start = Wall::now();
  clock.next();
  EXPECT_LT(seconds_since(start), 5.0);
}

// Counts the commands to a machine, and stalls once.
class StallingMachine final : public Manipulator {
 public:
  struct Log {
    std::vector<std::int64_t> missed;  // missed ticks at the tick of each command
    std::int64_t commands = 0;
  };
  StallingMachine(std::unique_ptr<Manipulator> machine, Log& log) : machine_(std::move(machine)), log_(log) {}
  [[nodiscard]] Reach reach() const override { return machine_->reach(); }
  Measurement<TipSample> read(Time now) noexcept override { return machine_->read(now); }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override {
    machine_->command(X_RH);
    if (++log_.commands == 100) std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  void stop() noexcept override { machine_->stop(); }

 private:
  std::unique_ptr<Manipulator> machine_;
  Log& log_;
};

// An armed run with the sample driver and a simulated tracker, whose world follows. A stall is a hold on the
// first tick after it, and the run sends no command for the lost ticks.
TEST(LateClock, AnArmedRunHoldsAfterAStallAndSendsNoBurst) {
  setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
  for (const char* scene : {"rig_A", "tennis_ball"}) {
    StallingMachine::Log log;
    trial::TrialOptions options{.seconds = 0.6, .drivers = app::load_module, .armed = true};
    options.fit_out = [&](Rig& rig) {
      rig.manipulator = std::make_unique<StallingMachine>(std::move(rig.manipulator), log);
    };
    std::int64_t late_holds = 0, before = -1;
    bool contiguous = true;
    options.watch = [&](const trial::Glance& glance) {
      contiguous = contiguous && glance.tick.index == before + 1 + glance.in.missed;
      before = glance.tick.index;
      if (glance.in.missed < 200) return;
      ++late_holds;
      EXPECT_EQ(glance.out.mode, Mode::hold);
      EXPECT_NE(glance.out.why & kClockLate, 0U);
    };
    trial::Trial trial(
        test::shipped(scene, {"rig.manipulator.driver=\"sample\"", "rig.force.driver=\"sample\"",
                              "rig.calibration.date=\"2026-11-27\"", "rig.calibration.valid_days=36500"}),
        options);
    const trial::TrialResult result = trial.run();
    EXPECT_GE(late_holds, 1) << scene;
    EXPECT_TRUE(contiguous) << scene;
    EXPECT_GE(result.missed, 290) << scene;
    EXPECT_GE(result.ticks + result.missed, 601) << scene;
    EXPECT_LE(log.commands, 601 - 290) << scene;
  }
  unsetenv("ENCOUNTER_MODULES");
}

// Each cause of a refused priority has its own remedy.

TEST(RealTimeRefusal, AUserIsSentToLimitsConf) {
  EXPECT_THAT(real_time_refusal(EPERM, {.most = 0}), HasSubstr("/etc/security/limits.conf: rtprio 41"));
  EXPECT_THAT(real_time_refusal(EPERM, {.most = 39}), HasSubstr("limits.conf")) << "less than is asked for";
}

// EPERM in spite of the permission: CAP_SYS_NICE, as for root, or the limit.
TEST(RealTimeRefusal, AContainerWithoutABudgetIsNotSentToLimitsConf) {
  for (const RealTimeRights& rights :
       {RealTimeRights{.root = true, .sys_nice = true},
        RealTimeRights{.root = true, .sys_nice = true, .container = true},
        RealTimeRights{.container = true, .most = 41}, RealTimeRights{.most = 99}}) {
    const std::string words = real_time_refusal(EPERM, rights);
    EXPECT_THAT(words, HasSubstr("no real-time budget: docker run --cpu-rt-runtime=950000"));
    EXPECT_THAT(words, Not(HasSubstr("limits.conf")));
  }
}

TEST(RealTimeRefusal, AContainerWithoutTheRightIsToldHowToGetIt) {
  for (const RealTimeRights& rights :
       {RealTimeRights{.root = true}, RealTimeRights{.root = true, .container = true},
        RealTimeRights{.container = true}}) {
    const std::string words = real_time_refusal(EPERM, rights);
    EXPECT_THAT(words, HasSubstr("docker run --cap-add=SYS_NICE --ulimit rtprio=41"));
    EXPECT_THAT(words, Not(HasSubstr("limits.conf")));
  }
}

TEST(RealTimeRefusal, AnotherErrorIsNamed) {
  EXPECT_THAT(real_time_refusal(ENOSYS, {.root = true, .sys_nice = true}),
              HasSubstr("the system refuses SCHED_FIFO: Function not implemented"));
}

// The words state this system's result, and the thread is as before afterwards.
TEST(RealTimeRefusal, ATrialOfThePriorityLeavesTheThreadAsItWas) {
  int before = 0, after = 0;
  sched_param parameter{};
  pthread_getschedparam(pthread_self(), &before, &parameter);
  {
    const RealTime tried(true);
    EXPECT_EQ(tried.granted(), tried.refusal().empty());
    EXPECT_THAT(tried.words(),
                HasSubstr(tried.granted() ? "SCHED_FIFO 40" : "not first (" + tried.refusal()));
  }
  pthread_getschedparam(pthread_self(), &after, &parameter);
  EXPECT_EQ(before, after);
}

// The provenance of a result: program, machine and time.

TEST(Provenance, TimesAreUtcInIso8601) {
  const WallTime epoch{};
  EXPECT_EQ(time_text(epoch), "1970-01-01T00:00:00.000Z");
  const WallTime t{milliseconds(1'795'999'092'345)};
  EXPECT_EQ(time_text(t), "2026-11-30T00:38:12.345Z");
  EXPECT_EQ(day_text(t), "2026-11-30");
  EXPECT_EQ(day_text(t + std::chrono::hours(24)), "2026-12-01");
}

TEST(Provenance, OnlyARunOnTheWallClockSaysWhenItStarted) {
  const WallTime t{milliseconds(1'795'999'092'345)};
  const auto simulated = provenance_texts(t, false), real = provenance_texts(t, true);
  EXPECT_EQ(simulated.at("date"), "2026-11-30");
  EXPECT_FALSE(simulated.contains("started"));
  EXPECT_EQ(real.at("started"), "2026-11-30T00:38:12.345Z");
  for (const char* name : {"version", "commit", "commit_date", "machine"}) {
    EXPECT_FALSE(real.at(name).empty()) << name;
    EXPECT_EQ(real.at(name), simulated.at(name));
    EXPECT_EQ(real.at(name).find('\n'), std::string::npos);
  }
}

// A program that links no commit reports that. So a new commit does not relink the tests.
TEST(Provenance, WithoutACommitItIsUnknown) {
  EXPECT_STREQ(built_commit().name, "unknown");
  EXPECT_THAT(program_words(), testing::MatchesRegex("Encounter [0-9.]+, commit unknown of unknown"));
}

}  // namespace
}  // namespace enc::trial
