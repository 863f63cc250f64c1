// Several panels with the same axes and one legend under them.
#include "benchmarks/report/plot_panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace enc::bench {
namespace {

constexpr double kLeft = 78.0, kGap = 16.0, kRight = 14.0, kTitle = 28.0, kAbove = 34.0, kUnder = 92.0;  // px
constexpr double kHigh = 225.0, kWide = 930.0;  // px: of a panel; of all

// With every series that any panel has, so that a name has its look in each.
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

// Outside of what is drawn: only the legend is seen of it.
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

}  // namespace

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
  text += "set multiplot title " + plot_quoted(plot.title) + "\nunset key\n";
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    const std::size_t row = i / columns, column = i % columns;
    const bool last = i + columns >= plot.panels.size();
    const double left = kLeft + of(column) * (wide + kGap);
    const double top = kAbove + kTitle + of(row) * (kTitle + kHigh);
    text += margins(left, left + wide, top, top + kHigh - 6.0, kWide, height);
    text += "set format '%g'\nset xtics autofreq\nset ytics autofreq\n";
    text += "set title " + plot_quoted(plot.panels[i]) + " offset 0,-0.6 font ',14'\n";
    text += "set xlabel " + plot_quoted(last ? plot.x_label : std::string()) + "\nset ylabel " +
            plot_quoted(column == 0 ? plot.y_label : std::string()) + "\n";
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

}  // namespace enc::bench
