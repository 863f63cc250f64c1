// Small multiples, and what they share with a plot of its own. For plot.cpp alone.
#pragma once

#include <cstddef>
#include <string>

#include "benchmarks/report/plot.h"

namespace enc::bench {

[[nodiscard]] std::size_t legend_columns(const Plot& plot, std::size_t width);  // that fit, px
[[nodiscard]] std::string plot_head(std::size_t width, std::size_t height);     // px
// Axes of `whole` and the data of `plot`. `steady`: what has no data has its colour all the same.
[[nodiscard]] std::string plot_body(const Plot& plot, const Plot& whole, bool steady);
[[nodiscard]] std::string plot_quoted(const std::string& text);  // for gnuplot, which reads no command in it

[[nodiscard]] std::string panels_script(const Plot& plot);

}  // namespace enc::bench
