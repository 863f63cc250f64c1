// The machine beside its data sheet, and what was scaled to get it.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "benchmarks/gravity/gravity.h"

namespace enc::bench::gravity {
namespace {

// What the tip can push with along x, y, z of R at the zero pose, motors at these torques, one axis at a
// time, N.
Vec3 push(const Arm& arm, const PerJoint& motor_torque) {
  const Mat3 J = arm.jacobian(arm.zero());
  Vec3 most = Vec3::Constant(1e9);
  // A force along one axis needs J^T of it; the motor that gives out first is the limit.
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < arm.joints(); ++i) {
      const double lever = std::abs(J(axis, static_cast<int>(i)));
      if (lever > 1e-9)
        most(axis) = std::min(most(axis), motor_torque[i] * arm.machine().drives[i].ratio / lever);
    }
  return most;
}

// Mass that the bare tip opposes along x, y, z at the zero pose, kg.
Vec3 tip_mass(const Arm& arm) {
  const Mat3 J = arm.jacobian(arm.zero());
  return (J * arm.mass(arm.zero(), 0.0).inverse() * J.transpose()).diagonal().cwiseInverse();
}

// Smallest step of the tip that the encoders see along x, y, z there, m.
Vec3 resolution(const GravityRig& rig) {
  const Eigen::Map<const Vec3> step(rig.encoder_step.data());
  return (rig.real.arm.jacobian(rig.real.arm.zero()).cwiseAbs() * step);
}

void add_scaling(const PhantomGeometry& g, BenchResult& result) {
  Table table{"gravity.scaled",
              "Model 1.0A, scaled from the published 1.5 by s = 2/3",
              {"number", "1.5, published", "rule, s = 2/3", "1.0A, used here"},
              {}};
  const auto row = [&](const char* name, double published, const char* rule, double used, double unit,
                       const char* unit_name) {
    table.rows.push_back({fmt::format("{}, {}", name, unit_name), fmt::format("{:.5g}", published * unit),
                          rule, fmt::format("{:.5g}", used * unit)});
  };
  row("l1, upper arm", 0.20955, "s; 8.25 in become 5.5 in", g.l1, 1e3, "mm");
  row("l2, forearm", 0.169545, "s", g.l2, 1e3, "mm");
  row("l3, crank", 0.0325, "s", g.l3, 1e3, "mm");
  row("l5, centre of be", -0.0368, "s", g.l5, 1e3, "mm");
  row("l6, centre of df", 0.0527, "s", g.l6, 1e3, "mm");
  row("m_a, forearm", 0.0202, "s (a tube)", g.m_a, 1e3, "g");
  row("m_c, link", 0.0249, "s (a tube)", g.m_c, 1e3, "g");
  row("m_be, upper arm with motor", 0.2359, "same motor, the tube times s", g.m_be, 1e3, "g");
  row("m_df, crank with motor", 0.1906, "same motor, the tube times s", g.m_df, 1e3, "g");
  row("I_a.x", 0.4864e-4, "s^3", g.I_a.x(), 1e6, "kg mm2");
  row("I_c.x", 0.959e-4, "s^3", g.I_c.x(), 1e6, "kg mm2");
  row("I_be.x", 11.09e-4, "s^2", g.I_be.x(), 1e6, "kg mm2");
  row("I_df.x", 7.11e-4, "s^2", g.I_df.x(), 1e6, "kg mm2");
  row("I_base", 11.87e-4, "s^2", g.I_base, 1e6, "kg mm2");
  table.note =
      "Motors, encoders, joint limits as in the 1.5; capstan ratios times s. Least sure is l2: 113.0 mm "
      "here, "
      "often quoted as 139.7 mm.";
  result.tables.push_back(std::move(table));
}

}  // namespace

void add_catalogue(const GravityRig& rig, BenchResult& result) {
  const Arm& arm = rig.real.arm;
  const bool phantom = arm.machine().kind == ArmKind::phantom;
  const sim::ArmTruth& truth = rig.setup.twin.arm;
  const Vec3 stall = push(arm, truth.peak_torque), lasting = push(arm, truth.continuous_torque);
  const Vec3 mass = tip_mass(arm) * 1e3, step = resolution(rig) * 1e3;
  const double sheet_stall = phantom ? 8.5 : kUnset, sheet_lasting = phantom ? 1.4 : kUnset;
  const double sheet_mass = phantom ? 75.0 : kUnset, sheet_step = phantom ? 0.03 : kUnset;
  constexpr const char* kSheet =
      "paper: the maker's sheet of the 1.0A; here at the zero pose, from the motors";
  add_figure(result, "stall.max", sheet_stall, stall.maxCoeff(), "N", kSheet, 0.9 * sheet_stall,
             1.1 * sheet_stall);
  add_figure(result, "stall.min", kUnset, stall.minCoeff(), "N", "along the weakest of x, y, z");
  add_figure(result, "continuous.min", sheet_lasting, lasting.minCoeff(), "N", kSheet, sheet_lasting);
  add_figure(result, "tip_mass.max", sheet_mass, mass.maxCoeff(), "g", "paper: below 75 g; rotors included",
             kUnset, sheet_mass);
  add_figure(result, "resolution.max", sheet_step, step.maxCoeff(), "mm", kSheet, kUnset, sheet_step);
  Table table{"gravity.catalogue",
              "The machine beside its data sheet",
              {"at the zero pose", "x", "y", "z", "sheet"},
              {}};
  const auto row = [&](const char* name, const Vec3& v, const char* form, const char* sheet) {
    table.rows.push_back({name, fmt::format(fmt::runtime(form), v.x()),
                          fmt::format(fmt::runtime(form), v.y()), fmt::format(fmt::runtime(form), v.z()),
                          phantom ? sheet : ""});
  };
  row("force of stalled motors, N", stall, "{:.2f}", "8.5");
  row("for hours, N", lasting, "{:.2f}", "1.4");
  row("mass felt at the tip, g", mass, "{:.1f}", "< 75");
  row("resolution, mm", step, "{:.4f}", "0.03");
  result.tables.push_back(std::move(table));
  if (!phantom) return;
  add_scaling(arm.machine().phantom, result);
  const ArmBox box = place_box(arm, 5);
  add_figure(result, "coverage.best.share_percent", kUnset, 100.0 * box.share, "%",
             "of 125 points of 13 x 25 x 18 cm within joint and coupled limits, box where most are", 90.0);
  add_figure(result, "coverage.ahead.share_percent", kUnset,
             100.0 * share_in_reach(arm, {arm.machine().phantom.l1, 0, 0}, 5), "%",
             "box about (l1, 0, 0) of R");
  ArmMachine longer = arm.machine();
  longer.phantom.l2 = longer.phantom.l1;
  add_figure(result, "coverage.long_forearm.share_percent", kUnset,
             100.0 * share_in_reach(Arm(longer), {longer.phantom.l1, 0, 0}, 5), "%", "the same with l2 = l1");
}

}  // namespace enc::bench::gravity
