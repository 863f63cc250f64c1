#include "benchmarks/tracking/noise.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/tracking/motion.h"
#include "benchmarks/tracking/table1.h"
#include "core/base/units.h"
#include "sim/plants/tracker_plant.h"

namespace enc::bench::tracking {
namespace {

constexpr std::size_t kPoses = 8192, kSegment = 256;  // a minute at 120 Hz
constexpr double kNominal = 0.09;                     // mm rms, the tracker's accuracy [VHMR 2]

// Each pose of a tool in motion: where its tip seems to be, m.
std::vector<Vec3> seen_tips(const models::Setup& setup, const Motion& motion, std::uint64_t seed) {
  const ToolSpec& tool = setup.scene.tools.front();
  sim::TrackerTruth truth = sim::with_tool_known(setup.twin.tracker, tool.markers, tool.tip);
  truth.packets = sim::Packets::event;
  sim::TrackerPlant tracker(truth, Pose<'W', 'C'>::identity(), seed);
  std::vector<Vec3> tips;
  Measurement<TrackedTool> pose;
  for (Time t{}; tips.size() < kPoses; t += Duration(1'000'000)) {
    const Vec3 tip = motion.at(seconds(t.time_since_epoch())).position;
    tracker.advance(t, 0, Pose<'W', 'T'>(Quat::Identity(), tip));
    if (tracker.poll(pose)) tips.emplace_back(pose.value.X_CT.p());
  }
  return tips;
}

// mm^2/Hz over the frequencies k rate / kSegment, k from 1: mean over segments that overlap by half, each
// without its mean and under a Hann window (Welch).
std::vector<double> density_of(const std::vector<double>& values, double rate) {
  std::vector<double> window(kSegment), density(kSegment / 2);
  double squares = 0.0;
  for (std::size_t i = 0; i < kSegment; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / kSegment);
    squares += window[i] * window[i];
  }
  std::size_t segments = 0;
  for (std::size_t from = 0; from + kSegment <= values.size(); from += kSegment / 2, ++segments) {
    const std::vector<double> part(values.begin() + static_cast<std::ptrdiff_t>(from),
                                   values.begin() + static_cast<std::ptrdiff_t>(from + kSegment));
    const double middle = mean(part);
    for (std::size_t k = 1; k <= density.size(); ++k) {
      std::complex<double> sum;
      for (std::size_t i = 0; i < kSegment; ++i)
        sum += window[i] * (part[i] - middle) *
               std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k * i % kSegment) / kSegment);
      density[k - 1] += 2.0 * std::norm(sum) / (rate * squares);
    }
  }
  for (double& one : density) one /= static_cast<double>(segments);
  return density;
}

// A hand that holds the tool still shakes in a band; the tracker's jitter has no band. Both out of what the
// tracker shows alone, mm rms: jitter from the floor beside the band, shake from what rises above it.
struct RestSpectrum {
  double jitter = kUnset, shake = kUnset;
};
RestSpectrum told_apart(const std::vector<double>& values, double rate) {
  constexpr double kFrom = 6.0, kTo = 14.0, kFloor = 20.0;  // Hz
  const std::vector<double> density = density_of(values, rate);
  const double each = rate / kSegment;
  std::vector<double> floor;
  double band = 0.0, width = 0.0;
  for (std::size_t k = 0; k < density.size(); ++k) {
    const double at = static_cast<double>(k + 1) * each;
    if (at > kFloor) floor.push_back(density[k]);
    if (at < kFrom || at > kTo) continue;
    band += density[k] * each;
    width += each;
  }
  const double level = mean(floor);
  return {std::sqrt(0.5 * rate * level), std::sqrt(std::max(0.0, band - level * width))};
}

void add_shake(Bench& bench, const models::Setup& setup, double jitter) {
  constexpr double kShake = 0.06;  // mm rms [sources/hand 2]
  const Motion shaking = with_tremor(at_rest(100.0), kShake * kMillimetre, 8.0, 12.0, bench.context.seed);
  std::vector<double> values;
  for (const Vec3& tip :
       seen_tips(setup, bench.context.mutated("no_shake") ? at_rest(100.0) : shaking, bench.context.seed))
    values.push_back(tip.z() * kMmPerM);
  const RestSpectrum found = told_apart(values, setup.twin.tracker.rate);
  bench.figure("noise.shake_found", 100.0 * found.shake / kShake, "%", between(90.0, 110.0),
               "shake of a hand that holds the tool still, 0.06 mm rms, found in the spectrum of what the "
               "tracker shows, of its true size");
  bench.figure("noise.jitter_found", 100.0 * found.jitter / jitter, "%", between(90.0, 110.0),
               "the tracker's jitter, found in the same spectrum, of its true size");
}

// The errors along an axis, mm.
std::vector<double> along_axis(const BenchContext& context, const std::vector<Vec3>& errors, std::size_t a) {
  std::vector<double> values;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto of = [&](std::size_t at) { return errors[at](static_cast<Eigen::Index>(a)) * kMmPerM; };
    values.push_back(context.mutated("smoothed_noise") && i > 0 ? 0.5 * (of(i - 1) + of(i)) : of(i));
  }
  return values;
}

double share_mean(const std::vector<double>& density, double from, double to) {
  const auto at = [&](double share) {
    return density.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(density.size()));
  };
  return mean(std::vector<double>(at(from), at(to)));
}

}  // namespace

void add_noise(Bench& bench) {
  const models::Setup setup = load_scene(bench.context, "clamped_tool");
  const std::vector<Vec3> errors = seen_tips(setup, at_rest(100.0), bench.context.seed);
  const Table1 paper = table1_of(Reference::load(bench.context.models, "table1.csv"));
  const double rate = setup.twin.tracker.rate;
  Plot plot{.id = "noise",
            .title = "A tool at rest: spectrum of the tracked tip",
            .x_label = "frequency (Hz)",
            .y_label = "density (mm^2/Hz)",
            .log_y = true,
            .caption = "White in the twin: no frequency stands out, so a hand's shake at 8 to 12 Hz does."};
  double low = 0.0, high = 0.0, square = 0.0, jitter = kUnset;  // mm
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double> values = along_axis(bench.context, errors, a);
    const double middle = mean(values);
    double spread = 0.0;
    for (const double x : values) spread += (x - middle) * (x - middle);
    spread /= static_cast<double>(values.size());
    square += spread + middle * middle;
    jitter = std::sqrt(spread);
    // The bias is several times the noise, so the mean size is the bias.
    const double printed = kMmPerM * std::sqrt(std::pow(paper[0][a].rmse, 2) - std::pow(paper[0][a].mae, 2));
    bench.figure(fmt::format("noise.{}", kTableAxes[a]), std::sqrt(spread), "mm", calibrated(printed),
                 between(0.85 * printed, 1.15 * printed), "rms about its mean, tool at rest, a minute");
    const std::vector<double> density = density_of(values, rate);
    low += share_mean(density, 0.0, 0.25);
    high += share_mean(density, 0.75, 1.0);
    Series series{.name = kTableAxes[a]};
    for (std::size_t k = 0; k < density.size(); ++k)
      series.add(static_cast<double>(k + 1) * rate / kSegment, density[k]);
    plot.series.push_back(std::move(series));
  }
  bench.figure("noise.low_over_high", low / high, "x", between(0.8, 1.25),
               "density below 15 Hz over that above 45 Hz, mean of the axes: 1 if it is white");
  bench.figure("noise.accuracy", std::sqrt(square), "mm", predicted(kNominal), between(0.15, 0.17),
               "rms distance at rest, bias included; the paper's own Table 1 has 0.1588");
  bench.plot(std::move(plot));
  add_shake(bench, setup, jitter);
}

}  // namespace enc::bench::tracking
