// Prediction of the tool's present place from an old pose: hold, constant velocity and constant acceleration,
// on the paper's moves and on other motions of a hand. Packets are polled at 100 Hz as in the paper, or sent
// when ready.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/tracking/motion.h"
#include "benchmarks/tracking/tracking_fit.h"
#include "sim/plants/tracker_plant.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::tracking {
namespace {

struct PredictionRow {
  std::string id, title;
  std::function<Motion(std::uint64_t seed)> motion;
  std::function<void(sim::TrackerTruth&)> change{};  // changes the tracker; empty: as in the rig
  bool with_bias = false;                            // registration error kept
  bool moving_only = false;                          // excludes stops
  bool peak = false;                                 // judges the largest error
  bool in_figures = false;                           // adds figures for each prediction and kind of packets
  double from = 0.0, to = std::numeric_limits<double>::infinity();  // s, counted part of the motion
  double paper = kUnset;                                            // m
  double highest = kUnset;   // m: bound on the error of constant velocity, with
  std::size_t bound_on = 1;  // packets: 0 polled, 1 event
};

// Every axis moves alike, so that the distance equals the paper's norm of three separate axes.
const Vec3 kAll = Vec3::Ones();

Motion paper_moves(double speed, double acceleration, bool both_ways) {
  StopsSpec spec;
  spec.direction = kAll;
  for (double& stop : spec.stops) stop *= kAll.norm();
  spec.speed = speed * kAll.norm();
  spec.acceleration = acceleration * kAll.norm();
  spec.dwell = 0.5;  // a longer stop adds nothing new
  spec.both_ways = both_ways;
  return moves_with_stops(spec);
}

// 20 mm at 40 mm/s and 100 mm at 200 mm/s take equally long.
Motion reach(const ReachShape& shape, double peak_speed) {
  return reaches(shape, {0.5 * peak_speed * kAll, peak_speed * kAll.norm()});
}

Motion shaking(const Motion& motion, double rms, std::uint64_t seed) {
  return with_tremor(motion, rms, 8.0, 12.0, seed);
}

double middle(const ReachShape& shape) { return 0.25 * shape.peak; }  // s, of the first of those reaches

PredictionRow row(std::string id, std::string title, std::function<Motion(std::uint64_t)> motion) {
  PredictionRow made;
  made.id = std::move(id);
  made.title = std::move(title);
  made.motion = std::move(motion);
  return made;
}

// The row with wrong stamps: the assumed latency differs from the true one.
void add_wrong_stamps(std::vector<PredictionRow>& rows, const PredictionRow& right) {
  for (const double error : {3e-3, -3e-3}) {
    PredictionRow made = right;
    made.id = fmt::format("stamp_{}3ms.{}", error > 0 ? "plus" : "minus", right.id);
    made.title += fmt::format(", stamps {:.0f} ms {}", std::abs(error) * 1e3, error > 0 ? "late" : "early");
    made.change = [error](sim::TrackerTruth& truth) { truth.stamp_error += error; };
    made.paper = kUnset;
    if (!std::isnan(right.highest)) made.highest = 0.30e-3;
    rows.push_back(made);
  }
}

// The paper's Table 1 moves one way, along +, where the registration error opposes the lag (sources/tracking
// 6). A motion there and back has the error as often with the lag as against it, so a wrong latency has its
// average cost.
void add_paper(std::vector<PredictionRow>& rows, double acceleration, const Table1& paper) {
  const auto moves = [acceleration](double speed, bool both_ways) {
    return [=](std::uint64_t) { return paper_moves(speed, acceleration, both_ways); };
  };
  for (std::size_t s = 1; s < kTableSpeeds.size(); ++s) {
    const double speed = 1e-3 * kTableSpeeds[s];
    PredictionRow made =
        row(fixed(speed * 1e3, 0), fmt::format("paper's moves, {:.0f} mm/s, registration kept", speed * 1e3),
            moves(speed, false));
    made.with_bias = made.moving_only = made.in_figures = true;
    made.paper = paper[s][3].rmse;  // norm [VHMR Table 1]
    if (speed > 0.030) made.highest = 0.20e-3;
    rows.push_back(made);
  }
  PredictionRow back = rows.back();
  back.id = "there_and_back.40";
  back.title = "there and back, 40 mm/s, registration kept";
  back.motion = moves(0.040, true);
  back.paper = kUnset;
  rows.push_back(back);
  add_wrong_stamps(rows, back);
  PredictionRow one_way = rows[1];
  one_way.paper = one_way.highest = kUnset;
  add_wrong_stamps(rows, one_way);
  PredictionRow made = row("registered.40", "paper's moves, 40 mm/s", moves(0.040, true));
  made.moving_only = true;
  rows.push_back(made);
}

void add_hand(std::vector<PredictionRow>& rows) {
  const auto shaped = [](const ReachShape& shape, double speed) {
    return [&shape, speed](std::uint64_t) { return reach(shape, speed); };
  };
  rows.push_back(row("reach.40", "reach, peak 40 mm/s", shaped(minimum_jerk(), 0.040)));
  rows.push_back(row("reach.200", "reach, peak 200 mm/s", shaped(minimum_jerk(), 0.200)));
  rows.push_back(row("early_peak.200", "reach with an early peak, 200 mm/s", shaped(early_peak(), 0.200)));
  rows.push_back(row("two_movements.200", "reach and correction, 200 mm/s", shaped(two_movements(), 0.200)));
  rows.push_back(
      row("press", "press, 2 Hz, 3 mm", [](std::uint64_t) { return swing(0.003 * kAll, 2.0, 5.0); }));
  rows.push_back(row("tremor.50um", "reach, 40 mm/s, tremor 0.05 mm rms, 8 to 12 Hz", [](std::uint64_t seed) {
    return shaking(reach(minimum_jerk(), 0.040), 0.05e-3, seed);
  }));
  rows.push_back(row("tremor.200um", "tremor 0.2 mm rms alone",
                     [](std::uint64_t seed) { return shaking(at_rest(5.0), 0.2e-3, seed); }));
  rows.push_back(row("rest", "at rest: the tracker's noise", [](std::uint64_t) { return at_rest(5.0); }));
}

void add_faults(std::vector<PredictionRow>& rows) {
  PredictionRow stop = row("stop.200", "sudden stop at 200 mm/s", [](std::uint64_t) {
    return stopped(reach(minimum_jerk(), 0.200), middle(minimum_jerk()));
  });
  stop.peak = true;
  stop.from = middle(minimum_jerk());
  stop.to = stop.from + 0.3;
  rows.push_back(stop);
  for (const double length : {0.05, 0.1, 0.2, 0.5}) {
    PredictionRow out = row(fmt::format("drop_out.{:.0f}", length * 1e3),
                            fmt::format("reach, 40 mm/s, drop-out of {:.0f} ms", length * 1e3),
                            [](std::uint64_t) { return reach(minimum_jerk(), 0.040); });
    out.from = middle(minimum_jerk()) - 0.5 * std::min(length, 0.1);
    out.to = out.from + length + 0.5;
    out.change = [from = out.from, length](sim::TrackerTruth& truth) {
      truth.blackout_at = from;
      truth.blackout_for = length;
    };
    out.peak = true;
    if (length <= 0.1) out.highest = length < 0.1 ? 0.7e-3 : 1.5e-3;
    out.bound_on = 0;
    rows.push_back(out);
  }
  PredictionRow loss = row("loss", "reach, 40 mm/s, a fifth of the packets lost",
                           [](std::uint64_t) { return reach(minimum_jerk(), 0.040); });
  loss.change = [](sim::TrackerTruth& truth) { truth.loss = 1.0 - 0.8 * (1.0 - truth.loss); };
  loss.highest = 0.13e-3;
  loss.bound_on = 0;
  rows.push_back(loss);
}

// acceleration: of the machine that makes the paper's moves, m/s^2; paper: the reference of the rows with
// those moves.
std::vector<PredictionRow> prediction_rows(double acceleration, const Table1& paper) {
  std::vector<PredictionRow> rows;
  add_paper(rows, acceleration, paper);
  add_hand(rows);
  add_faults(rows);
  return rows;
}

constexpr std::array<sim::Packets, 2> kPackets{sim::Packets::polled, sim::Packets::event};
constexpr auto kPacketName = kWords<sim::Packets>;
constexpr std::array kName{"hold", "cv", "ca"};
constexpr std::array kLongName{"hold", "constant velocity", "constant acceleration"};

// One row with one kind of packets: errors of each prediction, over the seeds.
struct Outcome {
  std::array<std::vector<double>, 3> at_packets, at_ticks, peak, step;  // m
};
struct Trials {
  models::Setup setup;
  Scene scene;
  Pose<'W', 'C'> X_WC;
  std::vector<PredictionRow> rows;
  std::vector<std::array<Outcome, 2>> cells{};
  double simulated = 0.0;
};

double root_mean_square(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

PredictionRun run_of(const Trials& trials, const PredictionRow& row, sim::Packets packets,
                     std::uint64_t seed) {
  const ToolSpec& tool = trials.setup.scene.tools.front();
  PredictionRun run{row.motion(seed),
                    sim::with_tool_known(trials.setup.twin.tracker, tool.markers, tool.tip),
                    seed,
                    row.moving_only,
                    row.from,
                    row.to};
  run.truth.packets = packets;
  if (!row.with_bias) run.truth.bias = Vec3::Zero();
  if (row.change) row.change(run.truth);
  return run;
}

void run_rows(Trials& trials, const BenchContext& context, std::size_t seeds) {
  struct Job {
    std::size_t row, packets;
    std::uint64_t seed;
    std::array<TipErrors, 3> errors{};
    double time = 0.0;
  };
  std::vector<Job> jobs;
  for (std::size_t row = 0; row < trials.rows.size(); ++row)
    for (std::size_t p = 0; p < kPackets.size(); ++p)
      for (std::size_t s = 0; s < seeds; ++s) jobs.push_back({row, p, context.seed + s});
  in_parallel(jobs.size(), [&](std::size_t i) {
    Job& job = jobs[i];
    const PredictionRun run = run_of(trials, trials.rows[job.row], kPackets[job.packets], job.seed);
    job.errors = predicted_run(trials.scene, trials.X_WC, run);
    if (context.mutated("hold_for_velocity")) job.errors[1] = job.errors[0];
    job.time = std::min(run.motion.duration, run.to);
  });
  trials.cells.resize(trials.rows.size());
  for (const Job& job : jobs) {
    Outcome& cell = trials.cells[job.row][job.packets];
    for (std::size_t k = 0; k < 3; ++k) {
      cell.at_packets[k].push_back(job.errors[k].at_packets);
      cell.at_ticks[k].push_back(job.errors[k].at_ticks);
      cell.peak[k].push_back(job.errors[k].peak);
      cell.step[k].push_back(job.errors[k].largest_step);
    }
    trials.simulated += job.time;
  }
}

Figure figure_of(std::string id, const std::vector<double>& over_seeds, double twin, double high,
                 std::string note) {
  const auto [least, most] = std::minmax_element(over_seeds.begin(), over_seeds.end());
  return {std::move(id), kUnset, twin * 1e3,      "mm",         Role::ours,
          kUnset,        high,   std::move(note), *least * 1e3, *most * 1e3};
}

std::vector<Figure> figures_of(const Trials& trials) {
  std::vector<Figure> figures;
  for (std::size_t r = 0; r < trials.rows.size(); ++r) {
    const PredictionRow& row = trials.rows[r];
    for (std::size_t p = 0; p < kPackets.size(); ++p) {
      const Outcome& cell = trials.cells[r][p];
      for (std::size_t k = 0; k < kName.size(); ++k) {
        if (!row.in_figures && (k != 1 || p != 0)) continue;  // the other rows are in the tables only
        const bool bound = k == 1 && p == row.bound_on;
        const std::vector<double>& of = row.peak ? cell.peak[k] : cell.at_packets[k];
        Figure figure =
            figure_of(fmt::format("tracking.predicted.{}.{}.{}.{}", kName[k], kPacketName[p],
                                  row.peak ? "peak" : "rmse.norm", row.id),
                      of, row.peak ? *std::max_element(of.begin(), of.end()) : root_mean_square(of),
                      bound ? row.highest * 1e3 : kUnset,
                      fmt::format("{}; {}", row.title,
                                  row.peak ? "along an axis, on every tick" : "on ticks with a new pose"));
        if (k == 0 && p == 0) figure.paper = row.paper * 1e3;
        if (!std::isnan(figure.paper)) {  // Table 1 gave the delays
          figure.role = Role::calibrated;
          figure.low = 0.92 * figure.paper;
          figure.high = 1.08 * figure.paper;
        }
        figures.push_back(std::move(figure));
      }
    }
  }
  return figures;
}

std::string mm(double m) { return fixed(m * 1e3, 3); }

Table rmse_table(const Trials& trials) {
  Table table{
      "tracking_predicted", "Error of the tool's tip by motion and prediction", {"motion", "packets"}};
  for (const char* name : kLongName) table.columns.push_back(fmt::format("{} at packets mm", name));
  for (const char* name : kLongName) table.columns.push_back(fmt::format("{} at every tick mm", name));
  for (std::size_t r = 0; r < trials.rows.size(); ++r)
    for (std::size_t p = 0; p < kPackets.size(); ++p) {
      std::vector<std::string> line{trials.rows[r].title, std::string(kPacketName[p])};
      for (std::size_t k = 0; k < 3; ++k)
        line.push_back(mm(root_mean_square(trials.cells[r][p].at_packets[k])));
      for (std::size_t k = 0; k < 3; ++k)
        line.push_back(mm(root_mean_square(trials.cells[r][p].at_ticks[k])));
      table.rows.push_back(std::move(line));
    }
  table.note =
      "RMS distance of tip and truth; every axis moves alike. Registration is taken out but where it is "
      "named.";
  return table;
}

Table peak_table(const Trials& trials) {
  Table table{"tracking_predicted_peak",
              "Largest error along an axis, and largest step of the prediction in a tick",
              {"motion", "packets"}};
  for (const char* name : kLongName) table.columns.push_back(fmt::format("{} peak mm", name));
  for (const char* name : kLongName) table.columns.push_back(fmt::format("{} step mm", name));
  for (std::size_t r = 0; r < trials.rows.size(); ++r) {
    if (!trials.rows[r].peak) continue;
    for (std::size_t p = 0; p < kPackets.size(); ++p) {
      std::vector<std::string> line{trials.rows[r].title, std::string(kPacketName[p])};
      const auto most = [](const std::vector<double>& x) {
        return mm(*std::max_element(x.begin(), x.end()));
      };
      for (std::size_t k = 0; k < 3; ++k) line.push_back(most(trials.cells[r][p].peak[k]));
      for (std::size_t k = 0; k < 3; ++k) line.push_back(most(trials.cells[r][p].step[k]));
      table.rows.push_back(std::move(line));
    }
  }
  table.note =
      "The step is beyond the tool's own way in that tick; the machine goes 0.05 mm in a tick at most.";
  return table;
}

Plot named_plot(std::string id, std::string title, std::string x_label, std::string y_label) {
  Plot plot;
  plot.id = std::move(id);
  plot.title = std::move(title);
  plot.x_label = std::move(x_label);
  plot.y_label = std::move(y_label);
  return plot;
}

// The rows in the plot; the table has all rows.
struct PlotRow {
  const char *id, *name;
};
constexpr auto kShown = std::to_array<PlotRow>({{"20", "paper 20"},
                                                {"40", "paper 40"},
                                                {"reach.40", "reach 40"},
                                                {"reach.200", "reach 200"},
                                                {"press", "press 2 Hz"},
                                                {"tremor.200um", "tremor"},
                                                {"rest", "rest"},
                                                {"stop.200", "stop"},
                                                {"drop_out.100", "drop-out"},
                                                {"loss", "loss"}});

Plot rmse_plot(const Trials& trials) {
  Plot plot = named_plot("tracking_predicted_rmse", "Error of the tool's tip by motion and prediction",
                         "motion", "RMS distance, mm");
  plot.log_y = true;
  std::vector<std::size_t> rows;
  Series paper{.name = "paper (holds, polled)", .mark = Mark::points, .paper = true};
  for (const PlotRow& shown : kShown)
    for (std::size_t r = 0; r < trials.rows.size(); ++r) {
      if (trials.rows[r].id != shown.id) continue;
      if (!std::isnan(trials.rows[r].paper))
        paper.add(static_cast<double>(rows.size()) - 0.25, trials.rows[r].paper * 1e3);
      plot.x_names.emplace_back(shown.name);
      rows.push_back(r);
    }
  for (std::size_t p = 0; p < kPackets.size(); ++p)
    for (std::size_t k = 0; k < kName.size(); ++k) {
      Series series{.name = fmt::format("{}, {}", kLongName[k], kPacketName[p]), .mark = Mark::points};
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::vector<double>& of = trials.cells[rows[i]][p].at_packets[k];
        const auto [least, most] = std::minmax_element(of.begin(), of.end());
        series.add(static_cast<double>(i) + 0.1 * (static_cast<double>(3 * p + k) - 2.5),
                   {root_mean_square(of) * 1e3, *least * 1e3, *most * 1e3});
      }
      plot.series.push_back(std::move(series));
    }
  plot.series.push_back(std::move(paper));
  plot.caption =
      "On ticks with a new pose; intervals: over seeds. The table below has all motions. Where the tool "
      "shakes at 8 to 12 Hz or has just stopped, compare with hold: there prediction need not help.";
  return plot;
}

Plot time_plot(const Trials& trials, const BenchContext& context, const std::string& row_id,
               std::string plot_id, std::string caption) {
  const auto row = std::find_if(trials.rows.begin(), trials.rows.end(),
                                [&](const PredictionRow& r) { return r.id == row_id; });
  PredictionRun run = run_of(trials, *row, sim::Packets::event, context.seed);
  run.from = std::max(0.0, run.from - 0.1);
  TipTrace trace;
  (void)predicted_run(trials.scene, trials.X_WC, run, &trace);
  Plot plot = named_plot(std::move(plot_id), row->title, "time, s", "error along x, mm");
  for (std::size_t k = 0; k < kName.size(); ++k) {
    Series series{kLongName[k], trace.time, trace.error[k]};
    for (double& y : series.y) y *= 1e3;
    plot.series.push_back(std::move(series));
  }
  plot.caption = std::move(caption);
  return plot;
}

// ---- cost and benefit in the whole loop ---------------------------------------------------------------

// step() with each prediction, interleaved; ns, median of the runs' medians.
std::array<double, 3> step_costs(const models::Setup& setup, const BenchContext& context, double& simulated) {
  std::array<std::vector<double>, 3> medians;
  for (int round = 0; round < (context.full ? 5 : 1); ++round)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + static_cast<std::size_t>(round)) % 3;
      models::Setup with = setup;
      with.rig.tracker.prediction = kPredictions[k];
      trial::TrialOptions options{.seed = context.seed, .seconds = context.full ? 10.0 : 3.0};
      const trial::TrialResult run = trial::Trial(with, options).run();
      medians[k].push_back(median(run.step_ns));
      simulated += run.simulated;
    }
  return {median(medians[0]), median(medians[1]), median(medians[2])};
}

constexpr std::array<double, 5> kSpeeds{0.010, 0.020, 0.050, 0.100, 0.200};  // m/s

// First touches with a prediction at an approach speed: medians over the seeds of the miss, m, and of the
// time from the surface to the first force, s; and the touches that failed [docs/notes/encounter.md].
struct FirstTouches {
  double miss = kUnset, delay = kUnset;
  std::size_t failed = 0, tried = 0;
};
using TouchTable = std::array<std::array<FirstTouches, 5>, 3>;  // [prediction][speed]

TouchTable first_touches(const models::Setup& setup, const BenchContext& context, double& simulated) {
  const std::size_t seeds = context.full ? 40 : 2;
  std::vector<double> miss(3 * kSpeeds.size() * seeds, kUnset);
  std::vector<double> time(miss.size()), delay(miss.size(), kUnset);
  in_parallel(miss.size(), [&](std::size_t i) {
    models::Setup with = setup;
    const std::size_t prediction = i / (kSpeeds.size() * seeds);
    with.rig.tracker.prediction = kPredictions[context.mutated("hold_for_velocity") ? 0 : prediction];
    UserSpec& user = *with.scene.user;
    user.approach = {kSpeeds[i / seeds % kSpeeds.size()]};
    user.press_time = user.release_time = 0.8;
    user.hold_time = 0.1;
    user.depth = 0.002;
    const trial::PressMeasure measure = trial::measured_run(with, context.seed + i % seeds, time[i]);
    miss[i] = measure.presses().front().miss;
    delay[i] = measure.presses().front().first_force_delay;
  });
  for (const double t : time) simulated += t;
  TouchTable result{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t v = 0; v < kSpeeds.size(); ++v) {
      std::vector<double> missed, delayed;
      for (std::size_t i = (k * kSpeeds.size() + v) * seeds; missed.size() < seeds; ++i) {
        missed.push_back(miss[i]);
        if (!std::isnan(delay[i])) delayed.push_back(delay[i]);
      }
      result[k][v] = {median(missed), median(delayed), seeds - delayed.size(), seeds};
    }
  return result;
}

// The instant of contact and the misses of each prediction. Bounds, ms: a slow tool is felt once it has gone
// as deep as the force that counts.
constexpr std::array<double, 5> kLatest{kUnset, kUnset, 18.0, 10.0, 8.0};
void add_touches(BenchResult& result, const TouchTable& touches) {
  for (std::size_t k = 0; k < 3; ++k) {
    double failed = 0.0, tried = 0.0;
    for (std::size_t v = 0; v < kSpeeds.size(); ++v) {
      const FirstTouches& one = touches[k][v];
      failed += static_cast<double>(one.failed);
      tried += static_cast<double>(one.tried);
      result.figures.push_back(
          {fmt::format("tracking.predicted.{}.contact_ms.{:.0f}", kName[k], 1e3 * kSpeeds[v]), kUnset,
           1e3 * one.delay, "ms", Role::ours, kUnset, kLatest[v],
           fmt::format("from the surface to the first force at {:.0f} mm/s, median of {}", 1e3 * kSpeeds[v],
                       one.tried)});
    }
    result.figures.push_back({fmt::format("tracking.predicted.{}.missed.percent", kName[k]), kUnset,
                              100.0 * failed / tried, "%", Role::ours, kUnset, kUnset,
                              "first touches without a force, all speeds"});
  }
}

void add_loop(BenchResult& result, const models::Setup& setup, const BenchContext& context) {
  const auto cost = step_costs(setup, context, result.simulated);
  const TouchTable touches = first_touches(setup, context, result.simulated);
  add_touches(result, touches);
  Table table{"tracking_predicted_loop",
              "In the whole loop: cost of step() and miss at first touch",
              {"prediction", "step() p50 us"}};
  Plot plot = named_plot("tracking_predicted_miss", "Miss at first touch by prediction",
                         "approach speed, mm/s", "miss, mm");
  plot.log_x = true;
  for (const double v : kSpeeds) table.columns.push_back(fmt::format("miss at {:.0f} mm/s mm", v * 1e3));
  for (std::size_t k = 0; k < 3; ++k) {
    table.rows.push_back({kLongName[k], fixed(cost[k] * 1e-3, 2)});
    Series series{.name = kLongName[k], .mark = Mark::both};
    for (std::size_t v = 0; v < kSpeeds.size(); ++v) {
      table.rows.back().push_back(mm(touches[k][v].miss));
      series.add(kSpeeds[v] * 1e3, touches[k][v].miss * 1e3);
    }
    plot.series.push_back(std::move(series));
    result.figures.push_back({fmt::format("tracking.predicted.{}.step.p50", kName[k]), kUnset, cost[k] * 1e-3,
                              "us", Role::ours, kUnset, kUnset, "step() on tennis_ball, all stages"});
    result.figures.back().cost = true;
  }
  plot.caption =
      "True tool tip to haptic-tip, medians over seeds. The rest of the miss is the machine's own lag.";
  result.tables.push_back(std::move(table));
  result.plots.push_back(std::move(plot));
}

}  // namespace

void add_prediction(const BenchContext& context, BenchResult& result) {
  Trials trials{load_scene(context, "tennis_ball"), {}, {}, {}};
  trials.scene = trial::prepare_setup(trials.setup);
  trials.X_WC = pose_of<'W', 'C'>(trials.setup.twin.frames.W_C);
  trials.rows = prediction_rows(trials.setup.twin.hexapod.acceleration,
                                table1_of(Reference::load(context.models, "table1.csv")));
  const std::size_t seeds = context.count(context.full ? 24 : 4, 2);
  run_rows(trials, context, seeds);
  const auto append = [](auto& list, auto more) {
    list.insert(list.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  append(result.figures, figures_of(trials));
  append(result.tables, std::vector<Table>{rmse_table(trials), peak_table(trials)});
  append(result.plots,
         std::vector<Plot>{rmse_plot(trials),
                           time_plot(trials, context, "stop.200", "tracking_predicted_stop",
                                     "The tool meets a wall at 200 mm/s. Until the first pose from after the "
                                     "stop has come, every prediction goes on; holding never leads."),
                           time_plot(trials, context, "drop_out.100", "tracking_predicted_drop_out",
                                     "No poses for 100 ms in the middle of a reach. The prediction goes on "
                                     "for 100 ms and catches up afterwards.")});
  result.simulated += trials.simulated;
  if (context.progress) context.progress(0.8);
  add_loop(result, trials.setup, context);
}

}  // namespace enc::bench::tracking
