#include "trial/precision/precision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/words.h"
#include "models/order_statistics.h"

namespace enc::trial {
namespace {

struct Run {
  std::vector<Vec3> force, tip;
  std::vector<char> touching;
  std::optional<std::vector<double>> quantities;  // unset: the force is compared
  double cpu = kUnset, yards = kUnset, simulated = 0.0;
  std::string failure;
  [[nodiscard]] std::int64_t touched() const { return std::count(touching.begin(), touching.end(), 1); }
};

// `looks`: computes the compared quantities, which takes extra time.
Run run_once(const models::Setup& setup, const PrecisionOptions& asked, double seconds, bool looks = true) {
  Run run;
  TrialOptions options;
  options.seed = asked.seed;
  options.seconds = seconds;
  options.drivers = asked.drivers;
  std::unique_ptr<Quantities> own;
  options.watch = [&](const Glance& glance) {
    if (own) own->see(glance);
    run.force.push_back(glance.truth.contact_force.e());
    run.tip.push_back(glance.truth.tip.e());
    run.touching.push_back(glance.truth.touching ? 1 : 0);
  };
  try {
    if (looks && asked.quantities) own = asked.quantities(setup, options);
    Trial trial(setup, options);
    const double before = asked.yardstick ? asked.yardstick() : kUnset;
    const double start = asked.cpu();
    const TrialResult result = trial.run();
    const double cpu = asked.cpu() - start;
    const double after = asked.yardstick ? asked.yardstick() : kUnset;
    run.simulated = result.simulated;
    run.cpu = cpu / result.simulated;
    run.yards = cpu / static_cast<double>(result.ticks) / (0.5 * (before + after));
    if (own) run.quantities = own->all();
    if (result.diverged_at >= 0) run.failure = fmt::format("diverged at tick {}", result.diverged_at);
  } catch (const Error& e) {
    run.failure = e.what();
  }
  return run;
}

// A programme that waits for a touch may end at another time with another step. Only the common ticks are
// compared.
void judge(const Run& run, const Run& truth, PrecisionPoint& point) {
  point.failure = run.failure;
  if (!run.failure.empty()) return;
  const std::size_t ticks = std::min(run.force.size(), truth.force.size());
  constexpr std::size_t kApart = 1000;  // ticks: a larger difference is another course of events
  if (std::max(run.force.size(), truth.force.size()) - ticks > kApart) {
    point.failure =
        fmt::format("ends after {}, not after {}", counted(run.force.size(), "tick"), truth.force.size());
    return;
  }
  double force = 0.0, way = 0.0;
  std::int64_t touched = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    way += (run.tip[i] - truth.tip[i]).squaredNorm();
    if (run.touching[i] == 0 && truth.touching[i] == 0) continue;
    force += (run.force[i] - truth.force[i]).squaredNorm();
    ++touched;
  }
  if (touched == 0) {
    point.failure = "touches nothing by then";
    return;
  }
  point.error = truth.quantities ? apart(run.quantities.value(), *truth.quantities)
                                 : std::sqrt(force / static_cast<double>(touched));
  point.way = std::sqrt(way / static_cast<double>(std::max<std::size_t>(ticks, 1)));
  point.least_error = point.error;
  point.least_way = point.way;
  if (!std::isfinite(point.error) || !std::isfinite(point.way)) point.failure = "not finite";
}

models::Setup with(const SetupWith& setup_with, const Precision& all, const PrecisionPoint& point) {
  return setup_with(all.settings(point));
}

void judge_again(const Run& run, const Run& truth, PrecisionPoint& point) {
  PrecisionPoint again = point;
  if (point.failure.empty()) judge(run, truth, again);
  point.failure = again.failure;
  point.least_error = std::min(point.error, again.error);
  point.least_way = std::min(point.way, again.way);
  point.error = std::max(point.error, again.error);
  point.way = std::max(point.way, again.way);
}

std::vector<PrecisionPoint> points_of(const PrecisionOptions& options, const sim::Stepping& shipped,
                                      double period) {
  std::vector<PrecisionPoint> points;
  bool there = false;
  for (const std::string& integrator : options.grid.integrators)
    for (const int parts : options.grid.parts) {
      PrecisionPoint point{integrator, period / parts};
      point.shipped = shipped.integrator == integrator && std::abs(shipped.timestep - point.step) < 1e-9;
      there = there || point.shipped;
      points.push_back(std::move(point));
    }
  if (there || !options.shipped_too) return points;
  points.push_back({shipped.integrator, shipped.timestep});
  points.back().shipped = true;
  return points;
}

// The plan of the comparison, before any run.
Precision plan_of(const PrecisionOptions& options, const sim::Stepping& shipped, double period) {
  Precision all;
  all.table = shipped.table;
  all.tick = period;
  all.converged = {"rk4", period / options.converged};
  all.second = {"implicitfast", period / (2 * options.converged)};
  all.points = points_of(options, shipped, period);
  return all;
}

void keep_truth(const Run& truth, Precision& all) {
  if (!truth.failure.empty()) throw Error("the converged run failed: " + truth.failure);
  all.seconds = truth.simulated;
  all.touched = truth.touched();
  all.converged.cpu = truth.cpu;
  if (all.touched == 0)
    throw Error("there is no error of a force: nothing touched in this scene's programme");
}

// Times of a point's rounds, as in Run.
struct Times {
  std::vector<double> cpu, yards;
};
void keep_times(const Times& of, bool by_yardstick, PrecisionPoint& point) {
  if (of.cpu.empty()) return;
  point.cpu = models::median(of.cpu);
  if (!by_yardstick) return;
  point.yards = models::median(of.yards);
  const auto [least, most] = std::minmax_element(of.yards.begin(), of.yards.end());
  point.spread = *most / *least;
}

struct ReferenceRuns {
  const Run &truth, &second;
};

// Runs all points, round by round.
void run_points(const SetupWith& setup_with, const PrecisionOptions& options, double seconds,
                const ReferenceRuns& runs, const std::function<void(double)>& tell, Precision& all) {
  std::vector<Times> times(all.points.size());
  // Computing the quantities takes time, so a round either computes them or is timed.
  const int first = options.quantities ? -1 : 0;
  for (int round = first; round < options.rounds; ++round)
    for (std::size_t i = 0; i < all.points.size(); ++i) {
      PrecisionPoint& point = all.points[i];
      if (!point.failure.empty()) continue;
      const bool looks = round == first;
      const Run run = run_once(with(setup_with, all, point), options, seconds, looks);
      if (looks || first == 0) {
        judge(run, runs.truth, point);
        if (options.twice) judge_again(run, runs.second, point);
      }
      if (round < 0) continue;
      times[i].cpu.push_back(run.cpu);
      times[i].yards.push_back(run.yards);
      tell(2.0 / static_cast<double>(all.points.size()));
    }
  for (std::size_t i = 0; i < all.points.size(); ++i)
    keep_times(times[i], options.yardstick != nullptr, all.points[i]);
}

}  // namespace

double apart(std::span<const double> some, std::span<const double> truth) {
  double most = 0.0, largest = 0.0;
  bool finite = some.size() == truth.size();
  for (std::size_t i = 0; finite && i < truth.size(); ++i) {
    finite = std::isfinite(some[i]) && std::isfinite(truth[i]);
    most = std::max(most, std::abs(some[i] - truth[i]));
    largest = std::max(largest, std::abs(truth[i]));
  }
  return finite && largest > 0.0 ? most / largest : kUnset;
}

Spread Precision::error_spread(const PrecisionPoint& point) const {
  return {std::max(0.0, point.least_error - second.error), point.error + second.error};
}

Spread Precision::way_spread(const PrecisionPoint& point) const {
  return {std::max(0.0, point.least_way - second.way), point.way + second.way};
}

std::vector<std::string> Precision::settings(const PrecisionPoint& point) const {
  return {fmt::format("{}.timestep_us={}", table, point.step * 1e6),
          fmt::format("{}.integrator={}", table, point.integrator)};
}

Precision precision_of(const SetupWith& setup_with, const PrecisionOptions& options) {
  const models::Setup own = setup_with({});
  if (!own.scene.user && !own.scene.pusher && !own.scene.probe)
    throw Error(
        "there is no error of a force: no hand touches anything in this scene; expected one with "
        "[user], [pusher] or [probe]",
        "user");
  const sim::Stepping shipped = own.twin.stepping(own.scene);
  const double period = 1.0 / own.rig.loop.rate;
  Precision all = plan_of(options, shipped, period);
  double done = 0.0;
  const double whole = 8.0 + static_cast<double>(options.rounds) * 2.0;
  const auto tell = [&](double more) {
    done += more;
    if (options.progress) options.progress(std::min(1.0, done / whole));
  };
  double seconds = options.seconds;
  const auto converged = [&] { return run_once(with(setup_with, all, all.converged), options, seconds); };
  Run truth = converged();
  if (truth.failure.empty() && truth.touched() == 0) {
    seconds = kUnset;
    truth = converged();
  }
  tell(4.0);
  keep_truth(truth, all);
  Run second;
  if (options.twice) {
    second = run_once(with(setup_with, all, all.second), options, seconds);
    judge(second, truth, all.second);
    if (!all.second.failure.empty()) throw Error("the second converged run failed: " + all.second.failure);
  }
  all.second.cpu = second.cpu;
  tell(4.0);
  run_points(setup_with, options, seconds, {truth, second}, tell, all);
  return all;
}

const PrecisionPoint* shipped(const std::vector<PrecisionPoint>& points) {
  const auto at = std::find_if(points.begin(), points.end(), [](const auto& point) { return point.shipped; });
  return at == points.end() ? nullptr : &*at;
}

double PrecisionPoint::share(const Accuracy& most) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!failure.empty() || std::isnan(error) || std::isnan(way)) return kInfinite;
  double greatest = 0.0;
  if (!std::isnan(most.force)) greatest = error / most.force;
  if (!std::isnan(most.way)) greatest = std::max(greatest, way / most.way);
  return greatest;
}

const PrecisionPoint* cheapest(const std::vector<PrecisionPoint>& points, const Accuracy& most) {
  const PrecisionPoint* best = nullptr;
  for (const PrecisionPoint& point : points)
    if (point.meets(most) && (best == nullptr || point.cost() < best->cost())) best = &point;
  if (best == nullptr) return nullptr;
  const double dearest = kAsDear * best->cost();
  for (const PrecisionPoint& point : points) {
    if (!point.meets(most) || point.cost() > dearest) continue;
    if (point.shipped) return &point;
    if (point.share(most) < best->share(most)) best = &point;
  }
  return best;
}

const PrecisionPoint* next_cheaper(const std::vector<PrecisionPoint>& points, const PrecisionPoint& than) {
  const PrecisionPoint* next = nullptr;
  for (const PrecisionPoint& point : points)
    if (point.failure.empty() && point.cost() * kAsDear < than.cost() &&
        (next == nullptr || point.cost() > next->cost()))
      next = &point;
  return next;
}

}  // namespace enc::trial
