// A press on the button, and its analysis: lines, curves and lags.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/plane_button/plane_button.h"
#include "trial/measure/finger_measure.h"

namespace enc::bench::plane_button {
namespace {

// Three straight lines; between two of them the force blends smoothly (3 s^2 - 2 s^3) within `gradual`. The
// fit finds all nine places, slopes and widths from the curve alone.
struct ThreeLines {
  double d1 = kUnset, d2 = kUnset, gradual = kUnset;  // m
  double slope[3] = {kUnset, kUnset, kUnset};         // N/m
  double rms = kUnset;                                // N, of the residual
};

double at_depth(const Curve& curve, double depth) {
  const auto next = std::lower_bound(curve.depth.begin(), curve.depth.end(), depth);
  if (next == curve.depth.begin() || next == curve.depth.end()) return kUnset;
  const auto i = static_cast<std::size_t>(next - curve.depth.begin());
  const double share = (depth - curve.depth[i - 1]) / (curve.depth[i] - curve.depth[i - 1]);
  return curve.force[i - 1] + share * (curve.force[i] - curve.force[i - 1]);
}

using Coefficients = Eigen::Matrix<double, 6, 1>;  // offset and slope of each line
using Breaks = std::array<double, 3>;              // d1, d2, gradual, m

// The fit of a button's curve: three lines, two breaks, one width.

double gone_over(double depth, double from, double width) {
  const double s = std::clamp((depth - from) / width, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

// Least squares for given breaks: residual, N^2.
double rest_of(const Curve& curve, const Breaks& breaks, Coefficients& best) {
  constexpr double kNarrowest = 0.02e-3, kRefused = 1e12;
  const auto [d1, d2, gradual] = breaks;
  if (gradual < kNarrowest || d2 < d1 + gradual || d1 < curve.depth.front() ||
      d2 + gradual > curve.depth.back())
    return kRefused;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Coefficients right = Coefficients::Zero();
  double squares = 0.0;
  for (std::size_t i = 0; i < curve.depth.size(); ++i) {
    const double x = 1e3 * curve.depth[i];  // mm: makes offsets and slopes similar in size
    const double past1 = gone_over(curve.depth[i], d1, gradual);
    const double past2 = gone_over(curve.depth[i], d2, gradual);
    const double share[3] = {1.0 - past1, past1 * (1.0 - past2), past1 * past2};
    Coefficients row;
    for (int k = 0; k < 3; ++k) row.segment<2>(2 * k) << share[k], share[k] * x;
    normal += row * row.transpose();
    right += curve.force[i] * row;
    squares += curve.force[i] * curve.force[i];
  }
  best = normal.ldlt().solve(right);
  return best.allFinite() ? squares - best.dot(right) : kRefused;
}

// The best of a coarse grid over the whole curve.
Breaks coarse(const Curve& curve) {
  constexpr double kStep = 0.2e-3;
  Breaks best{};
  double least = 1e300;
  Coefficients unused;
  const double first = curve.depth.front();
  const int steps = static_cast<int>((curve.depth.back() - first) / kStep);
  for (int i = 0; i < steps; ++i)
    for (int k = i + 1; k <= steps; ++k)
      for (const double gradual : {0.1e-3, 0.3e-3, 0.6e-3, 1.0e-3}) {
        const Breaks breaks{first + i * kStep, first + k * kStep, gradual};
        const double rest = rest_of(curve, breaks, unused);
        if (rest >= least) continue;
        least = rest;
        best = breaks;
      }
  return best;
}

// Starts there and refines each of the three in turn, by steps that become smaller.
Breaks refined(const Curve& curve, Breaks at) {
  Coefficients unused;
  double least = rest_of(curve, at, unused);
  for (double step = 0.1e-3; step > 0.2e-6;) {
    bool better = false;
    for (std::size_t which = 0; which < at.size(); ++which)
      for (const double way : {-step, step}) {
        Breaks next = at;
        next[which] += way;
        const double rest = rest_of(curve, next, unused);
        if (rest >= least) continue;
        least = rest;
        at = next;
        better = true;
      }
    if (!better) step *= 0.5;
  }
  return at;
}

constexpr double kOfHand = 0.1;  // share by which a hand's drift moves a slope
using sim::Phase;
using Settings = std::vector<std::string>;

// The button of Fig 5: pressed slowly by a stiff finger; live by a hand that vision tracks; and without the
// gradual change that keeps the device stable.

// A finger like a testing machine: it follows its commanded path, so that it passes the dip slowly, too.
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
  const Settings one{"user.approach_mm_s=[20]", "user.depth_mm=8"};
  const Settings high = live(joined(one, kHighGain));
  ButtonRuns runs;
  const std::array<std::function<void()>, 4> all{
      [&] {
        runs.slow = press_trace(
            context, "button",
            live(joined(joined(one, kStiffFinger),
                        {"user.press_s=" + slow, "user.release_s=" + slow, "user.approach_from_mm=60"})));
      },
      [&] {
        runs.late =
            press_trace(context, "button",
                        joined(one, {"user.repeats=3", "user.approach_from_mm=60", "user.rest_s=0.5"}));
      },
      [&] { runs.gradual = press_trace(context, "button", high); },
      [&] { runs.sudden = press_trace(context, "button", joined(high, kSudden)); }};
  in_parallel(context.quick ? 2 : all.size(), [&](std::size_t i) { all[i](); });
  return runs;
}

ThreeLines fit_three_lines(const Curve& curve) {
  constexpr std::size_t kLeast = 20;
  if (curve.depth.size() < kLeast) return {};
  const Breaks breaks = refined(curve, coarse(curve));
  Coefficients lines = Coefficients::Zero();
  const double rest = rest_of(curve, breaks, lines);
  ThreeLines fit{breaks[0], breaks[1], breaks[2]};
  for (int k = 0; k < 3; ++k) fit.slope[k] = 1e3 * lines[2 * k + 1];
  fit.rms = std::sqrt(std::max(0.0, rest) / static_cast<double>(curve.depth.size()));
  return fit;
}

void slow_figures(const PressTrace& trace, const InteractionSpec& law, double resistance,
                  const Report& report) {
  const ThreeLines fit = fit_three_lines(mean_curve(trace, 0.8e-3, 5.9e-3, kBin));
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
  const Line first = line_of(trace, Phase::press, Depth::device, 0.7e-3, 0.95 * law.trigger);
  const Line last = line_of(mean_curve(trace, law.bottom + 1.1 * law.gradual, 5.9e-3, kBin));
  const Dip dip = dip_of(trace, law);
  report.figure(
      "button.vision.slope1", first.slope, "N/m",
      "a hand that vision sees, 20 Hz, 50 ms old: three presses. The law's damping adds 7 %, and the "
      "hand's drift scatters one press by 7 % [sources/twin 6]",
      0.85 * resistance, 1.2 * resistance);
  report.figure("button.vision.slope3", last.slope, "N/m",
                "end stop [F2]: mean of press and release, because the hand brakes there",
                (1.0 - kOfHand) * law.floor, (1.0 + kOfHand) * law.floor);
  report.figure("button.vision.dip", 100.0 * (1.0 - dip.least / dip.peak), "%",
                "of the peak [F2]: 30 to 35 % over seeds", 27.0, 40.0);
  report.figure("button.vision.step", greatest_step(trace, 0.0), "N", "change of the force in a ms [F2]", 0.0,
                0.2);
  report.figure("button.vision.switch_step", greatest_step(trace, law.bottom - law.gradual), "N",
                "the same where the target goes over to the bottom board [V33]", 0.0, 0.2);
}

// Number of falls of the gain at the trigger: one is a click.
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
// Energy that the prop gives the finger while it is pressed deeper and deeper, mJ: a passive button gives
// none.
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
    series.add(-1e3 * trace.depth[i], trace.force[i]);
  }
  return series;
}

Series over_time(const std::string& name, const PressTrace& trace) {
  Series series{name};
  std::size_t begin = 0;
  while (begin < trace.size() && !(trace.phase[begin] == Phase::press && trace.depth[begin] > 1e-3)) ++begin;
  for (std::size_t i = begin; i < trace.size() && trace.phase[i] != Phase::release; ++i)
    series.add(trace.t[i] - trace.t[begin], trace.force[i]);
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
    const RenderedStiffness felt = felt_at(law.does, law.stiffness, law.free, depth);
    force.add(-1e3 * depth, felt.stiffness * (depth - felt.sunk));
    click.add(1e3 * depth, felt.stiffness / law.does.floor);
    slide.add(1e3 * depth, felt_at(wall.does, wall.stiffness, wall.free, depth).stiffness / wall.stiffness);
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

std::vector<std::string> live(std::vector<std::string> more) {
  std::vector<std::string> all{"truth.tracker.rate_hz=1000",
                               "truth.tracker.latency_ms=0",
                               "truth.tracker.noise_mm=[0,0,0]",
                               "truth.tracker.marker_noise_mm=0",
                               "rig.tracker.prediction=\"hold\"",
                               "rig.tracker.usual_age_ms=2",
                               "rig.arm.settle_ms=5"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Law law_of(const BenchContext& context, const std::string& scene) {
  const models::Setup setup = load_scene(context, scene);
  const Scene prepared = trial::prepare_setup(setup);
  const Object& object = prepared.objects.front();
  return {object.interaction, object.stiffness, setup.rig.arm.stiffness};
}

PressTrace press_trace(const BenchContext& context, const std::string& scene, std::vector<std::string> own,
                       double seconds) {
  PressTrace trace;
  trial::TrialOptions options{.seed = context.seed, .seconds = seconds};
  options.watch = [&trace](const trial::Glance& glance) {
    const trial::TrueDepth at = trial::true_depth(glance);
    const bool known = at.normal.finite();
    const Vec<'W'>& pushed = glance.truth.contact_force;
    const double force = known ? -dot(pushed, at.normal) : 0.0;
    trace.t.push_back(::enc::seconds(glance.truth.t.time_since_epoch()));
    trace.depth.push_back(known ? at.depth + dot(at.touching - glance.truth.tip, at.normal) : -1.0);
    trace.finger.push_back(known ? at.depth : -1.0);
    trace.believed.push_back(-glance.out.gap);
    trace.force.push_back(force);
    trace.side.push_back(known ? (pushed + force * at.normal).norm() : 0.0);
    trace.gain.push_back(glance.out.arm.gain);
    trace.speed.push_back(glance.truth.tip_velocity.norm());
    trace.phase.push_back(glance.truth.phase);
    trace.contact.push_back(glance.out.mode == Mode::contact ? 1 : 0);
  };
  trial::Trial trial(load_scene(context, scene, std::move(own)), std::move(options));
  const double start = thread_seconds();
  trace.run = trial.run();
  trace.cpu = thread_seconds() - start;
  return trace;
}

Line line_of(const PressTrace& trace, sim::Phase phase, Depth of, double low, double high) {
  const std::vector<double>& over = of == Depth::device   ? trace.depth
                                    : of == Depth::finger ? trace.finger
                                                          : trace.believed;
  trial::LineFit fit;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace.phase[i] != phase || trace.contact[i] == 0) continue;
    if (trace.depth[i] < low || trace.depth[i] > high) continue;
    fit.add(over[i], trace.force[i]);
  }
  return {fit.slope(), fit.r2(), fit.n};
}

double greatest_step(const PressTrace& trace, double low, double beyond) {
  double most = 0.0;
  for (std::size_t i = 1; i < trace.size(); ++i) {
    if (trace.contact[i] == 0 || trace.contact[i - 1] == 0) continue;
    if (!(std::min(trace.depth[i], trace.depth[i - 1]) >= low)) continue;
    const double motion = beyond * std::abs(trace.depth[i] - trace.depth[i - 1]);
    most = std::max(most, std::abs(trace.force[i] - trace.force[i - 1]) - motion);
  }
  return most;
}

double lag_of(const PressTrace& trace) {
  constexpr std::size_t kMost = 200;  // ticks
  constexpr double kFrom = 1e-3;      // m
  double least = kUnset, lag = kUnset;
  for (std::size_t shift = 0; shift <= kMost; ++shift) {
    double sum = 0.0;
    std::size_t n = 0;
    for (std::size_t i = kMost; i < trace.size(); ++i) {
      const bool pressing = trace.phase[i] == sim::Phase::press || trace.phase[i] == sim::Phase::release;
      if (!pressing || trace.finger[i - shift] < kFrom || !std::isfinite(trace.believed[i])) continue;
      const double apart = trace.believed[i] - trace.finger[i - shift];
      sum += apart * apart;
      ++n;
    }
    const double mean = n > 0 ? sum / static_cast<double>(n) : kUnset;
    if (!(mean >= least) && n > 0) {
      least = mean;
      lag = trace.t[shift] - trace.t[0];
    }
  }
  return lag;
}

Curve curve_of(const PressTrace& trace, sim::Phase phase, double low, double high, double width) {
  const auto bins = static_cast<std::size_t>(std::ceil((high - low) / width));
  std::vector<double> depth(bins, 0.0), force(bins, 0.0), count(bins, 0.0);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace.phase[i] != phase || trace.contact[i] == 0) continue;
    const double at = (trace.depth[i] - low) / width;
    if (!(at >= 0.0) || at >= static_cast<double>(bins)) continue;
    const auto bin = static_cast<std::size_t>(at);
    depth[bin] += trace.depth[i];
    force[bin] += trace.force[i];
    count[bin] += 1.0;
  }
  Curve curve;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (count[bin] == 0.0) continue;
    curve.depth.push_back(depth[bin] / count[bin]);
    curve.force.push_back(force[bin] / count[bin]);
  }
  return curve;
}

Curve mean_curve(const PressTrace& trace, double low, double high, double width) {
  const Curve down = curve_of(trace, sim::Phase::press, low, high, width);
  const Curve up = curve_of(trace, sim::Phase::release, low, high, width);
  Curve mean;
  for (int i = 0; low + i * width < high; ++i) {
    const double depth = low + i * width;
    const double force = 0.5 * (at_depth(down, depth) + at_depth(up, depth));
    if (std::isnan(force)) continue;
    mean.depth.push_back(depth);
    mean.force.push_back(force);
  }
  return mean;
}

Line line_of(const Curve& curve) {
  trial::LineFit fit;
  for (std::size_t i = 0; i < curve.depth.size(); ++i) fit.add(curve.depth[i], curve.force[i]);
  return {fit.slope(), fit.r2(), fit.n};
}

void Report::figure(const std::string& id, double value, const char* unit, const std::string& note,
                    double low, double high) const {
  result_.figures.push_back({"plane_button." + id, kUnset, value, unit, Role::ours, low, high, note});
}

void measure_button(const BenchContext& context, const Report& report) {
  ButtonRuns runs = button_runs(context);
  if (context.mutated("exchange_changes")) std::swap(runs.gradual, runs.sudden);
  Law law = law_of(context, "button");
  if (context.mutated("other_law"))
    for (double* number :
         {&law.stiffness, &law.does.trigger, &law.does.bottom, &law.does.after, &law.does.floor})
      *number *= 1.1;
  slow_figures(runs.slow, law.does, law.stiffness, report);
  vision_figures(runs.late, law.does, law.stiffness, report);
  if (runs.sudden.size() > 0) sudden_figures(runs, report);
  button_plots(runs, law, law_of(context, "wall"), report);
  report.result().simulated += runs.slow.run.simulated + runs.late.run.simulated;
}

}  // namespace enc::bench::plane_button
