// The child process that draws.
#include <algorithm>
#include <string>

#include "benchmarks/kit/child.h"
#include "benchmarks/report/plot.h"

namespace enc::bench {
namespace {

std::string first_complaint(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find('\n', i), text.size());
    const std::string line = text.substr(i, end - i);
    if (line.find_first_not_of(" \t^") != std::string::npos && line.find("gnuplot>") == std::string::npos)
      return line;
    i = end + 1;
  }
  return "it said nothing";
}

}  // namespace

Drawing draw(const Plot& plot) {
  // -d: without what the user's own start-up file says.
  Child child = run_child({"gnuplot", "-d", "-"}, plot_script(plot));
  if (!child.started) return {"", "gnuplot is missing (Debian: gnuplot-nox)"};
  if (child.code != 0 || child.out.find("</svg>") == std::string::npos)
    return {"", plot.id + ": gnuplot failed: " + first_complaint(child.err)};
  return {std::move(child.out), ""};
}

}  // namespace enc::bench
