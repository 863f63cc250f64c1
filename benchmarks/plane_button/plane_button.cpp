#include "benchmarks/plane_button/plane_button.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "core/control/scene/scene.h"

namespace enc::bench::plane_button {
namespace {

// Error of the wall's curve over run time, integrators by time steps, against RK4 at 31.25 us.

// A quick press by a hand without tremor, so that each depth has one force.
PressTrace pressed(const BenchContext& context, const std::string& integrator, double step_us,
                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"user.approach_mm_s=[100]",
                               "user.approach_from_mm=40",
                               "user.press_s=0.8",
                               "user.hold_s=0.1",
                               "user.release_s=0.2",
                               "truth.hand.tremor_mm=0",
                               "truth.hand.drift_mm=0",
                               "truth.arm.integrator=\"" + integrator + "\"",
                               fmt::format("truth.arm.timestep_us={}", step_us)};
  set.insert(set.end(), more.begin(), more.end());
  return press_trace(context, "wall", live(std::move(set)), 2.0);
}

// Root of the mean square of the force's difference at equal depths, N.
double apart(const Curve& a, const Curve& b) {
  double sum = 0.0;
  const std::size_t n = std::min(a.force.size(), b.force.size());
  for (std::size_t i = 0; i < n; ++i) sum += std::pow(a.force[i] - b.force[i], 2);
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : kUnset;
}

// Interpolated at fixed depths.
Curve sampled(const PressTrace& trace) {
  const Curve fine = curve_of(trace, sim::Phase::press, 1e-3, 10e-3, 0.05e-3);
  Curve curve;
  if (fine.depth.size() < 2) return curve;  // hardly pressed
  std::size_t at = 1;
  for (int i = 0; i < 60; ++i) {
    const double depth = 2e-3 + i * 0.1e-3;
    while (at + 1 < fine.depth.size() && fine.depth[at] < depth) ++at;
    const double share = (depth - fine.depth[at - 1]) / (fine.depth[at] - fine.depth[at - 1]);
    curve.depth.push_back(depth);
    curve.force.push_back(fine.force[at - 1] + share * (fine.force[at] - fine.force[at - 1]));
  }
  return curve;
}

// Free space: the step response of the tip when its target moves 20 mm aside, and the stiffest wall that it
// holds alone, by two integrators.

constexpr double kLeap = 20e-3;  // m
// The tip is lightest along x at home; 30 mm farther back it is 2.5 times as heavy along y.
struct Way {
  Vec3 from, along;
};
const Way kHome{{0, 0, 0}, Vec3::UnitX()}, kHeavy{{-0.03, -0.01, 0}, Vec3::UnitY()};
constexpr double kAbove = 40e-3;  // m: near enough to be followed
constexpr double kWhen = 1.0;     // s
constexpr double kEnd = 2.5;      // s

// A finger that hovers above the wall and leaps aside.
class LeapingFinger : public PoseTracker {
 public:
  LeapingFinger(std::unique_ptr<PoseTracker> clockwork, const Pose<'C', 'W'>& X_CW, const Way& way)
      : clockwork_(std::move(clockwork)), X_CW_(X_CW), way_(way) {}
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    const bool news = clockwork_->poll(now, newest);
    const bool after = seconds(newest.t.time_since_epoch()) >= kWhen;
    newest.value.X_CT =
        X_CW_ * Pose<'W', 'T'>(Quat::Identity(),
                               way_.from + (after ? kLeap : 0.0) * way_.along + kAbove * Vec3::UnitZ());
    return news;
  }

 private:
  std::unique_ptr<PoseTracker> clockwork_;  // source of the stamps
  Pose<'C', 'W'> X_CW_;
  Way way_;
};

struct Leap {
  std::vector<double> t, x, target;  // s, m, m
  double speed = 0.0;                // rms at the end, m/s
  double ratio = kUnset;             // damping, with the mass at the tip
};

Leap leap(const BenchContext& context, const std::vector<std::string>& more, const Way& way = kHome) {
  std::vector<std::string> own = live(more);
  own.insert(own.end(), {"user.approach_mm_s=[1]", "user.approach_from_mm=40", "user.approach_tilt_deg=0",
                         "rig.arm.settle_ms=20"});
  models::Setup setup = load_scene(context, "wall", own);
  const Pose<'C', 'W'> X_CW = pose_of<'W', 'C'>(setup.rig.frames.W_C).inverse();
  trial::TrialOptions options{.seed = context.seed, .seconds = kEnd};
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<LeapingFinger>(std::move(rig.tracker), X_CW, way);
  };
  Leap leap;
  double sum = 0.0, n = 0.0;
  options.watch = [&](const trial::Glance& glance) {
    const double now = seconds(glance.truth.t.time_since_epoch());
    leap.t.push_back(now - kWhen);
    leap.x.push_back((glance.truth.tip.e() - way.from).dot(way.along));
    leap.target.push_back((glance.out.arm.target.e() - way.from).dot(way.along));
    if (now < kEnd - 0.3) return;
    sum += std::pow(glance.truth.tip_velocity.norm(), 2);
    n += 1.0;
  };
  trial::Trial trial(std::move(setup), std::move(options));
  const Impedance& law = *trial.scene().impedance();
  leap.ratio = damping_ratio(law.rig, law.home_mass);
  trial.run();
  leap.speed = std::sqrt(sum / n);
  return leap;
}

// The stiffest wall, lambda K_p, that the free prop holds without ringing; lambda scales K_v with it.
double stiffest(const BenchContext& context, const std::string& integrator) {
  constexpr double kRinging = 0.02;  // m/s
  const Law law = law_of(context, "wall");
  const double damping = load_scene(context, "wall").rig.arm.damping;
  double low = 1.0, high = 16.0;
  for (int i = 0; i < 7; ++i) {
    const double lambda = std::sqrt(low * high);
    const Leap run = leap(context, {fmt::format("rig.arm.stiffness_N_per_m={}", lambda * law.free),
                                    fmt::format("rig.arm.damping_Ns_per_m={}", lambda * damping),
                                    "truth.arm.friction_Nm=[0,0,0]", "truth.arm.viscous_Nms=[0,0,0]",
                                    "truth.arm.integrator=\"" + integrator + "\""});
    (run.speed > kRinging ? high : low) = lambda;
  }
  return std::sqrt(low * high) * law.free;
}

// The wall of Fig 5: force over depth, with a finger that is tracked each tick and with one that vision
// tracks.

constexpr double kFrom = 2e-3, kTo = 8e-3;  // m: the depth of the fit
using sim::Phase;

struct WallRuns {
  PressTrace live, slide, late, seen;
};

// Presses slowly: the damping of the law adds to the spring while the finger moves.
WallRuns wall_runs(const BenchContext& context) {
  const std::vector<std::string> press{"user.approach_mm_s=[50]", "user.press_s=5", "user.release_s=5"};
  std::vector<std::string> sliding = press;
  sliding.insert(sliding.end(), {"user.press_s=2", "user.release_s=1", "user.depth_mm=8", "user.slide_mm=30",
                                 "user.slide_mm_s=60"});
  // No slack: the depth comes from vision alone, independent of the prop.
  std::vector<std::string> alone = press;
  alone.emplace_back("rig.contact.leave_gap_mm=0.001");
  WallRuns runs;
  if (context.mutated("stuck")) sliding.emplace_back("truth.arm.friction_Nm=[0.2,0.2,0.2]");
  const std::array<std::function<void()>, 4> all{
      [&] { runs.live = press_trace(context, "wall", live(press)); },
      [&] { runs.late = press_trace(context, "wall", press); },
      [&] { runs.slide = press_trace(context, "wall", live(sliding)); },
      [&] { runs.seen = press_trace(context, "wall", alone); }};
  in_parallel(context.quick ? 2 : all.size(), [&](std::size_t i) { all[i](); });
  return runs;
}

double side_share(const PressTrace& trace) {
  double side = 0.0, normal = 0.0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace.phase[i] != Phase::hold) continue;
    side += trace.side[i];
    normal += trace.force[i];
  }
  return 100.0 * side / normal;
}

// Half the width of the loop of pressing and releasing, N: friction and damping.
double loop_width(const PressTrace& trace) {
  const Line down = line_of(trace, Phase::press, Depth::device, 5e-3, 7e-3);
  double press = 0.0, release = 0.0, n = 0.0, m = 0.0;
  for (std::size_t i = 0; i < trace.size() && down.n > 0; ++i) {
    if (trace.contact[i] == 0 || std::abs(trace.depth[i] - 6e-3) > 0.5e-3) continue;
    const double spring = trace.force[i] - down.slope * (trace.depth[i] - 6e-3);
    if (trace.phase[i] == Phase::press) press += spring, n += 1.0;
    if (trace.phase[i] == Phase::release) release += spring, m += 1.0;
  }
  return 0.5 * (press / n - release / m);
}

void live_figures(const WallRuns& runs, double law, const Report& report) {
  const PressTrace& trace = runs.live;
  const Line mean = line_of(mean_curve(trace, kFrom, kTo, kBin));
  report.figure("wall.live.slope", mean.slope, "N/m",
                fmt::format("contact force over the prop's depth, 2 to 8 mm, mean of press and release; the "
                            "law: {:g} N/m",
                            law),
                0.98 * law, 1.02 * law);
  report.figure("wall.live.r2", mean.r2, "", "of that line", 0.999, 1.0);
  report.figure("wall.live.press.slope", line_of(trace, Phase::press, Depth::device, kFrom, kTo).slope, "N/m",
                "pressed alone: with the friction and the damping of the law");
  report.figure("wall.live.finger.slope", line_of(trace, Phase::press, Depth::finger, kFrom, kTo).slope,
                "N/m", "pressed, over the depth of the finger: with its pad in series");
  report.figure("wall.live.loop", loop_width(trace), "N",
                "half the loop between press and release at 6 mm: dry friction and damping");
  report.figure("wall.live.step", greatest_step(trace, kFrom), "N", "change of the force in a ms, below 2 mm",
                0.0, 0.2);
  report.figure("wall.live.touch_step", greatest_step(trace, 0.0), "N",
                "the same with the first touch at 50 mm/s");
  if (runs.slide.size() > 0)
    report.figure("wall.live.tangential", side_share(runs.slide), "%",
                  "of the normal force, while the finger slides 30 mm at up to 60 mm/s", 0.0, 5.0);
}

// Runs alone and unobserved, because it measures time.
void speed_figures(const BenchContext& context, const Report& report) {
  constexpr int kRepeats = 3;
  std::vector<double> times, ns;
  Yardstick yardstick;
  for (int i = 0; i < kRepeats; ++i) {
    trial::TrialOptions options{
        .seed = context.seed, .seconds = context.quick ? 1.0 : 6.0, .watch = yardstick.watch()};
    trial::Trial trial(load_scene(context, "wall", {"user.approach_mm_s=[200]"}), std::move(options));
    const double start = thread_seconds();
    const trial::TrialResult run = trial.run();
    const double cpu = thread_seconds() - start;
    times.push_back(run.simulated / cpu);
    ns.insert(ns.end(), run.step_ns.begin(), run.step_ns.end());
    if (context.mutated("whole_tick")) ns = {1e9 * cpu / static_cast<double>(run.ticks)};
  }
  report.cost("arm.times_real_time", median(times), "x",
              "the whole scene: the twin, its finger, hand, tracker, step() and the bench's own accounts; "
              "CPU time of the thread, RK4 at 1 ms");
  report.cost("arm.step.p99_9", 1e-3 * percentile(ns, 0.999), "us", "step(), wall clock");
  report.cost("arm.step_over_yardstick.median", 1e-9 * percentile(ns, 0.5) / yardstick.seconds(), "x",
              "step() over a fixed piece of work of the same run (kit/cost.h)", 0.6);
}

// Vision at 20 Hz and 50 ms old. One run uses the prop under the pressing finger as a witness of the depth,
// one does not. The force is judged by the true depth. The lag of the estimate is judged by vision alone,
// because with the witness the depth is the prop's own.
void vision_figures(const WallRuns& runs, double law, const Report& report) {
  const PressTrace& trace = runs.late;
  const Line mean = line_of(mean_curve(trace, kFrom, kTo, kBin));
  report.figure("wall.vision.slope", mean.slope, "N/m", "the same of a finger seen at 20 Hz, 50 ms old",
                0.98 * law, 1.02 * law);
  report.figure("wall.vision.r2", mean.r2, "", "of that line", 0.99, 1.0);
  report.figure("wall.vision.lag", 1e3 * lag_of(trace), "ms",
                "the believed depth behind the true one: the prop's while the finger lies on it");
  report.figure("wall.vision.step", greatest_step(trace, kFrom, law), "N",
                "change of the force in a ms, below 2 mm, beyond what the motion gives the spring", 0.0, 0.2);
  report.figure("wall.vision.step_plain", greatest_step(trace, kFrom), "N", "with the motion");
  report.figure("wall.vision.touch_step", greatest_step(trace, 0.0), "N", "and with the first touch");
  if (runs.seen.size() == 0) return;
  const Line seen = line_of(runs.seen, Phase::press, Depth::believed, kFrom, kTo);
  report.figure("wall.vision_alone.r2", seen.r2, "",
                "contact force over the depth that vision alone believes (leave_gap_mm = 0.001)", 0.9, 1.0);
  report.figure("wall.vision_alone.lag", 1e3 * lag_of(runs.seen), "ms",
                "of that depth behind the true one; a picture is 50 to 100 ms old, and is carried on", 0.0,
                50.0);
  report.figure("wall.vision_alone.step", greatest_step(runs.seen, kFrom), "N", "likewise");
}

Series series_of(const std::string& name, const PressTrace& trace, Phase phase, Depth over) {
  Series series{name};
  constexpr std::size_t kEvery = 8;
  for (std::size_t i = 0; i < trace.size(); i += kEvery) {
    if (trace.phase[i] != phase || trace.depth[i] < -2e-3) continue;
    series.add(-1e3 * (over == Depth::device ? trace.depth[i] : trace.believed[i]), trace.force[i]);
  }
  return series;
}

void wall_plots(const WallRuns& runs, double law, const Report& report) {
  Plot wall{"plane_button_wall", "Normal force over distance, wall (Fig 5 left)",
            "distance of the finger (mm), negative: under the surface", "normal force (N)"};
  Series shape{"the law (shape of Fig 4)", {-10.0, 0.0, 2.0}, {1e-2 * law, 0.0, 0.0}};
  shape.paper = true;
  wall.series = {shape, series_of("pressed", runs.live, Phase::press, Depth::device),
                 series_of("let go", runs.live, Phase::release, Depth::device)};
  wall.caption =
      "Contact force in the simulator over the true depth of the finger; axis as in the paper, which prints "
      "no units. Between press and release lie dry friction and the damping of the law.";
  report.result().plots.push_back(std::move(wall));
  Plot late{"plane_button_late", "The same with a finger that vision sees, 20 Hz and 50 ms old",
            "distance of the finger as believed (mm)", "normal force (N)"};
  late.series = {shape, series_of("depth from the prop", runs.late, Phase::press, Depth::believed)};
  if (runs.seen.size() > 0) {
    late.series.insert(late.series.begin() + 1,
                       series_of("depth from vision alone", runs.seen, Phase::press, Depth::believed));
    late.series[1].mark = Mark::points;
  }
  late.caption = "Vision says that the finger is there; how deep it is, the prop's encoders say each tick.";
  report.result().plots.push_back(std::move(late));
}

void measure_wall(const BenchContext& context, const Report& report) {
  const WallRuns runs = wall_runs(context);
  const double law = (context.mutated("other_law") ? 1.1 : 1.0) * law_of(context, "wall").stiffness;
  speed_figures(context, report);
  live_figures(runs, law, report);
  vision_figures(runs, law, report);
  wall_plots(runs, law, report);
  report.result().simulated += runs.live.run.simulated + runs.late.run.simulated;
}

// 20 mm, in free space
void measure_step(const BenchContext& context, const Report& report) {
  const Leap step = leap(context, {});
  const auto overshoot = [](const Leap& run) {
    return std::max(0.0, 100.0 * (*std::max_element(run.x.begin(), run.x.end()) / kLeap - 1.0));
  };
  report.figure("step.overshoot", overshoot(step), "%", "the target leaps 20 mm aside in free space", 0.0,
                1.0);
  report.figure("step.overshoot_heavy", overshoot(leap(context, {}, kHeavy)), "%",
                "the same 30 mm behind home and along y, where the tip is half as heavy again", 0.0, 1.0);
  report.figure("step.damping_ratio", (context.mutated("heavier_tip") ? 0.8 : 1.0) * step.ratio, "",
                "K_v / (2 sqrt(K_p m)), with the greatest mass that is felt at the tip at home", 1.0);
  Plot plot{"plane_button_step", "Step response in free space", "time (s)", "tip along x (mm)"};
  Series wanted{"target"}, tip{"tip"};
  for (std::size_t i = 0; i < step.t.size(); ++i) {
    if (step.t[i] < -0.05 || step.t[i] > 0.5) continue;
    wanted.add(step.t[i], 1e3 * step.target[i]);
    tip.add(step.t[i], 1e3 * step.x[i]);
  }
  plot.series = {wanted, tip};
  plot.caption =
      "The target keeps within speed and acceleration; the tip stops short by what dry friction holds.";
  report.result().plots.push_back(std::move(plot));
  if (!context.full) return;
  const std::array<std::string, 2> integrators{"rk4", "implicitfast"};
  std::array<double, 2> limit{};
  in_parallel(limit.size(), [&](std::size_t i) { limit[i] = stiffest(context, integrators[i]); });
  report.figure("limit.rk4", limit[0], "N/m",
                "lambda K_p at which the free prop begins to ring, no friction, RK4 at 1 ms");
  report.figure("limit.implicitfast", limit[1], "N/m",
                "the same physics by a first-order integrator [sources/twin 1]");
}

// Error over run time. Runs alone on one core, because it measures time.
void measure_precision(const BenchContext& context, const Report& report) {
  std::vector<std::string> other;
  if (context.mutated("stiffer_reference")) other = {"behaviour.phantom_wall.stiffness_N_per_mm=0.606"};
  const Curve reference = sampled(pressed(context, "rk4", context.full ? 31.25 : 125.0, other));
  Plot plot{"plane_button_precision",
            "Error of the wall's curve over run time",
            "run time (us a tick)",
            "rms error of the force at a depth (N)",
            true,
            true};
  Table table{"plane_button_precision",
              "Error of the wall's curve, pressed quickly, against RK4 at fine steps",
              {"integrator", "step (us)", "rms error (mN)", "run time (us a tick)"}};
  const std::vector<std::string> integrators = context.full
                                                   ? std::vector<std::string>{"rk4", "implicitfast", "euler"}
                                                   : std::vector<std::string>{"rk4"};
  const std::vector<double> steps =
      context.full ? std::vector<double>{1000.0, 500.0, 250.0, 125.0} : std::vector<double>{1000.0, 500.0};
  for (const std::string& integrator : integrators) {
    Series series{integrator};
    series.mark = Mark::both;
    for (const double step : steps) {
      const PressTrace trace = pressed(context, integrator, step);
      const double error = apart(sampled(trace), reference);
      const double time = 1e6 * trace.cpu / static_cast<double>(trace.run.ticks);
      series.add(time, error);
      table.rows.push_back({integrator, fmt::format("{:g}", step), fixed(1e3 * error, 2), fixed(time, 1)});
      if (integrator == "rk4" && step == 1000.0)
        report.figure("precision.default", 1e3 * error, "mN", "rms error of the default, RK4 at 1 ms", 0.0,
                      15.0);
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption = "Same law, held at 1 kHz; only the physics between two ticks is solved more finely.";
  report.result().plots.push_back(std::move(plot));
  report.result().tables.push_back(std::move(table));
}

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  result.note =
      "The paper prints no units on either axis: shapes are compared, all numbers are ours. Force is the "
      "contact force in the simulator, distance the true finger's.";
  const Report report(result);
  measure_wall(context, report);
  bench.progress(0.3);
  measure_button(context, report);
  bench.progress(0.6);
  measure_step(context, report);
  bench.progress(0.8);
  if (!context.quick) measure_precision(context, report);
}

}  // namespace

const Reads kReads{"plane_button", {.scenes = {"wall", "button"}}};
const Entry kEntry{"plane_button", "wall",
                   "force over distance, wall and button (VisHap Figs 4, 5); late finger, step, limits", run};

}  // namespace enc::bench::plane_button
