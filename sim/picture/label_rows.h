// Where the labels of a picture stand: in its margins, each with a line to what it names, below the title.
// Pixels, y downwards.
#pragma once

#include <vector>

namespace enc::sim {

struct LabelRow {
  bool left = false;             // margin
  double x = 0.0, y = 0.0;       // of what it names; within the picture below `clear` once it is there
  double row = 0.0;              // of the text's middle
  double edge = 0.0, end = 0.0;  // x of the text: at the margin, and where the line begins
  bool dot = true;               // at the end of the line: what it names is in view
};

// Rows of both margins in the order of what they name: `pitch` apart, or closer where they would not fit
// between `top` and `bottom`.
void spread_rows(std::vector<LabelRow>& labels, double pitch, double top, double bottom);
// Exchanges rows of a margin as long as fewer lines cross another line or text, or the lines get shorter.
void uncross(std::vector<LabelRow>& labels);
// Ends the line from `from` (in the label's row) at the height `clear`, where it would go on above it.
void end_below(LabelRow& label, double from, double clear);

}  // namespace enc::sim
