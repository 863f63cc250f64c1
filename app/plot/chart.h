// Draws charts with axes, curves and bands as parts of an SVG file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace enc::app {

struct Range {
  double least = 0.0, most = 0.0;
  bool any = false;
  void see(double value);
};

// Place of a chart in the picture, px, and its axes.
struct Chart {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
  Range x, y;
  std::string x_label, y_label;  // with unit; no x_label: no numbers under the axis either

  [[nodiscard]] double px(double at) const;
  [[nodiscard]] double py(double value) const;
};

// Rounds the ends of an axis outward to its ticks.
[[nodiscard]] Range rounded(const Range& range);

// The points of a path, px. Points less than a pixel apart are left out.
class Path {
 public:
  void add(double x, double y);
  void lift() { down_ = false; }  // the next point begins a new line
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool down_ = false;
  double x_ = 0.0, y_ = 0.0;
};

// A curve over time, with the least and the greatest value of each column of pixels.
class Trace {
 public:
  explicit Trace(const Chart& chart);
  void add(double time, double value);  // times ascend; an unset value is a gap
  [[nodiscard]] std::string text() const;

 private:
  struct Column {
    Range range;
    bool rises = true;   // the greatest value came last
    bool unset = false;  // an unset value came
  };
  const Chart& chart_;
  std::vector<Column> columns_;
};

[[nodiscard]] std::string svg_text(std::string_view text);  // escaped
[[nodiscard]] std::string label(double x, double y, std::string_view text, std::string_view more = {});
[[nodiscard]] std::string bar(double x, double y, double width, double height, std::string_view colour);
// Frame, grid, numbers and labels; `clip` is the id of the chart's clip path.
[[nodiscard]] std::string axes(const Chart& chart, std::string_view clip);
[[nodiscard]] std::string line(std::string_view path, std::string_view clip);

}  // namespace enc::app
