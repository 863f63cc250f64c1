// Layout of a picture's labels: in its margins, below the title, each with a line to its object. Pixels, y
// downwards.
#pragma once

#include <vector>

namespace enc::sim {

struct LabelRow {
  bool left = false;             // left margin, else right
  double x = 0.0, y = 0.0;       // target of the line; within the picture below `clear` once it is there
  double row = 0.0;              // y of the text's middle
  double edge = 0.0, end = 0.0;  // x of the text: at the margin, and at the start of the line
  bool dot = true;               // dot at the line's end: the object is in view
};

// Orders the rows of both margins by their objects: `pitch` apart, or closer if they would not fit between
// `top` and `bottom`.
void spread_rows(std::vector<LabelRow>& labels, double pitch, double top, double bottom);
// Exchanges rows of a margin while this reduces crossings of lines with lines or text, or shortens the lines.
void uncross(std::vector<LabelRow>& labels);
// Ends the line from `from` (in the label's row) at the height `clear` if it would go on above it.
void end_below(LabelRow& label, double from, double clear);

}  // namespace enc::sim
