// What gravity compensation leaves at the tip, over the workspace: with the true masses, with wrong ones,
// with a prop that is added to m_a as the paper has it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "benchmarks/gravity/gravity.h"
#include "benchmarks/kit/statistics.h"

namespace enc::bench::gravity {
namespace {

constexpr double kBound = 0.05;                 // N: what is asked of equal masses
constexpr double kPlate = 0.020, kKey = 0.003;  // kg
constexpr std::array<double PhantomGeometry::*, 4> kMasses{&PhantomGeometry::m_a, &PhantomGeometry::m_c,
                                                           &PhantomGeometry::m_be, &PhantomGeometry::m_df};

// Every mass times 1 + off, or only some: bit i of `minus` makes the i-th lighter instead.
Laden heavier(const Laden& laden, double off, unsigned minus = 0) {
  ArmMachine machine = laden.arm.machine();
  for (std::size_t i = 0; i < kMasses.size(); ++i)
    machine.phantom.*kMasses[i] *= 1.0 + ((minus >> i & 1U) != 0 ? -off : off);
  for (ChainLink& link : machine.links) link.mass *= 1.0 + off;
  return {Arm(machine), laden.payload};
}
Laden with(const Laden& laden, double payload) { return {laden.arm, payload}; }

// The residual is linear in each mass, so the worst of masses that are each off by so much is at a corner.
Spread worst_corner(const GravityRig& rig, const ArmBox& box, double off) {
  Spread worst;
  for (unsigned minus = 0; minus < 1U << kMasses.size(); ++minus) {
    Spread spread =
        residuals(rig.believed, Compensation::exact, heavier(rig.real, off, minus), rig.encoder_step, box);
    if (!(spread.most <= worst.most)) worst = std::move(spread);
  }
  return worst;
}

// Share of the workspace where no more than a force is left.
Plot distribution(const std::vector<GravityCase>& cases) {
  Plot plot{"gravity.residual",
            "What gravity compensation leaves at the tip",
            "force left at the tip, N",
            "share of the workspace where it is no more, %",
            true,
            false,
            {}};
  for (const GravityCase& c : cases) {
    Series series{c.name, {}, {}};
    std::vector<double> force = c.spread.force;
    std::sort(force.begin(), force.end());
    const std::size_t stride = std::max<std::size_t>(1, force.size() / 100);
    for (std::size_t i = 0; i < force.size(); i += stride) {
      series.x.push_back(std::max(force[i], 1e-6));
      series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(force.size()));
    }
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

// The middle plane of the workspace, in classes of the force that is left: a map.
Plot map(const GravityRig& rig, const ArmBox& box, int n) {
  constexpr std::array<double, 5> kEdges{0.0, 0.02, 0.05, 0.10, 1e9};
  Plot plot{"gravity.map",
            "A 20 g plate, added to m_a as published",
            "x, forwards, mm",
            "z, upwards, mm",
            false,
            false,
            {}};
  plot.equal = true;
  for (std::size_t k = 0; k + 1 < kEdges.size(); ++k) {
    const bool last = k + 2 == kEdges.size();
    Series series{last ? fmt::format("more than {:.2f} N", kEdges[k])
                       : fmt::format("{:.2f} to {:.2f} N", kEdges[k], kEdges[k + 1]),
                  {},
                  {}};
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
    series.x.push_back(p.x() * 1e3);
    series.y.push_back(p.z() * 1e3);
  }
  std::erase_if(plot.series, [](const Series& s) { return s.x.empty(); });
  plot.caption =
      "Middle plane of the workspace (y = 0), seen from the side; R, where the axes of turret and upper "
      "arm meet, is at (0, 0). The error is g m l2 / 2 sin q3 of joint 3: it grows with the angle of the "
      "forearm from the vertical. Gaps are out of reach.";
  return plot;
}

Plot over_mass_error(const GravityRig& rig, const ArmBox& box) {
  Plot plot{"gravity.masses",
            "What wrong masses leave at the tip",
            "masses off by, %",
            "force left at the tip, N",
            false,
            false,
            {}};
  Series most{"all alike, worst pose", {}, {}}, typical{"all alike, median pose", {}, {}},
      corner{"each on its own, worst signs, worst pose", {}, {}};
  for (Series* s : {&most, &typical, &corner}) s->mark = Mark::both;
  for (const double percent : {-20.0, -15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0}) {
    const Spread all = residuals(rig.believed, Compensation::exact, heavier(rig.real, percent / 100.0),
                                 rig.encoder_step, box);
    for (Series* s : {&most, &typical}) s->x.push_back(percent);
    most.y.push_back(all.most);
    typical.y.push_back(all.median);
    if (percent < 0.0) continue;
    corner.x.push_back(percent);
    corner.y.push_back(worst_corner(rig, box, percent / 100.0).most);
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
              {"plant and compensation", "median, N", "worst, N", "share below 0.05 N, %"},
              {}};
  for (const GravityCase& c : cases) {
    const auto good =
        std::count_if(c.spread.force.begin(), c.spread.force.end(), [](double f) { return f <= kBound; });
    table.rows.push_back({c.name, fmt::format("{:.4f}", c.spread.median),
                          fmt::format("{:.4f}", c.spread.most),
                          fmt::format("{:.1f}", 100.0 * static_cast<double>(good) /
                                                    static_cast<double>(c.spread.force.size()))});
  }
  table.note =
      "Static, without friction; encoders in their steps. The friction of the machine, 0.04 N at its tip by "
      "its data sheet, hides what is smaller.";
  result.tables.push_back(std::move(table));
}

}  // namespace

void add_statics(const GravityRig& rig, const BenchContext& context, BenchResult& result) {
  const int n = context.quick ? 7 : 15;
  const ArmBox box = place_box(rig.real.arm, n);
  const auto left = [&](const Laden& believed, Compensation form, const Laden& real) {
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

}  // namespace enc::bench::gravity
