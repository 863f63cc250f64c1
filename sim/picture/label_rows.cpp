#include "sim/picture/label_rows.h"

#include <algorithm>

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

}  // namespace

void spread_rows(std::vector<LabelRow>& labels, double pitch, double top, double bottom) {
  for (const bool left : {true, false}) {
    std::vector<LabelRow*> column;
    for (LabelRow& label : labels)
      if (label.left == left) column.push_back(&label);
    spread_column(column, pitch, top, bottom);
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
