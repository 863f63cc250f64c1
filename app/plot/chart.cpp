#include "app/plot/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace enc::app {
namespace {

// Distance of the ticks of an axis: 1, 2 or 5 times a power of ten, for about five of them.
double tick_step(const Range& range) {
  const double rough = (range.most - range.least) / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= rough) return step * power;
  return 10.0 * power;
}

std::string number(double value, double step) {
  const double near = std::round(value / step) * step;
  return fmt::format("{:.6g}", near == 0.0 ? 0.0 : near);
}

template <class Draw>
void for_ticks(const Range& range, const Draw& draw) {
  const double step = tick_step(range);
  const auto last = static_cast<std::int64_t>(std::floor(range.most / step + 1e-9));
  for (auto i = static_cast<std::int64_t>(std::ceil(range.least / step - 1e-9)); i <= last; ++i) {
    const double at = static_cast<double>(i) * step;
    draw(at, number(at, step));
  }
}

}  // namespace

void Range::see(double value) {
  if (!std::isfinite(value)) return;
  least = any ? std::min(least, value) : value;
  most = any ? std::max(most, value) : value;
  any = true;
}

Range rounded(const Range& range) {
  Range wide = range.any ? range : Range{0.0, 1.0, true};
  const double narrow = 1e-9 * std::max(1.0, std::abs(wide.most));
  if (wide.most - wide.least < narrow) {
    const double room = std::max(0.5, narrow);
    wide.least -= room;
    wide.most += room;
  }
  const double step = tick_step(wide);
  // Noise around zero gets no tick of its own.
  if (wide.least < 0.0 && wide.least > -0.05 * step) wide.least = 0.0;
  return {std::floor(wide.least / step + 1e-6) * step, std::ceil(wide.most / step - 1e-6) * step, true};
}

double Chart::px(double at) const { return left + (at - x.least) / (x.most - x.least) * width; }
double Chart::py(double value) const { return top + (y.most - value) / (y.most - y.least) * height; }

void Path::add(double x, double y) {
  if (down_ && std::hypot(x - x_, y - y_) < 1.0) return;
  text_ += fmt::format("{}{:.1f} {:.1f}", down_ ? 'L' : 'M', x, y);
  x_ = x;
  y_ = y;
  down_ = true;
}

Trace::Trace(const Chart& chart) : chart_(chart), columns_(static_cast<std::size_t>(chart.width) + 1) {}

void Trace::add(double time, double value) {
  const double at = std::clamp(chart_.px(time) - chart_.left, 0.0, chart_.width);
  Column& column = columns_[static_cast<std::size_t>(at)];
  if (!std::isfinite(value)) {
    column.unset = true;
    return;
  }
  if (column.range.any && value != column.range.least && value != column.range.most)
    column.rises = value > column.range.least;
  column.range.see(value);
}

std::string Trace::text() const {
  Path path;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    if (!column.range.any) {
      if (column.unset) path.lift();
      continue;
    }
    const double x = chart_.left + static_cast<double>(i);
    path.add(x, chart_.py(column.rises ? column.range.least : column.range.most));
    path.add(x, chart_.py(column.rises ? column.range.most : column.range.least));
  }
  return path.text();
}

std::string svg_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string label(double x, double y, std::string_view text, std::string_view more) {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' {}>{}</text>\n", x, y, more, svg_text(text));
}

std::string bar(double x, double y, double width, double height, std::string_view colour) {
  return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>\n", x, y, width,
                     height, colour);
}

std::string axes(const Chart& c, std::string_view clip) {
  const double right = c.left + c.width, bottom = c.top + c.height;
  std::string text = fmt::format(
      "<clipPath id='{}'><rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/></clipPath>\n", clip,
      c.left, c.top, c.width, c.height);
  std::string grid;
  for_ticks(c.y, [&](double at, const std::string& number) {
    const double y = c.py(at);
    grid += fmt::format("M{:.1f} {:.1f}H{:.1f}", c.left, y, right);
    text += label(c.left - 6.0, y + 4.5, number, "text-anchor='end'");
  });
  for_ticks(c.x, [&](double at, const std::string& number) {
    const double x = c.px(at);
    grid += fmt::format("M{:.1f} {:.1f}V{:.1f}", x, c.top, bottom);
    if (!c.x_label.empty()) text += label(x, bottom + 18.0, number, "text-anchor='middle'");
  });
  text += fmt::format("<path d='{}' stroke='#000000' stroke-opacity='0.13' fill='none'/>\n", grid);
  text += fmt::format("<path d='M{:.1f} {:.1f}V{:.1f}H{:.1f}' stroke='#555555' fill='none'/>\n", c.left,
                      c.top, bottom, right);
  if (!c.x_label.empty())
    text += label(c.left + 0.5 * c.width, bottom + 38.0, c.x_label, "text-anchor='middle'");
  const double x = c.left - 46.0, y = c.top + 0.5 * c.height;
  return text + label(x, y, c.y_label,
                      fmt::format("text-anchor='middle' transform='rotate(-90 {:.1f} {:.1f})'", x, y));
}

std::string line(std::string_view path, std::string_view clip) {
  return fmt::format(
      "<path d='{}' clip-path='url(#{})' stroke='#0072B2' stroke-width='1.3' stroke-linejoin='round' "
      "fill='none'/>\n",
      path, clip);
}

}  // namespace enc::app
