#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/synchrony/synchrony.h"
#include "core/base/units.h"

namespace enc::bench::synchrony {
namespace {

std::string mm(double metres) { return fmt::format("{:.4f}", metres * kMmPerM); }

double mean(const SyncGroup& group, SyncErrors SyncSummary::*against, double SyncErrors::*what) {
  return group.over([&](const SyncSummary& s) { return s.*against.*what; }).mean;
}

double mean_lag(const SyncGroup& group, double SyncSummary::*lag) {
  return group.over([&](const SyncSummary& s) { return s.*lag; }).mean;
}

Table pipelines(const SyncStudy& study) {
  Table table{"synchrony_pipelines",
              "What dents the seen surface",
              {"plant", "pipeline", "MAE to haptic (mm)", "RMSE to haptic (mm)", "bias (mm)", "lag (ms)",
               "MAE to truth (mm)", "RMSE to truth (mm)", "bias to truth (mm)", "lag behind truth (ms)"},
              {}};
  const auto row = [&](const char* plant, const SyncGroup& g) {
    table.rows.push_back({plant, g.name, mm(mean(g, &SyncSummary::haptic, &SyncErrors::mae)),
                          mm(mean(g, &SyncSummary::haptic, &SyncErrors::rmse)),
                          mm(mean(g, &SyncSummary::haptic, &SyncErrors::bias)),
                          fmt::format("{:.1f}", mean_lag(g, &SyncSummary::lag) * kMsPerS),
                          mm(mean(g, &SyncSummary::truth, &SyncErrors::mae)),
                          mm(mean(g, &SyncSummary::truth, &SyncErrors::rmse)),
                          mm(mean(g, &SyncSummary::truth, &SyncErrors::bias)),
                          fmt::format("{:.1f}", mean_lag(g, &SyncSummary::truth_lag) * kMsPerS)});
  };
  for (const SyncGroup* g : {&study.paper, &study.later, &study.predicted, &study.late_fused, &study.fused})
    row("as the rig is", *g);
  for (const SyncGroup* g : {&study.giving_paper, &study.giving_late_fused, &study.giving_blind,
                             &study.giving_fused, &study.giving_known})
    row("gives and tilts", *g);
  const double given = study.fused.over([](const SyncSummary& s) { return s.given; }).most;
  table.note = fmt::format(
      "In contact, each cycle; means over seeds. Gives and tilts: the contact gives 3 um/N, the tool bends "
      "10 um/N between tip and markers and tilts 5 deg to either side at 0.5 Hz, poses turn by 0.01 deg rms. "
      "Also where the rig says that nothing gives, the physics engine lets the two tips overlap by some 5.6 "
      "um/N, at most {:.0f} um; fused believes 6 um/N where nothing else is said.",
      given * 1e6);
  return table;
}

Table readings(const SyncStudy& study) {
  Table table{"synchrony_readings",
              "The paper's pipeline: which samples count",
              {"samples", "MAE (mm)", "RMSE (mm)", "bias (mm)"},
              {}};
  const auto row = [&](const char* what, SyncErrors SyncSummary::*errors) {
    table.rows.push_back({what, mm(mean(study.paper, errors, &SyncErrors::mae)),
                          mm(mean(study.paper, errors, &SyncErrors::rmse)),
                          mm(mean(study.paper, errors, &SyncErrors::bias))});
  };
  row("in contact, each haptic cycle (used)", &SyncSummary::haptic);
  row("in contact, new packets alone", &SyncSummary::packets);
  row("first to last contact, rests included", &SyncSummary::rests);
  table.rows.push_back({"paper", mm(study.paper_mae), mm(study.paper_rmse), ""});
  return table;
}

Table sweep(const SyncStudy& study) {
  Table table{"synchrony_sweep",
              "Press time and side of the bias: the two free choices",
              {"bias makes the tool seem", "press (s)", "peak speed (mm/s)", "MAE (mm)", "RMSE (mm)",
               "RMSE / MAE", "bias (mm)", "lag (ms)"},
              {}};
  for (std::size_t side = 0; side < kBiasSides.size(); ++side)
    for (const SyncGroup& g : study.presses[side]) {
      const double peak = g.over([](const SyncSummary& s) { return s.peak_speed; }).mean;
      const double mae = mean(g, &SyncSummary::haptic, &SyncErrors::mae);
      const double rmse = mean(g, &SyncSummary::haptic, &SyncErrors::rmse);
      table.rows.push_back({kBiasSides[side], fmt::format("{:g}", g.setup.scene.user->press_time),
                            fmt::format("{:.1f}", peak * kMmPerM), mm(mae), mm(rmse),
                            fmt::format("{:.2f}", rmse / mae),
                            mm(mean(g, &SyncSummary::haptic, &SyncErrors::bias)),
                            fmt::format("{:.1f}", mean_lag(g, &SyncSummary::lag) * kMsPerS)});
    }
  table.rows.push_back({"paper", "", "", mm(study.paper_mae), mm(study.paper_rmse),
                        fmt::format("{:.2f}", study.paper_rmse / study.paper_mae), "", ""});
  table.note =
      "Calibrated: the press time, 1.7 s. The bias is the tracker's of Table 1: fixed in the room, it "
      "opposes "
      "the lag upwards, as there, and adds to it on the way in: the tool seems shallower. The two other rows "
      "are what one would print if it were not so.";
  return table;
}

Table rates(const SyncStudy& study) {
  Table table{"synchrony_rates",
              "The paper's pipeline over the display's frame rate",
              {"rate (Hz)", "MAE (mm)", "RMSE (mm)", "lag (ms)"},
              {}};
  for (const SyncGroup& g : study.rates)
    table.rows.push_back({fmt::format("{:g}", g.setup.twin.display.rate),
                          mm(mean(g, &SyncSummary::haptic, &SyncErrors::mae)),
                          mm(mean(g, &SyncSummary::haptic, &SyncErrors::rmse)),
                          fmt::format("{:.1f}", mean_lag(g, &SyncSummary::lag) * kMsPerS)});
  return table;
}

Series line(const char* name, const std::vector<SyncSample>& samples, double SyncSample::*what, double from,
            double to, std::size_t every) {
  Series series{name, {}, {}};
  for (std::size_t i = 0; i < samples.size(); i += every) {
    const SyncSample& s = samples[i];
    if (s.t < from || s.t > to) continue;
    series.x.push_back(s.t);
    series.y.push_back(s.*what * kMmPerM);
  }
  return series;
}

// When each contact begins and ends, s.
struct Span {
  double from, to;
};
std::vector<Span> contacts_of(const std::vector<SyncSample>& samples) {
  std::vector<Span> all;
  bool before = false;
  for (const SyncSample& s : samples) {
    if (s.contact && !before) all.push_back({s.t, s.t});
    if (s.contact) all.back().to = s.t;
    before = s.contact;
  }
  return all;
}

Plot deflections(const char* id, const char* title, const SyncRun& run, double from, double to,
                 const char* caption) {
  const std::size_t every = to - from > 2.0 ? 4 : 1;
  return {id,
          title,
          "time (s)",
          "deflection (mm)",
          false,
          false,
          {line("haptic-tip", run.samples, &SyncSample::haptic, from, to, every),
           line("visual tip", run.samples, &SyncSample::visual, from, to, every)},
          caption};
}

void add_figure_13(const SyncStudy& study, BenchResult& result) {
  const SyncRun& run = study.paper.first;
  const std::vector<Span> spans = contacts_of(run.samples);
  if (spans.empty()) return;
  const Span first = spans.front();
  const double middle = 0.5 * (first.from + first.to);
  result.plots.push_back(deflections(
      "synchrony_fig13", "Fig 13: three presses, the paper's pipeline", run, first.from - 0.3,
      spans.back().to + 0.3,
      "The machine stops the presses at 6, 4 and 2 mm. The visual tip comes later and in steps, as frames "
      "do."));
  result.plots.push_back(deflections(
      "synchrony_fig13_held", "Zoom i: the first press, held", run, middle, middle + 0.4,
      "At the limit the haptic-tip stands; the visual tip shows the tracker's jitter, the hand's tremor and "
      "the registration's bias."));
  result.plots.push_back(deflections(
      "synchrony_fig13_release", "Zoom ii: its release", run, first.to - 0.45, first.to + 0.05,
      "On the way out the visual tip is deeper than the haptic-tip by speed times lag, less the bias."));
}

Plot errors(const SyncStudy& study) {
  Plot plot{"synchrony_error", "Error over time", "time (s)", "error (mm)", false, false, {}};
  const auto add = [&](const char* name, const SyncRun& run, double SyncSample::*judge) {
    Series series{name, {}, {}};
    for (std::size_t i = 0; i < run.samples.size(); i += 4) {
      const SyncSample& s = run.samples[i];
      series.x.push_back(s.t);
      series.y.push_back(s.contact ? (s.visual - s.*judge) * kMmPerM : kUnset);
    }
    plot.series.push_back(std::move(series));
  };
  add("tracked (the paper's), to haptic", study.paper.first, &SyncSample::haptic);
  add("fused, to the true tool that gives and tilts", study.giving_fused.first, &SyncSample::truth);
  plot.caption =
      "In contact. Tracked: below zero on the way in, above zero on the way out: the lag. Fused: the steps "
      "of "
      "the frames are left.";
  return plot;
}

Series paper_line(const char* name, double value, double from, double to) {
  return {name, {from, to}, {value * kMmPerM, value * kMmPerM}, {}, {}, Mark::line, true};
}

Plot press_plot(const SyncStudy& study) {
  Plot plot{"synchrony_press",
            "RMSE over the press time",
            "press and release time (s)",
            "RMSE (mm)",
            false,
            false,
            {}};
  constexpr std::array<const char*, 3> kNames{"bias: seems deeper", "bias: seems shallower (Table 1's sign)",
                                              "no bias"};
  for (std::size_t side = 0; side < kBiasSides.size(); ++side) {
    Series series{kNames[side], {}, {}, {}, {}, Mark::both};
    for (const SyncGroup& g : study.presses[side]) {
      const OverSeeds over = g.over([](const SyncSummary& s) { return s.haptic.rmse; });
      series.x.push_back(g.setup.scene.user->press_time);
      series.y.push_back(over.mean * kMmPerM);
      series.low.push_back(over.least * kMmPerM);
      series.high.push_back(over.most * kMmPerM);
    }
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back(paper_line("paper", study.paper_rmse, kPressTimes.front(), kPressTimes.back()));
  plot.caption =
      "The paper gives neither the press time nor the bias's side. Bars: least and most over seeds.";
  return plot;
}

Plot rate_plot(const SyncStudy& study) {
  Plot plot{"synchrony_rate", "Error over the frame rate", "frame rate (Hz)", "error (mm)", false, false, {}};
  const auto add = [&](const char* name, double SyncErrors::*what) {
    Series series{name, {}, {}, {}, {}, Mark::both};
    for (const SyncGroup& g : study.rates) {
      const OverSeeds over = g.over([&](const SyncSummary& s) { return s.haptic.*what; });
      series.x.push_back(g.setup.twin.display.rate);
      series.y.push_back(over.mean * kMmPerM);
      series.low.push_back(over.least * kMmPerM);
      series.high.push_back(over.most * kMmPerM);
    }
    plot.series.push_back(std::move(series));
  };
  add("RMSE", &SyncErrors::rmse);
  add("MAE", &SyncErrors::mae);
  plot.series.push_back(paper_line("paper, RMSE", study.paper_rmse, kRates.front(), kRates.back()));
  plot.series.push_back(paper_line("paper, MAE", study.paper_mae, kRates.front(), kRates.back()));
  plot.caption =
      "The tracked pipeline. A faster display takes half a frame of lag away; the tracker's lag stays.";
  return plot;
}

}  // namespace

void add_sync_tables(const SyncStudy& study, BenchResult& result) {
  for (Table table : {pipelines(study), readings(study), sweep(study), rates(study)})
    result.tables.push_back(std::move(table));
}

void add_sync_plots(const SyncStudy& study, BenchResult& result) {
  add_figure_13(study, result);
  result.plots.push_back(errors(study));
  result.plots.push_back(press_plot(study));
  result.plots.push_back(rate_plot(study));
}

}  // namespace enc::bench::synchrony
