#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/stiffness/push_study.h"
#include "benchmarks/stiffness/stiffness.h"
#include "core/control/scene/steadiness.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::stiffness {
namespace {

// The softest object that this machine holds still: the prediction of `check`
// (core/control/scene/steadiness.h) against the twin, over hands, filters and machines.

constexpr double kDepth = 0.015, kForce = 30.0;  // m, N: the push that `check` assumes
constexpr double kWithin = 1.25;

struct Hand {
  double stiffness, damping;  // N/m, N s/m
};
struct Cell {
  Hand hand;
  double filter, servo;              // Hz
  bool limited;                      // in its acceleration
  double ramp;                       // s
  double said = kUnset;              // N/m
  bool least = false;                // softer objects are not rendered, so there is no prediction
  double there = 0.0, softer = 0.0;  // m, peak to peak, largest: at the predicted stiffness, and 25 % softer
  double still = kUnset;             // m
};

std::vector<Cell> cells_of(const BenchContext& context) {
  constexpr std::array<Hand, 5> kHands{{{40, 1}, {200, 2}, {700, 4}, {2000, 8}, {5000, 15}}};
  std::vector<Cell> cells;
  for (const double ramp : {Steadiness::kSlow, Steadiness::kQuick})
    for (const bool limited : {true, false})
      for (const Hand& hand : kHands)
        for (const double filter : {2.0, 5.0, 30.0})
          for (const double servo : {15.0, 60.0}) cells.push_back({hand, filter, servo, limited, ramp});
  if (context.full) return cells;
  std::vector<Cell> some;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (context.quick ? i == 12 || i == 42 || i == 72 : i % 17 == 1) some.push_back(cells[i]);
  return some;
}

models::Setup setup_of(const BenchContext& context, const Cell& cell) {
  const double k = cell.hand.stiffness * 1e-3, b = cell.hand.damping;
  std::vector<std::string> set{fmt::format("truth.pusher.stiffness_N_per_mm={}", k),
                               fmt::format("truth.pusher.damping_Ns_per_m={}", b),
                               fmt::format("rig.contact.hand_stiffness_N_per_mm={}", k),
                               fmt::format("rig.contact.hand_damping_Ns_per_m={}", b),
                               fmt::format("rig.force.filter_hz={}", cell.filter),
                               fmt::format("truth.hexapod.servo_hz={}", cell.servo),
                               fmt::format("rig.manipulator.servo_hz={}", cell.servo),
                               fmt::format("pusher.ramp_s={}", cell.ramp)};
  if (!cell.limited) set.insert(set.end(), unlimited_acceleration().begin(), unlimited_acceleration().end());
  return push_setup(context.models, set);
}

// The widest swing over pushes of several depths; `check` assumes only the deepest.
double widest(const BenchContext& context, models::Setup setup) {
  double way = 0.0;
  std::uint64_t seed = context.seed;
  for (const double share : {1.0, 0.85, 0.6, 0.38}) {
    setup.scene.pusher->depth = share * kDepth;
    setup.scene.pusher->force = share * kForce;
    const double here = push_once(setup, seed++).peak_to_peak;
    way = std::isnan(here) ? here : std::max(way, here);
  }
  return way;
}

void judge(const BenchContext& context, Cell& cell) {
  const models::Setup setup = setup_of(context, cell);
  const Steadiness loop(setup.rig);
  cell.still = loop.still();
  cell.said = loop.softest(kDepth, kForce, cell.ramp);
  cell.least = cell.said < kWithin * loop.least_felt(kDepth);
  if (context.mutated("softer")) cell.said /= kWithin;
  cell.there = widest(context, with_stiffness(setup, cell.said));
  cell.softer = widest(context, with_stiffness(setup, cell.said / kWithin));
}

using Words = std::vector<std::string>;

// The controller, and the sensor that a threshold of 3 mN requires (docs/reference/model.md). The user's
// settings come after.
const Words kController{"rig.admittance.damping=observed", "rig.force.threshold_N=0",
                        "rig.force.contact_N=0.01",        "rig.force.tare=window",
                        "rig.contact.leave_time_ms=500",   "pusher.rest_s=4"};
// The zero has drifted before the push, where re-taring can correct it, and drifts less during it.
const Words kSensor{"truth.force.oversampling=8", "truth.force.drift_ahead_s=3",
                    "truth.force.drift_N_per_sqrt_s=0.0003"};

struct Pusher {
  const char* name;
  const char* set;
};
constexpr std::array<Pusher, 2> kPushers{
    {{"soft", ""}, {"firm", "truth.pusher.stiffness_N_per_mm=1"}}};  // soft: as the rig has it

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
Words of(const Pusher& pusher) { return *pusher.set == 0 ? Words{} : Words{pusher.set}; }

struct BeyondExtent {
  std::vector<double> stiffnesses, boundary;  // N/m
  std::size_t pushes;
  Words hold;
};
BeyondExtent beyond_extent(const BenchContext& context) {
  BeyondExtent e{{10, 20, 30, 100, 1000, 10000, 100000},
                 {1, 2, 3},
                 context.full ? std::size_t{3} : 1,
                 {"pusher.hold_s=12"}};
  if (context.quick) e.hold = {"pusher.hold_s=6"};
  if (context.repeats > 0) e.pushes = static_cast<std::size_t>(context.repeats);
  return e;
}

struct Run {
  Push push;
  PushTrace trace;
  double settling = kUnset;  // s
};

// s from the end of the ramp until the deflection, averaged over 0.2 s, stays within 2 % of its final value;
// the whole hold if it does not come to rest.
double settling_of(const PushTrace& trace, const PusherSpec& pusher, double dt) {
  const std::vector<double>& x = trace.deflection;
  const auto ticks = [&](double s) { return static_cast<std::size_t>(std::llround(s / dt)); };
  const std::size_t window = ticks(0.2), begin = ticks(pusher.rest_time + pusher.ramp_time);
  if (x.size() < begin + 10 * window) return kUnset;
  std::vector<double> sum{0.0};
  for (const double d : x) sum.push_back(sum.back() + d);
  const auto mean = [&](std::size_t from, std::size_t n) {
    return (sum[from + n] - sum[from]) / static_cast<double>(n);
  };
  const double end = mean(x.size() - ticks(0.25 * pusher.hold_time), ticks(0.25 * pusher.hold_time));
  std::size_t last = begin;
  for (std::size_t i = begin; i + window <= x.size(); ++i)
    if (!(std::abs(mean(i, window) - end) <= 0.02 * std::abs(end))) last = i + window;
  return static_cast<double>(last - begin) * dt;
}

// runs[i * pushes + j]: push j at stiffness i.
std::vector<Run> runs_of(const models::Setup& setup, const std::vector<double>& stiffnesses,
                         std::size_t pushes, std::uint64_t seed) {
  std::vector<Run> runs(stiffnesses.size() * pushes);
  in_parallel(runs.size(), [&](std::size_t i) {
    const models::Setup one = with_stiffness(setup, stiffnesses[i / pushes]);
    runs[i].push = push_once(one, seed + i, &runs[i].trace);
    runs[i].settling = settling_of(runs[i].trace, *one.scene.pusher, 1.0 / one.rig.loop.rate);
    runs[i].trace = {};
  });
  return runs;
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
  [[nodiscard]] double worst() const { return std::max(std::abs(least), std::abs(most)); }
};
// Statistics of the pushes at one stiffness.
struct BeyondLevel {
  double stiffness;
  Range error, load_error, settling, way;
};
std::vector<BeyondLevel> beyond_levels(const std::vector<Run>& runs, const std::vector<double>& stiffnesses) {
  std::vector<BeyondLevel> levels;
  const std::size_t pushes = runs.size() / stiffnesses.size();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i % pushes == 0) levels.push_back({stiffnesses[i / pushes], {}, {}, {}, {}});
    const Run& run = runs[i];
    levels.back().error.add(run.push.error(run.push.measured));
    levels.back().load_error.add(run.push.error(run.push.load));
    levels.back().settling.add(run.settling);
    levels.back().way.add(run.push.peak_to_peak);
  }
  return levels;
}

Series series_of(const std::vector<BeyondLevel>& levels, const std::string& name, bool settling, bool log) {
  Series s{.name = name, .mark = Mark::both};
  for (const BeyondLevel& level : levels) {
    s.x.push_back(level.stiffness * 1e-3);
    const double y = settling ? level.settling.most : level.load_error.worst();
    s.y.push_back(log ? std::max(y, 1e-3) : y);
  }
  return s;
}

// The lowest stable stiffness, with all tested ones above it stable, N/m; infinite if all are unstable.
double boundary_of(const std::vector<BeyondLevel>& levels) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = levels.size(); i-- > 0 && levels[i].way.most <= kWander;) lowest = levels[i].stiffness;
  return lowest;
}

struct Study {
  std::vector<BeyondLevel> beyond, soft_end, paper;  // paper: with --full
};

Study study(const BenchContext& context, const BeyondExtent& extent, const Pusher& pusher,
            BenchResult& result) {
  const models::Setup beyond =
      push_setup(context.models, kController + kSensor + extent.hold + of(pusher) + context.set);
  Study s;
  s.beyond = beyond_levels(runs_of(beyond, extent.stiffnesses, extent.pushes, context.seed + 3000),
                           extent.stiffnesses);
  s.soft_end =
      beyond_levels(runs_of(beyond, extent.boundary, extent.pushes, context.seed + 4000), extent.boundary);
  const auto runs = static_cast<double>((extent.stiffnesses.size() + extent.boundary.size()) * extent.pushes);
  result.simulated += runs * push_time(beyond);
  if (!context.full) return s;
  const models::Setup paper = push_setup(context.models, of(pusher) + context.set);
  s.paper = beyond_levels(runs_of(paper, extent.stiffnesses, 1, context.seed + 5000), extent.stiffnesses);
  result.simulated += static_cast<double>(extent.stiffnesses.size()) * push_time(paper);
  return s;
}

void add_figures(const Study& s, const Pusher& pusher, BenchResult& result) {
  const std::string head = fmt::format("stiffness.beyond.{}.", pusher.name);
  const auto add = [&](const std::string& id, double twin, const char* unit, double high, const Range& range,
                       const char* note) {
    result.figures.push_back(
        {head + id, kUnset, twin, unit, Role::ours, kUnset, high, note, range.least, range.most});
  };
  std::vector<BeyondLevel> all = s.soft_end;
  all.insert(all.end(), s.beyond.begin(), s.beyond.end());
  add("boundary_N_per_mm", boundary_of(all) * 1e-3, "N/mm", 0.003, {kUnset, kUnset},
      "lowest stiffness that was tried and came to rest, as did all above");
  for (const BeyondLevel& level : s.beyond) {
    const std::string k = fmt::format("{:g}", level.stiffness * 1e-3);
    add("error_percent." + k + ".worst", level.load_error.worst(), "%", 2.0, level.load_error,
        "true load over true displacement");
    add("settling_s." + k, level.settling.most, "s", kUnset, level.settling,
        "until it stays within 2 % of where it ends, longest");
  }
}

Table level_table(const std::array<Study, 2>& studies) {
  Table table{"stiffness_beyond",
              "Damped by what is seen to swing, re-tared before each push",
              {"pusher", "stiffness, N/mm", "error of true load, %", "error of measured force, %",
               "settling, s", "peak to peak, mm"},
              {},
              "Least to greatest of the pushes."};
  for (std::size_t i = 0; i < studies.size(); ++i)
    for (const std::vector<BeyondLevel>* levels : {&studies[i].soft_end, &studies[i].beyond})
      for (const BeyondLevel& l : *levels)
        table.rows.push_back({kPushers[i].name, fmt::format("{:g}", l.stiffness * 1e-3),
                              fmt::format("{:+.2f} .. {:+.2f}", l.load_error.least, l.load_error.most),
                              fmt::format("{:+.2f} .. {:+.2f}", l.error.least, l.error.most),
                              fmt::format("{:.2f} .. {:.2f}", l.settling.least, l.settling.most),
                              fmt::format("{:.3f} .. {:.3f}", l.way.least * 1e3, l.way.most * 1e3)});
  return table;
}

void add_plots(const std::array<Study, 2>& studies, BenchResult& result) {
  Plot error{"stiffness_beyond_error",
             "Beyond the paper: error of the rendered stiffness",
             "commanded stiffness, N/mm",
             "worst error of true load, %",
             true,
             true};
  Plot settling{"stiffness_beyond_settling", "Beyond the paper: what it costs", "commanded stiffness, N/mm",
                "settling time, s", true};
  for (std::size_t i = 0; i < studies.size(); ++i) {
    const std::string pusher = fmt::format(", {} pusher", kPushers[i].name);
    std::vector<BeyondLevel> all = studies[i].soft_end;
    all.insert(all.end(), studies[i].beyond.begin(), studies[i].beyond.end());
    error.series.push_back(series_of(all, "damped, re-tared" + pusher, false, true));
    settling.series.push_back(series_of(all, "damped, re-tared" + pusher, true, false));
    if (studies[i].paper.empty()) continue;
    error.series.push_back(series_of(studies[i].paper, "as the paper" + pusher, false, true));
    settling.series.push_back(series_of(studies[i].paper, "as the paper" + pusher, true, false));
  }
  error.series.push_back(
      {.name = "paper: within 2 % from 0.3 N/mm", .x = {0.3, 200}, .y = {2, 2}, .paper = true});
  error.caption =
      "Worst of the pushes, where they come to rest. With the damper: no threshold, a fresh zero, a sensor "
      "that averages eight readings. --full draws the controller of the paper, too.";
  settling.caption =
      "Time after the push until the tip stays within 2 % of where it ends; as long as the hold where it "
      "never does. --full draws the controller of the paper, too.";
  result.plots.push_back(std::move(error));
  result.plots.push_back(std::move(settling));
}

struct Course {
  std::vector<double> time, deflection, seen;  // s, mm, N/mm
};

// One push, every 10 ms: the true tip, and the pusher stiffness that the core has estimated.
Course course_of(const models::Setup& setup, std::uint64_t seed) {
  trial::Trial trial(setup, {.seed = seed, .seconds = push_time(setup)});
  const PressPoint at = pushed_point(setup.scene, trial.scene()).at;
  Course course;
  for (int i = 0; trial.tick(); ++i) {
    if (i % 10 != 0) continue;
    const sim::Truth& truth = trial.world().truth();
    course.time.push_back(seconds(truth.t.time_since_epoch()));
    course.deflection.push_back(1e3 * (dot(at.point - truth.tip, at.normal) - trial.scene().tip_radius));
    course.seen.push_back(1e-3 * recall<AdmittanceState>(trial.state()).swing.stiffness);
  }
  return course;
}

// Both pushers on a very soft wall, with and without the damper; and the signals that drive the damper.
void add_courses(const BenchContext& context, const BeyondExtent& extent, BenchResult& result) {
  Plot motion{"stiffness_beyond_motion", "A push into a wall of 0.01 N/mm", "time, s", "deflection, mm"};
  Plot seen{"stiffness_beyond_seen", "What drives the damper: the pusher's stiffness, as seen in the swing",
            "time, s", "stiffness, N/mm"};
  std::array<Course, 4> courses;
  in_parallel(courses.size(), [&](std::size_t i) {
    const Words damper = i < 2 ? Words{} : Words{"rig.admittance.damping=none"};
    const models::Setup setup = push_setup(
        context.models, kController + kSensor + extent.hold + of(kPushers[i % 2]) + damper + context.set);
    courses[i] = course_of(with_stiffness(setup, 10.0), context.seed + 3000);
  });
  for (const std::size_t i : {std::size_t{3}, std::size_t{2}, std::size_t{1}, std::size_t{0}}) {
    const std::string pusher = fmt::format("{} pusher", kPushers[i % 2].name);
    motion.series.push_back(
        {pusher + (i < 2 ? ", damped" : ", no damper"), courses[i].time, courses[i].deflection});
    if (i < 2) seen.series.push_back({pusher, courses[i].time, courses[i].seen});
  }
  motion.caption = "True deflection. Without the damper the tip leaves the pusher and comes back against it.";
  seen.caption =
      "A soft wall is touched as if the rig's hand pushed (0.7 N/mm). While nothing swings the damper fades; "
      "what swings then brings it back to as much as that pusher needs.";
  result.plots.push_back(std::move(motion));
  result.plots.push_back(std::move(seen));
}

// Cost of the controller at an object that needs no help, the paper's tennis ball.
void add_price(const BenchContext& context, BenchResult& result) {
  Table table{"stiffness_beyond_elsewhere",
              "The tennis ball with and without the damper",
              {"controller", "press RMSE, N", "release RMSE, N", "net work of the tip, mJ"},
              {},
              "Same scene, same seed; negative work would mean that the object gave energy."};
  const std::array<Words, 2> sets{Words{}, Words{"rig.admittance.damping=observed"}};
  std::array<double, 2> release{};
  std::array<std::vector<std::string>, 2> rows;
  std::array<double, 2> simulated{};
  in_parallel(2, [&](std::size_t i) {
    models::Setup setup = load_scene(context, "tennis_ball", sets[i]);
    setup.scene.user->approach = {0.02};
    const trial::PressMeasure m = trial::measured_run(setup, context.seed, simulated[i]);
    release[i] = m.rmse_release();
    rows[i] = {i == 0 ? "none" : "observed", fixed(m.rmse_press(), 4), fixed(m.rmse_release(), 4),
               fixed(1e3 * (m.energy_in() - m.energy_out()), 2)};
  });
  table.rows = {rows[0], rows[1]};
  result.tables.push_back(std::move(table));
  result.simulated += simulated[0] + simulated[1];
  result.figures.push_back({"stiffness.beyond.tennis_ball.release_rmse.ratio", kUnset,
                            release[1] / release[0], "", Role::ours, kUnset, kUnset,
                            "with the damper over without"});
}

// Each part of the controller and of the sensor switched off alone, with the soft pusher.
void add_parts(const BenchContext& context, const BeyondExtent& extent, BenchResult& result) {
  struct Part {
    const char* name;
    Words set;
  };
  const std::vector<Part> parts{
      {"all of it", {}},
      {"no damper", {"rig.admittance.damping=none"}},
      {"threshold 0.05 N", {"rig.force.threshold_N=0.05"}},
      {"zero taken once", {"rig.force.tare=start"}},
      {"no oversampling", {"truth.force.oversampling=1"}},
      {"zero walks 2 mN/sqrt(s) while pressed", {"truth.force.drift_N_per_sqrt_s=0.002"}},
      {"filter 30 Hz", {"rig.force.filter_hz=30"}},
      {"margin 1", {"rig.admittance.margin=1"}},
      {"margin 4", {"rig.admittance.margin=4"}}};
  Table table{"stiffness_beyond_parts",
              "What each part does",
              {"left out or changed", "pusher", "error at 0.003 N/mm, %", "at 0.01", "at 0.03",
               "peak to peak at 0.003, mm", "at 0.01", "settling at 0.01, s"},
              {},
              "Worst of the pushes."};
  const std::vector<double> stiffnesses{3, 10, 30};
  for (const Part& part : parts)
    for (const Pusher& pusher : kPushers) {
      const models::Setup setup = push_setup(
          context.models, kController + kSensor + extent.hold + of(pusher) + part.set + context.set);
      const std::vector<BeyondLevel> l =
          beyond_levels(runs_of(setup, stiffnesses, extent.pushes, context.seed + 3000), stiffnesses);
      result.simulated += 3.0 * static_cast<double>(extent.pushes) * push_time(setup);
      table.rows.push_back({part.name, pusher.name, fixed(l[0].load_error.worst(), 2),
                            fixed(l[1].load_error.worst(), 2), fixed(l[2].load_error.worst(), 2),
                            fixed(l[0].way.most * 1e3, 3), fixed(l[1].way.most * 1e3, 3),
                            fixed(l[1].settling.most, 2)});
    }
  result.tables.push_back(std::move(table));
}

}  // namespace

void add_softest(const BenchContext& context, BenchResult& result) {
  std::vector<Cell> cells = cells_of(context);
  in_parallel(cells.size(), [&](std::size_t i) { judge(context, cells[i]); });
  Table table{"stiffness_softest",
              "The softest spring that stands still, as `check` says it, and the twin",
              {"hand (N/m)", "its damping (N s/m)", "filter (Hz)", "servo (Hz)", "acceleration limited",
               "ramp (s)", "said (N/m)", "the twin there (mm)", "25 % softer (mm)", "still (mm)"}};
  double moving = 0.0, careful = 0.0;
  for (const Cell& cell : cells) {
    moving += cell.there <= cell.still ? 0.0 : 1.0;
    careful += cell.least || cell.softer > cell.still ? 0.0 : 1.0;
    table.rows.push_back({fmt::format("{:g}", cell.hand.stiffness), fmt::format("{:g}", cell.hand.damping),
                          fmt::format("{:g}", cell.filter), fmt::format("{:g}", cell.servo),
                          cell.limited ? "yes" : "no", fmt::format("{:g}", cell.ramp), fixed(cell.said, 1),
                          fixed(1e3 * cell.there, 3), fixed(1e3 * cell.softer, 3),
                          fixed(1e3 * cell.still, 3)});
  }
  table.note =
      "The way of the true tip in the second half of a hold, peak to peak: the most of four pushes, 15, "
      "12.8, 9 and 5.7 mm deep.";
  result.tables.push_back(std::move(table));
  const auto count = static_cast<double>(cells.size());
  result.figures.push_back({"stiffness.softest.cells", kUnset, count, "", Role::ours, kUnset, kUnset,
                            "hands of 40 to 5000 N/m that push in 2 s and in 0.5 s, filters of 2 to 30 Hz, "
                            "servos of 15 and 60 Hz, with the limit of acceleration and without"});
  result.figures.push_back({"stiffness.softest.moving", kUnset, moving, "", Role::ours, kUnset, 0.0,
                            "of them, in which the twin does not hold still what check says it does"});
  result.figures.push_back({"stiffness.softest.careful", kUnset, careful, "", Role::ours, kUnset, kUnset,
                            "of them, in which the twin holds still what is 25 % softer, too"});
}

void add_beyond(const BenchContext& context, const std::function<void(double)>& progress,
                BenchResult& result) {
  const BeyondExtent extent = beyond_extent(context);
  const auto tell = [&](double done) {
    if (progress) progress(done);
  };
  std::array<Study, 2> studies;
  for (std::size_t i = 0; i < studies.size(); ++i) {
    studies[i] = study(context, extent, kPushers[i], result);
    add_figures(studies[i], kPushers[i], result);
    tell(0.4 * static_cast<double>(i + 1));
  }
  add_plots(studies, result);
  result.tables.push_back(level_table(studies));
  if (!context.quick) {
    add_courses(context, extent, result);
    add_price(context, result);
  }
  if (context.full) add_parts(context, extent, result);
  tell(1.0);
}

}  // namespace enc::bench::stiffness
