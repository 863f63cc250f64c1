#include "benchmarks/tracking/prediction_rows.h"

#include <cmath>

#include <fmt/format.h>

namespace enc::bench::tracking {
namespace {

// Every axis moves alike, so that the distance is what the paper's norm of three separate axes is.
const Vec3 kAll = Vec3::Ones();

Motion paper_moves(double speed, double acceleration, bool both_ways) {
  StopsSpec spec;
  spec.direction = kAll;
  for (double& stop : spec.stops) stop *= kAll.norm();
  spec.speed = speed * kAll.norm();
  spec.acceleration = acceleration * kAll.norm();
  spec.dwell = 0.5;  // what comes later in a stop is like that
  spec.both_ways = both_ways;
  return moves_with_stops(spec);
}

// 20 mm at 40 mm/s and 100 mm at 200 mm/s take as long.
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

// The same with stamps that are wrong: the latency is believed to be another than it is.
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

// One way, along +, the registration error opposes the lag (sources/tracking 6): the paper's Table 1. There
// and back it is as often with the lag as against it, so a wrong latency costs as much as it does on average.
void add_paper(std::vector<PredictionRow>& rows, double acceleration, const Table1& paper) {
  const auto moves = [acceleration](double speed, bool both_ways) {
    return [=](std::uint64_t) { return paper_moves(speed, acceleration, both_ways); };
  };
  for (std::size_t s = 1; s < kTableSpeeds.size(); ++s) {
    const double speed = 1e-3 * kTableSpeeds[s];
    PredictionRow made =
        row(fmt::format("{:.0f}", speed * 1e3),
            fmt::format("paper's moves, {:.0f} mm/s, registration kept", speed * 1e3), moves(speed, false));
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
    if (length <= 0.1) out.highest = 1.5e-3;
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

}  // namespace

std::vector<PredictionRow> prediction_rows(double acceleration, const Table1& paper) {
  std::vector<PredictionRow> rows;
  add_paper(rows, acceleration, paper);
  add_hand(rows);
  add_faults(rows);
  return rows;
}

}  // namespace enc::bench::tracking
