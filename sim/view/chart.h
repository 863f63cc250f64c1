// Elements over a picture in a window: strip charts, and a bar of time.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace enc::sim {

using Colour = std::array<float, 4>;  // red, green, blue, opacity; 0 to 1

// A strip chart in the corner of a window.
struct ViewLine {
  std::string name;
  std::vector<float> xy;  // x, y, x, y...; at most 1000 points are drawn
};
struct ViewChart {
  std::string title;
  std::vector<ViewLine> lines;
  std::array<float, 2> across{0, 1};  // range of x
  std::array<float, 2> up{0, 0};      // smallest range of y
  std::optional<float> cursor{};      // x of a vertical line
};

// A bar along the bottom of a window: time, the shown moment, marks. Positions are shares, 0 to 1.
struct ViewBar {
  struct Mark {
    float from = 0.0F, to = 0.0F;
    Colour colour{};
  };
  bool shown = false;
  float at = 0.0F;
  std::vector<Mark> marks;
};

}  // namespace enc::sim
