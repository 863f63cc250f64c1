#include "benchmarks/tracking/tracking_plots.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/frames.h"
#include "core/base/units.h"

namespace enc::bench::tracking {
namespace {

Table from_20(const Pictures& p) {
  Table table{"tracking_from_20",
              "40 mm/s predicted from the columns 0 and 20 mm/s alone",
              {"axis", "statistic", "paper (mm)", "median (mm)", "5 % (mm)", "95 % (mm)", "paper inside",
               "twin, best chain (mm)", "difference (%)"},
              {}};
  const Predicted40& prediction = p.fits.prediction[0];
  for (std::size_t a = 0; a < kTableAxes.size(); ++a)
    for (const auto& [name, id, what] : kStatistics) {
      const double value = p.paper[2][a].*what;
      const bool inside = value >= prediction.low[2][a].*what && value <= prediction.high[2][a].*what;
      table.rows.push_back({kTableAxes[a], name, fine_mm(value), fine_mm(prediction.median[2][a].*what),
                            fine_mm(prediction.low[2][a].*what), fine_mm(prediction.high[2][a].*what),
                            inside ? "yes" : "no", fine_mm(p.twin_from_20[2][a].*what),
                            percent(p.twin_from_20[2][a].*what / value)});
    }
  return table;
}

Table hypotheses(const Pictures& p) {
  Table table{"tracking_hypotheses",
              "On which side of the lag is the bias?",
              {"bias", "calibrated on", "misfit at 20 (%)", "misfit at 20 and 40 (%)",
               "worst of what is asked", "fixed delay (ms)", "jitter (ms)", "acceleration (m/s2)",
               "mean age (ms)", "norm RMSE 40 (mm)", "norm MAE 40 (mm)"},
              {}};
  const auto row = [&](std::size_t side, const char* on, const Candidate& c) {
    const Misfit m = misfit(c.table[side], p.paper);
    ChainSpec chain = p.chain;
    chain.fixed = c.fixed;
    chain.jitter = c.jitter;
    table.rows.push_back({kSides[side], on, fmt::format("{:.1f}", 100.0 * m.moving20),
                          fmt::format("{:.1f}", 100.0 * m.moving), fmt::format("{:.2f}", m.worst),
                          fmt::format("{:.2f}", c.fixed * 1e3), fmt::format("{:.2f}", c.jitter * 1e3),
                          fmt::format("{:.2f}", c.acceleration), fmt::format("{:.1f}", mean_age(chain) * 1e3),
                          fine_mm(c.table[side][2][3].rmse), fine_mm(c.table[side][2][3].mae)});
  };
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    row(side, "0, 20", p.fits.from_20[side]);
    row(side, "all, rig's acceleration", p.fits.all[side]);
    row(side, "all", p.fits.all_free[side]);
  }
  table.note =
      "Worst: largest difference in units of 13 % for a figure and 6 % for a norm; above 1 the hypothesis "
      "does "
      "not fit. A bias fixed in the room opposes the lag one way and adds to it the other way; both_ways is "
      "the "
      "mixture.";
  return table;
}

Table directions(const Pictures& p) {
  Table table{"tracking_directions",
              "One way, the other way, both ways: norm",
              {"motion", "speed (mm/s)", "statistic", "paper (mm)", "twin, default rig (mm)", "theory (mm)",
               "twin, best chain of 'adds' (mm)"},
              {}};
  const std::array<const Table1*, 3> twins{&p.twin.table, &p.twin_back, &p.twin_both};
  constexpr std::array<const char*, 3> kMotions{"along + (opposes)", "along - (adds)", "both"};
  for (std::size_t side = 0; side < twins.size(); ++side)
    for (std::size_t s = 1; s < p.paper.size(); ++s)
      for (const auto& [name, id, what] : kStatistics)
        table.rows.push_back({kMotions[side], fmt::format("{}", kTableSpeeds[s]), name,
                              fine_mm(p.paper[s][3].*what), fine_mm((*twins[side])[s][3].*what),
                              fine_mm(p.theory.table[side][s][3].*what),
                              side == 1 ? fine_mm(p.twin_adds[s][3].*what) : ""});
  return table;
}

// One move of the paper's, from 20 to 40 mm along x.
Plot move_plot(const Pictures& p) {
  constexpr double kBefore = 0.0205, kAfter = 0.0395, kAround = 0.15;  // m, m, s
  double from = INFINITY;
  double to = -INFINITY;
  for (const PacketError& packet : p.packets)
    if (packet.axis == 0 && packet.moving == Moving::forward && packet.position > kBefore &&
        packet.position < kAfter) {
      from = std::min(from, packet.t);
      to = std::max(to, packet.t);
    }
  Series error{"error at new packets", {}, {}, {}, {}, Mark::both};
  Series place{"place of the tip / 100", {}, {}, {}, {}, Mark::line};
  for (const PacketError& packet : p.packets) {
    if (packet.axis != 0 || packet.t < from - kAround || packet.t > to + kAround) continue;
    error.x.push_back(packet.t - from);
    error.y.push_back(packet.error * kMmPerM);
    place.x.push_back(packet.t - from);
    place.y.push_back(packet.position * kMmPerM / 100.0);
  }
  return {
      "tracking_move",
      "One move, 20 to 40 mm along x at 40 mm/s",
      "time (s)",
      "error (mm)",
      false,
      false,
      {error, place},
      "At rest the error is the registration's bias, above zero. On the move the tool is seen where it was "
      "an age ago: the lag is below zero, so on the way out the bias takes from it."};
}

double age_of(const Pictures& p, const Candidate& c) {
  ChainSpec chain = p.chain;
  chain.fixed = c.fixed;
  chain.jitter = c.jitter;
  return mean_age(chain) * 1e3;
}

Plot posterior_plot(const Pictures& p) {
  Series likely{"as likely as columns 0 and 20 say", {}, {}, {}, {}, Mark::points};
  for (std::size_t i = 0; i < p.fits.prediction[0].drawn.size(); i += 10) {
    const Candidate& c = p.open[p.fits.prediction[0].drawn[i]];
    likely.x.push_back(age_of(p, c));
    likely.y.push_back(c.acceleration);
  }
  const auto one = [&](const char* name, const Candidate& c) {
    return Series{name, {age_of(p, c)}, {c.acceleration}, {}, {}, Mark::points};
  };
  return {
      "tracking_posterior",
      "What the columns 0 and 20 mm/s leave open",
      "mean age of a packet (ms)",
      "acceleration of the machine (m/s2)",
      false,
      true,
      {likely, one("best of columns 0 and 20", p.fits.from_20[0]),
       one("best of all columns, rig's acceleration", p.fits.all[0])},
      "At 20 mm/s a slow start and a long delay look alike: the acceleration stays open, and that is what "
      "widens the prediction at 40 mm/s."};
}

Plot predictive_plot(const Pictures& p) {
  constexpr std::array<const char*, 3> kNames{"bias opposes the lag", "bias adds to the lag", "both ways"};
  Plot plot{"tracking_predictive",
            "Norm RMSE at 40 mm/s, predicted from the columns 0 and 20",
            "norm RMSE (mm)",
            "share below",
            false,
            false,
            {}};
  for (std::size_t side = 0; side < kNames.size(); ++side) {
    const std::vector<double>& values = p.fits.prediction[side].norm_rmse;
    Series series{kNames[side], {}, {}, {}, {}, Mark::line};
    for (std::size_t i = values.size() / 200; i < values.size() - values.size() / 200; i += 20) {
      series.x.push_back(values[i] * kMmPerM);
      series.y.push_back(static_cast<double>(i) / static_cast<double>(values.size()));
    }
    plot.series.push_back(std::move(series));
  }
  const double value = p.paper[2][3].rmse * kMmPerM;
  plot.series.push_back({"paper", {value, value}, {0.0, 1.0}, {}, {}, Mark::line, true});
  plot.caption =
      "What columns 0 and 20 leave open about 40 mm/s, for each side of the lag on which the bias may be.";
  return plot;
}

}  // namespace

void add_tables(BenchResult& result, const Pictures& pictures) {
  result.tables = {table1_table(pictures.paper, pictures.twin, pictures.theory.table[0]), from_20(pictures),
                   hypotheses(pictures), directions(pictures)};
}

void add_plots(BenchResult& result, const Pictures& pictures) {
  const Predicted40& p = pictures.fits.prediction[0];
  for (const Statistic& statistic : kStatistics)
    result.plots.push_back(table1_plot(statistic, pictures.paper, pictures.twin, {p.median, p.low, p.high}));
  result.plots.push_back(move_plot(pictures));
  result.plots.push_back(posterior_plot(pictures));
  result.plots.push_back(predictive_plot(pictures));
}

}  // namespace enc::bench::tracking
