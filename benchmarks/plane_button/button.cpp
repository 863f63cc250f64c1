// The button of Fig 5: pressed slowly by a stiff finger, live by a hand that vision sees, and without the
// gradual change that keeps the device stable.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/plane_button/plane_button.h"

namespace enc::bench::plane_button {
namespace {

using sim::Phase;
using Settings = std::vector<std::string>;

// A finger like a testing machine: it goes where it is told, so that the dip is passed slowly, too.
const Settings kStiffFinger{"truth.hand.stiffness_N_per_mm=20", "truth.hand.grip_stiffness_N_per_mm=20",
                            "truth.hand.damping_Ns_per_m=200",  "truth.hand.grip_damping_Ns_per_m=20",
                            "truth.hand.tremor_mm=0",           "truth.hand.drift_mm=0"};
const Settings kHighGain{"behaviour.phantom_button.stiffness_N_per_mm=1",
                         "behaviour.phantom_button.interaction.after_N_per_mm=0.3",
                         "behaviour.phantom_button.interaction.floor_N_per_mm=1.5"};
const Settings kSudden{"behaviour.phantom_button.interaction.gradual_mm=0",
                       "behaviour.phantom_button.interaction.gradual_ms=0"};

Settings joined(Settings a, const Settings& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct ButtonRuns {
  PressTrace slow, late, gradual, sudden;
};

ButtonRuns button_runs(const BenchContext& context) {
  const std::string slow = context.quick ? "6" : "12";
  const Settings one{"user.approach_mm_s=[20]"};
  const Settings high = live(joined(one, kHighGain));
  ButtonRuns runs;
  const std::array<std::function<void()>, 4> all{
      [&] {
        runs.slow = press_trace(
            context, "button",
            live(joined(joined(one, kStiffFinger),
                        {"user.press_s=" + slow, "user.release_s=" + slow, "user.approach_from_mm=60"})));
      },
      [&] { runs.late = press_trace(context, "button", one); },
      [&] { runs.gradual = press_trace(context, "button", high); },
      [&] { runs.sudden = press_trace(context, "button", joined(high, kSudden)); }};
  in_parallel(context.quick ? 2 : all.size(), [&](std::size_t i) { all[i](); });
  return runs;
}

void slow_figures(const PressTrace& trace, const InteractionSpec& law, double resistance,
                  const Report& report) {
  const ThreeLines fit = fit_three_lines(mean_curve(trace, 0.8e-3, 5.9e-3, 0.02e-3));
  const auto near = [&](const char* id, double value, double wanted, const char* unit, const char* note) {
    report.figure(id, value, unit, note, 0.98 * wanted, 1.02 * wanted);
  };
  near("button.live.d1", 1e3 * fit.d1, 1e3 * law.trigger, "mm",
       "three lines fitted with free breaks: the trigger");
  near("button.live.d2", 1e3 * fit.d2, 1e3 * law.bottom, "mm", "the bottom");
  report.figure("button.live.gradual", 1e3 * fit.gradual, "mm", "over which one line becomes the next");
  near("button.live.slope1", fit.slope[0], resistance, "N/m", "resistance before the trigger");
  near("button.live.slope2", fit.slope[1], law.after, "N/m", "after it");
  near("button.live.slope3", fit.slope[2], law.floor, "N/m", "at the bottom");
  report.figure("button.live.fit.rms", 1e3 * fit.rms, "mN", "that the fit leaves");
}

// Peak before the trigger and least force after it, N, while pressing.
struct Dip {
  double peak = 0.0, least = 1e9;
};
Dip dip_of(const PressTrace& trace, const InteractionSpec& law) {
  Dip dip;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace.phase[i] != Phase::press || trace.contact[i] == 0) continue;
    const double depth = trace.depth[i];
    if (depth < law.trigger + law.gradual) dip.peak = std::max(dip.peak, trace.force[i]);
    if (depth > law.trigger && depth < law.bottom) dip.least = std::min(dip.least, trace.force[i]);
  }
  return dip;
}

void vision_figures(const PressTrace& trace, const InteractionSpec& law, double resistance,
                    const Report& report) {
  const Line first = line_of(trace, Phase::press, Depth::truth, 0.7e-3, 0.95 * law.trigger);
  const Line last = line_of(mean_curve(trace, law.bottom + 1.1 * law.gradual, 5.9e-3, 0.02e-3));
  const Dip dip = dip_of(trace, law);
  report.figure("button.vision.slope1", first.slope, "N/m",
                "a hand that vision sees, 20 Hz, 50 ms old; pressed [sources/twin 6]", resistance,
                1.7 * resistance);
  report.figure("button.vision.slope3", last.slope, "N/m",
                "end stop [F2]: mean of press and release, because the hand brakes there", 0.95 * law.floor,
                1.05 * law.floor);
  report.figure("button.vision.dip", 100.0 * (1.0 - dip.least / dip.peak), "%", "of the peak [F2]", 20.0,
                100.0);
  report.figure("button.vision.step", greatest_step(trace, 0.0), "N", "change of the force in a ms [F2]", 0.0,
                0.4);
  report.figure("button.vision.switch_step", greatest_step(trace, law.bottom - law.gradual), "N",
                "the same where the target goes over to the bottom board [V33]", 0.0, 0.2);
}

// How often the gain falls at the trigger: once is a click.
int triggers(const PressTrace& trace) {
  int n = 0;
  for (std::size_t i = 1; i < trace.size(); ++i)
    if (trace.phase[i] == Phase::press && trace.gain[i] < trace.gain[i - 1] - 0.5) ++n;
  return n;
}
int losses(const PressTrace& trace, double deeper) {
  int n = 0;
  for (std::size_t i = 1; i < trace.size(); ++i)
    if (trace.depth[i] > deeper && trace.force[i] < 1e-3 && trace.force[i - 1] >= 1e-3) ++n;
  return n;
}
// Energy that the prop gives the finger while it is pressed deeper and deeper, mJ: what it has no right to.
double given_back(const PressTrace& trace) {
  double sum = 0.0;
  for (std::size_t i = 1; i < trace.size(); ++i) {
    if (trace.phase[i] != Phase::press || trace.contact[i] == 0) continue;
    sum +=
        std::max(0.0, -0.5 * (trace.force[i] + trace.force[i - 1]) * (trace.depth[i] - trace.depth[i - 1]));
  }
  return 1e3 * sum;
}

void sudden_figures(const ButtonRuns& runs, const Report& report) {
  report.figure("button.live.gradual.step", greatest_step(runs.gradual, 1e-3), "N",
                "high gain (1000, 300, 1500 N/m), gradual change: in a ms", 0.0, 0.4);
  report.figure("button.live.sudden.step", greatest_step(runs.sudden, 1e-3), "N",
                "the same at once: the paper's warning", 0.4);
  report.figure("button.live.sudden.triggers", triggers(runs.sudden), "",
                "leaps of the gain down while pressing");
  report.figure("button.live.sudden.lost", losses(runs.sudden, 1e-3), "",
                "times that the finger is let go below 1 mm");
  report.figure("button.live.gradual.lost", losses(runs.gradual, 1e-3), "", "with the gradual change");
  report.figure("button.live.sudden.given_back", given_back(runs.sudden), "mJ",
                "energy that the prop gives the finger while this presses");
  report.figure("button.live.gradual.given_back", given_back(runs.gradual), "mJ", "with the gradual change");
}

Series over_distance(const std::string& name, const PressTrace& trace, Phase phase) {
  Series series{name};
  constexpr std::size_t kEvery = 8;
  for (std::size_t i = 0; i < trace.size(); i += kEvery) {
    if (trace.phase[i] != phase || trace.depth[i] < -2e-3) continue;
    series.x.push_back(-1e3 * trace.depth[i]);
    series.y.push_back(trace.force[i]);
  }
  return series;
}

Series over_time(const std::string& name, const PressTrace& trace) {
  Series series{name};
  std::size_t begin = 0;
  while (begin < trace.size() && !(trace.phase[begin] == Phase::press && trace.depth[begin] > 1e-3)) ++begin;
  for (std::size_t i = begin; i < trace.size() && trace.phase[i] != Phase::release; ++i) {
    series.x.push_back(trace.t[i] - trace.t[begin]);
    series.y.push_back(trace.force[i]);
  }
  return series;
}

void button_plots(const ButtonRuns& runs, const Law& law, const Law& wall, const Report& report) {
  Plot button{"plane_button_button", "Normal force over distance, button (Fig 5 right)",
              "distance of the finger (mm), negative: under the surface", "normal force (N)"};
  Plot shape{"plane_button_shape", "Gain over depth, wall and button (Fig 4)", "depth of the finger (mm)",
             "lambda_z over its greatest"};
  Series force{"the law (shape of Fig 4)"}, click{"button"}, slide{"wall"};
  force.paper = true;
  for (int i = 0; i < 300; ++i) {
    const double depth = i * 0.02e-3;
    const Felt felt = felt_at(law.does, law.stiffness, law.free, depth);
    force.x.push_back(-1e3 * depth);
    force.y.push_back(felt.stiffness * (depth - felt.sunk));
    click.x.push_back(1e3 * depth);
    click.y.push_back(felt.stiffness / law.does.floor);
    slide.x.push_back(1e3 * depth);
    slide.y.push_back(felt_at(wall.does, wall.stiffness, wall.free, depth).stiffness / wall.stiffness);
  }
  button.series = {force, over_distance("slow, pressed", runs.slow, Phase::press),
                   over_distance("slow, let go", runs.slow, Phase::release),
                   over_distance("a hand, seen at 20 Hz", runs.late, Phase::press)};
  button.caption =
      "The dip is the click. A hand is softer than the dip is steep, so it falls through; the damping of the "
      "law carries it there.";
  report.result().plots.push_back(std::move(button));
  shape.series = {slide, click};
  report.result().plots.push_back(std::move(shape));
  if (runs.sudden.size() == 0) return;
  Plot time{"plane_button_sudden", "A button of high gain, with and without a gradual change", "time (s)",
            "normal force (N)"};
  time.series = {over_time("at once", runs.sudden), over_time("gradual", runs.gradual)};
  time.caption = "\"The change of force is a gradual process ... necessary to ensure stability\" [VisHap 3].";
  report.result().plots.push_back(std::move(time));
}

}  // namespace

void measure_button(const BenchContext& context, const Report& report) {
  const ButtonRuns runs = button_runs(context);
  const Law law = law_of(context, "button");
  slow_figures(runs.slow, law.does, law.stiffness, report);
  vision_figures(runs.late, law.does, law.stiffness, report);
  if (runs.sudden.size() > 0) sudden_figures(runs, report);
  button_plots(runs, law, law_of(context, "wall"), report);
  report.result().simulated += runs.slow.run.simulated + runs.late.run.simulated;
}

}  // namespace enc::bench::plane_button
