// Error against computing time of a scene: the result of each integrator and time step of its twin, compared
// with a converged run. That run has an equal scene and seed, and so an equal hand.
//
// The error is the true force on the held body, N rms, over the ticks with a touch in either run. Two
// converged runs differ slightly: a sensor count that falls the other way goes around the loop. This
// difference is about the floor; a smaller error is luck. Other quantities of a run may replace the force.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::trial {

// Largest allowed errors; unset: no limit.
struct Accuracy {
  double force = kUnset;  // N rms, or the unit of Quantities
  double way = kUnset;    // m rms, of the tip's path
};

struct PrecisionPoint {
  std::string integrator;
  double step = 0.0;      // s
  double error = kUnset;  // N rms, by the judge with the larger value; unset: it failed
  double way = kUnset;    // m rms, true tip over all ticks
  double least_error = kUnset, least_way = kUnset;  // the smaller value of the two judges
  double cpu = kUnset;                              // s for each second of experiment, median of some runs
  std::string failure{};                            // reason for a missing error
  double yards = kUnset;                            // cost of a tick in yardsticks, median of some runs
  double spread = kUnset;                           // largest over smallest of these runs
  bool shipped = false;                             // the scene's default setting
  // Cost that compares settings; both costs come from the same run.
  [[nodiscard]] double cost() const { return std::isnan(yards) ? cpu : yards; }
  // Error over the allowed error, the larger of the two; infinite for a failed point.
  [[nodiscard]] double share(const Accuracy& most) const;
  [[nodiscard]] bool meets(const Accuracy& most) const { return share(most) <= 1.0; }
};

struct Spread {
  double least = kUnset, most = kUnset;
};
struct Precision {
  std::string table;  // rig table with timestep_us and integrator: "truth.world"
  std::vector<PrecisionPoint> points;
  PrecisionPoint converged;  // main judge of all points; the larger error of both judges counts
  PrecisionPoint second;     // the other converged run; its error and path error are the floor
  double seconds = 0.0;      // s of experiment
  double tick = 1e-3;        // s
  std::int64_t touched = 0;  // ticks with a touch, in the converged run
  [[nodiscard]] std::vector<std::string> settings(const PrecisionPoint& point) const;  // arguments for --set
  // Range of the error by a third converged run, which may differ from both judges by the floor, as they do.
  [[nodiscard]] Spread error_spread(const PrecisionPoint& point) const;  // N rms
  [[nodiscard]] Spread way_spread(const PrecisionPoint& point) const;    // m rms
};

// Costs within this factor count as equal, because times are not known more accurately.
inline constexpr double kAsDear = 1.1;

struct Grid {
  std::vector<std::string> integrators{"implicitfast", "euler", "rk4", "discrete"};
  std::vector<int> parts{1, 2, 4, 8};  // divisors of the haptic period that give the step
};

// Largest difference over the largest true value. Unset if a value is not finite, all true ones are 0, or the
// numbers of values differ.
[[nodiscard]] double apart(std::span<const double> some, std::span<const double> truth);
// Other results of a run than its force: numbers of one unit, compared by apart() with a converged run's.
class Quantities {
 public:
  Quantities() = default;
  virtual ~Quantities() = default;
  Quantities(const Quantities&) = delete;
  Quantities& operator=(const Quantities&) = delete;
  virtual void see(const Glance& glance) = 0;
  [[nodiscard]] virtual std::vector<double> all() const = 0;  // valid while the trial is alive
};
// Makes the quantities of a run with these options; it may change them, except `watch`.
using QuantityMaker = std::function<std::unique_ptr<Quantities>(const models::Setup&, TrialOptions&)>;

struct PrecisionOptions {
  std::uint64_t seed = 1;
  double seconds = 12.0;        // longest time; without a touch by then, the scene's whole programme
  std::function<double()> cpu;  // s of computing time of this thread or process so far
  int rounds = 3;               // number of timings of each point, all in turn
  Grid grid{};
  bool shipped_too = true;  // adds the shipped setting, even if it is not in the grid
  int converged = 50;       // parts of a period in the main judge (RK4); the other one has twice as many
  bool twice = true;        // also judges by the other one; the larger error counts
  // Times a fixed piece of work now, s; costs are also reported relative to it. Empty: no relative costs.
  std::function<double()> yardstick{};
  QuantityMaker quantities{};  // compared instead of the force; empty: the force
  DriverSource drivers{};      // drivers, for a scene with a camera
  std::function<void(double)> progress{};
};

// The scene with these settings; later ones take precedence.
using SetupWith = std::function<models::Setup(const std::vector<std::string>& set)>;

// Throws Error for a scene without a simulated hand, which cannot touch anything.
[[nodiscard]] Precision precision_of(const SetupWith& setup_with, const PrecisionOptions& options);

// The scene's default setting; null: not among the points, because settings have replaced it.
[[nodiscard]] const PrecisionPoint* shipped(const std::vector<PrecisionPoint>& points);
// The cheapest point with this accuracy; null: no such point. Within a tenth of its cost, the default setting
// wins, otherwise the smallest error.
[[nodiscard]] const PrecisionPoint* cheapest(const std::vector<PrecisionPoint>& points, const Accuracy& most);
// The most expensive point that is cheaper than this one; null: no such point.
[[nodiscard]] const PrecisionPoint* next_cheaper(const std::vector<PrecisionPoint>& points,
                                                 const PrecisionPoint& than);

}  // namespace enc::trial
