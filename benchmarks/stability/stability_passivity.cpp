// The passivity controller of the core in the loop of a wall, on the slide in MuJoCo: how much energy the
// wall gives out, with and without it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "benchmarks/kit/yardstick.h"
#include "benchmarks/stability/stability.h"
#include "core/control/safety/passivity/passivity.h"

namespace enc::bench::stability {
namespace {

constexpr double kPeak = 8.5;  // N, of a PHANToM
constexpr Stepping kTenths{Scheme::rk4, 10};

// A wall that pushes outwards alone, as far as the machine can.
struct Rendered {
  Device device;
  Wall wall;
  bool controlled = false, limited = true;
  double wave = 0.0;  // m, of the surface under a finger that slides along it at 100 mm/s, 40 mm long
};

class Loop {
 public:
  explicit Loop(const Rendered& r) : r_(r), slide_(r.device, {}, kTenths, 1.0) {}

  void throw_from(double x, double speed) {
    slide_.throw_from(x, speed);
    before_ = slide_.read() - surface();
    energy_ = {};
    contact_ = 0.0;
    touching_ = false;
  }
  // One period, under a hand's push. Outwards is +x.
  void period(double hand) {
    const double apart = slide_.read() - surface(), moved = apart - before_, depth = std::max(0.0, -apart);
    before_ = apart;
    if (depth > 0.0 && !touching_) contact_ = 0.0;
    touching_ = depth > 0.0;
    const double before = slide_.work(), stood = surface();
    const double push = law(depth, moved);
    slide_.period(push, hand);
    ++periods_;
    contact_ += slide_.work() - before - push * (surface() - stood);
    given_ = std::max(given_, contact_);
  }
  [[nodiscard]] bool touching() const { return touching_; }
  [[nodiscard]] const Slide& slide() const { return slide_; }
  [[nodiscard]] double contact() const { return contact_; }  // J, true, of the present or last one
  [[nodiscard]] double given() const { return given_; }  // J, true: at any moment of any contact, the most

 private:
  [[nodiscard]] double surface() const {
    const double turn = 2.0 * std::numbers::pi * 0.1 / 0.04 * r_.device.period;
    return r_.wave * std::sin(turn * static_cast<double>(periods_));
  }
  double law(double depth, double moved) {
    const double most = r_.limited ? kPeak : 1e9;
    const double asked =
        depth > 0.0
            ? std::clamp(r_.wall.stiffness * depth - r_.wall.damper * moved / r_.device.period, 0.0, most)
            : 0.0;
    if (!r_.controlled) return asked;
    if (!(depth > 0.0)) {
      energy_ = {};
      return 0.0;
    }
    const Yielded tick{moved, depth, std::min(most, r_.wall.stiffness * depth)};
    if (energy_.on)
      observe(energy_, tick, r_.device.count);
    else
      begin(energy_, tick, 0.0);
    const double per_newton = r_.device.period * r_.device.period / (2.0 * r_.device.mass);
    const double push = std::clamp(passive(energy_, asked, per_newton, r_.device.count), -most, most);
    hold(energy_, push, asked);
    return push;
  }

  Rendered r_;
  Slide slide_;
  Passivity energy_;
  double before_ = 0.0, contact_ = 0.0, given_ = 0.0;
  bool touching_ = false;
  std::int64_t periods_ = 0;
};

// Of many bounces.
struct Bounced {
  double given = 0.0;   // J: that was out more than in, at any moment of a contact, the most
  double kept = -1.0;   // J: at its end, the most
  double parted = 0.0;  // speed at which it parts over that at which it met, mean
};
Bounced bounce(const Rendered& r, int times, double slowest, double fastest) {
  std::mt19937_64 draw(20);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  Loop loop(r);
  Bounced all;
  for (int i = 0; i < times; ++i) {
    const double speed = slowest + (fastest - slowest) * even(draw);
    loop.throw_from(speed * r.device.period * even(draw), -speed);
    const std::int64_t most = std::llround(1.0 / r.device.period);  // in a second it has parted
    bool met = false;
    for (std::int64_t k = 0; k < most && !(met && !loop.touching()); ++k) {
      loop.period(0.0);
      met = met || loop.touching();
    }
    all.kept = std::max(all.kept, loop.contact());
    all.parted += std::abs(loop.slide().speed()) / speed / times;
  }
  all.given = loop.given();
  return all;
}

// Pressed against it by 1 N for so long: what it gave out in one contact, J, the most.
double pressed(const Rendered& r, double seconds) {
  Loop loop(r);
  loop.throw_from(2e-3, 0.0);
  for (int i = 0; i < std::lround(seconds / r.device.period); ++i) loop.period(-1.0);
  return loop.given();
}

// Three times what is passive, and what is stable.
double beyond(double damping) {
  const Device device{0.1, damping, 1e-3};
  return 3.0 * std::max(2.0 * damping / device.period, certificate::critical_stiffness(loop_of(device)));
}

struct Row {
  double damping = 0.2, stiffness = 0.0, count = 0.0;
  Bounced off{}, on{};
  double off_pressed = 0.0, on_pressed = 0.0;
};
Row measured(Row row, bool quick) {
  Rendered r{{0.1, row.damping, 1e-3}, {row.stiffness, 0.0}};
  r.device.count = row.count;
  const int times = quick ? 100 : 1000;
  row.off = bounce(r, times, 0.02, 0.3);
  const double seconds = quick ? 3.0 : 30.0;
  r.wave = 1e-3;
  row.off_pressed = pressed(r, seconds);
  r.controlled = true;
  row.on_pressed = pressed(r, seconds);
  r.wave = 0.0;
  row.on_pressed = std::max(row.on_pressed, pressed(r, seconds));
  row.on = bounce(r, times, 0.02, 0.3);
  return row;
}

// By how much faster it parts from a wall that is held for a period than from one that goes along, %
// [fidelity d1: 0.1 kg at 0.2 m/s, damping ratio 0.1].
double gained(double stiffness, bool controlled) {
  Rendered r{{0.1, 0.0, 1e-3}, {stiffness, 0.2 * std::sqrt(0.1 * stiffness)}, controlled, false};
  const double held = bounce(r, 200, 0.2, 0.2).parted;
  r.controlled = false;
  r.device.period = 1e-5;
  return 100.0 * (held / bounce(r, 1, 0.2, 0.2).parted - 1.0);
}

void add_cost_of_control(Bench& bench) {
  constexpr int kTimes = 200'000;
  std::vector<double> seconds;
  double kept = 0.0;
  for (int k = 0; k < 15; ++k) {
    Passivity now;
    begin(now, {-1e-4, 1e-3, 1.0}, 1e-4);
    const double start = thread_seconds();
    for (int i = 0; i < kTimes; ++i) {
      const double moved = 1e-4 * ((i % 7) - 3), asked = 1.0 + (i % 5);
      observe(now, {moved, 1e-3 - moved, 1.0}, 3e-5);
      const double push = passive(now, asked, 5e-6, 3e-5);
      hold(now, push, asked);
      kept += push;
    }
    seconds.push_back((thread_seconds() - start) / kTimes);
  }
  bench.cost("passivity.time.median", 1e9 * median(seconds), "ns",
             kept == 0.0 ? "of a tick: nothing was pushed" : "of a tick, observer and controller");
}

}  // namespace

void add_passivity(Bench& bench) {
  std::vector<Row> rows;
  for (const double damping : {0.05, 0.2, 1.0}) rows.push_back({damping, beyond(damping)});
  for (const double stiffness : {1e3, 1e4, 1e5}) rows.push_back({0.2, stiffness});
  const std::size_t exact = rows.size();
  for (std::size_t i = 0; i < exact; ++i) rows.push_back({rows[i].damping, rows[i].stiffness, 30e-6});
  const bool quick = bench.context.quick;
  rows = bench.each(rows, [&](const Row& row) { return measured(row, quick); });
  Table table{
      "passivity",
      "Energy that a sampled wall gives out",
      {"b (N s/m)", "K (N/m)", "count (um)", "bounce: out (mJ)", "parts at", "pressed: out (mJ)",
       "controlled: out (mJ)", "parts at", "pressed: out (mJ)"},
      {},
      "0.1 kg, 1 kHz, at most 8.5 N, 20 to 300 mm/s. Out: more than in, at any moment of a contact. "
      "Parts at: over the speed at which it met. Pressed: by 1 N for 30 s, on a surface that waves by "
      "1 mm under a finger that slides at 100 mm/s."};
  double bounced = 0.0, slid = 0.0, stiff = 0.0, without = HUGE_VAL, counted = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& r = rows[i];
    table.add(r.damping, fmt::format("{:.0f}", r.stiffness), r.count * 1e6,
              fmt::format("{:.3f}", r.off.given * 1e3), fmt::format("{:.3f}", r.off.parted),
              fmt::format("{:.3f}", r.off_pressed * 1e3), fmt::format("{:.4f}", r.on.given * 1e3),
              fmt::format("{:.3f}", r.on.parted), fmt::format("{:.4f}", r.on_pressed * 1e3));
    if (i < 3) {
      bounced = worse(bounced, r.on.given);
      slid = worse(slid, r.on_pressed);
      without = std::min(without, r.off.given);
    }
    if (i < exact)
      stiff = worse(stiff, r.on.kept);
    else
      counted = worse(counted, r.on.kept);
  }
  bench.figure("passivity.bounces.energy.max", 1e3 * bounced, "mJ", at_most(0.1),
               "more out than in, at any moment of 1000 bounces at three times the bound of stability, with "
               "the controller");
  bench.figure("passivity.sliding.energy.max", 1e3 * slid, "mJ", at_most(0.1),
               "the same, pressed by 1 N for 30 s, at rest and while it slides over a wave");
  bench.figure("passivity.none.energy.min", 1e3 * without, "mJ", at_least(0.1),
               "the bounces without it: the least of the three");
  bench.figure("passivity.stiff.energy.max", 1e3 * stiff, "mJ", at_most(8.5 * 0.3 * 1e-3 * 1e3),
               "that a bounce gains with it, walls to 1e5 N/m: at most F v T of one cycle");
  bench.figure("passivity.counts.energy.max", 1e3 * counted, "mJ", at_most(8.5 * 0.3 * 1e-3 * 1e3),
               "the same with counts of 30 um");
  bench.figure("passivity.none.gain", gained(1e3, false), "%", between(7.0, 11.0),
               "by which it parts faster from 1e3 N/m, held for 1 ms, than from a wall without sampling; no "
               "controller; theory: 9");
  bench.figure("passivity.gain", gained(1e3, true), "%",
               "the same with it: the damper of that law takes more than sampling gives out, so there is "
               "nothing to take");
  add_cost_of_control(bench);
  bench.table(std::move(table));
}

}  // namespace enc::bench::stability
