// The experiment of [VHMR Fig 3]: the machine renders a spring; a pusher presses it from outside and waits.
// Measures the rendered stiffness, and whether the machine comes to rest. One push is one whole run, in the
// twin or over devices.
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

// The tip does not come to rest if its path in the second half of the hold, peak to peak, is longer than
// this, m [sources/twin 6].
inline constexpr double kWander = 1e-3;

[[nodiscard]] double peak_to_peak(std::span<const double> way);
// Hz, of the strongest oscillation between 1 Hz and a quarter of the rate; NaN without motion.
[[nodiscard]] double strongest_frequency(std::span<const double> signal, double dt);
// Mean under a raised cosine: a remaining oscillation does not depend on where the window cuts it.
[[nodiscard]] double steady_mean(std::span<const double> signal);

// Values that need the ground truth are unset without it.
struct Push {
  double stiffness = kUnset;     // N/m, commanded
  double measured = kUnset;      // N/m, the paper's way: measured force over measured displacement
  double load = kUnset;          // N/m: that force without its zero error, over the true displacement
  double reading = kUnset;       // N/m: like `measured`, from the last single reading
  double force = kUnset;         // N, measured
  double peak_to_peak = kUnset;  // m, of the true tip
  double way = kUnset;           // m, peak to peak of the position that the machine reports
  double force_noise = kUnset;   // N rms, of the measured force, less its mean
  double frequency = kUnset;     // Hz, of the measured force
  std::string held{};            // time and reason of a hold of the run
  [[nodiscard]] bool unstable() const { return !(peak_to_peak <= kWander); }
  [[nodiscard]] double error(double felt) const { return 100.0 * (felt / stiffness - 1.0); }  // %
};

// The true deflection over the whole push.
struct PushTrace {
  std::vector<double> time, deflection;  // s, m
};

// The scene `stiffness` as in the paper: the force zero is found once, and no stiffness is refused as too
// low. The user's settings override it; the settings of a variant of the experiment override those.
[[nodiscard]] models::Setup push_setup(const std::string& models, const std::vector<std::string>& set,
                                       const std::vector<std::string>& variant = {});
// The set-up with another stiffness of the pushed object, N/m.
[[nodiscard]] models::Setup with_stiffness(models::Setup setup, double stiffness);
// `base` as in scenes.h; the trace needs the ground truth.
[[nodiscard]] Push push_once(const models::Setup& setup, std::uint64_t seed, PushTrace* trace = nullptr,
                             const trial::TrialOptions& base = {});

// Index of the pushed object's behaviour in the scene.
[[nodiscard]] std::size_t pushed_behaviour(const SceneSpec& scene);
// Part of a push by the scene's times, s since the run began: before it, going in, held. In the twin the
// ground truth gives it. Over devices the person who pushes keeps to these times, as does the fakes' pusher.
enum class PushPart : std::uint8_t { rest, ramp, hold };
[[nodiscard]] PushPart part_at(const PusherSpec& pusher, double t);

// Number of unstable pushes of several seeded ones, over a grid of stiffnesses. Caches its results.
class StabilityMap {
 public:
  static constexpr double kGrid = 1.0;  // N/m
  // A stiffness counts as rendered if `stable_share` of its pushes are stable.
  StabilityMap(models::Setup setup, std::uint64_t seed, std::size_t pushes, double stable_share,
               double grid = kGrid)
      : setup_(std::move(setup)), seed_(seed), pushes_(pushes), share_(stable_share), grid_(grid) {}

  // Peak-to-peak paths, m, of each push at the grid point nearest to `stiffness`, N/m.
  const std::vector<double>& at(double stiffness);
  [[nodiscard]] double unstable_share(double stiffness);
  // N/m: the lowest grid point that is stable with all points above it; searched by halving between stable
  // and unstable, starting from a guess. 0: stable however soft; infinite: never stable.
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

// s, duration of one push.
[[nodiscard]] double push_time(const models::Setup& setup);
// The true loop, with the pusher in place of the hand. The command limiter adds one cycle to the machine's
// delay: it goes half of the remaining way in each cycle. Half a cycle is subtracted, by which a sampled
// filter leads the continuous one. Speed and acceleration limits are left out.
[[nodiscard]] LoopModel pushed_loop(const models::Setup& setup);

}  // namespace enc::bench::stiffness
