#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/session/session.h"
#include "core/base/units.h"

namespace enc::bench::session {
namespace {

// Share of the presses with at most x, in percent, over all that touched.
template <class Of>
Series cumulative(const std::vector<SessionRun>& runs, const std::string& name, const Of& of) {
  Series series{name, {}, {}};
  for (const SessionRun& run : runs)
    for (const SessionPress& press : run.presses)
      if (const double x = of(press); !press.aborted && !std::isnan(x)) series.x.push_back(x);
  std::sort(series.x.begin(), series.x.end());
  series.y.reserve(series.x.size());
  for (std::size_t i = 0; i < series.x.size(); ++i)
    series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(series.x.size()));
  return series;
}

template <class Of>
Plot share_plot(const std::vector<SessionRun>& runs, const char* id, const char* title, const char* label,
                const char* caption, const Of& of) {
  Plot plot{id, title, label, "share of the presses (%)", false, false, {}};
  plot.caption = caption;
  const auto slower_than = [&](double low, double high) {
    return
        [=](const SessionPress& p) { return p.touch_speed >= low && p.touch_speed < high ? of(p) : kUnset; };
  };
  plot.series.push_back(cumulative(runs, "all", of));
  plot.series.push_back(cumulative(runs, "touch below 40 mm/s", slower_than(0.0, 0.040)));
  plot.series.push_back(cumulative(runs, "40 to 70 mm/s", slower_than(0.040, 0.070)));
  plot.series.push_back(cumulative(runs, "above 70 mm/s", slower_than(0.070, trial::kInfinite)));
  std::erase_if(plot.series, [](const Series& s) { return s.x.empty(); });
  return plot;
}

// Seen from above: the angle from straight up is the distance from the middle.
Plot places(const std::vector<SessionRun>& runs) {
  Plot plot{"session_places",
            "Where the ball is pressed",
            "towards +x (degrees from straight up)",
            "towards +y (degrees from straight up)",
            false,
            false,
            {}};
  plot.equal = true;
  plot.caption =
      "Each press of all hands, as the place nearest to the tool, seen from above; the distance from the "
      "middle "
      "is the angle from straight up. Places are even over what the machine can press within the scene's "
      "limit.";
  Series pressed{"pressed", {}, {}}, aborted{"turned back", {}, {}};
  pressed.mark = aborted.mark = Mark::points;
  for (const SessionRun& run : runs)
    for (const SessionPress& press : run.presses) {
      const double polar = std::acos(std::clamp(press.normal.z(), -1.0, 1.0)) / kDegree;
      const double turn = std::atan2(press.normal.y(), press.normal.x());
      Series& into = press.aborted ? aborted : pressed;
      into.x.push_back(polar * std::cos(turn));
      into.y.push_back(polar * std::sin(turn));
    }
  for (Series* series : {&pressed, &aborted})
    if (!series->x.empty()) plot.series.push_back(std::move(*series));
  return plot;
}

Plot timeline(const std::vector<SessionSample>& drawn) {
  Plot plot{"session_timeline", "One session", "time (s)", "deflection (mm)", false, false, {}};
  plot.caption =
      "True deflection under the haptic-tip, with what the core makes of it below: mode as a step at -3 "
      "(away), -2.5 "
      "(follow), -2 (contact), -1.5 (restore), -1 (hold); the overlay's tool at -4.5 (none), -4 (first), "
      "-3.5 "
      "(other). The deflection is that of the inset, 0.5 mm, while the tip follows.";
  Series deflection{"deflection (mm)", {}, {}}, mode{"mode", {}, {}}, tool{"overlay's tool", {}, {}};
  constexpr std::size_t kEvery = 20;  // ticks
  for (std::size_t i = 0; i < drawn.size(); i += kEvery) {
    const SessionSample& s = drawn[i];
    for (Series* series : {&deflection, &mode, &tool}) series->x.push_back(s.t);
    // On its way to another place the tip may be anywhere below the surface.
    deflection.y.push_back(std::max(-0.5, s.deflection * 1e3));
    mode.y.push_back(-3.0 + 0.5 * static_cast<double>(s.mode));
    tool.y.push_back(-4.0 + 0.5 * s.shown);
  }
  plot.series = {std::move(deflection), std::move(mode), std::move(tool)};
  return plot;
}

// The first reaches of the drawn session, and the first that turns back.
Plot reaches(const std::vector<SessionRun>& runs, const std::vector<SessionSample>& drawn) {
  Plot plot{"session_reaches",
            "Reaches",
            "time from the start of the reach (s)",
            "true speed of the tool (mm/s)",
            false,
            false,
            {}};
  plot.caption =
      "A reach is a fast primary submovement and, where that falls short of the surface, a slower one that "
      "overlaps it. A reach that turns back goes and comes at like speed.";
  std::size_t pressed = 0, aborted = 0;
  for (std::size_t k = 0; k < runs.front().presses.size(); ++k) {
    const SessionPress& press = runs.front().presses[k];
    std::size_t& count = press.aborted ? aborted : pressed;
    if (count == (press.aborted ? 1U : 3U)) continue;
    ++count;
    Series series{press.aborted ? std::string("turns back") : fmt::format("press {}", k + 1), {}, {}};
    double begin = kUnset;
    for (const SessionSample& s : drawn) {
      if (s.press != static_cast<std::int32_t>(k) || s.phase == sim::Phase::change) continue;
      if (s.phase == sim::Phase::wait && std::isnan(begin)) continue;
      if (std::isnan(begin)) begin = s.t;
      constexpr double kShown = 1.2;  // s
      if (s.t - begin > kShown) break;
      series.x.push_back(s.t - begin);
      series.y.push_back(s.speed * 1e3);
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

Table press_table(const std::vector<SessionRun>& runs) {
  Table table{"session_presses",
              "Every press",
              {"hand", "press", "tool", "turned back", "polar_deg", "azimuth_deg", "touch_mm_s", "miss_mm",
               "delay_ms", "impact_N", "peak_N", "contacts", "bounces"},
              {}};
  const auto number = [](double x, int digits) {
    return std::isnan(x) ? std::string() : fmt::format("{:.{}f}", x, digits);
  };
  for (std::size_t hand = 0; hand < runs.size(); ++hand)
    for (std::size_t i = 0; i < runs[hand].presses.size(); ++i) {
      const SessionPress& p = runs[hand].presses[i];
      table.rows.push_back(
          {fmt::format("{}", hand + 1), fmt::format("{}", i + 1), fmt::format("{}", p.tool),
           p.aborted ? "yes" : "no", number(std::acos(std::clamp(p.normal.z(), -1.0, 1.0)) / kDegree, 1),
           number(std::atan2(p.normal.y(), p.normal.x()) / kDegree, 1), number(p.touch_speed * 1e3, 1),
           number(p.miss * 1e3, 3), number(p.delay * 1e3, 0), number(p.impact, 3), number(p.peak_force, 2),
           fmt::format("{}", p.contacts), fmt::format("{}", p.bounces)});
    }
  return table;
}

}  // namespace

void add_session_plots(const std::vector<SessionRun>& runs, const std::vector<SessionSample>& drawn,
                       BenchResult& result) {
  result.plots.push_back(share_plot(
      runs, "session_miss", "Miss at the first touch", "miss (mm)",
      "Share of the presses with at most this miss: tool tip to haptic-tip where the tool meets the surface. "
      "The inset of the waiting tip is in it. The faster the touch, the larger the miss.",
      [](const SessionPress& p) { return p.miss * 1e3; }));
  result.plots.push_back(share_plot(runs, "session_impact", "Impact", "impact (N)",
                                    "Share of the presses with at most this impact: the largest force in the "
                                    "first 100 ms beyond what the ball "
                                    "gives at the same true deflection.",
                                    [](const SessionPress& p) { return p.impact; }));
  result.plots.push_back(places(runs));
  result.plots.push_back(timeline(drawn));
  result.plots.push_back(reaches(runs, drawn));
  result.tables.push_back(press_table(runs));
}

}  // namespace enc::bench::session
