#include "sim/picture/label_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace enc::sim {
namespace {

void spread_column(std::vector<LabelRow*>& column, double pitch, double top, double bottom) {
  std::stable_sort(column.begin(), column.end(),
                   [](const LabelRow* a, const LabelRow* b) { return a->y < b->y; });
  const auto gaps = static_cast<double>(column.size()) - 1.0;
  if (gaps > 0.0) pitch = std::min(pitch, (bottom - top) / gaps);
  double lowest = top;
  for (LabelRow* label : column) {
    label->row = std::max(lowest, label->y);
    lowest = label->row + pitch;
  }
  double highest = bottom;
  for (auto label = column.rbegin(); label != column.rend(); ++label) {
    (*label)->row = std::min(highest, (*label)->row);
    highest = (*label)->row - pitch;
  }
}

// Twice the area of a triangle; its sign is the side of a-b on which c is.
double side(double ax, double ay, double bx, double by, double cx, double cy) {
  return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

// A line from a to b.
struct Segment {
  double ax, ay, bx, by;
};
bool meet(const Segment& s, const Segment& t) {
  return side(s.ax, s.ay, s.bx, s.by, t.ax, t.ay) * side(s.ax, s.ay, s.bx, s.by, t.bx, t.by) < 0.0 &&
         side(t.ax, t.ay, t.bx, t.by, s.ax, s.ay) * side(t.ax, t.ay, t.bx, t.by, s.bx, s.by) < 0.0;
}

bool cross(const LabelRow& a, const LabelRow& b) {
  const Segment line_a{a.end, a.row, a.x, a.y}, line_b{b.end, b.row, b.x, b.y};
  const Segment text_a{a.edge, a.row, a.end, a.row}, text_b{b.edge, b.row, b.end, b.row};
  return meet(line_a, line_b) || meet(line_a, text_b) || meet(line_b, text_a);
}

// Crossings first, then the length of all lines, px.
double cost(const std::vector<LabelRow*>& column) {
  constexpr double kCrossing = 1e6;
  double sum = 0.0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    sum += std::hypot(column[i]->x - column[i]->end, column[i]->y - column[i]->row);
    for (std::size_t k = i + 1; k < column.size(); ++k)
      if (cross(*column[i], *column[k])) sum += kCrossing;
  }
  return sum;
}

}  // namespace

void spread_rows(std::vector<LabelRow>& labels, double pitch, double top, double bottom) {
  for (const bool left : {true, false}) {
    std::vector<LabelRow*> column;
    for (LabelRow& label : labels)
      if (label.left == left) column.push_back(&label);
    spread_column(column, pitch, top, bottom);
  }
}

void uncross(std::vector<LabelRow>& labels) {
  for (const bool left : {true, false}) {
    std::vector<LabelRow*> column;
    for (LabelRow& label : labels)
      if (label.left == left) column.push_back(&label);
    double least = cost(column);
    for (bool better = true; better;) {
      better = false;
      for (std::size_t i = 0; i < column.size(); ++i)
        for (std::size_t k = i + 1; k < column.size(); ++k) {
          std::swap(column[i]->row, column[k]->row);
          const double now = cost(column);
          better = better || now < least - 1e-6;
          if (now < least - 1e-6)
            least = now;
          else
            std::swap(column[i]->row, column[k]->row);
        }
    }
  }
}

void end_below(LabelRow& label, double from, double clear) {
  if (label.y >= clear || label.row <= clear) return;
  const double share = (label.row - clear) / (label.row - label.y);
  label.x = from + share * (label.x - from);
  label.y = clear;
  label.dot = false;
}

}  // namespace enc::sim
