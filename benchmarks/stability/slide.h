// A device along one axis in MuJoCo, with a computed wall of its own loop and delay line: the counterpart of
// the certificate, written independently. It uses nothing of core/control/safety/certificate.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "sim/bodies/mujoco.h"

namespace enc::bench::stability {

struct Device {
  double mass = 0.1, damping = 0.2;                               // kg, N s/m
  double period = 1e-3, delay = 0.0;                              // s, of the wall
  double hand_mass = 0.0, hand_damping = 0.0, hand_spring = 0.0;  // kg, N s/m, N/m to the ground
  double friction = 0.0, count = 0.0;                             // N, dry; m, of the encoder
};
struct Wall {
  double stiffness = 0.0, damper = 0.0;  // N/m, N s/m
};

enum class Scheme : std::uint8_t { rk4, euler, implicitfast };
inline constexpr auto kSchemes = {Scheme::rk4, Scheme::euler, Scheme::implicitfast};
[[nodiscard]] const char* name_of(Scheme scheme);

// Steps in a period of the wall: the delay must be a whole number of steps.
struct Stepping {
  Scheme scheme = Scheme::rk4;
  int steps = 1;
};

class Slide {
 public:
  // Holds the device at x0, m, until the wall's history is full, and releases it.
  Slide(const Device& device, const Wall& wall, const Stepping& stepping, double x0);
  void period();  // one period of the wall; throws Error if MuJoCo warns
  // A period with another law's force, N, and an additional push.
  void period(double force, double hand = 0.0);
  [[nodiscard]] double x() const { return physics_.data()->qpos[0]; }
  [[nodiscard]] double read() const;  // by the encoder
  [[nodiscard]] double speed() const { return physics_.data()->qvel[0]; }
  void throw_from(double x, double speed);
  [[nodiscard]] double work() const { return work_; }     // J, work of the law's force since the beginning
  [[nodiscard]] double pushes() const { return force_; }  // N: the law's present force

 private:
  Device device_;
  Wall wall_;
  int steps_;
  sim::Physics physics_;
  std::int64_t step_ = 0, late_;                           // steps
  double before_;                                          // m, the reading one period ago
  double force_;                                           // N, that acts
  double work_ = 0.0;                                      // J
  std::deque<std::pair<std::int64_t, double>> under_way_;  // first step of each force; force, N
};

// 1/s: growth rate of a swing (above 0: it grows), without friction and counts, from the readings of the last
// half of a run.
[[nodiscard]] double growth(const Device& device, const Wall& wall, const Stepping& stepping);
// N/m: stiffness at which the growth changes its sign. Searched from `most` downwards, or around `near` if it
// is given. 0: it grows down to 0.5 N/m; infinite: it does not grow at `most`.
[[nodiscard]] double critical(const Device& device, double damper, const Stepping& stepping, double near,
                              double most);

enum class Outcome : std::uint8_t { still, cycle, away, unknown };
// Outcome of a device that is released x0 beside the wall's edge. `still`: in the last quarter of the time it
// swings by less than 1 % of x0, or less than 0.9 of the quarter before. `away`: it has left 20 x0, or swings
// wider than 1.1 of the quarter before. If a count pushes more than friction holds, (K + 2 |B|/T) count > 2
// friction, a shrinking swing is watched on until it is one of these; `unknown` after eight times the time.
[[nodiscard]] Outcome let_go(const Device& device, const Wall& wall, const Stepping& stepping, double x0);

}  // namespace enc::bench::stability
