#include "benchmarks/tracking/forensics.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/tracking/motion.h"
#include "benchmarks/tracking/tracking_fit.h"
#include "core/base/units.h"
#include "models/setup/scene_file.h"
#include "sim/plants/tracker_plant.h"
#include "sim/truth/random.h"

namespace enc::bench::tracking {
namespace {

constexpr double kPeriod = 1e-3;  // s [VHMR 2]

std::vector<Motion> motions_of(const LogSpec& spec) {
  std::vector<Motion> all;
  for (int a = 0; a < 3; ++a)
    for (const double speed : spec.speeds) {
      if (!spec.axes[static_cast<std::size_t>(a)]) continue;
      StopsSpec moves;
      moves.direction = Vec3::Unit(a);
      moves.speed = speed;
      moves.dwell = spec.dwell;
      moves.both_ways = spec.both_ways;
      all.push_back(moves_with_stops(moves));
    }
  if (all.empty()) all.push_back(at_rest(3.0));
  return all;
}

}  // namespace

MadeLog made_log(const LogSpec& spec, std::uint64_t seed) {
  MadeLog made;
  models::TrackerLog& log = made.log;
  sim::TrackerPlant tracker(spec.tracker, Pose<'W', 'C'>::identity(), seed);
  double sum = 0.0, count = 0.0, before = 0.0;
  std::int64_t n = 0;
  for (const Motion& motion : motions_of(spec)) {
    for (; static_cast<double>(n) * kPeriod < before + motion.duration; ++n) {
      const Time t{from_seconds(static_cast<double>(n) * kPeriod)};
      const double now = seconds(t.time_since_epoch());
      const MotionPoint tip = motion.at(now - before);
      tracker.advance(t, 0, {Quat::Identity(), tip.position});
      log.time.push_back(now);
      log.tip.push_back(tip.position);
      Measurement<TrackedTool> packet;
      if (!tracker.poll(packet)) continue;
      const double stamp = seconds(packet.t.time_since_epoch());
      log.packets.push_back({now, spec.stamps ? stamp : kUnset, Vec3(packet.value.X_CT.p())});
      if (tip.velocity.norm() < 1e-3) continue;
      sum += now - stamp;
      ++count;
    }
    before += motion.duration;
  }
  log.period = kPeriod;
  log.packet_period = 1.0 / spec.tracker.server_rate;
  made.latency = sum / count;
  return made;
}

namespace {

struct ForensicCase {
  double latency = kUnset, found = kUnset;  // s
  Vec3 bias{0, 0, 0}, found_bias{0, 0, 0};  // m
  bool latency_held = false;                // the interval contains the injected value
  int bias_held = 0;                        // axes
};

// Random devices around those of the rig: latency to 40 ms, delay to 5 ms, bias to 0.3 mm, noise 5 to 30 um.
ForensicCase tried(const sim::TrackerTruth& rig, std::uint64_t seed) {
  sim::Stream random(seed, "forensics");
  LogSpec spec;
  spec.tracker = rig;
  spec.tracker.latency = 0.040 * random.uniform();
  spec.tracker.udp_delay = 0.005 * random.uniform();
  for (Eigen::Index a = 0; a < 3; ++a) {
    spec.tracker.bias(a) = 0.3 * kMillimetre * (2.0 * random.uniform() - 1.0);
    spec.tracker.noise(a) = (0.005 + 0.025 * random.uniform()) * kMillimetre;
  }
  const MadeLog made = made_log(spec, seed);
  const models::LatencyFit fit = models::fit_latency(made.log);
  ForensicCase trial{made.latency, fit.latency.value, spec.tracker.bias, {}, fit.latency.holds(made.latency)};
  for (std::size_t a = 0; a < 3; ++a) {
    trial.found_bias(static_cast<Eigen::Index>(a)) = fit.axes[a].bias.value;
    trial.bias_held += fit.axes[a].bias.holds(spec.tracker.bias(static_cast<Eigen::Index>(a)));
  }
  return trial;
}

void add_figures(BenchResult& result, const std::vector<ForensicCase>& trials) {
  double near = 0.0, near_bias = 0.0, held = 0.0, bias_held = 0.0, worst = 0.0, worst_bias = 0.0;
  for (const ForensicCase& t : trials) {
    const double error = std::abs(t.found - t.latency);
    const double bias_error = (t.found_bias - t.bias).cwiseAbs().maxCoeff();
    near += error <= kMillisecond ? 1.0 : 0.0;
    near_bias += bias_error <= 0.01 * kMillimetre ? 1.0 : 0.0;
    held += t.latency_held ? 1.0 : 0.0;
    bias_held += t.bias_held / 3.0;
    worst = std::max(worst, error);
    worst_bias = std::max(worst_bias, bias_error);
  }
  const double share = 100.0 / static_cast<double>(trials.size());
  const std::string logs = fmt::format("{} seeded logs", trials.size());
  const auto add = [&](const char* id, double value, const char* unit, double low, const std::string& note) {
    result.figures.push_back(
        {std::string("tracking.forensics.") + id, kUnset, value, unit, Role::ours, low, kUnset, note});
  };
  add("latency.percent", near * share, "%", 95.0, logs + ", recovered to 1 ms; injected 4 to 50 ms");
  add("bias.percent", near_bias * share, "%", 95.0, logs + ", all axes recovered to 0.01 mm; up to 0.3 mm");
  add("latency.max", worst / kMillisecond, "ms", kUnset, "largest error of the latency");
  add("bias.max", worst_bias / kMillimetre, "mm", kUnset, "largest error of a bias");
  add("latency_interval.percent", held * share, "%", kUnset,
      "its 95 % interval holds the mean age of this log's packets; it is wide, because it is made for the "
      "mean of all that might have come");
  add("bias_interval.percent", bias_held * share, "%", kUnset, "its 95 % interval holds the bias");
}

void add_plot(BenchResult& result, const std::vector<ForensicCase>& trials) {
  Series logs{.name = "logs", .mark = Mark::points};
  Series exact{"found = injected", {0, 60}, {0, 60}};
  for (const ForensicCase& t : trials) logs.add(t.latency / kMillisecond, t.found / kMillisecond);
  Plot plot{"tracking_forensics", "Latency out of a log", "injected, ms", "found, ms", false, false,
            {exact, logs}};
  plot.caption =
      "Each point is a log of a tool carried 40 mm and back along each axis, with a random latency, delay, "
      "bias and noise. The method sees the log alone.";
  result.plots.push_back(std::move(plot));
}

// Table 1 is no log: three speeds, and no sign. So its result depends on the assumed bias.
void add_table(const Table1& paper, BenchResult& result) {
  Table table{"tracking_table1_latency",
              "Latency in the paper's Table 1, by what is assumed of the bias (ms)",
              {"axis", "bias (mm)", "noise (mm)", "RMSE, bias in quadrature, 20", "same, 40", "bias adds, 20",
               "same, 40", "bias opposes, 20", "same, 40", "slope 20 to 40"},
              {},
              "Column 0 gives bias and noise. Quadrature: as if the bias fell out between two directions. "
              "Adds, opposes: (MAE -/+ bias) / speed. Slope: (MAE at 40 - MAE at 20) / 20 mm/s, any bias "
              "that does not change. Speed changes at both ends of a move are ignored."};
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<double, 3> rmse{}, mae{};  // errors at rest, at 20 and at 40 mm/s, mm
    for (std::size_t s = 0; s < paper.size(); ++s) {
      rmse[s] = paper[s][a].rmse / kMillimetre;
      mae[s] = paper[s][a].mae / kMillimetre;
    }
    std::vector<std::string> row{kTableAxes[a], fixed(mae[0], 4),
                                 fixed(std::sqrt(rmse[0] * rmse[0] - mae[0] * mae[0]), 4)};
    const auto add = [&](double mm, double speed) { row.push_back(fixed(1e3 * mm / speed, 1)); };
    add(std::sqrt(rmse[1] * rmse[1] - rmse[0] * rmse[0]), 20.0);
    add(std::sqrt(rmse[2] * rmse[2] - rmse[0] * rmse[0]), 40.0);
    add(mae[1] - mae[0], 20.0);
    add(mae[2] - mae[0], 40.0);
    add(mae[1] + mae[0], 20.0);
    add(mae[2] + mae[0], 40.0);
    add(mae[2] - mae[1], 20.0);
    table.rows.push_back(std::move(row));
  }
  result.tables.push_back(std::move(table));
}

}  // namespace

void add_forensics(const BenchContext& context, BenchResult& result) {
  const models::Setup setup = load_scene(context, "clamped_tool");
  std::vector<ForensicCase> trials(context.full ? 100 : 20);
  in_parallel(trials.size(), [&](std::size_t i) { trials[i] = tried(setup.twin.tracker, context.seed + i); });
  if (context.mutated("late_logs"))
    for (ForensicCase& trial : trials) {
      trial.found += 2.0 * kMillisecond;
      trial.found_bias.array() += 0.02 * kMillimetre;
    }
  add_figures(result, trials);
  add_plot(result, trials);
  add_table(table1_of(Reference::load(context.models, "table1.csv")), result);
}

}  // namespace enc::bench::tracking
