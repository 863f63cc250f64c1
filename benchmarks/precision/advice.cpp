#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/precision/parts.h"

namespace enc::bench::precision {
namespace {

using trial::PrecisionPoint;

// What is asked about: the force that is felt, or the way of the tip.
struct Norm {
  const char* name;
  double PrecisionPoint::*error;
  double trial::Accuracy::*most;
  double unit;  // as it is printed: N, um
};
constexpr std::array kNorms{Norm{"force, N", &PrecisionPoint::error, &trial::Accuracy::force, 1.0},
                            Norm{"path, um", &PrecisionPoint::way, &trial::Accuracy::way, 1e-6}};

struct Carried {
  std::string scene;
  const Norm* norm = nullptr;
  const PrecisionPoint *advised = nullptr, *next = nullptr;  // of the study; null: none
  double asked = kUnset, error = kUnset, next_error = kUnset;
  std::string failure{};  // of a run that judges
  [[nodiscard]] bool meets() const { return error <= asked; }
  [[nodiscard]] bool has_next() const { return !std::isnan(next_error); }
  [[nodiscard]] bool next_fails() const { return next_error > asked; }
};

// An error that somebody could ask for, and that tells settings apart: in the middle of the widest gap, by
// ratio, between what a setting gives and what all that are cheaper do. Where no gap is wide, half more than
// what costs least errs.
double asked_of(const std::vector<PrecisionPoint>& points, double PrecisionPoint::*error) {
  constexpr double kWide = 1.3;
  const PrecisionPoint* least = nullptr;
  double asked = kUnset, widest = kWide;
  for (const PrecisionPoint& point : points) {
    if (!point.failure.empty()) continue;
    if (least == nullptr || point.cost() < least->cost()) least = &point;
    double best = kUnset;  // of what is cheaper
    for (const PrecisionPoint& other : points)
      if (other.failure.empty() && other.cost() * trial::kAsDear < point.cost() && !(best <= other.*error))
        best = other.*error;
    if (!(best > widest * point.*error)) continue;
    widest = best / point.*error;
    asked = std::sqrt(best * point.*error);
  }
  return std::isnan(asked) && least != nullptr ? 1.5 * least->*error : asked;
}

std::string words(const PrecisionPoint* point) {
  return point != nullptr ? fmt::format("{} at {:g} us", point->integrator, point->step * 1e6) : "-";
}

bool same(const PrecisionPoint& a, const PrecisionPoint& b) {
  return a.integrator == b.integrator && std::abs(a.step - b.step) < 1e-9;
}

// These points again, judged by RK4 at an eightieth of a period.
std::vector<PrecisionPoint> again(const BenchContext& context, const ForceStudy& study,
                                  const std::vector<const PrecisionPoint*>& points) {
  trial::PrecisionOptions options;
  options.rounds = 1;
  options.converged = 80;
  std::set<std::string> integrators;
  std::set<int> parts;
  for (const PrecisionPoint* point : points) {
    integrators.insert(point->integrator);
    parts.insert(static_cast<int>(std::lround(study.all.tick / point->step)));
  }
  options.grid = {{integrators.begin(), integrators.end()}, {parts.begin(), parts.end()}};
  options.shipped_too = false;
  options.twice = false;
  return force_study(context, study.scene, {}, options).all.points;
}

std::vector<Carried> carried_out(const BenchContext& context, const ForceStudy& study) {
  std::vector<Carried> all;
  std::vector<const PrecisionPoint*> points;
  for (const Norm& norm : kNorms) {
    Carried one{study.scene, &norm};
    one.asked = asked_of(study.all.points, norm.error);
    trial::Accuracy most;
    most.*norm.most = one.asked;
    one.advised = trial::cheapest(study.all.points, most);
    if (one.advised != nullptr) one.next = trial::next_cheaper(study.all.points, *one.advised);
    for (const PrecisionPoint* point : {one.advised, one.next})
      if (point != nullptr) points.push_back(point);
    all.push_back(std::move(one));
  }
  const std::vector<PrecisionPoint> judged = again(context, study, points);
  const auto error_of = [&](Carried& one, const PrecisionPoint* point) {
    if (point == nullptr) return kUnset;
    const auto at =
        std::find_if(judged.begin(), judged.end(), [&](const auto& j) { return same(j, *point); });
    if (!at->failure.empty()) one.failure = at->failure;
    return at->failure.empty() ? *at.*one.norm->error : kUnset;
  };
  for (Carried& one : all) {
    one.error = error_of(one, one.advised);
    one.next_error = error_of(one, one.next);
  }
  return all;
}

}  // namespace

void add_advice(Bench& bench, const std::vector<ForceStudy>& studies) {
  const std::vector<std::vector<Carried>> all =
      bench.each(studies, [&](const ForceStudy& study) { return carried_out(bench.context, study); });
  Table table{"advice",
              "Advice carried out: errors by another converged run",
              {"scene", "error of", "asked", "advised", "errs by", "next cheaper", "errs by", "judged"},
              {}};
  table.printed = true;
  std::size_t asked = 0, meets = 0, with_next = 0, next_fails = 0;
  for (const std::vector<Carried>& scene : all)
    for (const Carried& one : scene) {
      ++asked;
      meets += one.meets() ? 1 : 0;
      with_next += one.has_next() ? 1 : 0;
      next_fails += one.next_fails() ? 1 : 0;
      const auto printed = [&](double error) {
        return std::isnan(error) ? "-" : fmt::format("{:.4g}", error / one.norm->unit);
      };
      const bool holds = one.meets() && (!one.has_next() || one.next_fails());
      table.add(one.scene, one.norm->name, printed(one.asked), words(one.advised), printed(one.error),
                words(one.next), printed(one.next_error),
                !one.failure.empty() ? one.failure
                : holds              ? "holds"
                                     : "does not");
    }
  bench.figure(
      "advice.meets", static_cast<double>(meets) / static_cast<double>(asked), "", at_least(0.9),
      fmt::format("share of {} pieces of advice in which the advised setting errs by no more than was "
                  "asked, by another converged run",
                  asked));
  bench.figure(
      "advice.next_fails", static_cast<double>(next_fails), "", at_least(10.0),
      fmt::format("of {} that have a next cheaper setting: it errs by more than was asked", with_next));
  bench.table(std::move(table));
}

}  // namespace enc::bench::precision
