// The wall of Fig 5: force over depth, with a finger that is seen each tick and with one that vision sees.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/kit/yardstick.h"
#include "benchmarks/plane_button/plane_button.h"

namespace enc::bench::plane_button {
namespace {

constexpr double kFrom = 2e-3, kTo = 10e-3;  // m: the depth of the fit
using sim::Phase;

struct WallRuns {
  PressTrace live, slide, late, seen;
};

// Slowly: the damping of the law adds to the spring while the finger moves.
WallRuns wall_runs(const BenchContext& context) {
  const std::vector<std::string> press{"user.approach_mm_s=[50]", "user.press_s=5", "user.release_s=5"};
  std::vector<std::string> sliding = press;
  sliding.insert(sliding.end(), {"user.press_s=2", "user.release_s=1", "user.depth_mm=8", "user.slide_mm=30",
                                 "user.slide_mm_s=60"});
  // No slack: the depth is what vision says, whatever the prop says.
  std::vector<std::string> alone = press;
  alone.emplace_back("rig.contact.leave_gap_mm=0.001");
  WallRuns runs;
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

// Half the width of the loop that pressing and releasing make, N: friction and damping.
double loop_width(const PressTrace& trace) {
  const Line down = line_of(trace, Phase::press, Depth::truth, 5e-3, 7e-3);
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
  const Line press = line_of(trace, Phase::press, Depth::truth, kFrom, kTo);
  const Line release = line_of(trace, Phase::release, Depth::truth, kFrom, kTo);
  report.figure("wall.live.slope", press.slope, "N/m",
                fmt::format("contact force over true depth, pressed from 2 to 10 mm; the law: {:g} N/m", law),
                0.98 * law, 1.02 * law);
  report.figure("wall.live.r2", press.r2, "", "of that line", 0.999, 1.0);
  report.figure("wall.live.release.slope", release.slope, "N/m", "let go: the damping of the law pulls back");
  report.figure("wall.live.release.r2", release.r2, "", "of that line");
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

// Nothing else runs meanwhile, and nobody looks on.
void speed_figures(const BenchContext& context, const Report& report) {
  constexpr int kRepeats = 3;
  std::vector<double> times, ns;
  Yardstick yardstick;
  for (int i = 0; i < kRepeats; ++i) {
    trial::TrialOptions options;
    options.seed = context.seed;
    options.seconds = context.quick ? 1.0 : 6.0;
    options.watch = yardstick.watch();
    trial::Trial trial(load_scene(context, "wall", {"user.approach_mm_s=[200]"}), std::move(options));
    const double start = thread_seconds();
    const trial::TrialResult run = trial.run();
    times.push_back(run.simulated / (thread_seconds() - start));
    ns.insert(ns.end(), run.step_ns.begin(), run.step_ns.end());
  }
  report.cost(
      "arm.times_real_time", median(times), "x",
      "the whole scene: the twin, its finger, hand, tracker, step() and the bench's own accounts; CPU time "
      "of the thread, RK4 at 1 ms");
  report.cost("arm.step.p99_9", 1e-3 * percentile(ns, 0.999), "us", "step(), wall clock");
  report.cost("arm.step_over_yardstick.median", 1e-9 * percentile(ns, 0.5) / yardstick.seconds(), "x",
              "step() over a fixed piece of work of the same run (kit/yardstick.h)", 0.6);
}

// What vision sees, 20 Hz and 50 ms old: with the prop, on which a finger lies that presses it, as a witness
// of the depth, and without. What is felt is judged by the true depth; how late a belief is, by vision alone,
// for with the witness the depth is the prop's own.
void vision_figures(const WallRuns& runs, double law, const Report& report) {
  const PressTrace& trace = runs.late;
  const Line press = line_of(trace, Phase::press, Depth::truth, kFrom, kTo);
  report.figure("wall.vision.slope", press.slope, "N/m",
                "finger seen at 20 Hz, 50 ms old: contact force over true depth, pressed from 2 to 10 mm",
                0.98 * law, 1.02 * law);
  report.figure("wall.vision.r2", press.r2, "", "of that line", 0.99, 1.0);
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
    series.x.push_back(-1e3 * (over == Depth::truth ? trace.depth[i] : trace.believed[i]));
    series.y.push_back(trace.force[i]);
  }
  return series;
}

void wall_plots(const WallRuns& runs, double law, const Report& report) {
  Plot wall{"plane_button_wall", "Normal force over distance, wall (Fig 5 left)",
            "distance of the finger (mm), negative: under the surface", "normal force (N)"};
  Series shape{"the law (shape of Fig 4)", {-10.0, 0.0, 2.0}, {1e-2 * law, 0.0, 0.0}};
  shape.paper = true;
  wall.series = {shape, series_of("pressed", runs.live, Phase::press, Depth::truth),
                 series_of("let go", runs.live, Phase::release, Depth::truth)};
  wall.caption =
      "Contact force in the simulator over the true depth of the finger; axis as in the paper, which prints "
      "no "
      "units. Between press and release lie dry friction and the damping of the law.";
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

}  // namespace

void measure_wall(const BenchContext& context, const Report& report) {
  const WallRuns runs = wall_runs(context);
  const double law = law_of(context, "wall").stiffness;
  speed_figures(context, report);
  live_figures(runs, law, report);
  vision_figures(runs, law, report);
  wall_plots(runs, law, report);
  report.result().simulated += runs.live.run.simulated + runs.late.run.simulated;
}

}  // namespace enc::bench::plane_button
