// Draws a plot with gnuplot in the report's style, and writes its data as a table.
#pragma once

#include <string>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

struct Drawing {
  std::string svg;      // a whole SVG file; empty: not drawn
  std::string why_not;  // one line for people, then
};

// The gnuplot script, including the data. Text from a plot is never read as a command.
[[nodiscard]] std::string plot_script(const Plot& plot);
// Runs gnuplot from PATH on the script. Touches no file.
[[nodiscard]] Drawing draw(const Plot& plot);
// The drawing for a page with several drawings: no prolog, and unique ids.
[[nodiscard]] std::string svg_for_page(const std::string& svg, const std::string& plot_id);

[[nodiscard]] std::string plot_csv(const Plot& plot);  // series,paper,x,y,low,high
[[nodiscard]] std::string table_csv(const Table& table);

}  // namespace enc::bench
