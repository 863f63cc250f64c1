// The first contact: force, bounces and grip force over the solver's settings, the time step, speed and
// stiffness, against an independent contact law (docs/reference/impact.md).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/impact/touch.h"
#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "models/order_statistics.h"

namespace enc::bench::impact {
namespace {

constexpr const char* kStill = "truth.hand.drift_mm=0";  // makes the touch equal in each run
constexpr double kFine = 5e-6;                           // s: half of this step changes the force by 0.1 %

// N/m and damping ratio for the tool's mass: the converged result does not depend on them.
Law law_of(const models::Setup& setup, double stiffness) {
  constexpr double kRatio = 0.3;
  const double mass = setup.scene.tools.front().mass;
  return {stiffness, 1.0, 0.0, 2.0 * kRatio * std::sqrt(stiffness * mass), setup.twin.world.tip_friction};
}

struct TouchComparison {
  FirstTouch touch, reference;
  double cpu = kUnset, simulated = 0.0;
  std::string failure;
  [[nodiscard]] double error() const { return 100.0 * std::abs(touch.grip / reference.grip - 1.0); }  // %
};

TouchComparison compare(const models::Setup& setup, std::uint64_t seed, double stiffness = 1e5) {
  const TouchRecord watched = watch_touch(setup, seed);
  TouchComparison found{watched.touch, {}, watched.cpu, watched.simulated, watched.failure};
  if (!std::isnan(watched.touch.at))
    found.reference = refer(setup, seed, watched, law_of(setup, stiffness), kFine);
  return found;
}

template <class Of>
std::vector<double> values(const std::vector<TouchComparison>& all, Of of) {
  std::vector<double> known;
  for (const TouchComparison& one : all)
    if (const double value = of(one); !std::isnan(value)) known.push_back(value);
  return known;
}

struct Setting {
  const char* family;
  std::string name;
  std::vector<std::string> set;
};

constexpr const char* kCoarse = "truth.solver.tolerance=1e-8";  // MuJoCo's default

// The rig's own setting comes first.
std::vector<Setting> settings() {
  std::vector<Setting> all{{"as the rig has it", "1 ms", {}}};
  const auto step = [](double us) { return fmt::format("truth.world.timestep_us={:g}", us); };
  for (const double us : {500.0, 250.0, 125.0, 62.5})
    all.push_back({"as the rig has it", fmt::format("{:g} ms", us * 1e-3), {step(us)}});
  for (const double ratio : {1.0, 20.0})
    for (const int noslip : {0, 4})
      for (const double us : {1000.0, 250.0, 62.5})
        all.push_back({ratio == 1.0  ? noslip == 0 ? "impratio 1, no noslip" : "impratio 1, noslip 4"
                       : noslip == 0 ? "impratio 20, no noslip"
                                     : "impratio 20, noslip 4",
                       fmt::format("{:g} ms", us * 1e-3),
                       {step(us), fmt::format("truth.solver.impratio={:g}", ratio),
                        fmt::format("truth.solver.noslip_iterations={}", noslip), kCoarse}});
  for (const double us : {1000.0, 250.0})
    all.push_back({"pyramidal cone, no noslip",
                   fmt::format("{:g} ms", us * 1e-3),
                   {step(us), "truth.solver.cone=pyramidal", "truth.solver.noslip_iterations=0", kCoarse}});
  for (const int iterations : {1, 3})
    all.push_back({"few iterations",
                   fmt::format("{}", iterations),
                   {fmt::format("truth.solver.iterations={}", iterations), kCoarse}});
  for (const char* tolerance : {"1e-4", "1e-8", "1e-10", "1e-12"})
    all.push_back({"tolerance", tolerance, {fmt::format("truth.solver.tolerance={}", tolerance)}});
  return all;
}

// All hands in the order of the settings.
std::vector<TouchComparison> compare_all(Bench& bench, const std::string& scene,
                                         const std::vector<Setting>& all, std::size_t hands) {
  std::vector<std::pair<std::size_t, std::uint64_t>> runs;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const std::uint64_t seed : bench.seeds(hands)) runs.emplace_back(i, seed);
  return bench.each(runs, [&](const auto& run) {
    std::vector<std::string> own{kStill};
    own.insert(own.end(), all[run.first].set.begin(), all[run.first].set.end());
    TouchComparison found = compare(load_scene(bench.context, scene, own), run.second);
    if (bench.context.mutated("contact_for_grip")) found.touch.grip = found.touch.peak;
    return found;
  });
}

double breaks_of(const TouchComparison& c) { return static_cast<double>(c.touch.breaks); }

// The touches of all hands with one setting.
struct SweepResult {
  std::vector<TouchComparison> hands;
  std::vector<double> errors;  // %, of what is felt
  Tail tail;                   // of the errors
  std::ptrdiff_t failed;       // hands
  double error, cost;          // %, the tail, unset if a run failed; s of CPU for each second of experiment

  template <class Of>
  [[nodiscard]] double middle(Of of) const {
    return median(values(hands, of));
  }
};
SweepResult swept(const std::vector<TouchComparison>& found, std::size_t setting, std::size_t hands) {
  std::vector<TouchComparison> of(found.begin() + static_cast<std::ptrdiff_t>(setting * hands),
                                  found.begin() + static_cast<std::ptrdiff_t>((setting + 1) * hands));
  std::vector<double> errors = values(of, [](const TouchComparison& c) { return c.error(); });
  const auto failed =
      std::count_if(of.begin(), of.end(), [](const TouchComparison& c) { return !c.failure.empty(); });
  const Tail tail = tail_of(errors, 0.95);
  const double error = failed > 0 ? kUnset : tail.value;
  const double cost = median(values(of, [](const TouchComparison& c) { return c.cpu; }));
  return {std::move(of), std::move(errors), tail, failed, error, cost};
}

void add_row(const Setting& setting, const SweepResult& of, Table& table) {
  table.add(setting.family, setting.name, fmt::format("{:.2g}", median(of.errors)),
            fmt::format("{:.2g}", of.error),
            fmt::format("{:.3g}", of.middle([](const TouchComparison& c) { return c.touch.peak; })),
            fmt::format("{:.3g}", of.middle([](const TouchComparison& c) { return c.touch.sampled; })),
            fmt::format("{:g}", of.middle(breaks_of)), fmt::format("{:.3g}", of.cost), of.failed);
}

void judge_default(Bench& bench, const std::string& scene, const SweepResult& of) {
  bench.figure(scene + ".felt.error.median", median(of.errors), "%", at_most(10.0),
               fmt::format("most that the grip pushes the hand with in 0.1 s from the touch, at the "
                           "default, against a contact law of its own with a converged step; {} hands",
                           of.hands.size()));
  bench.figure(scene + ".felt.error." + of.tail.word, of.error, "%",
               "the same, of 95 % of the hands or of all");
  const Tail newtons = tail_of(
      values(of.hands, [](const TouchComparison& c) { return std::abs(c.touch.grip - c.reference.grip); }),
      0.95);
  bench.figure(scene + ".felt.error_N." + newtons.word, newtons.value, "N", at_most(0.1),
               "the same in newtons: the least force that is told is 0.1 N");
  bench.figure(scene + ".breaks.median", of.middle(breaks_of), "",
               "of the contact in that time, at the default");
  bench.figure(scene + ".reference.breaks.median",
               of.middle([](const TouchComparison& c) { return static_cast<double>(c.reference.breaks); }),
               "", "the same by the law of its own, 10^5 N/m, damping ratio 0.3: what of it is physics");
}

// The solver's settings and the time step, for one scene; %.
void add_sweep(Bench& bench, const std::string& scene) {
  const std::size_t hands = bench.context.count(20, 3);  // 20 have a p95
  std::vector<Setting> all = settings();
  if (bench.context.quick) all.resize(5);
  const std::vector<TouchComparison> found = compare_all(bench, scene, all, hands);
  Table table{"sweep_" + scene,
              "First touch of " + scene + ": the solver and the time step",
              {"setting", "step or value", "error of what is felt (%), median",
               "95 % (of fewer than 20 hands the most)", "contact, most (N)", "at ticks (N)", "breaks",
               "CPU s per s", "failed"}};
  std::vector<CostCurve> curves;
  Series chosen{.name = "default", .mark = Mark::points, .paper = true};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const SweepResult of = swept(found, i, hands);
    if (curves.empty() || curves.back().name != all[i].family) curves.push_back({all[i].family});
    curves.back().cost.push_back(of.cost);
    curves.back().error.push_back(of.error);
    if (i == 0) chosen.add(of.cost, of.error);
    add_row(all[i], of, table);
    if (i == 0) judge_default(bench, scene, of);
  }
  Plot plot = cost_beside_error(
      {.id = "sweep_" + scene,
       .title = "First touch of " + scene + ": error against run time",
       .x_label = "CPU time for one second of experiment (s)",
       .y_label = "error of what the hand feels (%)",
       .caption = "Of the grip's largest force, 95 % of the hands, against a contact law of its own at a "
                  "converged step. A person tells 7 %, and 0.1 N. Crosses: the engine warned."},
      curves, {{"a person tells", 7.0}});
  plot.series.push_back(std::move(chosen));
  bench.plot(std::move(plot));
  bench.table(std::move(table));
}

struct TouchMedians {
  double grip, peak, breaks, push;
};
// Medians over the touches that happened.
TouchMedians touch_medians(const std::vector<FirstTouch>& all) {
  std::vector<double> grip, peak, breaks, push;
  for (const FirstTouch& t : all) {
    if (std::isnan(t.at)) continue;
    grip.push_back(t.grip);
    peak.push_back(t.peak);
    breaks.push_back(t.breaks);
    push.push_back(t.push);
  }
  return {median(grip), median(peak), median(breaks), median(push)};
}

// The independent contact law over its stiffness and step: the dependence of a touch on each.
void add_law(Bench& bench) {
  const models::Setup setup = load_scene(bench.context, "session", {kStill});
  const std::size_t hands = bench.context.count(8, 2);
  const auto measured = bench.each(bench.seeds(hands), [&](std::uint64_t seed) {
    return std::pair{seed, watch_touch(setup, seed)};
  });
  Table table{
      "law",
      "The law of its own: first touch of session",
      {"stiffness (N/m)", "friction", "step (us)", "felt (N)", "contact, most (N)", "breaks", "push (mN s)"}};
  const auto felt = [&](const Law& law, double step, const std::string& stiffness) {
    const auto all = bench.each(measured, [&](const auto& m) {
      return std::isnan(m.second.touch.at) ? FirstTouch{} : refer(setup, m.first, m.second, law, step);
    });
    const TouchMedians middle = touch_medians(all);
    table.add(stiffness, law.friction, step * 1e6, fixed(middle.grip, 4), fixed(middle.peak, 3),
              middle.breaks, fixed(1e3 * middle.push, 2));
    return middle.grip;
  };
  const double softest = bench.context.mutated("softer_law") ? 1e3 : 1e4;
  const double step = bench.context.mutated("coarse_step") ? 5e-4 : kFine;
  const double soft = felt(law_of(setup, softest), kFine, "1e4"),
               middle = felt(law_of(setup, 1e5), step, "1e5");
  const double hard = felt(law_of(setup, 1e6), kFine, "1e6"), fine = felt(law_of(setup, 1e5), 1e-6, "1e5");
  Law smooth = law_of(setup, 1e5);
  smooth.friction = 0.0;
  felt(smooth, kFine, "1e5");
  felt({1e9, 1.5, 1.0, 0.0, setup.twin.world.tip_friction}, kFine, "1e9 d^1.5 (Hertz)");
  bench.figure("law.step.error", 100.0 * std::abs(middle / fine - 1.0), "%", at_most(0.5),
               "what is felt by the law of its own: step of 5 us against 1 us");
  bench.figure(
      "law.stiffness.spread", 100.0 * (std::max({soft, middle, hard}) / std::min({soft, middle, hard}) - 1.0),
      "%", at_most(7.0),
      "the same over 10^4 to 10^6 N/m: less than a person tells; the contact's own force differs ten times");
  bench.table(std::move(table));
}

struct Machine {
  const char* name;
  const char* scene;
  bool arm;
  std::vector<std::string> prepared, late;  // the prop waits; the prop sets out when the tool is near
};
const std::vector<Machine>& machines() {
  static const std::vector<Machine> kMachines{
      {"hexapod",
       "tennis_ball",
       false,
       {"user.approach_tilt_deg=0"},
       {"user.approach_tilt_deg=0", "user.polar_deg=20", "follow.resume_mm=20", "follow.pause_mm=25"}},
      {"arm",
       "wall",
       true,
       {"object.wall.position_mm=[0,0,25]"},
       {"object.wall.position_mm=[0,0,25]", "follow.resume_mm=15", "follow.pause_mm=20"}}};
  return kMachines;
}

// A speed, and what the tool meets: the stiffness of the wall or the stop, and a machine that stands or not.
struct Approach {
  double speed;  // mm/s
  std::string what;
  bool stands;
  std::vector<std::string> set;
};
std::vector<Approach> approaches(const Machine& machine, const std::vector<double>& speeds) {
  std::vector<Approach> all;
  for (const double speed : speeds)
    for (const double value :
         machine.arm ? std::vector<double>{0.2, 0.6, 1.2} : std::vector<double>{2, 5, 10})
      for (const bool stands : {true, false}) {
        Approach one{speed,
                     machine.arm ? fmt::format("{:g} N/mm", value) : fmt::format("stop of {:g} ms", value),
                     stands, stands ? machine.prepared : machine.late};
        one.set.insert(
            one.set.end(),
            {kStill, "user.press_s=1", "user.release_s=1", fmt::format("user.approach_mm_s=[{:g}]", speed),
             fmt::format("user.approach_from_mm={:g}", std::max(150.0, 0.3 * speed)),
             machine.arm ? fmt::format("behaviour.phantom_wall.stiffness_N_per_mm={:g}", value)
                         : fmt::format("truth.world.contact_time_ms={:g}", value)});
        all.push_back(std::move(one));
      }
  return all;
}

struct TouchSummary {
  FirstTouch first;      // of the first hand
  double bounces = 0.0;  // of all hands
};
TouchSummary touch_of(const Bench& bench, const Machine& machine, const Approach& approach,
                      std::size_t hands) {
  const models::Setup setup = load_scene(bench.context, machine.scene, approach.set);
  TouchSummary all;
  for (const std::uint64_t seed : bench.seeds(hands)) {
    const FirstTouch touch = watch_touch(setup, seed).touch;
    if (seed == bench.context.seed) all.first = touch;
    all.bounces += touch.long_breaks;
  }
  return all;
}

void add_bounces(Bench& bench, const char* machine, double standing, double moving, std::size_t touches) {
  bench.figure(fmt::format("{}.bounces.standing", machine), standing, "",
               fmt::format("contact lost for 5 ms or more and found again in 0.1 s, in all {} touches by a "
                           "machine that stands",
                           touches));
  bench.figure(fmt::format("{}.bounces.late", machine), moving, "", "the same of one that sets out late");
  bench.figure(fmt::format("{}.bounces.fewer", machine),
               moving > 0.0 ? 100.0 * (1.0 - standing / moving) : 0.0, "%",
               bench.context.quick ? Bounds{} : at_least(80.0), "by how much fewer");
}

// The series of that name, which is added if there is none.
Series& series_of(Plot& plot, const std::string& name) {
  const auto at =
      std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
  if (at != plot.series.end()) return *at;
  return plot.series.emplace_back(Series{.name = name, .mark = Mark::both});
}

void add_machine(Bench& bench, const Machine& machine, const std::vector<double>& speeds, Table& table) {
  const std::vector<Approach> runs = approaches(machine, speeds);
  const std::size_t hands = bench.context.count(4, 1);
  const auto found =
      bench.each(runs, [&](const Approach& run) { return touch_of(bench, machine, run, hands); });
  Plot plot{
      .id = fmt::format("speeds_{}", machine.name),
      .title = fmt::format("First contact of the {}: force and bounces over approach speed", machine.name),
      .x_label = "approach speed (mm/s)",
      .y_label = "most felt in 0.1 s (N)",
      .log_x = true,
      .log_y = true,
      .caption =
          "Felt: the grip's largest force. Dashed names: the machine sets out when the tool is already "
          "near, and still moves at the touch. Bounces: table `speeds`."};
  double standing = 0.0, moving = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const FirstTouch& t = found[i].first;
    series_of(plot, fmt::format("{}, {}", runs[i].what, runs[i].stands ? "stands" : "sets out late"))
        .add(runs[i].speed, t.grip);
    (runs[i].stands ? standing : moving) += found[i].bounces;
    table.add(machine.name, runs[i].speed, runs[i].what, runs[i].stands ? "yes" : "no",
              fixed(1e3 * t.moving, 1), fixed(1e3 * t.closing, 0), fixed(t.peak, 2), fixed(t.grip, 2),
              t.breaks, fixed(1e3 * t.lost, 1), t.long_breaks);
  }
  bench.plot(std::move(plot));
  add_bounces(bench, machine.name, standing, moving, hands * runs.size() / 2);
}

// Force and bounces over approach speed x stiffness of the stop, or of the wall; for a waiting and a late
// prop.
void add_speeds(Bench& bench) {
  const std::vector<double> speeds =
      bench.context.quick ? std::vector<double>{50, 1000} : std::vector<double>{50, 100, 200, 400, 700, 1000};
  Table table{"speeds",
              "First contact: approach speed, stiffness, and whether the machine stands",
              {"machine", "speed (mm/s)", "stiffness or stop", "stands", "its speed (mm/s)", "closing (mm/s)",
               "contact, most (N)", "felt (N)", "breaks", "lost (ms)", "bounces of 5 ms"}};
  for (const Machine& machine : machines()) add_machine(bench, machine, speeds, table);
  bench.table(std::move(table));
}

void run(Bench& bench) {
  add_sweep(bench, "session");
  add_sweep(bench, "training");
  add_law(bench);
  add_speeds(bench);
}

const Reads kReads{"impact", {.scenes = {"session", "training", "tennis_ball", "wall"}}};
const Entry kEntry{"impact", "a first contact",
                   "force and bounces over solver, time step, speed and stiffness, and what is felt of them",
                   run};

}  // namespace
}  // namespace enc::bench::impact
