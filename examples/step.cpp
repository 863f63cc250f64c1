// Steps the haptic core without devices: a stylus approaches a virtual wall, touches it and presses.
#include "core/control/step.h"

#include <algorithm>
#include <cstdio>

using namespace enc;

int main() {
  SceneSpec spec;  // contents of a scene file, in SI units
  const double stiffness = 2000.0, top = 0.008;
  spec.behaviours = {{.name = "wall", .curves = {{stiffness}, {stiffness}, 0.006}}};
  spec.objects = {{.name = "wall", .shape = ShapeKind::plane, .position = {0, 0, top}, .behaviour = "wall"}};
  spec.tools = {{.name = "stylus", .tip = {0, 0, -0.120}, .tip_radius = 0.002}};
  spec.manipulator = ManipulatorSpec{}, spec.force = ForceSpec{}, spec.tracker = TrackerSpec{};
  const Scene scene = prepare(spec, RigSpec{});

  Inputs in;                                            // readings of the devices
  State state;                                          // state of the core between steps
  Outputs out;                                          // commands to the machine
  Pose<'R', 'H'> machine = scene.reach.machine.zero();  // an ideal machine: it is at its commanded pose
  for (Tick tick; tick.index < 5000; ++tick.index, tick.t += tick.dt) {
    // Your devices go here. The simulated hand is as stiff as a person's and aims 8 mm below the surface.
    const double wanted = std::max(top + 0.030 - 0.010 * seconds(tick.t.time_since_epoch()), top - 0.008);
    const double tip = (scene.X_WR * machine.origin()).xyz[2] + scene.tip_radius;
    const double low = std::max(wanted, tip), press = 700.0 * (low - wanted);
    const Vec<'W'> push(0, 0, -press), weight(0, 0, -9.80665 * scene.force.mass);
    const Pose<'W', 'T'> X_WT(Quat::Identity(), Vec3(0, 0, low + 0.002 + 0.120));
    in.tool = {{0, scene.X_WC.inverse() * X_WT}, tick.t, Health::ok};
    in.tip = {{machine, Vec<'R'>::zero(), Vec<'R'>::zero()}, tick.t, Health::ok};
    const Pose<'F', 'W'> X_FW = (scene.X_WR * machine * scene.X_HF).inverse();
    in.wrench = {{X_FW * (push + weight), Vec<'F'>::zero()}, tick.t, Health::ok};
    step(scene, tick, in, state, out);
    machine = out.manipulator.tip;
    if (tick.index % 500 == 0)
      std::printf("%4d ms  %-8s gap %5.1f mm  deflection %4.2f mm  force %4.2f N\n", int(tick.index),
                  mode_name(out.mode).data(), 1e3 * out.gap, 1e3 * out.deflection, press);
  }
}
