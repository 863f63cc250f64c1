// The report page of a sweep: one HTML file without scripts, with pictures in it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/plot/chart.h"
#include "app/sweep/results.h"
#include "core/base/words.h"
#include "models/order_statistics.h"
#include "trial/sweep/statistics.h"

namespace enc::app {
namespace {

using trial::Effect;
using trial::Summary;

constexpr std::size_t kMostDots = 1500, kMostCharts = 80;
constexpr double kWidth = 380.0, kHeight = 280.0;  // px, of one picture
constexpr const char* kDots = "#0072B2";
constexpr const char* kMeans = "#D55E00";

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : std::string("-"); }

std::string row(const char* cell, const std::vector<std::string>& cells) {
  std::string text = "<tr>";
  for (const std::string& one : cells) text += fmt::format("<{0}>{1}</{0}>", cell, svg_text(one));
  return text + "</tr>\n";
}

std::string figure_rows(const SweepTable& table) {
  std::string text =
      row("th", {"figure", "n", "mean", "95 % interval", "SD", "least", "5 %", "median", "95 %", "most"});
  for (std::size_t i = 0; i < table.figures.size(); ++i) {
    const Summary s = trial::summary_of(table.figures[i]);
    const std::string interval =
        std::isnan(s.half) ? "-" : fmt::format("{:.4g} to {:.4g}", s.mean - s.half, s.mean + s.half);
    text += row("td", {table.spec.keep[i], std::to_string(s.n), number(s.mean), interval, number(s.sd),
                       number(s.least), number(s.p5), number(s.median), number(s.p95), number(s.most)});
  }
  return "<table>\n" + text + "</table>\n";
}

std::string share_rows(const SweepTable& table, const std::vector<std::vector<Effect>>& effects) {
  std::vector<std::string> head{"figure"};
  for (const trial::Axis& axis : table.spec.axes) head.push_back(axis.name);
  std::string text = row("th", head);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    std::vector<std::string> cells{table.spec.keep[i]};
    for (const Effect& effect : effects[i])
      cells.push_back(std::isnan(effect.share) ? "-" : fmt::format("{:.1f} %", 100.0 * effect.share));
    text += row("td", cells);
  }
  return "<table>\n" + text + "</table>\n";
}

// A picture with room for its labels.
class Picture {
 public:
  Picture(Range x, Range y, const std::string& x_label, const std::string& y_label) {
    constexpr double kLeft = 64.0, kTop = 14.0, kRight = 14.0, kBottom = 50.0;  // px
    static int pictures = 0;
    chart_.left = kLeft;
    chart_.top = kTop;
    chart_.width = kWidth - kLeft - kRight;
    chart_.height = kHeight - kTop - kBottom;
    chart_.x = rounded(x);
    chart_.y = rounded(y);
    chart_.x_label = x_label;
    chart_.y_label = y_label;
    text_ = axes(chart_, fmt::format("clip{}", ++pictures));
  }
  void dot(double x, double y) {
    text_ += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='1.6' fill='{}55'/>\n", chart_.px(x),
                         chart_.py(y), kDots);
  }
  void column(double from, double to, double height) {
    const double top = chart_.py(height), left = chart_.px(from);
    text_ += bar(left, top, std::max(1.0, chart_.px(to) - left - 1.0), chart_.py(0.0) - top, kDots);
  }
  void mean(double x, const Summary& s) {
    const double at = chart_.px(x);
    text_ +=
        fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4' fill='{}'/>\n", at, chart_.py(s.mean), kMeans);
    if (std::isnan(s.half)) return;
    text_ += fmt::format("<path d='M{:.1f} {:.1f}V{:.1f}' stroke='{}' stroke-width='2'/>\n", at,
                         chart_.py(s.mean - s.half), chart_.py(s.mean + s.half), kMeans);
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("<svg viewBox='0 0 {0} {1}' width='{0}' height='{1}'>\n{2}</svg>\n", kWidth, kHeight,
                       text_);
  }

 private:
  Chart chart_;
  std::string text_;
};

// How often each part of a figure's range occurs.
std::string marginal(const std::string& name, const std::vector<double>& values) {
  Range x;
  for (const double value : values) x.see(value);
  x = rounded(x);
  constexpr std::size_t kColumns = 20;
  std::vector<double> counts(kColumns);
  const double width = (x.most - x.least) / static_cast<double>(kColumns);
  for (const double value : values)
    if (std::isfinite(value))
      counts[std::min(kColumns - 1, static_cast<std::size_t>((value - x.least) / width))] += 1.0;
  Range y;
  y.see(0.0);
  for (const double count : counts) y.see(count);
  Picture picture(x, y, name, "runs");
  for (std::size_t i = 0; i < kColumns; ++i)
    if (counts[i] > 0.0)
      picture.column(x.least + static_cast<double>(i) * width, x.least + static_cast<double>(i + 1) * width,
                     counts[i]);
  return picture.text();
}

// Values of a parameter that are words stand at 0, 1, 2, ... in the order of their levels.
double place_of(const std::string& value, const Effect& effect) {
  const double x = trial::number_of(value);
  if (!std::isnan(x)) return x;
  const auto at = std::find_if(effect.levels.begin(), effect.levels.end(),
                               [&](const auto& level) { return level.name == value; });
  return static_cast<double>(at - effect.levels.begin());
}

// The parameter's values, with room at both ends: no dot hides behind an axis.
Range range_of(const std::vector<std::string>& parameter, const Effect& effect) {
  Range x;
  for (const std::string& value : parameter) x.see(place_of(value, effect));
  const double room = 0.05 * (x.most - x.least);
  x.see(x.least - room);
  x.see(x.most + room);
  return x;
}

// The figure's values, and the intervals of its means.
Range range_of(const std::vector<double>& values, const Effect& effect) {
  Range y;
  for (const double value : values) y.see(value);
  for (const trial::EffectLevel& level : effect.levels) {
    y.see(level.summary.mean - level.summary.half);
    y.see(level.summary.mean + level.summary.half);
  }
  return y;
}

std::string effect_picture(const SweepTable& table, std::size_t axis, std::size_t figure,
                           const Effect& effect) {
  const std::vector<std::string>& parameter = table.parameters[axis];
  const std::vector<double>& values = table.figures[figure];
  const std::size_t step = 1 + (values.size() - 1) / kMostDots;
  std::string label = table.spec.axes[axis].name;
  for (std::size_t i = 0; i < effect.levels.size(); ++i)
    if (std::isnan(effect.levels[i].x))
      label += fmt::format("{}{} = {}", i == 0 ? ": " : ", ", i, effect.levels[i].name);
  Picture picture(range_of(parameter, effect), range_of(values, effect), label, table.spec.keep[figure]);
  for (std::size_t i = 0; i < values.size(); i += step)
    if (std::isfinite(values[i])) picture.dot(place_of(parameter[i], effect), values[i]);
  for (std::size_t i = 0; i < effect.levels.size(); ++i) {
    const auto& level = effect.levels[i];
    if (level.summary.n > 0)
      picture.mean(std::isnan(level.x) ? static_cast<double>(i) : level.x, level.summary);
  }
  return picture.text();
}

std::string pictures(const SweepTable& table, const std::vector<std::vector<Effect>>& effects) {
  std::string text;
  std::size_t charts = 0;
  for (std::size_t figure = 0; figure < effects.size(); ++figure) {
    text += fmt::format("<h2>{}</h2>\n", svg_text(table.spec.keep[figure]));
    if (trial::summary_of(table.figures[figure]).n == 0) {
      text += "<p>No run has this figure.</p>\n";
      continue;
    }
    text += marginal(table.spec.keep[figure], table.figures[figure]);
    for (std::size_t axis = 0; axis < effects[figure].size(); ++axis)
      if (++charts <= kMostCharts) text += effect_picture(table, axis, figure, effects[figure][axis]);
  }
  if (charts > kMostCharts)
    text += fmt::format("<p>{} more pictures are left out; results.csv has the numbers.</p>\n",
                        charts - kMostCharts);
  return text;
}

std::string failure_list(const SweepTable& table) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, table.errors.size()); ++i)
    text += "<li>" + svg_text(table.errors[i]) + "</li>\n";
  if (table.errors.size() > kMost) text += fmt::format("<li>and {} more</li>\n", table.errors.size() - kMost);
  return text.empty() ? text : "<h2>Failed runs</h2>\n<ul>\n" + text + "</ul>\n";
}

// Takes out the parameters with one value, which have no effect, and says them in a sentence.
std::string take_constant(trial::SweepSpec& spec, std::vector<std::vector<std::string>>& parameters) {
  std::string text;
  for (std::size_t i = parameters.size(); i-- > 0;) {
    const std::vector<std::string>& values = parameters[i];
    if (values.empty() || std::count(values.begin(), values.end(), values[0]) != std::ssize(values)) continue;
    text = fmt::format("{} = {}{}{}", spec.axes[i].name, values[0], text.empty() ? "" : ", ", text);
    spec.axes.erase(spec.axes.begin() + static_cast<std::ptrdiff_t>(i));
    parameters.erase(parameters.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return text.empty() ? text : "<p>In every run: " + svg_text(text) + ".</p>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:#222}"
    "table{border-collapse:collapse}td,th{padding:.2em .7em;border-bottom:1px solid #ddd;text-align:right}"
    "td:first-child,th:first-child{text-align:left}svg{font:12px sans-serif;max-width:100%}";

}  // namespace

std::string sweep_page(const SweepTable& whole) {
  trial::SweepSpec spec = whole.spec;
  SweepTable table{spec,        whole.program, whole.parameters, whole.figures,
                   whole.exits, whole.errors,  whole.cpu};
  const std::string constant = take_constant(spec, table.parameters);
  std::vector<std::vector<Effect>> effects(table.figures.size());
  for (std::size_t i = 0; i < effects.size(); ++i)
    for (const std::vector<std::string>& parameter : table.parameters)
      effects[i].push_back(trial::effect_of(parameter, table.figures[i]));
  double cpu = 0.0;
  for (const double s : table.cpu) cpu += s;
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>Sweep of {0}</title>"
      "<style>{1}</style></head><body>\n<h1>Sweep of {0}</h1>\n"
      "<p>{2}: {3} design, {4}, {5} each. {6} failed, {7} crossed limits. {8:.1f} s of CPU time, {9:.3f} s a "
      "run (median). Made by {10}.</p>\n",
      svg_text(table.spec.scene), kStyle, counted(table.exits.size(), "run"), word_of(table.spec.design),
      counted(table.spec.points, "point"), counted(table.spec.seeds, "seed"), table.failures(),
      table.crossed(), cpu, models::median(table.cpu), svg_text(table.program));
  text +=
      constant + "<h2>Figures</h2>\n" + figure_rows(table) +
      "<p>Interval: of the mean over all runs (Student's t). A percentile needs enough runs: the median 10, "
      "5 % and 95 % 20.</p>\n";
  if (!table.spec.axes.empty())
    text += "<h2>Main effects</h2>\n" + share_rows(table, effects) +
            "<p>Share of a figure's variance between the values of a parameter, each alone (eta squared). "
            "In the pictures below: dots are runs, orange points are means at a value (of a range: at an "
            "eighth of the runs) with their 95 % intervals.</p>\n";
  return text + failure_list(table) + pictures(table, effects) + "</body></html>\n";
}

}  // namespace enc::app
