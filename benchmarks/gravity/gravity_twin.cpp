// The arm's equations against the twin's: torque and mass at random poses; and a free swing at many time
// steps and with all integrators, against a solution without MuJoCo.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "benchmarks/gravity/gravity.h"
#include "benchmarks/kit/cost.h"
#include "sim/bodies/arm_model.h"

namespace enc::bench::gravity {
namespace {

// The twin's bodies alone, without devices.
struct TwinArm {
  sim::Physics physics;
  sim::ArmBody body;

  void set(const PerJoint& q, const PerJoint& rate) {
    mj_resetData(physics.model(), physics.data());
    body.put(physics.data(), q, rate);
    mj_forward(physics.model(), physics.data());
  }
  // N m, at a pose at rest: the torque that the motors need against gravity.
  [[nodiscard]] Vec3 weight() const {
    const PerJoint load = body.load(physics.data());
    return {load[0], load[1], load[2]};
  }
};

TwinArm twin_arm(const LoadedArm& laden, double timestep, mjtIntegrator integrator,
                 const PerJoint& friction = {}, const PerJoint& viscous = {}) {
  sim::install_mujoco_handlers();
  sim::SpecPtr spec(mj_makeSpec());
  spec->compiler.degree = false;  // limits are in rad
  spec->option.timestep = timestep;
  spec->option.integrator = integrator;
  spec->option.gravity[2] = -kStandardGravity;
  sim::ArmTruth truth;
  truth.friction = friction;
  truth.viscous = viscous;
  PropSpec prop;
  prop.mass = laden.payload;
  const ArmMachine& machine = laden.arm.machine();
  sim::build_arm(spec.get(), {machine, truth, &prop, Pose<'W', 'R'>::identity()});
  sim::Physics physics(std::move(spec));
  sim::ArmBody body(physics, laden.arm.joints());
  return {std::move(physics), body};
}

PerJoint random_pose(const Arm& arm, std::mt19937_64& random) {
  PerJoint q{};
  do {
    for (std::size_t i = 0; i < arm.joints(); ++i)
      q[i] = std::uniform_real_distribution<double>(arm.machine().drives[i].low,
                                                    arm.machine().drives[i].high)(random);
  } while (!arm.within_limits(q));
  return q;
}

// Largest differences of ours from the twin's: gravity, N m, and mass matrix, relative.
std::array<double, 2> apart(const LoadedArm& laden, TwinArm& twin, const PerJoint& q, double believed) {
  twin.set(q, {});
  const PerJoint ours = laden.arm.gravity(q, believed, Payload::exact);
  const Mat3 M = twin.body.mass(twin.physics.model(), twin.physics.data());
  return {(twin.weight() - Vec3(ours[0], ours[1], ours[2])).cwiseAbs().maxCoeff(),
          (M - laden.arm.mass(q, believed)).norm() / M.norm()};
}

void add_equations(const LoadedArm& laden, const BenchContext& context, BenchResult& result) {
  TwinArm twin = twin_arm(laden, 0.001, mjINT_EULER);
  std::mt19937_64 random(context.seed);
  double torque = 0.0, mass = 0.0;
  const double believed = context.mutated("other_payload") ? 0.5 * laden.payload : laden.payload;
  for (int i = 0; i < 1'000; ++i) {
    const auto [t, m] = apart(laden, twin, random_pose(laden.arm, random), believed);
    torque = std::max(torque, t);
    mass = std::max(mass, m);
  }
  add_figure(result, "torque_apart_from_mujoco.max", kUnset, torque, "N m",
             "eq. 5, prop at the tip, against the weight of the simulated bodies; 1,000 random poses", kUnset,
             1e-9);
  add_figure(result, "mass_apart_from_mujoco.max", kUnset, 100.0 * mass, "%",
             "mass matrix against that of the bodies", kUnset, 1.0);
  Plot plot{"gravity.torque", "Eq. 5 against the simulated bodies", "joint angle, deg",
            "torque of the joint, mN m"};
  for (const std::size_t joint : {1U, 2U}) {
    Series eq5{fmt::format("q{}: eq. 5", joint + 1)}, bodies{fmt::format("q{}: MuJoCo", joint + 1), {}, {}};
    bodies.mark = Mark::points;
    for (int degree = -120; degree <= 210; degree += 3) {
      PerJoint q{};
      q[1] = q[2] = degree * M_PI / 180.0;  // the fold at 0: both within their limits, or nothing is drawn
      if (!laden.arm.within_limits(q)) continue;
      eq5.add(degree, 1e3 * laden.arm.gravity(q, laden.payload, Payload::exact)[joint]);
      if (degree % 15 != 0) continue;
      twin.set(q, {});
      bodies.add(degree, 1e3 * twin.weight()(static_cast<int>(joint)));
    }
    plot.series.push_back(std::move(eq5));
    plot.series.push_back(std::move(bodies));
  }
  plot.caption =
      "Both joints at the same angle, upper arm and forearm at right angles, with the scene's prop. The "
      "points are the bodies of the simulated arm, put together by MuJoCo.";
  result.plots.push_back(std::move(plot));
}

// The arm without MuJoCo: M q'' = -(M' q' - grad(q' M q') / 2) - g, with M's slopes by central differences.
// Runge and Kutta's fourth order at `h`.
struct Motion {
  Vec3 q, rate;
};
PerJoint per_joint(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Vec3 acceleration(const LoadedArm& laden, const Motion& s) {
  constexpr double kStep = 1e-5;
  Vec3 load = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 aside = kStep * Vec3::Unit(k);
    const Mat3 slope = (laden.arm.mass(per_joint(s.q + aside), laden.payload) -
                        laden.arm.mass(per_joint(s.q - aside), laden.payload)) /
                       (2.0 * kStep);
    load += slope * s.rate * s.rate(k);
    load(k) -= 0.5 * s.rate.dot(slope * s.rate);
  }
  const PerJoint g = laden.arm.gravity(per_joint(s.q), laden.payload, Payload::exact);
  return -laden.arm.mass(per_joint(s.q), laden.payload).inverse() * (load + Vec3(g[0], g[1], g[2]));
}

Motion runge_kutta(const LoadedArm& laden, const Motion& s, double h) {
  const auto slope = [&](const Motion& at) { return Motion{at.rate, acceleration(laden, at)}; };
  const auto go = [&](const Motion& by, double way) {
    return Motion{s.q + way * by.q, s.rate + way * by.rate};
  };
  const Motion a = slope(s), b = slope(go(a, h / 2)), c = slope(go(b, h / 2)), d = slope(go(c, h));
  return {s.q + h / 6 * (a.q + 2 * b.q + 2 * c.q + d.q),
          s.rate + h / 6 * (a.rate + 2 * b.rate + 2 * c.rate + d.rate)};
}

constexpr double kMostStep = 8.0;  // steps of the reference
constexpr double kSample = 0.004;  // s: every time step divides it
const Motion kStart{{-0.2, 0.35, 0.30}, {4.0, -1.5, 2.0}};

// The tip's path while the joints stay within their limits, in samples.
std::vector<Vec3> reference(const LoadedArm& laden, int samples) {
  constexpr int kSteps = 100;  // steps of 40 us in a sample
  std::vector<Vec3> path;
  Motion s = kStart;
  while (static_cast<int>(path.size()) < samples && laden.arm.within_limits(per_joint(s.q))) {
    path.push_back(laden.arm.tip(per_joint(s.q)).e());
    for (int i = 0; i < kSteps; ++i) s = runge_kutta(laden, s, kSample / kSteps);
  }
  path.pop_back();  // the last sample may be beside a limit
  return path;
}

struct IntegratorResult {
  double error = 0.0;              // m, worst distance from the reference's path
  double cost = 0.0;               // s of CPU time for each second of experiment
  double over_reference = kUnset;  // a step over one of the reference, median
};
IntegratorResult swing(const LoadedArm& laden, const std::vector<Vec3>& path, double timestep,
                       mjtIntegrator integrator, int laps, const PerJoint& friction = {},
                       const PerJoint& viscous = {}) {
  TwinArm twin = twin_arm(laden, timestep, integrator, friction, viscous);
  const auto steps = static_cast<int>(std::lround(kSample / timestep));
  IntegratorResult worked{0.0, 1e9};
  std::vector<double> slices, reference;  // s, of `steps` steps each, in turn: a busy computer slows both
  constexpr double kFine = 40e-6;         // s
  for (int lap = 0; lap < laps; ++lap) {
    twin.set(per_joint(kStart.q), per_joint(kStart.rate));
    double spent = 0.0;
    for (const Vec3& tip : path) {
      const Vec3 at = laden.arm.tip(twin.body.joints(twin.physics.data())).e();
      worked.error = std::max(worked.error, at.allFinite() ? (at - tip).norm() : 1.0);
      const double start = thread_seconds();
      for (int i = 0; i < steps; ++i) twin.physics.step();
      slices.push_back(thread_seconds() - start);
      spent += slices.back();
      Motion beside = kStart;
      const double then = thread_seconds();
      for (int i = 0; i < steps; ++i) beside = runge_kutta(laden, beside, kFine);
      reference.push_back(thread_seconds() - then);
      worked.error = std::max(worked.error, beside.q.allFinite() ? 0.0 : 1.0);
    }
    worked.cost = std::min(worked.cost, spent / (kSample * static_cast<double>(path.size())));
  }
  worked.over_reference = median(slices) / median(reference);
  return worked;
}

constexpr std::array<std::pair<const char*, mjtIntegrator>, 4> kIntegrators{
    {{"euler", mjINT_EULER},
     {"implicitfast", mjINT_IMPLICITFAST},
     {"implicit", mjINT_IMPLICIT},
     {"rk4", mjINT_RK4}}};

// Error against run time of the swing, of each integrator over its time steps.
void add_swing_curves(const LoadedArm& laden, const std::vector<Vec3>& path, const BenchContext& context,
                      BenchResult& result) {
  Plot plot{"gravity.swing",
            "A free swing of the arm: error against run time",
            "CPU time for each second, s",
            "worst error of the tip, mm",
            true,
            true};
  Table table{"gravity.swing",
              "A free swing of the arm",
              {"integrator", "time step, us", "worst error, mm", "CPU s/s"}};
  const std::vector<double> timesteps =
      context.quick ? std::vector<double>{0.002, 0.001}
                    : std::vector<double>{0.004, 0.002, 0.001, 0.0005, 0.00025, 0.000125};
  for (const auto& [name, integrator] : kIntegrators) {
    Series series{name};
    series.mark = Mark::both;
    for (const double timestep : timesteps) {
      const IntegratorResult worked = swing(laden, path, timestep, integrator, context.quick ? 2 : 5);
      series.add(worked.cost, worked.error * 1e3);
      table.rows.push_back({name, fmt::format("{:g}", timestep * 1e6),
                            fmt::format("{:.3g}", worked.error * 1e3), fixed(worked.cost, 4)});
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption = fmt::format(
      "{:.0f} ms without motors and friction, from turning joints, with the scene's prop; the reference is "
      "solved from mass matrix and eq. 5 without MuJoCo. Farther down and left is better.",
      1e3 * kSample * static_cast<double>(path.size() - 1));
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
}

// Error and cost of the swing with the rig's own integrator and time step.
void add_swing_as_shipped(const LoadedArm& laden, const std::vector<Vec3>& path, const sim::ArmTruth& truth,
                          const BenchContext& context, BenchResult& result) {
  const auto* own = std::find_if(kIntegrators.begin(), kIntegrators.end(),
                                 [&](const auto& i) { return truth.integrator == i.first; });
  if (own == kIntegrators.end()) return;
  const IntegratorResult used = swing(laden, path, truth.timestep, own->second, 5);
  add_figure(result, "swing.error.max", kUnset, used.error * 1e3, "mm",
             fmt::format("of the tip, free swing, {} at {:g} us as the rig has it", truth.integrator,
                         truth.timestep * 1e6),
             kUnset, 0.05);
  add_cost(result, "swing.times_real_time", 1.0 / used.cost, "x", "the arm's bodies, without friction");
  const IntegratorResult rubbed =
      swing(laden, path, truth.timestep, own->second, 15, truth.friction, truth.viscous);
  add_cost(result, "twin.times_real_time", 1.0 / rubbed.cost, "x",
           fmt::format("the same with dry and viscous friction, {} at {:g} us; CPU time of the thread",
                       truth.integrator, truth.timestep * 1e6));
  add_cost(result, "twin.step_over_reference.median",
           (context.mutated("three_times") ? 3.0 : 1.0) * rubbed.over_reference, "x",
           "a step of it over a step of the solution without MuJoCo, in turn", kUnset, kMostStep);
}

void add_swing(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  const LoadedArm& laden = rig.real;
  const std::vector<Vec3> path = reference(laden, 75);
  if (path.size() < 10) {
    result.note += "no free swing: it leaves the joint limits at once. ";
    return;
  }
  add_swing_curves(laden, path, context, result);
  add_swing_as_shipped(laden, path, rig.setup.twin.arm, context, result);
}

// Motion of the tip in ten seconds when only gravity compensation drives the motors, at 1 kHz from the
// encoders' readings; or when nothing drives them.
struct DriftTrace {
  std::vector<double> time, way;  // s, mm
  double dexterity = 0.0;         // at the end
};
DriftTrace left_alone(const GravityRig& rig, double payload, double told, Compensation form,
                      const PerJoint& friction) {
  const sim::ArmTruth& truth = rig.setup.twin.arm;
  const Arm& believed = rig.believed.arm;
  const LoadedArm laden{rig.real.arm, payload};
  TwinArm twin = twin_arm(laden, 0.001, mjINT_RK4, friction, truth.viscous);
  const PerJoint start{0.1, 0.2, 0.4};
  twin.set(start, {});
  const Vec3 home = laden.arm.tip(start).e();
  DriftTrace still;
  for (int tick = 0; tick <= 10'000; ++tick) {
    PerJoint q = twin.body.joints(twin.physics.data());
    if (tick % 50 == 0) {
      still.time.push_back(1e-3 * tick);
      still.way.push_back(1e3 * (laden.arm.tip(q).e() - home).norm());
      still.dexterity = laden.arm.dexterity(laden.arm.jacobian(q));
    }
    for (std::size_t i = 0; i < kMostJoints; ++i)
      q[i] = rig.encoder_step[i] * std::round(q[i] / rig.encoder_step[i]);
    const Mat3 J = believed.jacobian(q);
    if (form != Compensation::none)
      twin.body.drive(twin.physics.data(),
                      believed.torque(J, believed.force(J, believed.gravity(q, told, Payload::exact))));
    twin.physics.step();
  }
  return still;
}

void add_drift(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  using enum Compensation;
  struct Case {
    const char *id, *name;
    double payload;
    Compensation form;
    bool friction;
  };
  constexpr std::array<Case, 4> kCases{
      {{"drift.plate.max", "20 g plate, compensated", kPlate, exact, true},
       {"drift.bare.max", "bare tip, compensated", 0.0, exact, true},
       {"drift.no_friction.max", "20 g plate, compensated, no dry friction", kPlate, exact, false},
       {"fall.bare.max", "bare tip, not compensated", 0.0, none, true}}};
  Plot plot{"gravity.drift", "Left alone for ten seconds", "time, s", "way of the tip, mm", false, true};
  for (const Case& c : kCases) {
    const DriftTrace still =
        left_alone(rig, c.payload, context.mutated("other_payload") ? kPlate - c.payload : c.payload, c.form,
                   c.friction ? rig.setup.twin.arm.friction : PerJoint{});
    Series series{c.name, still.time, still.way};
    for (double& way : series.y) way = std::max(way, 1e-4);
    plot.series.push_back(std::move(series));
    const double most = *std::max_element(still.way.begin(), still.way.end());
    const bool held = c.form != none;
    add_figure(result, c.id, kUnset, most, "mm",
               held ? "in 10 s, bodies, encoders and gravity compensation alone"
                    : fmt::format("in 10 s; where it ends the dexterity is {:.2f}", still.dexterity),
               kUnset, held && c.friction ? 1.0 : kUnset);
  }
  plot.caption =
      "Without compensation the arm falls to its limits: the counterweight was made for a gimbal that is not "
      "there, and lifts the upper arm. With it, dry friction holds what the steps of the encoders leave. No "
      "control of the position takes part here.";
  result.plots.push_back(std::move(plot));
}

}  // namespace

void add_twin(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  if (rig.real.arm.machine().kind != ArmKind::phantom) return;
  add_equations(rig.real, context, result);
  add_swing(rig, context, result);
  add_drift(rig, context, result);
}

}  // namespace enc::bench::gravity
