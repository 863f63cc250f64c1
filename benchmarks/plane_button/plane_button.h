// Parts of the benchmark `plane_button`: runs of wall and button in the twin, and their analysis.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "trial/trial.h"

namespace enc::bench::plane_button {

// A run, tick by tick, from the ground truth; `believed` is the depth that the core assumed. A law is a force
// over the depth of the device. The finger is deeper, by what its pad yields.
struct PressTrace {
  std::vector<double> t;         // s
  std::vector<double> depth;     // depth of the prop's front under the surface, m
  std::vector<double> finger;    // depth of the finger, m
  std::vector<double> believed;  // m
  std::vector<double> force;     // true contact force along the normal, N
  std::vector<double> side;      // across it, N
  std::vector<double> gain;      // lambda_z of eq. 7
  std::vector<double> speed;     // speed of the tip, m/s
  std::vector<sim::Phase> phase;
  std::vector<char> contact;  // the core's mode
  trial::TrialResult run;
  double cpu = 0.0;  // s of its thread
  [[nodiscard]] std::size_t size() const { return t.size(); }
};

// The rendered law of the first object of a scene, with the user's settings.
struct Law {
  InteractionSpec does;
  double stiffness = kUnset;  // N/m, at the touched place
  double free = kUnset;       // K_p
};
[[nodiscard]] Law law_of(const BenchContext& context, const std::string& scene);

// The scene with the benchmark's settings before the user's.
[[nodiscard]] PressTrace press_trace(const BenchContext& context, const std::string& scene,
                                     std::vector<std::string> own, double seconds = kUnset);

// Settings of a finger that is tracked each tick, without noise: the remaining error is the display's. No
// picture leaps, so the target needs little time to settle.
[[nodiscard]] std::vector<std::string> live(std::vector<std::string> more);

// Straight line through the force of a phase, over a depth from `low` to `high`.
struct Line {
  double slope = kUnset, r2 = kUnset;  // N/m
  std::int64_t n = 0;
};
enum class Depth : std::uint8_t { device, finger, believed };
[[nodiscard]] Line line_of(const PressTrace& trace, sim::Phase phase, Depth of, double low, double high);

// Largest change of the force from one tick to the next, N, in contact and deeper than `low`. `beyond`:
// subtracts the change of a spring of this stiffness, N/m, for the motion in that tick.
[[nodiscard]] double greatest_step(const PressTrace& trace, double low, double beyond = 0.0);
// Lag of the believed depth behind the true one, s: the shift with the least mean square difference.
[[nodiscard]] double lag_of(const PressTrace& trace);

// Force over depth, the mean of pressing and releasing: friction and damping, which oppose the motion,
// cancel.
struct Curve {
  std::vector<double> depth, force;  // m, N
};
[[nodiscard]] Curve curve_of(const PressTrace& trace, sim::Phase phase, double low, double high,
                             double width);

// Mean of pressing and releasing, as the paper averages the force: damping and friction cancel, and the
// hand's drift, which changes its speed, averages out.
inline constexpr double kBin = 0.02e-3;  // m, of a mean curve
[[nodiscard]] Curve mean_curve(const PressTrace& trace, double low, double high, double width);

[[nodiscard]] Line line_of(const Curve& curve);

// Parts of the result.
class Report {
 public:
  explicit Report(BenchResult& result) : result_(result) {}
  void figure(const std::string& id, double value, const char* unit, const std::string& note,
              double low = kUnset, double high = kUnset) const;
  void cost(const std::string& id, double value, const char* unit, const std::string& note,
            double high = kUnset) const {
    figure(id, value, unit, note, kUnset, high);
    result_.figures.back().cost = true;
  }
  [[nodiscard]] BenchResult& result() const { return result_; }

 private:
  BenchResult& result_;
};
void measure_button(const BenchContext& context, const Report& report);

}  // namespace enc::bench::plane_button
