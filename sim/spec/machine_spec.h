// Ground truth of the physics, the machine, its gripper and its pusher: [truth.world], [truth.solver],
// [truth.hexapod], [truth.structure], [truth.gripper], [truth.pusher]. A part of twin_spec.h.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/machine/hexapod.h"

namespace enc::sim {

// MuJoCo's method for contacts and dry friction.
enum class Cone : std::uint8_t { elliptic, pyramidal };
constexpr auto words(Cone) { return enum_words("elliptic", "pyramidal"); }
struct SolverTruth {
  Cone cone = Cone::elliptic;
  double impratio = 20.0;     // friction's impedance over that of the stop: friction without creep
  double noslip = kUnset;     // steps of the pass that removes creep; unset: 4, and 0 with an arm
  double iterations = 100.0;  // most iterations of Newton's method
  double tolerance = 1e-12;   // tolerance of Newton's method
};

struct WorldTruth {
  double timestep = 0.001;  // s
  std::string integrator = "implicitfast";
  double tip_friction = 0.6;    // tool on haptic-tip
  double contact_time = 0.005;  // s, stop between tool and tip: hard, not a rendered stiffness
};

struct Stepping {
  double timestep;  // s
  std::string integrator;
  std::string table;  // table of the file with both keys

  // Physics steps in a haptic period (rate in Hz); 0 if the time step does not divide it.
  [[nodiscard]] int steps_per_tick(double rate) const {
    const double steps = 1.0 / (rate * timestep);
    const double whole = std::round(steps);
    return whole >= 1.0 && std::abs(steps - whole) <= 1e-6 * whole ? static_cast<int>(whole) : 0;
  }
};

// Values of every key `integrator`, by MuJoCo's names.
inline constexpr auto kIntegrators = enum_words("euler", "rk4", "implicit", "implicitfast", "discrete");

enum class HexapodForm : std::uint8_t {
  control,    // the platform's pose is prescribed: exactly at the servo's pose, no sag, no modes
  structural  // the platform is a free body on six legs with stiffness and damping (sim/bodies/legs.h)
};
constexpr auto words(HexapodForm) { return enum_words("control", "structural"); }

struct HexapodTruth {
  HexapodForm form = HexapodForm::control;
  HexapodGeometry geometry;
  double servo = 15.0;  // Hz, natural frequency of the position loop
  double damping = 0.8;
  std::int64_t delay_cycles = 4;
  double speed = 0.050;           // m/s
  double acceleration = 0.41;     // m/s^2
  double step = 3e-6;             // m, quantisation of commands
  double repeatability = 0.5e-6;  // m rms along each axis: scatter of a command's final pose between moves
  double tip_radius = 0.005;      // m
  double mass = 0.91;             // kg, behind the sensor
  Vec3 misplaced{0, 0, 0};        // machine against the rig's X_WR, m
  Vec3 turned{0, 0, 0};           // machine's rotation against X_WR, rad
};

// The legs and their load, in the structural form. It has its own time step, so that a single key switches
// the form.
struct StructureTruth {
  double timestep = 0.0005;  // s
  std::string integrator = "rk4";
  double leg_stiffness = 2e6;  // N/m
  double leg_damping = 0.05;   // ratio, for a leg that carries a sixth of the moved mass (legs.h)
  double platform_mass =
      2.5;               // kg, including the sensor's machine side; the mass behind the sensor adds to it
  double payload = 0.0;  // kg, added after the calibration of the zero
};

// A gripper with two jaws that clamps a tool.
struct GripperTruth {
  double stroke = 0.008;           // m, each jaw
  double closing_time = 0.21;      // s, over the whole stroke
  double force_min = 54.0;         // N
  double force_max = 215.0;        // N
  double repeatability = 0.02e-3;  // m rms, position of the jaws
  double width = 0.006;            // m, object between the jaws; 0: no object
};

// A pusher outside of the machine, a hand or a stand: a spring to its intended position, and a damper.
struct PusherTruth {
  double stiffness = 40.0;   // N/m: calibrated (docs/notes/stiffness.md); "firm": 1000
  double damping = 1.0;      // N s/m
  double tremor = 0.005;     // N rms
  double tremor_rate = 8.1;  // Hz
};

}  // namespace enc::sim
