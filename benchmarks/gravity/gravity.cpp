// Gravity compensation of the arm [VisHap 2.3.2, eq. 4 and 5]: the force left at the tip over the workspace,
// the cost of the published way to add a prop, the machine beside its catalogue, the race against KDL.
#include "benchmarks/gravity/gravity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>

#include <Eigen/LU>
#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/peers/peers.h"
#include "core/devices/module.h"
#include "sim/spec/arm_spec.h"

namespace enc::bench::gravity {
namespace {

// The 13 x 18 x 25 cm of [VisHap 1] in front of the arm, and the joints at its grid points. Its place in x
// and z keeps most of it within the limits. No source gives the axes of its sides; here x is the shortest, y
// (sideways) the longest.
struct ArmBox {
  static constexpr std::array<double, 3> kSize{0.13, 0.25, 0.18};  // m
  Vec3 centre{0, 0, 0};                                            // in R, m
  double share = 0.0;                                              // share of points within the limits
  std::vector<PerJoint> poses;
  std::vector<Vec3> points;  // tip positions of these poses, in R
};

struct Spread {
  std::vector<double> force;  // N, at each pose
  double median = kUnset, most = kUnset;
};

struct GravityCase {
  std::string name;
  Spread spread;
};

// The force that gravity compensation leaves at the tip over the workspace: with the true masses, with wrong
// ones, and with a prop that is added to m_a as in the paper.

constexpr double kBound = 0.05;  // N: bound for equal masses
constexpr double kKey = 0.003;   // kg
constexpr std::array<double PhantomGeometry::*, 4> kMasses{&PhantomGeometry::m_a, &PhantomGeometry::m_c,
                                                           &PhantomGeometry::m_be, &PhantomGeometry::m_df};

// Every mass times 1 + off, except those with a bit in `minus`: bit i makes the i-th lighter instead.
LoadedArm heavier(const LoadedArm& laden, double off, unsigned minus = 0) {
  ArmMachine machine = laden.arm.machine();
  for (std::size_t i = 0; i < kMasses.size(); ++i)
    machine.phantom.*kMasses[i] *= 1.0 + ((minus >> i & 1U) != 0 ? -off : off);
  for (ChainLink& link : machine.links) link.mass *= 1.0 + off;
  return {Arm(machine), laden.payload};
}
LoadedArm with(const LoadedArm& laden, double payload) { return {laden.arm, payload}; }

// Force with which the tip pushes (or must be held) at a pose when the device applies the force that the core
// computes [eq. 4, 5]: J_real^-T (J_believed^T F_gc - gravity_real). Joints are read in the encoders' steps.
// N.
Vec3 residual(const LoadedArm& believed, Compensation form, const LoadedArm& real,
              const PerJoint& encoder_step, const PerJoint& q) {
  const PerJoint weight = real.arm.gravity(q, real.payload, Payload::exact);
  PerJoint left{};
  for (std::size_t i = 0; i < kMostJoints; ++i) left[i] = -weight[i];
  if (form != Compensation::none) {
    PerJoint read = q;
    for (std::size_t i = 0; i < kMostJoints; ++i)
      if (encoder_step[i] > 0.0) read[i] = encoder_step[i] * std::round(q[i] / encoder_step[i]);
    const Mat3 J = believed.arm.jacobian(read);
    const PerJoint wanted = believed.arm.gravity(
        read, believed.payload, form == Compensation::exact ? Payload::exact : Payload::published);
    const PerJoint motors = believed.arm.torque(J, believed.arm.force(J, wanted));
    for (std::size_t i = 0; i < kMostJoints; ++i) left[i] += motors[i];
  }
  return real.arm.force(real.arm.jacobian(q), left).e();
}

Spread residuals(const LoadedArm& believed, Compensation form, const LoadedArm& real,
                 const PerJoint& encoder_step, const ArmBox& box) {
  Spread spread;
  for (const PerJoint& q : box.poses)
    spread.force.push_back(residual(believed, form, real, encoder_step, q).norm());
  if (spread.force.empty()) return spread;
  spread.median = median(spread.force);
  spread.most = *std::max_element(spread.force.begin(), spread.force.end());
  return spread;
}

// The residual is linear in each mass, so the worst case of masses with a bounded error is at a corner.
Spread worst_corner(const GravityRig& rig, const ArmBox& box, double off) {
  Spread worst;
  for (unsigned minus = 0; minus < 1U << kMasses.size(); ++minus) {
    Spread spread =
        residuals(rig.believed, Compensation::exact, heavier(rig.real, off, minus), rig.encoder_step, box);
    if (!(spread.most <= worst.most)) worst = std::move(spread);
  }
  return worst;
}

// Share of the workspace where at most a given force is left.
Plot distribution(const std::vector<GravityCase>& cases) {
  Plot plot{"gravity.residual", "What gravity compensation leaves at the tip", "force left at the tip, N",
            "share of the workspace where it is no more, %", true};
  for (const GravityCase& c : cases) {
    Series series{c.name};
    std::vector<double> force = c.spread.force;
    std::sort(force.begin(), force.end());
    const std::size_t stride = std::max<std::size_t>(1, force.size() / 100);
    for (std::size_t i = 0; i < force.size(); i += stride)
      series.add(std::max(force[i], 1e-6),
                 100.0 * static_cast<double>(i + 1) / static_cast<double>(force.size()));
    plot.series.push_back(std::move(series));
  }
  plot.series.push_back({"asked for with equal masses", {kBound, kBound}, {0.0, 100.0}});
  plot.caption =
      "Farther left is better. With equal masses only the steps of the encoders are left. A prop that is "
      "added to "
      "m_a, as published, leaves what joint 3 does not get: half of its weight there. Masses that are off, "
      "or a prop "
      "that the core is not told of, leave as much or more; without compensation the whole weight pushes.";
  return plot;
}

// The middle plane of the workspace, in classes of the residual force: a map.
Plot map(const GravityRig& rig, const ArmBox& box, int n) {
  constexpr std::array<double, 5> kEdges{0.0, 0.02, 0.05, 0.10, 1e9};
  Plot plot{"gravity.map", "A 20 g plate, added to m_a as published", "x, forwards, mm", "z, upwards, mm"};
  plot.equal = true;
  for (std::size_t k = 0; k + 1 < kEdges.size(); ++k) {
    const bool last = k + 2 == kEdges.size();
    Series series{last ? fmt::format("more than {:.2f} N", kEdges[k])
                       : fmt::format("{:.2f} to {:.2f} N", kEdges[k], kEdges[k + 1])};
    series.mark = Mark::points;
    plot.series.push_back(std::move(series));
  }
  for (int i = 0; i < n * n; ++i) {
    const int across = i % n, up = i / n;
    const Vec3 p = box.centre + Vec3(ArmBox::kSize[0] * (across / (n - 1.0) - 0.5), 0.0,
                                     ArmBox::kSize[2] * (up / (n - 1.0) - 0.5));
    PerJoint q;
    if (!rig.real.arm.inverse(Point<'R'>(p), q)) continue;
    const double force = residual(with(rig.believed, kPlate), Compensation::published, with(rig.real, kPlate),
                                  rig.encoder_step, q)
                             .norm();
    const auto above = std::upper_bound(kEdges.begin() + 1, kEdges.end() - 1, force);
    Series& series = plot.series[static_cast<std::size_t>(above - kEdges.begin()) - 1];
    series.add(p.x() * 1e3, p.z() * 1e3);
  }
  std::erase_if(plot.series, [](const Series& s) { return s.x.empty(); });
  plot.caption =
      "Middle plane of the workspace (y = 0), seen from the side; R, where the axes of turret and upper "
      "arm meet, is at (0, 0). The error is g m l2 / 2 sin q3 of joint 3: it grows with the angle of the "
      "forearm from the vertical. Gaps are out of reach.";
  return plot;
}

Plot over_mass_error(const GravityRig& rig, const ArmBox& box) {
  Plot plot{"gravity.masses", "What wrong masses leave at the tip", "masses off by, %",
            "force left at the tip, N"};
  Series most{"all alike, worst pose"}, typical{"all alike, median pose"},
      corner{"each on its own, worst signs, worst pose"};
  for (Series* s : {&most, &typical, &corner}) s->mark = Mark::both;
  for (const double percent : {-20.0, -15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0}) {
    const Spread all = residuals(rig.believed, Compensation::exact, heavier(rig.real, percent / 100.0),
                                 rig.encoder_step, box);
    for (Series* s : {&most, &typical}) s->x.push_back(percent);
    most.y.push_back(all.most);
    typical.y.push_back(all.median);
    if (percent < 0.0) continue;
    corner.add(percent, worst_corner(rig, box, percent / 100.0).most);
  }
  plot.series = {most, typical, corner};
  plot.caption =
      "Straight lines, because gravity is linear in the masses. Where all are off alike the counterweights "
      "be and df hide a part of it; the worst signs are those where they add up.";
  return plot;
}

void add_cases(const std::vector<GravityCase>& cases, BenchResult& result) {
  Table table{"gravity.residuals",
              "Force left at the tip over the workspace",
              {"plant and compensation", "median, N", "worst, N", "share below 0.05 N, %"}};
  for (const GravityCase& c : cases) {
    const auto good =
        std::count_if(c.spread.force.begin(), c.spread.force.end(), [](double f) { return f <= kBound; });
    table.rows.push_back(
        {c.name, fixed(c.spread.median, 4), fixed(c.spread.most, 4),
         fixed(100.0 * static_cast<double>(good) / static_cast<double>(c.spread.force.size()), 1)});
  }
  table.note =
      "Static, without friction; encoders in their steps. The friction of the machine, 0.04 N at its tip by "
      "its data sheet, hides what is smaller.";
  result.tables.push_back(std::move(table));
}

// The machine beside its data sheet, and the scaling that was needed.

// Largest push of the tip along x, y, z of R at the zero pose with these motor torques, one axis at a time,
// N.
Vec3 push(const Arm& arm, const PerJoint& motor_torque) {
  const Mat3 J = arm.jacobian(arm.zero());
  Vec3 most = Vec3::Constant(1e9);
  // A force along one axis needs J^T of it; the first motor at its limit sets the bound.
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < arm.joints(); ++i) {
      const double lever = std::abs(J(axis, static_cast<int>(i)));
      if (lever > 1e-9)
        most(axis) = std::min(most(axis), motor_torque[i] * arm.machine().drives[i].ratio / lever);
    }
  return most;
}

// Effective mass of the bare tip along x, y, z at the zero pose, kg.
Vec3 tip_mass(const Arm& arm) {
  const Mat3 J = arm.jacobian(arm.zero());
  return (J * arm.mass(arm.zero(), 0.0).inverse() * J.transpose()).diagonal().cwiseInverse();
}

// Smallest step of the tip that the encoders resolve along x, y, z at the zero pose, m.
Vec3 resolution(const GravityRig& rig) {
  const Eigen::Map<const Vec3> step(rig.encoder_step.data());
  return (rig.real.arm.jacobian(rig.real.arm.zero()).cwiseAbs() * step);
}

void add_scaling(const PhantomGeometry& g, BenchResult& result) {
  Table table{"gravity.scaled",
              "Model 1.0A, scaled from the published 1.5 by s = 2/3",
              {"number", "1.5, published", "rule, s = 2/3", "1.0A, used here"}};
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

// Kinematics, Jacobian, gravity and J^T f of one pose: closed form and chain against Orocos KDL. All get
// equal poses in one run with interleaved chunks; ours takes part twice.

constexpr std::size_t kPoses = 10'000, kChunk = 250;

// A PHANToM in KDL's form: three hinges in a row, each with its angle against the one before. The links of
// the parallelogram are left out, to the peer's advantage.
ArmMachine in_a_row(const ArmMachine& machine, double payload) {
  const PhantomGeometry& g = machine.phantom;
  ArmMachine row = machine;
  row.kind = ArmKind::chain;
  row.links = {{"turret", JointKind::hinge, {0, 0, 1}, {0, 0, 0}, 0.0, {0, 0, 0}, Vec3::Constant(g.I_base)},
               {"upper arm", JointKind::hinge, {0, -1, 0}, {0, 0, 0}, g.m_be, {g.l5, 0, 0}, g.I_be},
               {"forearm", JointKind::hinge, {0, -1, 0}, {g.l1, 0, 0}, g.m_a, {0, 0, -0.5 * g.l2}, g.I_a}};
  row.tip = {0, 0, -g.l2};
  // The prop, at the tip, is a part of the last link.
  ChainLink& last = row.links.back();
  last.centre = (last.mass * last.centre + payload * row.tip) / (last.mass + payload);
  last.mass += payload;
  return row;
}
PerJoint relative(const PerJoint& q) { return {q[0], q[1], q[2] - q[1]}; }

struct Question {
  PerJoint q, relative;
  Vec<'R'> force;
};
std::vector<Question> questions(const Arm& arm, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Question> all;
  while (all.size() < kPoses) {
    PerJoint q{};
    for (std::size_t i = 0; i < arm.joints(); ++i)
      q[i] = uniform(arm.machine().drives[i].low, arm.machine().drives[i].high);
    if (!arm.within_limits(q)) continue;
    all.push_back({q, relative(q), Vec<'R'>(uniform(-8, 8), uniform(-8, 8), uniform(-8, 8))});
  }
  return all;
}

ArmAnswer answer(const Arm& arm, const PerJoint& q, const Vec<'R'>& force, double payload) {
  const Mat3 J = arm.jacobian(q);
  ArmAnswer answer{arm.tip(q).e(), arm.gravity(q, payload, Payload::exact)};
  const PerJoint push = arm.torque(J, force);
  for (std::size_t i = 0; i < kMostJoints; ++i) answer.torque[i] += push[i];
  return answer;
}

using Answers = std::vector<ArmAnswer>;
// Largest difference between the two: tips, m, and torques, N m.
std::array<double, 2> apart(const Answers& a, const Answers& b) {
  std::array<double, 2> most{0.0, 0.0};
  for (std::size_t i = 0; i < kPoses; ++i) {
    most[0] = std::max(most[0], (a[i].tip - b[i].tip).norm());
    for (std::size_t j = 0; j < kMostJoints; ++j)
      most[1] = std::max(most[1], std::abs(a[i].torque[j] - b[i].torque[j]));
  }
  return most;
}

// The i-th of n places along each axis, in the order x, y, z: from -0.5 to 0.5.
Vec3 place_in_cube(int i, int n) {
  const int x = i % n, y = i / n % n, z = i / (n * n);
  return Vec3(x, y, z) / (n - 1) - Vec3::Constant(0.5);
}

double share_in_reach(const Arm& arm, const Vec3& centre, int n) {
  int reached = 0;
  PerJoint q;
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 p = centre + place_in_cube(i, n).cwiseProduct(Eigen::Map<const Vec3>(ArmBox::kSize.data()));
    if (arm.inverse(Point<'R'>(p), q)) ++reached;
  }
  return static_cast<double>(reached) / (n * n * n);
}

ArmBox place_box(const Arm& arm, int n) {
  constexpr double kStep = 0.005;
  ArmBox box;
  const double reach = arm.tip(arm.zero()).e().norm();
  const int ahead = static_cast<int>(1.3 * reach / kStep), high = static_cast<int>(2.0 * reach / kStep);
  for (int i = 0; i <= ahead; ++i)
    for (int k = 0; k <= high; ++k) {
      const Vec3 centre(i * kStep, 0.0, k * kStep - reach);
      const double share = share_in_reach(arm, centre, 5);
      if (share <= box.share) continue;
      box.share = share;
      box.centre = centre;
    }
  const Vec3 size = Eigen::Map<const Vec3>(ArmBox::kSize.data());
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 p = box.centre + place_in_cube(i, n).cwiseProduct(size);
    PerJoint q;
    if (!arm.inverse(Point<'R'>(p), q)) continue;
    box.poses.push_back(q);
    box.points.push_back(p);
  }
  return box;
}

GravityRig gravity_rig(const BenchContext& context) {
  models::Setup setup = load_scene(context, "wall");
  const double prop = setup.scene.prop ? setup.scene.prop->mass : 0.0;
  GravityRig rig{{Arm(setup.rig.arm.machine), prop},
                 {Arm(sim::true_machine(setup.twin.arm)), prop},
                 {},
                 std::move(setup)};
  for (std::size_t i = 0; i < rig.real.arm.joints(); ++i)
    rig.encoder_step[i] =
        2.0 * M_PI / (rig.setup.twin.arm.counts[i] * rig.real.arm.machine().drives[i].ratio);
  return rig;
}

void add_statics(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  const int n = context.quick ? 7 : 15;
  const ArmBox box = place_box(rig.real.arm, n);
  const auto left = [&](const LoadedArm& believed, Compensation form, const LoadedArm& real) {
    return residuals(believed, form, real, rig.encoder_step, box);
  };
  const auto prop = [&](double mass, Compensation form) {
    return left(with(rig.believed, mass), form, with(rig.real, mass));
  };
  using enum Compensation;
  const std::vector<GravityCase> cases{
      {"equal masses, prop at the tip (exact)", left(rig.believed, exact, rig.real)},
      {"plate of 20 g added to m_a (published)", prop(kPlate, published)},
      {"key of 3 g added to m_a (published)", prop(kKey, published)},
      {"all masses 15 % heavier", left(rig.believed, exact, heavier(rig.real, 0.15))},
      {"each mass 15 % off, worst signs", worst_corner(rig, box, 0.15)},
      {"plate that is not told of", left(with(rig.believed, 0.0), exact, with(rig.real, kPlate))},
      {"no compensation", left(rig.believed, none, rig.real)},
  };
  add_cases(cases, result);
  const std::string where = fmt::format("{} poses in 13 x 25 x 18 cm about x = {:.0f}, z = {:.0f} mm of R",
                                        box.poses.size(), box.centre.x() * 1e3, box.centre.z() * 1e3);
  add_figure(result, "residual.equal_masses.max", kUnset, cases[0].spread.most, "N", where, kUnset, kBound);
  add_figure(result, "residual.plate_published.max", kUnset, cases[1].spread.most, "N",
             "20 g through m_a, which gives joint 3 half of it");
  add_figure(result, "residual.plate_published.p50", kUnset, cases[1].spread.median, "N", "");
  add_figure(result, "residual.key_published.max", kUnset, cases[2].spread.most, "N", "3 g through m_a",
             kUnset, kBound);
  add_figure(result, "residual.heavier_15_percent.max", kUnset, cases[3].spread.most, "N",
             "all masses alike");
  add_figure(result, "residual.worst_15_percent.max", kUnset, cases[4].spread.most, "N",
             "each mass on its own, worst signs");
  add_figure(result, "residual.plate_forgotten.max", kUnset, cases[5].spread.most, "N", "");
  add_figure(result, "residual.none.max", kUnset, cases[6].spread.most, "N", "what makes the arm fall");
  result.plots.push_back(distribution(cases));
  result.plots.push_back(over_mass_error(rig, box));
  if (rig.real.arm.machine().kind == ArmKind::phantom)
    result.plots.push_back(map(rig, box, context.quick ? 13 : 27));
}

// Shares of the paper's box that the PHANToM reaches: where most of it is, ahead, and with a longer forearm.
void add_coverage(const Arm& arm, BenchResult& result) {
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
  Table table{
      "gravity.catalogue", "The machine beside its data sheet", {"at the zero pose", "x", "y", "z", "sheet"}};
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
  add_coverage(arm, result);
}

// Null if KDL was not built.
std::unique_ptr<ArmPeer> kdl_of(const BenchContext& context, const ArmMachine& machine) {
  const ModuleInfo* module = context.module ? context.module("peers") : nullptr;
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  return peers != nullptr && peers->kdl != nullptr ? peers->kdl(machine) : nullptr;
}

double nanoseconds(const Race& raced, std::size_t way) { return raced.seconds(way) / kChunk * 1e9; }

// Times of the race's ways: the closed form twice, our chain, KDL's chain; and the answers of the two chains.
void add_kdl(const Race& raced, std::size_t own, const Answers& chain, const Answers& theirs,
             BenchResult& result) {
  add_cost(result, "statics.kdl.p50", nanoseconds(raced, 3), "ns",
           "Orocos KDL, chain of three hinges without the parallelogram's links");
  add_cost(result, "kdl_ratio.median", raced.ratio(3, own), "x",
           "KDL over the closed form, chunks of 250 interleaved", 5.0);
  add_cost(result, "kdl_ratio.chain.median", raced.ratio(3, 2), "x", "KDL over our chain, the same machine");
  const auto [tip, torque] = apart(chain, theirs);
  add_figure(result, "apart_from_kdl.tip.max", kUnset, tip, "m", "our chain against KDL", kUnset, 1e-12);
  add_figure(result, "apart_from_kdl.torque.max", kUnset, torque, "N m", "our chain against KDL", kUnset,
             1e-12);
}

void add_race(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  const Arm& arm = rig.believed.arm;
  if (arm.machine().kind != ArmKind::phantom) {
    result.note += "no race: it is about the closed form of the PHANToM. ";
    return;
  }
  const Arm row(in_a_row(arm.machine(), rig.believed.payload));
  ArmMachine peer = arm.machine();
  if (context.mutated("longer_arm")) peer.phantom.l1 *= 1.001;
  const std::unique_ptr<ArmPeer> kdl = kdl_of(context, in_a_row(peer, rig.believed.payload));
  const std::vector<Question> all = questions(arm, context.seed);
  Answers ours(kPoses), chain(kPoses), theirs(kPoses);
  const auto closed = in_chunks(kPoses, kChunk, [&](std::size_t i) {
    ours[i] = answer(arm, all[i].q, all[i].force, rig.believed.payload);
  });
  std::vector<std::function<void()>> ways{closed, closed, in_chunks(kPoses, kChunk, [&](std::size_t i) {
                                            chain[i] = answer(row, all[i].relative, all[i].force, 0.0);
                                          })};
  if (kdl)
    ways.push_back(in_chunks(
        kPoses, kChunk, [&](std::size_t i) { theirs[i] = kdl->answer(all[i].relative, all[i].force.e()); }));
  constexpr std::size_t kLap = kPoses / kChunk;
  const Race raced(context.count(10, 2) * kLap, ways, kLap);
  add_cost(result, "statics.p50", nanoseconds(raced, 0), "ns",
           "kinematics, Jacobian, gravity, J^T f of one pose, closed form; over chunks of 250");
  add_cost(result, "statics.chain.p50", nanoseconds(raced, 2), "ns", "the same of a chain of three hinges");
  add_cost(result, "same_over_same.median", raced.ratio(1, 0), "x",
           "ours over ours in the same run: how far the machine can be trusted");
  if (!kdl) {
    result.note += "no race: Orocos KDL was not there when this was built (./encounter bench installs it). ";
    return;
  }
  add_kdl(raced, context.mutated("chain") ? 2 : 0, chain, theirs, result);
}

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const GravityRig rig = gravity_rig(context);
  add_statics(rig, context, result);
  if (context.progress) context.progress(0.5);
  add_catalogue(rig, result);
  add_twin(rig, context, result);
  if (context.progress) context.progress(0.7);
  add_race(rig, context, result);
}

}  // namespace

void add_figure(BenchResult& result, const std::string& id, double paper, double twin, const char* unit,
                const std::string& note, double low, double high) {
  const Role role = std::isnan(paper) ? Role::ours : Role::predicted;
  result.figures.push_back({"gravity." + id, paper, twin, unit, role, low, high, note});
}

void add_cost(BenchResult& result, const std::string& id, double value, const char* unit,
              const std::string& note, double low, double high) {
  add_figure(result, id, kUnset, value, unit, note, low, high);
  result.figures.back().cost = true;
}

const Reads kReads{
    "gravity",
    {.only = {"prop.mass_kg", "rig.arm.machine", "truth.arm.machine", "truth.arm.mass_scale",
              "truth.arm.counts", "truth.arm.timestep_us", "truth.arm.integrator", "truth.arm.friction_Nm",
              "truth.arm.viscous_Nms", "truth.arm.peak_torque_Nm", "truth.arm.continuous_torque_Nm"}}};
const Entry kEntry{"gravity", "wall",
                   "gravity compensation of the arm: residual force over the workspace, catalogue, race "
                   "against KDL (VisHap eq. 5)",
                   run};

}  // namespace enc::bench::gravity
