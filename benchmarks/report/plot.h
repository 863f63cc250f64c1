// Draws a plot with gnuplot, in the one style of the report, and writes its data as a table.
#pragma once

#include <string>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

struct Drawing {
  std::string svg;      // a whole SVG file; empty: not drawn
  std::string why_not;  // one line for people, then
};

// What gnuplot is told; the data are in it. Text from a plot is never read as a command.
[[nodiscard]] std::string plot_script(const Plot& plot);
// Runs gnuplot, which is looked for in PATH, on the script. Touches no file.
[[nodiscard]] Drawing draw(const Plot& plot);
// The same drawing to be put into a page among others: no prolog, and ids that no other drawing has.
[[nodiscard]] std::string svg_for_page(const std::string& svg, const std::string& plot_id);

[[nodiscard]] std::string plot_csv(const Plot& plot);  // series,paper,x,y,low,high
[[nodiscard]] std::string table_csv(const Table& table);

}  // namespace enc::bench
