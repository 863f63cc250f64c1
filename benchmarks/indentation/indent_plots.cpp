// The pictures of Figs 8 and 10 and of Table 2.
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"

namespace enc::bench::indentation {
namespace {

double centre_of(std::size_t bin) { return (static_cast<double>(bin) + 0.5) * kBin; }

Series line_of(const Branch& loop, const std::string& name, double from, double to, bool press_only,
               bool release_only) {
  Series s{name, {}, {}};
  const auto top = static_cast<std::size_t>(std::max_element(loop.deflection.begin(), loop.deflection.end()) -
                                            loop.deflection.begin());
  const std::size_t each = to - from > 2e-3 ? 20 : 5;
  for (std::size_t i = 0; i < loop.size(); i += each) {
    if ((press_only && i > top) || (release_only && i <= top)) continue;
    if (loop.deflection[i] < from || loop.deflection[i] > to) continue;
    s.x.push_back(loop.deflection[i] * 1e3);
    s.y.push_back(loop.force[i]);
  }
  return s;
}

// The two polynomials between two deflections.
void add_curves(const Response& reference, double from, double to, bool press, bool release, Plot& plot) {
  constexpr int kSteps = 60;
  for (const bool way : {true, false}) {
    if (!(way ? press : release)) continue;
    Series s{way ? "reference, press" : "reference, release", {}, {}};
    for (int i = 0; i <= kSteps; ++i) {
      const double d = from + (to - from) * i / kSteps;
      s.x.push_back(d * 1e3);
      s.y.push_back(way ? reference.press(d) : reference.release(d));
    }
    plot.series.push_back(std::move(s));
  }
}

}  // namespace

std::vector<double> binned(const Branch& branch, double limit, const Response* minus, bool press) {
  const auto bins = static_cast<std::size_t>(std::lround(limit / kBin));
  std::vector<double> sum(bins, 0.0), count(bins, 0.0);
  for (std::size_t i = 0; i < branch.size(); ++i) {
    const double d = branch.deflection[i];
    const auto bin = static_cast<std::size_t>(std::max(0.0, d / kBin));
    if (bin >= bins) continue;
    const double curve = minus == nullptr ? 0.0 : press ? minus->press(d) : minus->release(d);
    sum[bin] += branch.force[i] - curve;
    count[bin] += 1.0;
  }
  for (std::size_t i = 0; i < bins; ++i) sum[i] = count[i] > 0.0 ? sum[i] / count[i] : kUnset;
  return sum;
}

void add_loops(const IndentRuns& runs, BenchResult& result) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const char* name = indentations()[i].name;
    Plot plot{fmt::format("indentation_fig8_{}", name),
              fmt::format("Indentation {} (VHMR Fig 8)", name),
              "deflection (mm)",
              "force (N)",
              false,
              false,
              {}};
    for (std::size_t r = 0; r < std::min<std::size_t>(5, runs[i].size()); ++r)
      plot.series.push_back(
          line_of(runs[i][r].loop, fmt::format("hand, run {}", r + 1), 0.0, 1.0, false, false));
    add_curves(runs[i].front().reference, 0.0, runs[i].front().limit, true, true, plot);
    plot.caption =
        "Force and deflection as the device records them, over the two polynomials of the rig's loop. The "
        "vertical "
        "part at 6 mm is the limit: the force there is the hand's.";
    result.plots.push_back(std::move(plot));
  }
  Plot residual{"indentation_residual",
                "What is left of Fig 8: recorded force less the reference curve",
                "deflection (mm)",
                "force error (N)",
                false,
                false,
                {}};
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const bool press : {true, false}) {
      Series s{fmt::format("{}, {}", indentations()[i].name, press ? "press" : "release"), {}, {}};
      const std::size_t count = std::min<std::size_t>(5, runs[i].size());
      std::vector<double> sum;
      for (std::size_t r = 0; r < count; ++r) {
        const IndentRun& run = runs[i][r];
        const std::vector<double> one =
            binned(press ? run.recorded.press : run.recorded.release, run.limit, &run.reference, press);
        sum.resize(one.size(), 0.0);
        for (std::size_t b = 0; b < one.size(); ++b) sum[b] += one[b] / static_cast<double>(count);
      }
      for (std::size_t b = 0; b < sum.size(); ++b) {
        s.x.push_back(centre_of(b) * 1e3);
        s.y.push_back(sum[b]);
      }
      residual.series.push_back(std::move(s));
    }
  residual.caption =
      "Mean of the runs. Pressing, the force is high by threshold and lag; releasing, the wave is where the "
      "Prandtl-Ishlinskii law and the constrained polynomial of the rig differ.";
  result.plots.push_back(std::move(residual));
}

void add_fig10(const std::vector<IndentRun>& a, BenchResult& result) {
  struct Zoom {
    const char *suffix, *title;
    double from, to;
    bool press, release;
  };
  for (const Zoom& z : {Zoom{"", "Five presses, indentation A (VHMR Fig 10)", 0.0, 6.1e-3, true, true},
                        Zoom{"_i", "Fig 10, i: the rise at contact", 0.0, 0.8e-3, true, false},
                        Zoom{"_ii", "Fig 10, ii: in the middle of the press", 2.6e-3, 3.4e-3, true, false},
                        Zoom{"_iii", "Fig 10, iii: at the top", 5.2e-3, 6.02e-3, true, true},
                        Zoom{"_iv", "Fig 10, iv: releasing", 2.6e-3, 3.4e-3, false, true}}) {
    Plot plot{fmt::format("indentation_fig10{}", z.suffix),
              z.title,
              "deflection (mm)",
              "force (N)",
              false,
              false,
              {}};
    for (std::size_t r = 0; r < std::min<std::size_t>(5, a.size()); ++r)
      plot.series.push_back(
          line_of(a[r].loop, fmt::format("run {}", r + 1), z.from, z.to, !z.release, !z.press));
    plot.caption =
        "A hand that differs in press time, depth, place and approach from run to run; the paper's five lie "
        "within 0.2 N of each other. Contact begins with the tip 0.5 mm inside, where it waits for the tool; "
        "it "
        "comes up to meet it.";
    result.plots.push_back(std::move(plot));
  }
}

void add_table2_plot(const IndentStudy& study, const std::vector<Cell>& standard,
                     const std::vector<Cell>& accurate, BenchResult& result) {
  Plot plot{"indentation_table2", "Error of the felt force (VHMR Table 2)", "", "RMSE (N)", false, false, {}};
  Series paper{"paper", {}, {}, {}, {}, Mark::points, true};
  Series twin{"twin", {}, {}, {}, {}, Mark::points},
      better{"twin, set for accuracy", {}, {}, {}, {}, Mark::points};
  for (std::size_t i = 0; i < kCells; ++i) {
    const auto x = static_cast<double>(i);
    plot.x_names.push_back(fmt::format("{} {}{}", study.paper[i].indentation, study.paper[i].way,
                                       study.paper[i].consistent ? "" : " (!)"));
    paper.x.push_back(x - 0.15);
    paper.y.push_back(study.paper[i].rmse);
    for (const auto& [series, cell, at] :
         {std::tuple{&twin, &standard[i], x}, std::tuple{&better, &accurate[i], x + 0.15}}) {
      series->x.push_back(at);
      series->y.push_back(cell->rmse);
      series->low.push_back(cell->least);
      series->high.push_back(cell->most);
    }
  }
  plot.series = {std::move(paper), std::move(twin), std::move(better)};
  plot.caption =
      "Bars reach over the runs. (!): the paper's value is below its own MAE there and cannot be right.";
  result.plots.push_back(std::move(plot));
}

}  // namespace enc::bench::indentation
