// Scenes that come with Encounter, whole runs of the tennis ball, and an observer that checks every tick.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::test {

using Set = std::vector<std::string>;

// A shipped scene with the rig that it names, or with this one.
[[nodiscard]] models::Setup shipped(const std::string& name, const Set& set = {},
                                    const std::string& rig = {});
[[nodiscard]] models::Setup scene(const std::string& name, const Set& set = {});
// One press of 4 mm, met 0.6 + 0.75 s after the start: 30 mm at 50 mm/s, with acceleration in the first 0.3
// s.
[[nodiscard]] Set quick(const Set& more = {});
// One slow press to the object's limit.
inline const Set kDeep{"user.approach_mm_s=[20]", "user.press_s=4", "user.hold_s=0.3", "user.release_s=2"};

trial::TrialResult run(const models::Setup& setup, trial::TrialOptions options = {});

// Checks a run for the conditions that hold under any fault.
struct Onlooker {
  double fastest = 0.0, hardest = 0.0;            // commands, m/s and m/s^2
  double true_fastest = 0.0, true_hardest = 0.0;  // of the machine
  double outside = -1.0;                          // m, of the tip outside the undeformed ball
  double moved_in_hold = 0.0;                     // m, of commands once at rest
  std::int64_t holds = 0, held = 0, ticks = 0;
  std::uint32_t reasons = 0;
  Time last_hold{};
  Mode last = Mode::away;

  void see(const trial::Glance& g);
  // Differences of commands of 0.2 m, each rounded to 2^-55 m: 1e-16 / (1e-3)^2 = 1e-10 m/s^2.
  void expect_within_limits() const;

 private:
  static double height(const trial::Glance& g);
  bool entered(const trial::Glance& g);
  Vec3 command_{0, 0, 0}, velocity_{0, 0, 0};
  double held_for_ = 0.0;
  bool entered_ = false;
};

struct ObservedRun {
  trial::TrialResult result;
  Onlooker onlooker;
};
ObservedRun look(const models::Setup& setup, trial::TrialOptions options = {},
                 std::function<void(const trial::Glance&)> also = {});

// A run of one press: the force at the limit, N; the number of contacts, and the deepest deflection, m.
double force_at_limit(const models::Setup& setup, std::int32_t& contacts, double& deepest);

}  // namespace enc::test
