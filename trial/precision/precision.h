// Error against run time of a scene: what each integrator and time step of its twin makes of it, judged by a
// converged run of the same scene, the same seed and so the same hand.
//
// The error is the true force on what is held, N rms over the ticks at which it touches in either run. Two
// converged runs do not agree to the last digit: a count of a sensor that falls the other way goes round the
// loop. What those two differ by is about the floor: what errs by less does so by luck. In place of the force
// other quantities of a run may be compared.
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

// What may be off at most; unset: by anything.
struct Accuracy {
  double force = kUnset;  // N rms, or as Quantities has it
  double way = kUnset;    // m rms, of the tip's path
};

struct PrecisionPoint {
  std::string integrator;
  double step = 0.0;                                // s
  double error = kUnset;                            // N rms, by the judge that says more; unset: it failed
  double way = kUnset;                              // m rms, of the true tip over all ticks
  double least_error = kUnset, least_way = kUnset;  // by the judge that says less
  double cpu = kUnset;     // s for each second of experiment, the median of some runs
  std::string failure{};   // why it has no error
  double yards = kUnset;   // what a tick cost in yardsticks, the median of some runs
  double spread = kUnset;  // greatest over least of these runs
  bool shipped = false;    // what the scene does without being told
  // What settings are compared by: both are of the same run.
  [[nodiscard]] double cost() const { return std::isnan(yards) ? cpu : yards; }
  // The error over what is allowed, the greater of the two; of what failed infinite.
  [[nodiscard]] double share(const Accuracy& most) const;
  [[nodiscard]] bool meets(const Accuracy& most) const { return share(most) <= 1.0; }
};

struct Spread {
  double least = kUnset, most = kUnset;
};
struct Precision {
  std::string table;  // of the rig, where timestep_us and integrator stand: "truth.world"
  std::vector<PrecisionPoint> points;
  PrecisionPoint converged;  // what all are judged by, and by the second: the greater error counts
  PrecisionPoint second;     // the other converged run; its error and way are the floor
  double seconds = 0.0;      // of experiment
  double tick = 1e-3;        // s
  std::int64_t touched = 0;  // ticks, in the converged run
  [[nodiscard]] std::vector<std::string> settings(const PrecisionPoint& point) const;  // for --set
  // Range of the error by a third converged run: it may differ from the two judges by the floor, as they do.
  [[nodiscard]] Spread error_spread(const PrecisionPoint& point) const;  // N rms
  [[nodiscard]] Spread way_spread(const PrecisionPoint& point) const;    // m rms
};

// What costs less than so many times as much is as dear: times are not known better.
inline constexpr double kAsDear = 1.1;

struct Grid {
  std::vector<std::string> integrators{"implicitfast", "euler", "rk4", "discrete"};
  std::vector<int> parts{1, 2, 4, 8};  // of the haptic period: a step is one of them
};

// The greatest difference over the greatest true value; unset where one is not finite, all true ones are 0,
// or there are not as many.
[[nodiscard]] double apart(std::span<const double> some, std::span<const double> truth);
// What a run comes to besides its force: numbers of one unit, that are apart() from those of a converged run.
class Quantities {
 public:
  Quantities() = default;
  virtual ~Quantities() = default;
  Quantities(const Quantities&) = delete;
  Quantities& operator=(const Quantities&) = delete;
  virtual void see(const Glance& glance) = 0;
  [[nodiscard]] virtual std::vector<double> all() const = 0;  // while the trial lives
};
// Of a run that will have these options, to which it may add, but for `watch`.
using QuantitiesOf = std::function<std::unique_ptr<Quantities>(const models::Setup&, TrialOptions&)>;

struct PrecisionOptions {
  std::uint64_t seed = 1;
  double seconds = 12.0;        // at most; where nothing touches by then, all of the scene's programme
  std::function<double()> cpu;  // s, that this thread or process has taken so far
  int rounds = 3;               // each point is timed so often, all in turn
  Grid grid{};
  bool shipped_too = true;  // what ships is a point, though the grid has it not
  int converged = 50;  // parts of a period, of the run that judges (RK4); the other one has twice as many
  bool twice = true;   // also judged by that other one: what errs more counts
  // A fixed piece of work, timed now, s: costs are told in it, too. Empty: they are not.
  std::function<double()> yardstick{};
  QuantitiesOf quantities{};  // compared in place of the force; empty: the force
  DriverSource drivers{};     // of a scene with a camera
  std::function<void(double)> progress{};
};

// The scene with these settings, later ones win.
using SetupWith = std::function<models::Setup(const std::vector<std::string>& set)>;

// Throws Error for a scene in which nothing can touch: without a simulated hand.
[[nodiscard]] Precision precision_of(const SetupWith& setup_with, const PrecisionOptions& options);

// What the scene does without being told; null: not among them, as settings have put another in its place.
[[nodiscard]] const PrecisionPoint* shipped(const std::vector<PrecisionPoint>& points);
// The cheapest that is so accurate; null: none. What costs the same within a tenth is as cheap: then
// what the scene does anyway, else what errs least.
[[nodiscard]] const PrecisionPoint* cheapest(const std::vector<PrecisionPoint>& points, const Accuracy& most);
// The dearest of those that are cheaper than this one; null: none.
[[nodiscard]] const PrecisionPoint* next_cheaper(const std::vector<PrecisionPoint>& points,
                                                 const PrecisionPoint& than);

}  // namespace enc::trial
