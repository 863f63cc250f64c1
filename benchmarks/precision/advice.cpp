#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/precision/parts.h"

namespace enc::bench::precision {
namespace {

using trial::PrecisionPoint;

struct Carried {
  std::string scene, advised, next = "-";
  double asked = kUnset, error = kUnset, next_error = kUnset;  // N
  [[nodiscard]] bool holds() const { return error <= asked && !(next_error <= asked); }
};

// An error that somebody could ask for, and that tells settings apart: in the middle of the widest gap, by
// ratio, between what some cost gives and what the next cheaper ones do. Where no gap is wide, half more than
// the cheapest errs.
double asked_of(std::vector<PrecisionPoint> points) {
  std::erase_if(points, [](const PrecisionPoint& point) { return !point.failure.empty(); });
  std::sort(points.begin(), points.end(),
            [](const PrecisionPoint& a, const PrecisionPoint& b) { return a.cpu < b.cpu; });
  double asked = kUnset, widest = 1.5, best = kUnset;  // best: of all that are cheaper
  for (const PrecisionPoint& point : points) {
    if (std::isnan(asked)) asked = 1.5 * point.error;
    if (best > widest * point.error) {
      widest = best / point.error;
      asked = std::sqrt(best * point.error);
    }
    if (!(best <= point.error)) best = point.error;
  }
  return asked;
}

std::string words(const PrecisionPoint& point) {
  return fmt::format("{} at {:g} us", point.integrator, point.step * 1e6);
}

// The same point again, judged by RK4 at an eightieth of a period.
double again(const BenchContext& context, const ForceStudy& study, const PrecisionPoint& point) {
  trial::PrecisionOptions options;
  options.rounds = 1;
  options.converged = 80;
  options.grid = {{point.integrator}, {static_cast<int>(std::lround(study.all.tick / point.step))}};
  options.shipped_too = false;
  options.twice = false;
  const ForceStudy judged = force_study(context, study.scene, {}, options);
  return judged.all.points.front().error;
}

Carried carried_out(const BenchContext& context, const ForceStudy& study) {
  Carried carried{study.scene, {}};
  carried.asked = asked_of(study.all.points);
  const PrecisionPoint* best = trial::cheapest(study.all.points, carried.asked);
  if (best == nullptr) return carried;
  carried.advised = words(*best);
  carried.error = again(context, study, *best);
  if (const PrecisionPoint* next = trial::next_cheaper(study.all.points, *best)) {
    carried.next = words(*next);
    carried.next_error = again(context, study, *next);
  }
  return carried;
}

}  // namespace

void add_advice(Bench& bench, const std::vector<ForceStudy>& studies) {
  const std::vector<Carried> all =
      bench.each(studies, [&](const ForceStudy& study) { return carried_out(bench.context, study); });
  Table table{"advice",
              "Advice carried out: errors by another converged run",
              {"scene", "asked (N)", "advised", "errs by (N)", "next cheaper", "errs by (N)", "holds"},
              {}};
  table.printed = true;
  std::size_t holds = 0;
  for (const Carried& one : all) {
    holds += one.holds() ? 1 : 0;
    table.add(one.scene, fmt::format("{:.4f}", one.asked), one.advised, fmt::format("{:.4f}", one.error),
              one.next, std::isnan(one.next_error) ? "-" : fmt::format("{:.4f}", one.next_error),
              one.holds() ? "yes" : "no");
  }
  bench.figure("advice.holds", static_cast<double>(holds), "", at_least(10.0),
               fmt::format("of {} scenes: the advised setting errs by no more than was asked, and the next "
                           "cheaper by more",
                           all.size()));
  bench.table(std::move(table));
}

}  // namespace enc::bench::precision
