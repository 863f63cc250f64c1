#include "benchmarks/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "benchmarks/kit/child.h"

namespace enc::bench {
namespace {

// The child process that draws.

std::string first_complaint(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find('\n', i), text.size());
    const std::string line = text.substr(i, end - i);
    if (line.find_first_not_of(" \t^") != std::string::npos && line.find("gnuplot>") == std::string::npos)
      return line;
    i = end + 1;
  }
  return "it said nothing";
}

// Colours that colour-blind readers can distinguish [Okabe and Ito 2008]; the paper is black.
constexpr std::array kColours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A5195"};
constexpr std::array kFields{"#BFE0EE", "#F2DC8C", "#CC6677", "#DDDDDD"};  // map fields, under lines
constexpr std::array kPoints{7, 5, 9, 13, 11, 15, 3};  // gnuplot's numbers of filled shapes
constexpr double kTop = 0.975;                         // place of failures, as a share of the axis

// Single quotes protect everything in gnuplot but the quote itself and the end of the line.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + "'";
}

double at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() && std::isfinite(values[i]) ? values[i] : kUnset;
}
std::string gnuplot_word(double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : "NaN"; }

struct Limits {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  double least_positive = least;
  void see(double value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
    if (value > 0.0) least_positive = std::min(least_positive, value);
  }
  // Reports whether an axis of this kind has a value to show.
  [[nodiscard]] bool any(bool log) const { return log ? std::isfinite(least_positive) : least <= most; }
};
Limits limits_of(const Plot& plot, bool of_y) {
  Limits limits;
  for (const Series& s : plot.series) {
    for (const double value : of_y ? s.y : s.x) limits.see(value);
    for (std::size_t i = 0; of_y && i < s.low.size(); ++i) limits.see(s.low[i]);
    for (std::size_t i = 0; of_y && i < s.high.size(); ++i) limits.see(s.high[i]);
  }
  return limits;
}

bool with_bars(const Series& s) { return !s.low.empty() && !s.high.empty(); }
bool any_finite(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double y) { return std::isfinite(y); });
}

// Width of one bar, and distance between the bars of one x: both in the unit of x.
struct Bars {
  double width = 0.8;
  int count = 0;
  explicit Bars(const Plot& plot) {
    std::vector<double> xs;
    for (const Series& s : plot.series) {
      if (s.mark != Mark::bars) continue;
      ++count;
      for (const double x : s.x)
        if (std::isfinite(x)) xs.push_back(x);
    }
    std::sort(xs.begin(), xs.end());
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < xs.size(); ++i)
      if (xs[i] > xs[i - 1]) gap = std::min(gap, xs[i] - xs[i - 1]);
    width = 0.8 * (std::isfinite(gap) ? gap : 1.0) / std::max(1, count);
  }
  [[nodiscard]] double offset(int bar) const { return (bar - 0.5 * (count - 1)) * width; }
};

// The data of a series. A logarithmic axis has no place for a value that is not positive: it becomes a gap;
// the lower end of an error bar becomes the edge of the picture.
std::string data_block(const Series& s, const Plot& plot, std::size_t index, double shift, double floor) {
  std::string text = fmt::format("$d{} << EOD\n", index);
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    double x = at(s.x, i);
    double y = at(s.y, i);
    double low = at(s.low, i);
    const double high = at(s.high, i);
    if (plot.log_x && x <= 0.0) x = kUnset;
    if (plot.log_y && y <= 0.0) y = kUnset;
    if (plot.log_y && low <= 0.0) low = floor;
    text += fmt::format("{} {} {} {}\n", gnuplot_word(x + shift), gnuplot_word(y), gnuplot_word(low),
                        gnuplot_word(high));
  }
  return text + "EOD\n";
}

// Edges of the fields of a map: half-way to the next existing field.
class Grid {
 public:
  Grid(const Plot& plot, bool of_y) : log_(of_y ? plot.log_y : plot.log_x) {
    for (const Series& s : plot.series)
      if (s.mark == Mark::cells)
        for (const double value : of_y ? s.y : s.x) places_.push_back(placed(value));
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  }
  [[nodiscard]] std::pair<double, double> around(double value) const {
    const double at = placed(value);
    const auto here = std::lower_bound(places_.begin(), places_.end(), at);
    const double up = std::next(here) != places_.end() ? *std::next(here) - at : kUnset;
    const double down = here != places_.begin() ? at - *std::prev(here) : kUnset;
    const double above = std::isnan(up) ? down : up, below = std::isnan(down) ? up : down;
    const auto edge = [&](double to) { return log_ ? std::exp(to) : to; };
    return {edge(at - 0.5 * (std::isnan(below) ? 1.0 : below)),
            edge(at + 0.5 * (std::isnan(above) ? 1.0 : above))};
  }

 private:
  [[nodiscard]] double placed(double value) const { return log_ ? std::log(value) : value; }
  bool log_;
  std::vector<double> places_;
};

std::string field_block(const Series& s, const Grid& across, const Grid& up, std::size_t index) {
  std::string text = fmt::format("$d{} << EOD\n", index);
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const auto [left, right] = across.around(s.x[i]);
    const auto [low, high] = up.around(s.y[i]);
    text +=
        fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", s.x[i], s.y[i], left, right, low, high);
  }
  return text + "EOD\n";
}

// The parts of gnuplot's one `plot` command.
class Parts {
 public:
  // `steady`: a series without data still takes its colour.
  explicit Parts(bool steady = false) : steady_(steady) {}
  void add(const Series& s, std::size_t index) {
    if (s.mark == Mark::cells) {
      field(s, index);
      return;
    }
    if (s.x.empty() && !steady_) return;
    if (s.mark != Mark::crosses) look_ = s.paper ? paper() : ours();
    if (s.x.empty()) return;
    const std::string data = fmt::format("$d{} using ", index);
    std::string title = " title " + quoted(s.name);
    const auto part = [&](const std::string& how) {
      if (!text_.empty()) text_ += ", \\\n  ";
      text_ += data + how + title;
      title = " notitle";  // one entry of the legend for each series
    };
    if (s.mark == Mark::crosses)
      part(crosses(s));
    else if (s.mark == Mark::bars)
      part(fmt::format("1:2 with boxes lc rgb '{}' {}", look_.colour,
                       s.paper ? "lw 1.6 fs empty border" : "fs solid 0.75 noborder"));
    else if (s.mark == Mark::band)
      part(
          fmt::format("1:3:4 with filledcurves fc rgb '{}' fs transparent solid 0.2 noborder", look_.colour));
    const bool curve = s.mark != Mark::bars && s.mark != Mark::crosses && any_finite(s.y);
    if (curve && s.mark == Mark::points)
      part(fmt::format("1:2 with points lc rgb '{}' pt {} ps {} lw 1.5", look_.colour, look_.point,
                       look_.size));
    if (curve && s.mark == Mark::both)
      part(fmt::format("1:2 with linespoints lc rgb '{}' lw {} dt {} pt {} ps {}", look_.colour, look_.width,
                       look_.dash, look_.point, look_.size));
    if (curve && (s.mark == Mark::line || s.mark == Mark::band))
      part(fmt::format("1:2 with lines lc rgb '{}' lw {} dt {}", look_.colour, look_.width, look_.dash));
    // Arrows with blunt heads, because gnuplot's error bars erase the lines under their points.
    if (with_bars(s) && s.mark != Mark::band && s.mark != Mark::crosses)
      part(fmt::format("1:3:(0):($4-$3) with vectors heads size graph 0.007,90 lc rgb '{}' lw 1.4",
                       s.mark == Mark::bars ? "#222222" : look_.colour));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void field(const Series& s, std::size_t index) {
    const char* colour = kFields[fields_++ % kFields.size()];
    if (s.x.empty()) return;
    text_ += fmt::format("{}$d{} using 1:2:3:4:5:6 with boxxyerror fc rgb '{}' fs solid 1 noborder title {}",
                         text_.empty() ? "" : ", \\\n  ", index, colour, quoted(s.name));
  }
  struct Look {
    std::string colour = "#000000", dash = "solid";
    int point = 6;
    double width = 2.0, size = 0.7;
  };
  static Look paper() { return {"#000000", "(8,5)", 6, 1.6, 1.0}; }
  Look ours() {
    const std::size_t i = next_++;
    // After three lines the dash also distinguishes the series.
    return {kColours[i % kColours.size()],
            i < 3        ? "solid"
            : i % 2 == 1 ? "(12,4)"
                         : "(12,4,3,4)",
            kPoints[i % kPoints.size()], 2.0, 0.7};
  }
  // Failures take the colour of the series before them, which they belong to.
  [[nodiscard]] std::string crosses(const Series& s) const {
    return fmt::format("1:{} with points lc rgb '{}' pt 2 ps 0.9 lw 2.2",
                       any_finite(s.y) ? "2" : fmt::format("({}) axes x1y2", kTop), look_.colour);
  }

  std::string text_;
  Look look_;
  std::size_t next_ = 0, fields_ = 0;
  bool steady_;
};

// Round numbers on an axis with few powers of ten: 1, 2, 5, 10, ...
std::string log_tics(const char* axis, double low, double high) {
  const bool plain = low >= 1e-5 && high <= 1e6;
  std::string text = fmt::format("set logscale {0}\nset format {0} {1}\n", axis, plain ? "'%g'" : "'1e%T'");
  if (std::log10(high / low) > 2.0) return text;
  std::string tics;
  for (int exponent = static_cast<int>(std::floor(std::log10(low))); exponent <= std::log10(high); ++exponent)
    for (const double tic :
         {std::pow(10.0, exponent), 2.0 * std::pow(10.0, exponent), 5.0 * std::pow(10.0, exponent)})
      if (tic >= low && tic <= high) tics += fmt::format("{}{:.9g}", tics.empty() ? "" : ", ", tic);
  return text + fmt::format("set format {} '%g'\nset {}tics ({})\n", axis, axis, tics);
}

// A range a little wider than the data. `above` is a share of the axis that stays free at the upper end; a
// logarithmic axis spans at least `ratio`.
std::string axis_range(const char* axis, const Limits& limits, bool log, double above, double ratio) {
  if (!limits.any(log)) return fmt::format("set {}range [{}]\n", axis, log ? "0.1:1" : "0:1");
  double low = log ? std::log(limits.least_positive) : limits.least;
  double high = log ? std::log(limits.most) : limits.most;
  if (const double more = 0.5 * (std::log(ratio) - (high - low)); log && more > 0.0) {
    low -= more;
    high += more;
  }
  const double span = high > low ? high - low : log ? 1.0 : std::max(std::abs(high), 1e-9);
  const bool from_zero = !log && low >= 0.0 && low < 0.1 * span;
  low = from_zero ? 0.0 : low - 0.04 * span;
  high += (0.04 + above) * span;
  if (!log) return fmt::format("set {}range [{:.9g}:{:.9g}]\n", axis, low, high);
  return fmt::format("set {}range [{:.9g}:{:.9g}]\n", axis, std::exp(low), std::exp(high)) +
         log_tics(axis, std::exp(low), std::exp(high));
}

// Bands come first: they cover the series behind them.
std::vector<std::size_t> drawing_order(const Plot& plot) {
  std::vector<std::size_t> order(plot.series.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
    return plot.series[i].mark == Mark::band || plot.series[i].mark == Mark::cells;
  });
  return order;
}

// Reports whether the names under the axis lack room side by side.
bool crowded(const Plot& plot) {
  std::size_t letters = 0;
  for (const std::string& name : plot.x_names) letters += name.size() + 2;
  constexpr std::size_t kRoom = 60;
  return letters > kRoom;
}

// px, without the legend.
std::size_t height_of(const Plot& plot) {
  if (plot.equal) return 520;
  constexpr std::size_t kUsual = 360;
  return std::max(kUsual, 110 + 24 * plot.y_names.size());
}

std::string axes(const Plot& plot, const Bars& bars) {
  Limits x = limits_of(plot, false);
  Limits y = limits_of(plot, true);
  const bool failures = std::any_of(plot.series.begin(), plot.series.end(), [](const Series& s) {
    return s.mark == Mark::crosses && !any_finite(s.y);
  });
  if (bars.count > 0) {
    x.see(x.least - 0.6 * bars.width * bars.count);
    x.see(x.most + 0.6 * bars.width * bars.count);
    y.see(0.0);  // the length of a bar is its value
  }
  // Costs and errors that differ by little must not appear to differ by much.
  const double ratio = plot.log_x && plot.log_y ? 4.0 : 1.0;
  std::string text = axis_range("x", x, plot.log_x, 0.0, ratio) +
                     axis_range("y", y, plot.log_y, failures ? 0.08 : 0.0, ratio);
  if (!plot.x_names.empty()) {
    text += fmt::format("set xrange [-0.6:{}]\nset xtics {}(", static_cast<double>(plot.x_names.size()) - 0.4,
                        crowded(plot) ? "rotate by 30 right " : "");
    for (std::size_t i = 0; i < plot.x_names.size(); ++i)
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", quoted(plot.x_names[i]), i);
    text += ")\n";
  }
  if (!plot.y_names.empty()) {
    text += fmt::format("set yrange [{}:-0.6]\nset ytics (", static_cast<double>(plot.y_names.size()) - 0.4);
    for (std::size_t i = 0; i < plot.y_names.size(); ++i)
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", quoted(plot.y_names[i]), i);
    text += ")\n";
  }
  if (plot.equal) text += "set size ratio -1\n";
  return text;
}

// Number of columns of the legend that fit into `width`, px.
std::size_t legend_columns(const Plot& plot, std::size_t width) {
  std::size_t longest = 1;
  for (const Series& s : plot.series) longest = std::max(longest, s.name.size());
  return std::max<std::size_t>(1, width / (62 + 8 * longest));
}

// Sizes in px.
std::string plot_head(std::size_t width, std::size_t height) {
  return fmt::format(
             "set encoding utf8\nset terminal svg size {},{} font 'sans-serif,15' background '#ffffff' "
             "noenhanced\n",
             width, height) +
         "set border 3 lc rgb '#555555'\nset tics nomirror out textcolor rgb '#333333'\n"
         "set grid lc rgb '#e2e2e2' lt 1 lw 1\nset y2range [0:1]\n";
}

// Axes of `whole` and the data of `plot`. `steady`: a series without data still takes its colour.
std::string plot_body(const Plot& plot, const Plot& whole, bool steady) {
  const Limits y = limits_of(plot, true);
  const Bars bars(plot);
  const Grid across(whole, false), up(whole, true);
  std::string text = axes(whole, Bars(whole)) + fmt::format("set boxwidth {}\n", bars.width);
  Parts parts(steady);
  int bar = 0;
  for (const std::size_t i : drawing_order(plot)) {
    const Series& s = plot.series[i];
    text += s.mark == Mark::cells
                ? field_block(s, across, up, i)
                : data_block(s, plot, i, s.mark == Mark::bars ? bars.offset(bar++) : 0.0, y.least_positive);
    parts.add(s, i);
  }
  return text + (parts.text().empty() ? "plot NaN notitle\n" : "plot " + parts.text() + "\n");
}

// Several panels with the same axes and one legend under them.

constexpr double kLeft = 78.0, kGap = 16.0, kRight = 14.0, kTitle = 28.0, kAbove = 34.0, kUnder = 92.0;  // px
constexpr double kHigh = 225.0, kWide = 930.0;  // px: height of a panel; width of all

// Has every series that any panel has, so that a name has one look in all panels.
Plot panel_of(const Plot& plot, std::size_t panel) {
  Plot one = plot;
  one.series.clear();
  for (const Series& s : plot.series) {
    const auto same = [&](const Series& other) { return other.name == s.name && other.mark == s.mark; };
    auto at = std::find_if(one.series.begin(), one.series.end(), same);
    if (at == one.series.end()) {
      one.series.push_back(Series{.name = s.name, .mark = s.mark, .paper = s.paper});
      at = one.series.end() - 1;
    }
    if (s.panel == panel) *at = s;
  }
  return one;
}

// The data lie outside the axes, so that only the legend is visible.
Plot legend_of(const Plot& plot) {
  Plot legend = panel_of(plot, plot.panels.size());
  for (Series& s : legend.series) {
    s.x = s.y = {plot.log_x || plot.log_y ? 1e-9 : -1e9};
    if (s.mark == Mark::crosses) s.name.clear();
  }
  return legend;
}

std::string margins(double left, double right, double top, double bottom, double width, double height) {
  return fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n"
      "set bmargin at screen {:.5f}\n",
      left / width, right / width, 1.0 - top / height, 1.0 - bottom / height);
}

std::string panels_script(const Plot& plot) {
  const std::size_t columns = std::max<std::size_t>(1, std::min(plot.columns, plot.panels.size()));
  const std::size_t rows = (plot.panels.size() + columns - 1) / columns;
  const Plot legend = legend_of(plot);
  const std::size_t keys = legend_columns(legend, static_cast<std::size_t>(kWide) - 40);
  const std::size_t lines = (legend.series.size() + keys - 1) / keys;
  const auto of = [](std::size_t count) { return static_cast<double>(count); };
  const double above = kAbove + of(rows) * (kTitle + kHigh) + kUnder,
               height = above + 22.0 * of(lines) + 10.0;
  const double wide = (kWide - kLeft - kRight - of(columns - 1) * kGap) / of(columns);
  std::string text = plot_head(static_cast<std::size_t>(kWide), static_cast<std::size_t>(height));
  text += "set multiplot title " + quoted(plot.title) + "\nunset key\n";
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    const std::size_t row = i / columns, column = i % columns;
    const bool last = i + columns >= plot.panels.size();
    const double left = kLeft + of(column) * (wide + kGap);
    const double top = kAbove + kTitle + of(row) * (kTitle + kHigh);
    text += margins(left, left + wide, top, top + kHigh - 6.0, kWide, height);
    text += "set format '%g'\nset xtics autofreq\nset ytics autofreq\n";
    text += "set title " + quoted(plot.panels[i]) + " offset 0,-0.6 font ',14'\n";
    text += "set xlabel " + quoted(last ? plot.x_label : std::string()) + "\nset ylabel " +
            quoted(column == 0 ? plot.y_label : std::string()) + "\n";
    std::string body = plot_body(panel_of(plot, i), plot, true);
    const std::size_t at = body.rfind("\nplot ") + 1;
    const std::string quiet = fmt::format("{}{}", last ? "" : "set format x ''\nset xtics (\"\" 0)\n",
                                          column == 0 ? "" : "set format y ''\n");
    body.insert(at, quiet);
    text += body;
  }
  text += "unset title\nunset xlabel\nunset ylabel\nunset border\nunset tics\nunset grid\n";
  text += margins(20.0, kWide - 20.0, above, height - 4.0, kWide, height);
  text +=
      fmt::format("set key at screen 0.5,{:.5f} center top horizontal Left reverse samplen 2.5 maxcols {}\n",
                  1.0 - (above - 8.0) / height, keys);
  std::string body = plot_body(legend, legend, true);
  body.insert(body.rfind("\nplot ") + 1, "unset tics\nunset logscale\nset xrange [1:2]\nset yrange [1:2]\n");
  return text + body + "unset multiplot\n";
}

}  // namespace

Drawing draw(const Plot& plot) {
  // -d: ignores the user's own start-up file.
  Child child = run_child({"gnuplot", "-d", "-"}, plot_script(plot));
  if (!child.started) return {"", "gnuplot is missing (Debian: gnuplot-nox)"};
  if (child.code != 0 || child.out.find("</svg>") == std::string::npos)
    return {"", plot.id + ": gnuplot failed: " + first_complaint(child.err)};
  return {std::move(child.out), ""};
}

std::string plot_script(const Plot& plot) {
  if (!plot.panels.empty()) return panels_script(plot);
  const bool names = !plot.y_names.empty();  // the names reduce the width of the plot and its legend
  const std::size_t columns = legend_columns(plot, names ? 340 : 590);
  const std::size_t rows = (plot.series.size() + columns - 1) / columns;
  return plot_head(names ? 900 : 640, height_of(plot) + (crowded(plot) ? 50 : 0) + 22 * rows) +
         fmt::format("set key bmargin center horizontal Left reverse samplen 2.5 height 0.5 maxcols {}\n",
                     columns) +
         "set title " + quoted(plot.title) + "\nset xlabel " + quoted(plot.x_label) + "\nset ylabel " +
         quoted(plot.y_label) + "\n" + plot_body(plot, plot, false);
}

std::string svg_for_page(const std::string& svg, const std::string& plot_id) {
  std::string text = svg.substr(std::min(svg.find("<svg"), svg.size()));
  std::string prefix = plot_id;
  std::replace(prefix.begin(), prefix.end(), '.', '_');
  const std::string title = "<title>Gnuplot</title>";  // browsers show it as a tooltip
  if (const std::size_t i = text.find(title); i != std::string::npos) text.erase(i, title.size());
  // Renames each definition and each use of a name of gnuplot.
  for (const std::string found :
       {"='gp", "=\"gp", "=\"gnuplot", "='#gp", "=\"#gp", "(#gp", "='textbox", "='greybox"}) {
    const std::size_t name = found.find_last_of("'\"#") + 1;
    const std::string renamed = std::string(found).insert(name, prefix + "_");
    for (std::size_t i = text.find(found); i != std::string::npos; i = text.find(found, i + renamed.size()))
      text.replace(i, found.size(), renamed);
  }
  return text;
}

}  // namespace enc::bench
