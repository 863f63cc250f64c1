#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/registration/registration.h"
#include "core/base/counted.h"
#include "core/base/units.h"

namespace enc::bench::registration {
namespace {

void add_point(Series& to, double x, const std::vector<double>& values) {
  to.x.push_back(x);
  to.y.push_back(median(values) * kMmPerM);
  // Of too few seeds for a band of 95 % the least and the most.
  const double out = models::has_percentile(values.size(), 0.975) ? 0.025 : 0.0;
  to.low.push_back(percentile(values, out) * kMmPerM);
  to.high.push_back(percentile(values, 1.0 - out) * kMmPerM);
}

Series bound(double paper, double from, double to) {
  Series series{"paper: less than", {from, to}, {paper, paper}};
  series.paper = true;
  return series;
}

Plot axes_plot(const std::vector<Accuracy>& all, double paper) {
  Plot plot{"registration_axes", "Registration: 8 pairs", "axis of W", "mean |error| (mm)", false, false, {}};
  struct Kind {
    const char* name;
    std::size_t frames;
    std::vector<Vec3> Accuracy::*what;
    double shift;  // so that they stand side by side
  };
  for (const Kind& kind : {Kind{"20 frames, left over at the pairs", 20, &Accuracy::residual, -0.15},
                           Kind{"20 frames, elsewhere", 20, &Accuracy::held_out, -0.05},
                           Kind{"one frame, left over", 1, &Accuracy::residual, 0.05},
                           Kind{"one frame, elsewhere", 1, &Accuracy::held_out, 0.15}}) {
    Series series{kind.name, {}, {}};
    series.mark = Mark::points;
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<double> axis;
      for (const Vec3& e : accuracy_of(all, 8, kind.frames).*kind.what)
        axis.push_back(e(static_cast<Eigen::Index>(a)));
      add_point(series, static_cast<double>(a) + kind.shift, axis);
    }
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back(bound(paper, -0.4, 2.4));
  plot.x_names = {"x", "y", "z"};
  plot.caption =
      "Median and 95 % band over seeds. With 20 frames averaged all axes are below the paper's bound, at the "
      "pairs and "
      "elsewhere; with single frames they are not, or hardly.";
  return plot;
}

// Of the registration all over the volume. With bands, lines stand a little aside of each other.
Plot frames_plot(const char* id, const char* title, const char* x_label, const std::vector<Accuracy>& all,
                 double paper, bool bands, const std::function<double(const Accuracy&)>& x) {
  Plot plot{id, title, x_label, "mean |error| elsewhere, worst axis (mm)", false, true, {}};
  double from = 1e300, to = 0.0, aside = bands ? -0.15 : 0.0;
  for (const std::size_t frames : {1UL, 5UL, 20UL, 100UL}) {
    Series series{counted(frames, "frame") + " of each", {}, {}};
    series.mark = Mark::both;
    for (const Accuracy& one : all) {
      if (one.frames != frames) continue;
      add_point(series, x(one) + aside, worst_axis(one.held_out));
      from = std::min(from, series.x.back());
      to = std::max(to, series.x.back());
    }
    if (bands)
      aside += 0.1;
    else
      series.low.clear(), series.high.clear();
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back(bound(paper, from, to));
  return plot;
}

Plot distance_plot(const std::vector<Accuracy>& all, const trial::RegistrationPlaces& places) {
  Plot plot{"registration_distance",
            "Registration: 8 pairs, over the volume in view",
            "distance from its middle (mm)",
            "rms length of the error (mm)",
            false,
            false,
            {}};
  constexpr std::size_t kBins = 8;
  for (const std::size_t frames : {1UL, 20UL, 100UL}) {
    const Accuracy& one = accuracy_of(all, 8, frames);
    Series series{counted(frames, "frame") + " of each", {}, {}};
    series.mark = Mark::both;
    for (std::size_t b = 0; b < kBins; ++b) {
      const std::size_t from = b * one.square.size() / kBins, to = (b + 1) * one.square.size() / kBins;
      if (from == to) continue;
      series.x.push_back(places.distance[(from + to) / 2] * kMmPerM);
      series.y.push_back(one.rms_at(from, to) * kMmPerM);
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Each point an eighth of the places. In the middle only the shift is wrong, outwards the turn adds to "
      "it.";
  return plot;
}

}  // namespace

void add_registration_plots(const std::vector<Accuracy>& all, const std::vector<RegistrationCost>& costs,
                            const trial::RegistrationPlaces& places, double paper, BenchResult& result) {
  result.plots.push_back(axes_plot(all, paper));
  Plot pairs =
      frames_plot("registration_pairs", "Registration: how many pairs, how many frames", "pairs", all, paper,
                  true, [](const Accuracy& one) { return static_cast<double>(one.pairs); });
  pairs.caption =
      "Median and 95 % band over seeds. Averaging helps until what stays while nothing moves is all that is "
      "left; then "
      "only more places do.";
  result.plots.push_back(std::move(pairs));
  result.plots.push_back(distance_plot(all, places));
  Plot time = frames_plot("registration_time", "Registration: error against time of the experiment",
                          "time of the experiment (s)", all, paper, false,
                          [](const Accuracy& one) { return one.seconds; });
  time.log_x = true;
  time.caption =
      "Points of a line: 4, 5, 6, 8, 12, 16, 20 pairs. Within the same time, 20 frames at many places beat "
      "100 at few.";
  result.plots.push_back(std::move(time));
  Plot cpu = frames_plot("registration_cpu", "Registration: error against run time", "CPU time (us)", all,
                         paper, false, [&](const Accuracy& one) {
                           for (const RegistrationCost& cost : costs)
                             if (cost.pairs == one.pairs && cost.frames == one.frames) return cost.cpu * 1e6;
                           return kUnset;
                         });
  cpu.caption = "Averaging the frames and one closed form: run time is never what limits it.";
  result.plots.push_back(std::move(cpu));
}

}  // namespace enc::bench::registration
