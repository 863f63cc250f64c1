// Every cell of the matrix of docs/reference/safety.md: fault x device x mode, the outcome of the run, and
// the time from the injected fault to it. In virtual time.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "core/devices/mode.h"
#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/wires/fake_settings.h"
#include "models/setup/driver_table.h"
#include "sim/plants/hexapod_plant.h"
#include "tests/benchmarks/wires/wired_trial.h"
#include "tests/support/built.h"

namespace enc::bench::wires {
namespace {

// Outcome of a run.
enum class End : std::uint8_t {
  unharmed,  // does not hold
  holds,     // holds while the fault lasts, then goes on
  link_lost  // holds, and needs a new run
};

struct Fault {
  const char *device, *name;
  void (*inject)(WiredTrial& at);
  void (*cure)(WiredTrial& at);  // after 0.7 s
  End end;
  double hold = 0.0;      // ms from the fault to the hold, at most
  std::uint32_t why = 0;  // one of the reasons
  // The driver's counter that proves a harmless fault occurred ("missing", "old").
  const char* counted = nullptr;
  // The fault is over when the loop returns: the machine stands by then, and the run goes on
  bool over = false;
  // Time and reason if no tool is in view and the machine waits; 0: as above.
  double hold_away = 0.0;
  std::uint32_t why_away = 0;
  bool streams = false;  // the tracker's own server over TCP, in place of datagrams
  [[nodiscard]] double hold_in(Mode mode) const {
    return mode == Mode::away && hold_away > 0 ? hold_away : hold;
  }
  [[nodiscard]] std::uint32_t why_in(Mode mode) const {
    return mode == Mode::away && why_away != 0 ? why_away : why;
  }
};

constexpr Mode kInjectedIn[] = {Mode::away, Mode::follow, Mode::contact, Mode::restore};

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Reaction {
  double hold = kNever, rest = kNever;  // ms from the fault; rest: below 0.1 mm/s from then on, for 0.7 s
  Mode in = Mode::hold;                 // mode at the injection
  double speed = 0.0;     // m/s, of the tip or its commanded position: the maximum from the fault to the hold
  double way = 0.0;       // m, of the tip from the fault on, for 0.7 s
  std::uint32_t why = 0;  // reason of the first hold
  bool held = false;      // within the 0.7 s
  bool linked = true;     // all devices, 0.5 s after the cure
  bool goes_on = false;   // the run was in another mode than hold in those 0.5 s
  std::string end{};      // reason of the hold at the end
  double counted = kUnset;  // the driver's count at the end
  double simulated = 0.0;   // s
};

// A short press of the tennis ball on the rig `fakes`, with the silence limits that ship for real devices.
struct ShortPress {
  models::Setup datagrams, stream;  // poses as tool data
  explicit ShortPress(const std::string& models);
  [[nodiscard]] const models::Setup& of(const Fault& fault) const {
    return fault.streams ? stream : datagrams;
  }
};

using Kind = Trouble::Kind;

void nothing(WiredTrial&) {}

// The sensor's wire, or the tracker's, has this fault from now on; the value is in percent.
template <Kind kind, int percent = 100>
void spoil_force(WiredTrial& at) {
  at.wires().box().suffer({kind, 0.01 * percent});
}
template <Kind kind>
void heal_force(WiredTrial& at) {
  at.wires().box().heal(kind);
}
template <Kind kind, int percent = 100>
void spoil_tracker(WiredTrial& at) {
  at.wires().tools().suffer({kind, 0.01 * percent});
}
template <Kind kind>
void heal_tracker(WiredTrial& at) {
  at.wires().tools().heal(kind);
}

constexpr const char* kStream = "tracker (TCP)";
constexpr Fault over_tcp(Fault fault) {
  fault.streams = true;
  return fault;
}

const std::array kFaults{
    Fault{"manipulator", "silent", [](WiredTrial& at) { at.wires().machine.silent = true; },
          [](WiredTrial& at) { at.wires().machine.silent = false; }, End::link_lost, 9, kTipLost},
    Fault{"manipulator", "cable cut", [](WiredTrial& at) { at.wires().machine.cut = true; },
          [](WiredTrial& at) { at.wires().machine.cut = false; }, End::link_lost, 9, kTipLost},
    Fault{"manipulator", "closed", [](WiredTrial& at) { at.wires().machine.hung_up = true; },
          [](WiredTrial& at) { at.wires().machine.hung_up = false; }, End::link_lost, 2, kTipInvalid},
    Fault{"manipulator", "garbage", [](WiredTrial& at) { at.wires().machine.instead = "?\x7f what\n"; },
          nothing, End::link_lost, 6, kTipInvalid},
    Fault{"manipulator", "half a message, then nothing",
          [](WiredTrial& at) { at.wires().machine.half = true; },
          [](WiredTrial& at) { at.wires().machine.silent = false; }, End::link_lost, 9, kTipLost},
    Fault{"manipulator", "a strut fails (error 504)",
          [](WiredTrial& at) { at.wires().controller().fail(504); },
          [](WiredTrial& at) {
            static_cast<void>(at.wires().controller().take("SVO X 1 Y 1 Z 1 U 1 V 1 W 1\n"));
          },
          End::link_lost, 6, kTipInvalid},
    Fault{"manipulator", "stopped by another hand (error 10)",
          [](WiredTrial& at) { static_cast<void>(at.wires().controller().take("STP\n")); }, nothing,
          End::link_lost, 6, kTipInvalid},
    Fault{"force", "silent", spoil_force<Kind::stall>, heal_force<Kind::stall>, End::link_lost, 6,
          kForceLost},
    Fault{"force", "saturated", [](WiredTrial& at) { at.wires().box().box().fail(0x80020000); },
          [](WiredTrial& at) { at.wires().box().box().fail(0); }, End::holds, 2, kForceSaturated},
    Fault{"force", "reports an error", [](WiredTrial& at) { at.wires().box().box().fail(0x90000000); },
          [](WiredTrial& at) { at.wires().box().box().fail(0); }, End::holds, 2, kForceInvalid},
    Fault{"force", "all noise", spoil_force<Kind::garbage>, heal_force<Kind::garbage>, End::link_lost, 6,
          kForceLost},
    Fault{"force", "half messages", spoil_force<Kind::half_message>, heal_force<Kind::half_message>,
          End::link_lost, 6, kForceLost},
    Fault{"force", "5 % lost", spoil_force<Kind::loss, 5>, heal_force<Kind::loss>, End::unharmed, 0, 0,
          "missing"},
    Fault{"force", "30 % behind the next", spoil_force<Kind::reorder, 30>, heal_force<Kind::reorder>,
          End::unharmed, 0, 0, "old"},
    Fault{"force", "half come twice", spoil_force<Kind::duplicate, 50>, heal_force<Kind::duplicate>,
          End::unharmed, 0, 0, "old"},
    Fault{"tracker", "silent", spoil_tracker<Kind::stall>, heal_tracker<Kind::stall>, End::link_lost, 101,
          kToolLost, nullptr, false, 501, kTrackerFault},
    Fault{"tracker", "all noise", spoil_tracker<Kind::garbage>, heal_tracker<Kind::garbage>, End::link_lost,
          101, kToolLost, nullptr, false, 501, kTrackerFault},
    Fault{"tracker", "half messages", spoil_tracker<Kind::half_message>, heal_tracker<Kind::half_message>,
          End::link_lost, 101, kToolLost, nullptr, false, 501, kTrackerFault},
    Fault{"tracker", "20 % lost and 30 % behind the next",
          [](WiredTrial& at) {
            spoil_tracker<Kind::loss, 20>(at);
            spoil_tracker<Kind::reorder, 30>(at);
          },
          [](WiredTrial& at) {
            heal_tracker<Kind::loss>(at);
            heal_tracker<Kind::reorder>(at);
          },
          End::unharmed, 0, 0, "datagrams missing"},
    Fault{"tracker", "half come twice", spoil_tracker<Kind::duplicate, 50>, heal_tracker<Kind::duplicate>,
          End::unharmed, 0, 0, "old"},
    over_tcp({kStream, "silent", spoil_tracker<Kind::stall>, heal_tracker<Kind::stall>, End::link_lost, 101,
              kToolLost, nullptr, false, 501, kTrackerFault}),
    over_tcp({kStream, "closed", spoil_tracker<Kind::disconnect>, heal_tracker<Kind::disconnect>,
              End::link_lost, 2, kTrackerFault}),
    // The first noise ends the connection. A pose comes every 10 ms plus its wait; without a tool in view the
    // server answers every 125 ms.
    over_tcp({kStream, "all noise", spoil_tracker<Kind::garbage>, heal_tracker<Kind::garbage>, End::link_lost,
              16, kTrackerFault, nullptr, false, 127, kTrackerFault}),
    over_tcp({kStream, "half messages", spoil_tracker<Kind::half_message>, heal_tracker<Kind::half_message>,
              End::link_lost, 101, kToolLost | kTrackerFault, nullptr, false, 501, kTrackerFault}),
    // Times count from the return of the loop: the machine stands already.
    Fault{"program", "its loop stands for 400 ms",
          [](WiredTrial& at) { at.wires().stand(Duration(400'000'000), false); }, nothing, End::holds, 1,
          kClockLate, nullptr, true},
    Fault{"program", "stopped for 2 s (SIGSTOP)",
          [](WiredTrial& at) { at.wires().stand(Duration(2'000'000'000), true); }, nothing, End::holds, 1,
          kClockLate, nullptr, true},
};

constexpr int kInjured = 700, kCured = 500;  // ticks
constexpr double kSlack = 1e-4;              // m: steps and noise of a tip at standstill

// s: the set-points that the controller still holds after its last message, and the machine's dead time.
double blind(const models::Setup& setup) {
  constexpr double kPoints = 4.0;  // three that wait (one is added while two do) and the current target
  gcs::GcsSettings machine;
  models::DriverTableReader table(setup, "gcs");
  machine.declare(table);
  return kPoints * machine.cycle + static_cast<double>(setup.twin.hexapod.delay_cycles) / setup.rig.loop.rate;
}
// 1/s, decay rate of the machine's servo.
double decay(const models::Setup& setup) {
  return setup.twin.hexapod.damping * 2.0 * std::numbers::pi * setup.twin.hexapod.servo;
}

models::Setup loaded(const std::string& models, const std::string& transport) {
  return models::load(models + "/scenes/tennis_ball.toml", "fakes",
                      enc::wires::tight_times({"rig.driver.gcs.watchdog_ms=5", "rig.driver.netft.silent_ms=5",
                                               "rig.driver.igtl.transport=\"" + transport + "\"",
                                               "user.press_s=1", "user.hold_s=0.2", "user.release_s=1",
                                               "user.rest_s=0.5", "user.approach_mm_s=[50]"}));
}

// The number before the word in a driver's remarks at the end of a run.
double number_before(const std::vector<std::string>& remarks, const std::string& word) {
  for (const std::string& remark : remarks) {
    const std::size_t at = remark.find(" " + word);
    if (at == std::string::npos) continue;
    const std::size_t begin = remark.rfind(' ', at - 1) + 1;
    return std::stod(remark.substr(begin, at - begin));
  }
  return kUnset;
}

std::span<const Fault> faults() { return kFaults; }

// A run without a fault: how far the tip would have gone.
const Fault& no_fault() {
  static constexpr Fault kNone{"", "", nothing, nothing, End::unharmed};
  return kNone;
}

// Bounds for every cell, from the tip's speed, the set-points that the controller still holds, and the
// machine's dead time, servo and acceleration. ms
double rest_bound(const Fault& fault, const Reaction& of, const models::Setup& setup) {
  const ServoLaw law = sim::servo_of(setup.twin.hexapod);
  return fault.hold_in(of.in) + 1e3 * (blind(setup) + longest_settling(law, of.speed, kStands));
}

// m
double way_bound(const Fault& fault, const Reaction& of, const models::Setup& setup) {
  const double brakes = 0.5 * of.speed * of.speed / setup.rig.manipulator.acceleration;
  return of.speed * (1e-3 * fault.hold_in(of.in) + blind(setup) + 1.0 / decay(setup)) + brakes + kSlack;
}

// Lists the bounds that the reaction violates; empty if it meets all.
std::string wrong_with(const Fault& fault, Mode mode, const Reaction& of, const models::Setup& setup) {
  std::string wrong;
  const auto say = [&](bool bad, const std::string& what) {
    if (bad) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  say(of.in != mode, fmt::format("it was in {}", mode_name(of.in)));
  if (fault.end == End::unharmed) {
    say(of.held, "held: " + why_text(of.why));
    say(!of.linked, "a link was lost");
    say(fault.counted != nullptr && !(of.counted > 0.0), "the driver has counted none");
    return wrong;
  }
  const double hold = fault.hold_in(mode);
  say(!(of.hold <= hold), fmt::format("held after {} ms, at most {}", of.hold, hold));
  say((of.why & fault.why_in(mode)) == 0, "held for another reason: " + why_text(of.why));
  const double rest = rest_bound(fault, of, setup), way = way_bound(fault, of, setup);
  say(!(of.rest <= rest), fmt::format("at rest after {} ms, at most {:.0f}", of.rest, rest));
  say(!(of.way <= way), fmt::format("went {:.2f} mm, at most {:.2f}", 1e3 * of.way, 1e3 * way));
  say(of.linked != (fault.end == End::holds), of.linked ? "the link came back" : "the link is lost");
  say(of.goes_on != (fault.end == End::holds),
      of.goes_on ? "it goes on by itself" : "it does not go on: " + of.end);
  return wrong;
}

ShortPress::ShortPress(const std::string& models)
    : datagrams(loaded(models, "udp")), stream(loaded(models, "tcp")) {}

// Injects the fault in that mode, at a moment that the seed selects.
Reaction react(const models::Setup& setup, const Fault& fault, Mode mode, std::uint64_t seed) {
  trial::TrialOptions options{.seed = seed};
  WiredTrial wired(setup, std::move(options));
  trial::Trial& trial = wired.trial();
  Reaction of;
  const auto in = [&](Mode wanted) { return trial.outputs().mode == wanted; };
  while (wired.tick() && !in(mode)) {
  }
  // Wait within the mode: a tool is far for some ten milliseconds at first, and restoring lasts as long.
  std::mt19937_64 random(seed);
  const int most = mode == Mode::contact ? 1500 : mode == Mode::follow ? 100 : mode == Mode::away ? 4 : 1;
  const int later = static_cast<int>(random() % static_cast<std::uint64_t>(most));
  for (int i = 0; i < later && in(mode); ++i)
    if (!wired.tick()) break;
  const auto& plant = trial.world().machine->state();
  of.in = trial.outputs().mode;
  const Vec3 first = plant.pose.p();
  Vec3 told = trial.outputs().manipulator.tip.p();
  fault.inject(wired);
  for (int i = 1; i <= kInjured; ++i) {
    const bool before = std::isinf(of.hold);
    if (before) of.speed = std::max(of.speed, plant.velocity.norm());
    if (!wired.tick()) break;
    if (before)
      of.speed = std::max(of.speed, (trial.outputs().manipulator.tip.p() - told).norm() / trial.scene().dt);
    told = trial.outputs().manipulator.tip.p();
    of.held = of.held || in(Mode::hold);
    if (in(Mode::hold) && std::isinf(of.hold)) {
      of.hold = i;
      of.why = trial.outputs().why;
    }
    const bool still = plant.velocity.norm() < kStands;
    if (fault.over) {  // state at the return of the loop
      of.goes_on = of.goes_on || (of.held && !in(Mode::hold));
      if (i == 1 && still) of.rest = i;
      if (i == 1) of.way = (plant.pose.p() - first).norm();
      continue;
    }
    if (!still) of.rest = kNever;
    if (still && std::isinf(of.rest)) of.rest = i;
    of.way = std::max(of.way, (plant.pose.p() - first).norm());
  }
  fault.cure(wired);
  for (int i = 0; i < kCured && wired.tick(); ++i) of.goes_on = of.goes_on || !in(Mode::hold);
  of.end = why_text(trial.outputs().why);
  const Rig& rig = trial.rig();
  if (fault.counted != nullptr)
    of.counted = number_before(
        fault.device == std::string_view("force") ? rig.force->remarks() : rig.tracker->remarks(),
        fault.counted);
  of.linked = rig.manipulator->linked() && rig.force->linked() && rig.tracker->linked();
  of.simulated = seconds(trial.now().t.time_since_epoch());
  return of;
}

struct Cell {
  const Fault* fault;
  Mode mode;
  std::uint64_t seed;
  Reaction of{};
};

void expect_all_hold(std::vector<Cell>& cells) {
  const ShortPress press(tests::source_dir() + "/models");
  in_parallel(cells.size(), [&](std::size_t i) {
    cells[i].of = react(press.of(*cells[i].fault), *cells[i].fault, cells[i].mode, cells[i].seed);
  });
  for (const Cell& cell : cells) {
    const std::string name = fmt::format("{} {}, in {}, seed {}", cell.fault->device, cell.fault->name,
                                         mode_name(cell.mode), cell.seed);
    EXPECT_EQ(wrong_with(*cell.fault, cell.mode, cell.of, press.datagrams), "") << name;
    testing::Test::RecordProperty(
        name, fmt::format("hold {} ms, fastest {:.1f} mm/s, rest {} ms, {:.2f} mm", cell.of.hold,
                          1e3 * cell.of.speed, cell.of.rest, 1e3 * cell.of.way));
  }
}

// Injects each fault once in each mode, at a different moment each time.
TEST(SafetyMatrix, EachFaultEndsAsStatedWithTheMachineAtRest) {
  std::vector<Cell> cells;
  for (const Fault& fault : faults())
    for (const Mode mode : kInjectedIn) cells.push_back({&fault, mode, 1 + cells.size()});
  expect_all_hold(cells);
}

// The table of docs/reference/safety.md has the minimum and the maximum of these.
TEST(SafetyMatrixLong, EachFaultEndsAsStatedOverFiveSeeds) {
  std::vector<Cell> cells;
  for (const Fault& fault : faults())
    for (const Mode mode : kInjectedIn)
      for (std::uint64_t seed = 1; seed <= 5; ++seed) cells.push_back({&fault, mode, seed});
  expect_all_hold(cells);
}

// The path bounds are meaningful: without the fault, in half of the cells with a moving tip, it would have
// gone beyond its bound.
TEST(SafetyMatrix, WithoutTheFaultTheTipWouldHaveGoneFarther) {
  const ShortPress press(tests::source_dir() + "/models");
  std::vector<Cell> cells;
  for (const Mode mode : {Mode::follow, Mode::contact}) {
    cells.push_back({&no_fault(), mode, 1});
    for (const Fault& fault : faults())
      if (fault.end != End::unharmed) cells.push_back({&fault, mode, 1});
  }
  in_parallel(cells.size(), [&](std::size_t i) {
    cells[i].of = react(press.of(*cells[i].fault), *cells[i].fault, cells[i].mode, cells[i].seed);
  });
  std::size_t moving = 0, farther = 0;
  double undisturbed = 0.0;  // m, in this mode
  for (const Cell& cell : cells) {
    if (cell.fault == &no_fault()) {
      undisturbed = cell.of.way;
      continue;
    }
    ++moving;
    farther += undisturbed > way_bound(*cell.fault, cell.of, press.datagrams) ? 1 : 0;
  }
  EXPECT_GE(2 * farther, moving);
}

}  // namespace

}  // namespace enc::bench::wires
