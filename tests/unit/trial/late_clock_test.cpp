// A clock that keeps wall time and falls behind: real devices lose the cycles, a simulation goes on where it
// was, and neither makes them up in a burst.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "sim/clock.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc {
namespace {

using Wall = std::chrono::steady_clock;

double seconds_since(Wall::time_point start) {
  return std::chrono::duration<double>(Wall::now() - start).count();
}

std::unique_ptr<Clock> counting() { return std::make_unique<trial::CountingClock>(1000.0); }

// Ticks that happen within 20 ms after a stall of 0.2 s: 20, or so; of a burst it would be 220.
int ticks_after_a_stall(sim::Paced& clock) {
  for (int i = 0; i < 20; ++i) clock.next();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Wall::time_point start = Wall::now();
  int ticks = 0;
  for (; seconds_since(start) < 0.020; ++ticks) clock.next();
  return ticks;
}

TEST(LateClock, RealDevicesLoseTheCyclesOfAStall) {
  sim::Paced clock(counting(), 1.0, sim::Late::skip);
  const Wall::time_point start = Wall::now();
  clock.next();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Tick tick = clock.next();
  const std::int64_t missed = clock.missed();
  EXPECT_GE(missed, 195);
  EXPECT_EQ(tick.index, missed + 1);  // none is made up
  EXPECT_NEAR(seconds(tick.t.time_since_epoch()), seconds_since(start), 0.1);
  EXPECT_GE(clock.lateness().longest, 0.19);
  sim::Paced again(counting(), 1.0, sim::Late::skip);
  EXPECT_LE(ticks_after_a_stall(again), 30);
}

TEST(LateClock, ASimulationGoesOnWhereItWas) {
  sim::Paced clock(counting(), 1.0, sim::Late::wait);
  clock.next();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(clock.next().index, 1);
  EXPECT_EQ(clock.missed(), 0);
  EXPECT_GE(clock.lateness().total, 0.19);
  sim::Paced again(counting(), 1.0, sim::Late::wait);
  EXPECT_LE(ticks_after_a_stall(again), 30);
}

// A pace that would last for years can be left.
TEST(LateClock, WaitingCanBeStopped) {
  bool stop = false;
  sim::Paced clock(counting(), 1e-12, sim::Late::wait, [&] { return stop; });
  clock.next();
  stop = true;
  const Wall::time_point start = Wall::now();
  clock.next();
  EXPECT_LT(seconds_since(start), 5.0);
}

// Counts what a machine is sent, and stalls once.
class Stalling final : public Manipulator {
 public:
  struct Log {
    std::vector<std::int64_t> missed;  // of the tick on which each command came
    std::int64_t commands = 0;
  };
  Stalling(std::unique_ptr<Manipulator> machine, Log& log) : machine_(std::move(machine)), log_(log) {}
  [[nodiscard]] Reach reach() const override { return machine_->reach(); }
  Stamped<TipSample> read(Time now) noexcept override { return machine_->read(now); }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override {
    machine_->command(X_RH);
    if (++log_.commands == 100) std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  void stop() noexcept override { machine_->stop(); }

 private:
  std::unique_ptr<Manipulator> machine_;
  Log& log_;
};

// Armed, with the sample driver: a stall is a hold on the first tick after it, and nothing is sent for what
// was lost. With a simulated tracker beside it, whose world follows.
TEST(LateClock, AnArmedRunHoldsAfterAStallAndSendsNoBurst) {
  setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
  for (const char* scene : {"rig_A", "tennis_ball"}) {
    Stalling::Log log;
    trial::TrialOptions options;
    options.drivers = app::load_module;
    options.armed = true;
    options.seconds = 0.6;
    options.fit_out = [&](Rig& rig) {
      rig.manipulator = std::make_unique<Stalling>(std::move(rig.manipulator), log);
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
        models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", {},
                     {"rig.manipulator.driver=\"sample\"", "rig.force.driver=\"sample\"",
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

}  // namespace
}  // namespace enc
