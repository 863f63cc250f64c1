// The safety matrix of the gripper on its coupler: each fault in four situations of a machine that carries a
// clamped tool, in virtual time.
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <poll.h>

#include "benchmarks/kit/parallel.h"
#include "core/control/scene/scene.h"
#include "hw_drivers/gripper/drive/modbus_gripper.h"
#include "hw_drivers/gripper/fake/server.h"
#include "models/setup/scene_file.h"
#include "tests/benchmarks/devices/driver_values.h"
#include "tests/benchmarks/devices/reaction.h"
#include "tests/support/built.h"
#include "trial/devices/device_log.h"
#include "trial/trial.h"

namespace enc::bench::devices {
namespace {

using Kind = Trouble::Kind;

// The coupler in front of the twin's gripper, and its driver in lockstep: each reading waits for the answers,
// in the run's time.
class GripLine {
 public:
  explicit GripLine(const RigSpec& spec) : spec_(spec) {}
  void fit_out(Rig& rig) {
    twin_ = std::move(rig.gripper);
    gripper::GripperSettings settings;
    settings.address = "127.0.0.1";
    settings.port = 0;
    server_ = std::make_unique<gripper::Server>(*twin_, settings, spec_.gripper.force, log_, true);
    thread_ = std::jthread([this](const std::stop_token& end) { serve(end); });
    DriverValues table;
    table.numbers = {{"timeout_ms", 1.0}};  // s: a busy machine is slow
    table.wholes = {{"port", server_->port()}};
    table.texts["address"] = "127.0.0.1";
    const Reach reach = reach_of(spec_);
    rig.gripper = gripper::connected({table, spec_, reach, Duration(1'000'000), log_, true, true});
    rig.clock = std::make_unique<GripClock>(*this, std::move(rig.clock));
  }
  template <class Act>
  void with(Act act) {
    const std::lock_guard lock(mutex_);
    act(*server_);
  }
  void stand(Duration how_long) { standing_ = how_long; }
  [[nodiscard]] std::string said() const { return fmt::format("{}", fmt::join(log_.lines(), "; ")); }
  void end() { thread_ = {}; }  // before the twin's gripper

 private:
  class GripClock final : public Clock {
   public:
    GripClock(GripLine& of, std::unique_ptr<Clock> clock) : of_(of), clock_(std::move(clock)) {}
    Tick next() override {
      const std::lock_guard lock(of_.mutex_);
      missed_ = 0;
      Tick tick = step();
      for (const Time until = tick.t + std::exchange(of_.standing_, {}); tick.t < until; ++missed_)
        tick = step();
      return tick;
    }
    [[nodiscard]] std::int64_t missed() const noexcept override { return missed_; }

   private:
    Tick step() {
      const Tick tick = clock_->next();
      of_.now_ = tick.t;
      of_.server_->publish(tick.t);
      return tick;
    }
    GripLine& of_;
    std::unique_ptr<Clock> clock_;
    std::int64_t missed_ = 0;
  };
  void serve(const std::stop_token& end) {
    while (!end.stop_requested()) {
      std::vector<int> descriptors;
      {
        const std::lock_guard lock(mutex_);
        server_->serve(now_);
        server_->wait_on(descriptors);
      }
      std::vector<pollfd> ready;
      for (const int one : descriptors) ready.push_back({one, POLLIN, 0});
      ::poll(ready.data(), ready.size(), 1);
    }
  }

  RigSpec spec_;
  trial::DeviceLog log_;
  std::unique_ptr<Gripper> twin_;
  std::unique_ptr<gripper::Server> server_;
  std::mutex mutex_;
  Time now_{};
  Duration standing_{};
  std::jthread thread_;
};

struct GripFault {
  const char* name;
  void (*inject)(GripLine& at);
  void (*cure)(GripLine& at);
  Limits limits;
  bool writes_only = false;  // harmless, unless an output is written
};

template <Kind kind>
void breaks(GripLine& at) {
  at.with([](gripper::Server& server) { server.suffer({kind, 1.0}); });
}
template <Kind kind>
void mended(GripLine& at) {
  at.with([](gripper::Server& server) { server.heal(kind); });
}
template <int code>
void errs(GripLine& at) {
  at.with([](gripper::Server& server) { server.suffer({Kind::error_code, static_cast<double>(code)}); });
}
void none(GripLine&) {}

constexpr Limits kGone{End::link_lost, 1, kNever, kToolNotHeld};
// The driver asks for the terminals' state in each second reading.
constexpr Limits kWhile{End::holds, 2, kNever, kToolNotHeld};

const std::vector<GripFault> kGripFaults{
    {"exception 4", errs<4>, mended<Kind::error_code>, kWhile},
    {"cut off from its terminals (0x1040)", errs<gripper::kBusStatus>, mended<Kind::error_code>, kWhile},
    {"refuses writes (0x1124)", errs<gripper::kWriteLock>, mended<Kind::error_code>, kWhile, true},
    {"silent", breaks<Kind::stall>, mended<Kind::stall>, kGone},
    {"closed", breaks<Kind::disconnect>, mended<Kind::disconnect>, kGone},
    {"all noise", breaks<Kind::garbage>, mended<Kind::garbage>, kGone},
    {"half messages", breaks<Kind::half_message>, mended<Kind::half_message>, kGone},
    {"program: its loop stands for 400 ms",
     [](GripLine& at) { at.stand(Duration(400'000'000)); },
     none,
     {End::holds, 1, kNever, kClockLate}},
    // Longer than the watchdog of the coupler: its outputs are off.
    {"program: stopped for 2 s (SIGSTOP)",
     [](GripLine& at) { at.stand(Duration(2'000'000'000)); },
     none,
     {End::link_lost, 2, kNever, kClockLate | kToolNotHeld}}};

enum class Situation : std::uint8_t { closing, stands, travels, held };
constexpr Situation kSituations[] = {Situation::closing, Situation::stands, Situation::travels,
                                     Situation::held};
constexpr auto words(Situation) {
  return enum_words("while the jaws close", "at a stop", "on the way", "in a hold");
}

struct GripCell {
  const GripFault* fault = nullptr;
  Situation when = Situation::closing;
  bool falsely = false;  // the core gets a false report
  Reaction of{};
};

Limits limits_of(const GripCell& cell) {
  Limits limits = cell.fault->limits;
  if (cell.fault->writes_only) limits.end = End::unharmed;  // the close output is on in all situations
  return limits;
}

class GripRun {
 public:
  explicit GripRun(GripCell& cell)
      : cell_(cell),
        setup_(models::load(tests::source_dir() + "/models/scenes/tracking.toml", "sim",
                            {"travel.dwell_s=0.5"})),
        line_(setup_.rig) {
    options_.fit_out = [this](Rig& rig) { line_.fit_out(rig); };
    options_.disturb = [this](Inputs& in) {
      if (stopped_) in.tool.health = Health::fault;
      if (cell_.falsely) report_.give(faulty_, limits_of(cell_).end, trial_->now().t, in.grip, in.missed);
    };
    trial_ = std::make_unique<trial::Trial>(setup_, options_);
  }
  ~GripRun() { line_.end(); }
  GripRun(const GripRun&) = delete;
  GripRun& operator=(const GripRun&) = delete;
  void react() {
    for (int i = 0; i < 20'000 && !there(); ++i) trial_->tick();
    stopped_ = cell_.when == Situation::held;
    for (int i = 0; i < 10; ++i) trial_->tick();
    cell_.of.in = trial_->outputs().mode;
    cell_.fault->inject(line_);
    faulty_ = true;
    for (int i = 1; i <= 100; ++i) {
      trial_->tick();
      if (trial_->outputs().mode != Mode::hold || cell_.of.hold < kNever) continue;
      cell_.of.hold = i;
      cell_.of.why = trial_->outputs().why;
    }
    stopped_ = faulty_ = false;
    cell_.fault->cure(line_);
    for (int i = 0; i < 100; ++i) {
      trial_->tick();
      cell_.of.goes_on = cell_.of.goes_on || trial_->outputs().mode != Mode::hold;
    }
    cell_.of.zero = 0.0;
    cell_.of.linked = trial_->rig().gripper->linked();
    cell_.of.said = line_.said();
  }

 private:
  [[nodiscard]] bool there() const {
    const GripSample& jaws = trial_->inputs().grip.value;
    const double speed = trial_->inputs().tip.value.velocity.norm();
    if (cell_.when == Situation::closing) return jaws.phase == GripPhase::closing;
    if (!jaws.holding) return false;
    return cell_.when == Situation::travels ? speed > 0.01 : speed < 1e-5;
  }
  GripCell& cell_;
  models::Setup setup_;
  GripLine line_;
  trial::TrialOptions options_;
  std::unique_ptr<trial::Trial> trial_;
  FalseReport<GripSample> report_;
  bool stopped_ = false, faulty_ = false;
};

TEST(GripperMatrix, EachFaultEndsAsStated) {
  std::vector<GripCell> cells;
  for (const GripFault& fault : kGripFaults)
    for (const Situation when : kSituations) cells.push_back({&fault, when});
  in_parallel(cells.size(), [&](std::size_t i) { GripRun(cells[i]).react(); });
  for (const GripCell& cell : cells) {
    const std::string name = fmt::format("{}, {}", cell.fault->name, word_of(cell.when));
    const Mode mode = cell.when == Situation::held ? Mode::hold : cell.of.in;
    EXPECT_EQ(wrong_with(limits_of(cell), mode, cell.of), "") << name;
    testing::Test::RecordProperty(name, fmt::format("hold {} ms", cell.of.hold));
  }
}

TEST(GripperMatrixLong, EachRowFailsForAFalseReport) {
  std::vector<GripCell> cells;
  for (const GripFault& fault : kGripFaults) cells.push_back({&fault, Situation::travels, true});
  in_parallel(cells.size(), [&](std::size_t i) { GripRun(cells[i]).react(); });
  for (const GripCell& cell : cells) {
    const std::string wrong = wrong_with(limits_of(cell), cell.of.in, cell.of);
    EXPECT_NE(wrong, "") << cell.fault->name;
    testing::Test::RecordProperty(cell.fault->name, wrong);
  }
}

}  // namespace
}  // namespace enc::bench::devices
