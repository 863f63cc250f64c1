// A device along one way in MuJoCo, with a computed wall of its own loop and delay line: the other side of
// the certificate, assembled apart from it. Knows nothing of core/control/safety/certificate.
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
  // Held at x0, m, for as long as the wall looks back, and let go.
  Slide(const Device& device, const Wall& wall, const Stepping& stepping, double x0);
  void period();  // one of the wall's; throws Error where MuJoCo warns
  // The same with another law's force, N, and one that pushes besides.
  void period(double force, double hand = 0.0);
  [[nodiscard]] double x() const { return physics_.data()->qpos[0]; }
  [[nodiscard]] double read() const;  // by the encoder
  [[nodiscard]] double speed() const { return physics_.data()->qvel[0]; }
  void throw_from(double x, double speed);
  [[nodiscard]] double work() const { return work_; }     // J, of the law's force since the beginning
  [[nodiscard]] double pushes() const { return force_; }  // N: the law's that acts

 private:
  Device device_;
  Wall wall_;
  int steps_;
  sim::Physics physics_;
  std::int64_t step_ = 0, late_;                           // steps
  double before_;                                          // m, read a period ago
  double force_;                                           // N, that acts
  double work_ = 0.0;                                      // J
  std::deque<std::pair<std::int64_t, double>> under_way_;  // from which step on, N
};

// 1/s: how quickly a swing grows (above 0) or dies out, without friction and counts, from the readings of the
// last half of a run.
[[nodiscard]] double growth(const Device& device, const Wall& wall, const Stepping& stepping);
// N/m: where it changes its sign. Looked for from `most` downwards, or around `near` where that is given; 0:
// it grows down to 0.5 N/m; infinite: it does not at `most`.
[[nodiscard]] double critical(const Device& device, double damper, const Stepping& stepping, double near,
                              double most);

enum class Outcome : std::uint8_t { still, cycle, away, unknown };
// What becomes of a device that is let go x0 beside the wall's edge: `still` where in the last quarter of the
// time it swings by less than 1 % of that, or less than 0.9 of the quarter before; `away` where it has left
// 20 times that, or swings wider than 1.1 of the quarter before. Where a count pushes more than friction
// holds, (K + 2 |B|/T) count > 2 friction, a swing that shrinks is watched on, until it is one of these;
// `unknown` where it is none after eight times the time.
[[nodiscard]] Outcome let_go(const Device& device, const Wall& wall, const Stepping& stepping, double x0);

}  // namespace enc::bench::stability
