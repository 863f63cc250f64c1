// The experiment of [VHMR Fig 3]: the machine renders a spring, something pushes into it from outside and
// waits. What stiffness is felt, and does the machine come to rest? One push is one whole run, in the twin or
// over devices.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/machine/loop_model.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::bench::stiffness {

// The tip does not come to rest: its way in the second half of the hold, peak to peak, is longer than this, m
// [sources/twin 6].
inline constexpr double kWander = 1e-3;

[[nodiscard]] double peak_to_peak(std::span<const double> way);
// Hz, of the strongest oscillation between 1 Hz and a quarter of the rate; NaN where nothing moves.
[[nodiscard]] double strongest_frequency(std::span<const double> signal, double dt);
// Mean under a raised cosine: what still swings does not depend on where the window cuts it.
[[nodiscard]] double steady_mean(std::span<const double> signal);

// What needs the truth is unset where nobody knows it.
struct Push {
  double stiffness = kUnset;  // N/m, commanded
  double measured = kUnset;   // N/m, the paper's way: measured force over measured displacement
  double load = kUnset;       // N/m: the same force without the error of its zero, over the true displacement
  double reading = kUnset;    // N/m: measured, from the last single reading
  double force = kUnset;      // N, measured
  double peak_to_peak = kUnset;  // m, of the true tip
  double way = kUnset;           // m, the same of where the machine says it is
  double force_noise = kUnset;   // N rms, of the measured force, less its mean
  double frequency = kUnset;     // Hz, of the measured force
  std::string held{};            // the run did: when and why
  [[nodiscard]] bool unstable() const { return !(peak_to_peak <= kWander); }
  [[nodiscard]] double error(double felt) const { return 100.0 * (felt / stiffness - 1.0); }  // %
};

// The true deflection over the whole push.
struct PushTrace {
  std::vector<double> time, deflection;  // s, m
};

// The scene `stiffness` as the paper did it: force zero found once, and nothing is too soft to be tried. Then
// what the user sets; then, stronger than that, what a variant of the experiment is made of.
[[nodiscard]] models::Setup push_setup(const std::string& models, const std::vector<std::string>& set,
                                       const std::vector<std::string>& variant = {});
// The same with another stiffness of the pushed object, N/m.
[[nodiscard]] models::Setup with_stiffness(models::Setup setup, double stiffness);
// `base` as scenes.h has it; the trace needs the truth.
[[nodiscard]] Push push_once(const models::Setup& setup, std::uint64_t seed, PushTrace* trace = nullptr,
                             const trial::TrialOptions& base = {});

// Of a scene's behaviours the index of that which is pushed.
[[nodiscard]] std::size_t pushed_behaviour(const SceneSpec& scene);
// Where a push is by the scene's times, s since the run began: before it, going in, held. In the twin the
// truth says so; over devices whoever pushes keeps to these times, and the fakes' pusher does.
enum class PushPart : std::uint8_t { rest, ramp, hold };
[[nodiscard]] PushPart part_at(const PusherSpec& pusher, double t);

// How many of some seeded pushes are unstable, over a grid of stiffnesses. Remembers what it has found.
class StabilityMap {
 public:
  static constexpr double kGrid = 1.0;  // N/m
  // `stable_share` of the pushes have to be stable for a stiffness to count as rendered.
  StabilityMap(models::Setup setup, std::uint64_t seed, std::size_t pushes, double stable_share,
               double grid = kGrid)
      : setup_(std::move(setup)), seed_(seed), pushes_(pushes), share_(stable_share), grid_(grid) {}

  // Peak-to-peak ways, m, of each push at the grid point nearest to `stiffness`, N/m.
  const std::vector<double>& at(double stiffness);
  [[nodiscard]] double unstable_share(double stiffness);
  // N/m: the lowest grid point from which on it is stable; searched by halving between stable and unstable,
  // starting from a guess. 0: stable however soft; infinite: nowhere stable.
  double lowest_stable(double guess);
  [[nodiscard]] const std::map<std::int64_t, std::vector<double>>& seen() const { return seen_; }
  [[nodiscard]] double grid() const { return grid_; }
  [[nodiscard]] double simulated() const;  // s

 private:
  [[nodiscard]] bool stable(std::int64_t point);

  models::Setup setup_;
  std::uint64_t seed_;
  std::size_t pushes_;
  double share_, grid_;
  std::map<std::int64_t, std::vector<double>> seen_;
};

// s, of one push as it is run.
[[nodiscard]] double push_time(const models::Setup& setup);
// The loop as it truly is, with the pusher in place of the hand. To the machine's delay comes one cycle of
// the command limiter (it goes half of the remaining way in each cycle), less half a cycle, by which a
// sampled filter is ahead of the continuous one. Speed and acceleration limits are not in it.
[[nodiscard]] LoopModel pushed_loop(const models::Setup& setup);

}  // namespace enc::bench::stiffness
