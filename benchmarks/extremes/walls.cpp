// Walls from 10^2 to 10^6 N/m on both machines.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "core/base/units.h"
#include "trial/certificates.h"

namespace enc::bench::extremes {
namespace {

constexpr double kPush = 4.0;   // N, of the finger
constexpr double kStill = 1.0;  // mm, peak to peak: what goes farther is not rendered

// m, peak to peak along z: how far the tip goes to and fro while it is watched.
class Swing {
 public:
  void see(const trial::Glance& glance) {
    low_ = std::min(low_, glance.truth.tip.xyz[2]);
    high_ = std::max(high_, glance.truth.tip.xyz[2]);
  }
  [[nodiscard]] double size() const { return high_ > low_ ? high_ - low_ : 0.0; }

 private:
  double low_ = kInfinite, high_ = -kInfinite;
};

std::string name_of(const char* machine, double stiffness) {
  return fmt::format("{}.wall.{:.0f}", machine, stiffness);
}

// The finger presses as the scene says it does; the last half of its hold is watched.
Found arm_wall(const BenchContext& context, double stiffness) {
  const models::Setup setup =
      load_scene(context, "wall",
                 {fmt::format("behaviour.phantom_wall.stiffness_N_per_mm={:g}", stiffness / 1e3),
                  fmt::format("user.push_N={:g}", kPush)});
  Found found{fmt::format("wall.toml at {:g} N/m, pressed with 4 N", stiffness),
              "the sheet's peak for at most a cycle more; named where beyond the law",
              {}};
  trial::TrialOptions options;
  options.seed = context.seed;
  Swing swing;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    if (g.truth.phase == sim::Phase::hold) swing.see(g);
  });
  const trial::Certified wall = trial::certificates_of(setup, trial::prepare_setup(setup)).back();
  const std::string beyond = trial::refusal_text(setup, wall);
  found.numbers = {
      {"force.max", run.judge.force, "N", at_most(setup.rig.arm.peak * (1.0 + 1e-9)), "commanded"},
      {"over.max", static_cast<double>(run.judge.over), "", at_most(1.0), "cycles in a row"},
      {"touch.max", run.judge.touch, "N", {}, "true force on the finger"},
      {"swing.max", swing.size() * kMmPerM, "mm", {}, "of the tip, while the finger holds", kStill}};
  if (stiffness > certificate::row_of(wall.certificate, "exact_with_hand").bound)
    found.numbers.push_back(
        {"named.value", beyond.empty() ? 0.0 : 1.0, "", exactly(1.0), "by check and run"});
  add_soundness(run, found);
  if (!beyond.empty()) found.words = "said before the run: " + beyond.substr(0, beyond.find(';'));
  return found;
}

// Pushed from outside with up to 30 N.
Found machine_wall(const BenchContext& context, double stiffness) {
  const models::Setup setup = load_scene(
      context, "stiffness", {fmt::format("behaviour.spring.stiffness_N_per_mm={:g}", stiffness / 1e3)});
  Found found{fmt::format("stiffness.toml at {:g} N/m, pushed with 30 N", stiffness),
              "commands within speed, acceleration and reach; at most 100 N",
              {}};
  trial::TrialOptions options;
  options.seed = context.seed;
  Swing swing;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    const double t = time_of(g);
    if (t > 5.0 && t < 8.5) swing.see(g);  // held from 3 s to 9 s
  });
  found.numbers = {
      {"speed.max", run.judge.fastest * kMmPerM, "mm/s", at_most(50.0 * (1.0 + 1e-9)), "commanded"},
      {"touch.max", run.judge.touch, "N", at_most(100.0), "true force on the tip"},
      {"swing.max", swing.size() * kMmPerM, "mm", at_most(kStill), "of the tip, while it is held down"}};
  add_soundness(run, found);
  return found;
}

}  // namespace

void add_walls(Cases& cases, bool quick) {
  const std::vector<double> soft{1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6}, stiff{1e3, 1e4, 1e5, 1e6},
      few{1e4, 1e6};
  for (const double stiffness : quick ? few : soft)
    cases.push_back({name_of("arm", stiffness),
                     [=](const BenchContext& context) { return arm_wall(context, stiffness); }});
  for (const double stiffness : quick ? few : stiff)
    cases.push_back({name_of("hexapod", stiffness),
                     [=](const BenchContext& context) { return machine_wall(context, stiffness); }});
}

void add_wall_plot(Bench& bench, const Cases& cases, const std::vector<Found>& found) {
  Series told{.name = "commanded", .mark = Mark::both},
      touch{.name = "true, on the finger", .mark = Mark::both};
  Series limit{.name = "what the device has"}, push{.name = "what the finger pushes with"};
  Series lost{.name = "does not hold the finger still", .mark = Mark::crosses};
  const std::string wall = "arm.wall.";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].id.starts_with(wall)) continue;
    const double stiffness = std::stod(cases[i].id.substr(wall.size()));
    for (const Number& n : found[i].numbers) {
      if (n.what == "force.max") {
        told.add(stiffness, n.value);
        limit.add(stiffness, n.bounds.high);
        push.add(stiffness, kPush);
      }
      if (n.what == "touch.max") touch.add(stiffness, n.value);
      if (n.what == "swing.max" && n.value > n.wanted) lost.add(stiffness, kUnset);
    }
  }
  bench.plot(
      {.id = "walls",
       .title = "A finger presses a wall with 4 N",
       .x_label = "stiffness of the wall (N/m)",
       .y_label = "largest force (N)",
       .log_x = true,
       .series = {told, touch, limit, push, lost},
       .caption =
           "However stiff a wall is, no more is commanded than the device has. From 10^4 N/m on the law "
           "rings, which is said before the run: the tip swings by centimetres."});
}

}  // namespace enc::bench::extremes
