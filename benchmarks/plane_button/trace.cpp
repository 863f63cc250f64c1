#include <algorithm>
#include <cmath>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/plane_button/plane_button.h"
#include "trial/measure/finger_measure.h"

namespace enc::bench::plane_button {

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
  const Scene prepared = trial::prepare_setup(load_scene(context, scene));
  const Object& object = prepared.objects.front();
  return {object.interaction, object.stiffness, prepared.impedance()->rig.stiffness};
}

PressTrace press_trace(const BenchContext& context, const std::string& scene, std::vector<std::string> own,
                       double seconds) {
  PressTrace trace;
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = seconds;
  options.watch = [&trace](const trial::Glance& glance) {
    const trial::TrueDepth at = trial::true_depth(glance);
    const bool known = at.normal.finite();
    const Vec<'W'>& pushed = glance.truth.contact_force;
    const double force = known ? -dot(pushed, at.normal) : 0.0;
    trace.t.push_back(::enc::seconds(glance.truth.t.time_since_epoch()));
    trace.depth.push_back(known ? at.depth : -1.0);
    trace.believed.push_back(-glance.out.gap);
    trace.force.push_back(force);
    trace.side.push_back(known ? (pushed + force * at.normal).norm() : 0.0);
    trace.gain.push_back(glance.out.gain);
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
  trial::LineFit fit;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace.phase[i] != phase || trace.contact[i] == 0) continue;
    if (trace.depth[i] < low || trace.depth[i] > high) continue;
    fit.add(of == Depth::truth ? trace.depth[i] : trace.believed[i], trace.force[i]);
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
      if (!pressing || trace.depth[i - shift] < kFrom || !std::isfinite(trace.believed[i])) continue;
      const double apart = trace.believed[i] - trace.depth[i - shift];
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

namespace {

double at_depth(const Curve& curve, double depth) {
  const auto next = std::lower_bound(curve.depth.begin(), curve.depth.end(), depth);
  if (next == curve.depth.begin() || next == curve.depth.end()) return kUnset;
  const auto i = static_cast<std::size_t>(next - curve.depth.begin());
  const double share = (depth - curve.depth[i - 1]) / (curve.depth[i] - curve.depth[i - 1]);
  return curve.force[i - 1] + share * (curve.force[i] - curve.force[i - 1]);
}

}  // namespace

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

}  // namespace enc::bench::plane_button
