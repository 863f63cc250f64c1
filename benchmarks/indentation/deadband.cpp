// Share of the felt force beyond a Weber deadband about the real ball's, for two thresholds: people notice a
// smaller difference when force changes fast [sources/hand 6].
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"

namespace enc::bench::indentation {
namespace {

// Samples of the true force above kLeastForce.
struct Samples {
  double beyond = 0.0, all = 0.0;
};
constexpr double kLeastForce = 0.5, kLeastError = 0.1;  // N: assumed [sources/hand 6]

void count(const Branch& branch, const Response& reference, bool press, double fraction, Samples& samples) {
  for (std::size_t i = 0; i < branch.size(); ++i) {
    const double d = branch.deflection[i];
    const double wanted = press ? reference.press(d) : reference.release(d);
    if (wanted < kLeastForce) continue;
    samples.all += 1.0;
    if (std::abs(branch.force[i] - wanted) > std::max(kLeastError, fraction * wanted)) samples.beyond += 1.0;
  }
}

}  // namespace

void add_deadband(const IndentRuns& runs, Bench& bench) {
  struct Deadband {
    const char *id, *words;
    double fraction;
    Bounds bounds;
  };
  for (const Deadband& band :
       // Seeds 1 to 4: 6.4 to 7.8 %, 19.9 to 25.4 %.
       {Deadband{"10", "10 % (slow changes)", 0.10, between(4.0, 11.0)},
        Deadband{"5", "5 % (fast changes)", 0.05, between(14.0, 33.0)}}) {
    Samples samples;
    for (const std::vector<IndentRun>& of : runs)
      for (const IndentRun& run : of) {
        count(run.truth.press, run.reference, true, band.fraction, samples);
        count(run.truth.release, run.reference, false, band.fraction, samples);
      }
    bench.figure(fmt::format("deadband.{}.percent", band.id), 100.0 * samples.beyond / samples.all, "%",
                 band.bounds,
                 fmt::format("true force above 0.5 N that is off the real ball's by more than a threshold of "
                             "{}, at least 0.1 N",
                             band.words));
  }
}

}  // namespace enc::bench::indentation
