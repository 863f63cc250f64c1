#include "benchmarks/deformation/fig11_contour.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"
#include "core/base/error.h"
#include "core/base/units.h"

namespace enc::bench::deformation {
namespace {

constexpr const char* kFile = "fig11_contour.csv";

double probe_radius() { return sim::ball_set(sim::BallSet::nominal).probe_radius; }

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(fmt::format("{}: {}; write it anew: docs/notes/deformation.md", name, what));
}

// The rows of one contour; from the axis outwards to below the ball's middle, anywhere near the ball.
Contour contour_of(const Reference& table, const std::string& name, double tip_radius, double depth) {
  Contour contour;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::abs(table.number(row, "tip_radius_mm") - kMmPerM * tip_radius) > 1e-6 ||
        std::abs(table.number(row, "depth_mm") - kMmPerM * depth) > 1e-6)
      continue;
    contour.emplace_back(table.number(row, "r_mm") / kMmPerM, table.number(row, "z_mm") / kMmPerM);
    const Vec2& p = contour.back();
    if (!(p[0] >= 0.0 && p.norm() > 15e-3 && p.norm() < 50e-3))
      refuse(name, fmt::format("row {} is ({}, {}) mm; expected a point of a pressed ball of 33 mm", row + 1,
                               kMmPerM * p[0], kMmPerM * p[1]));
  }
  if (contour.size() < 50 || contour.front()[0] > 0.0 || contour.back()[1] > 0.0)
    refuse(name,
           fmt::format("the contour for {} mm under a tip of {} mm is not whole ({} points); expected at "
                       "least 50 from the axis to below the ball's middle",
                       kMmPerM * depth, kMmPerM * tip_radius, contour.size()));
  return contour;
}

Fig11Contours contours(const Reference& table, const std::string& name) {
  Fig11Contours found;
  for (const double depth : fig11_depths()) {
    found.probe.push_back(contour_of(table, name, probe_radius(), depth));
    found.stylus.push_back(contour_of(table, name, kStylus, depth));
  }
  return found;
}

}  // namespace

const std::vector<double>& fig11_depths() {
  static const std::vector<double> kDepths{2e-3, 4e-3, 6e-3};
  return kDepths;
}

std::vector<PressedShell> press_fig11(double tip_radius, Fineness fineness) {
  sim::BallParameters ball = sim::ball_set(sim::BallSet::nominal);
  ball.probe_radius = tip_radius;
  return press_shell(ball, fineness.through, fineness.fine, fig11_depths());
}

double own_error(const std::vector<PressedShell>& coarse, const std::vector<Contour>& fine) {
  double most = 0.0;
  for (std::size_t d = 0; d < coarse.size(); ++d)
    most =
        std::max(most, contour_gap(coarse[d].contour, fine[d], sim::BallParameters{}.outer_radius).largest);
  return most / 3.0;
}

Fig11Contours load_fig11(const std::string& models) {
  return contours(Reference::load(models, kFile), kFile);
}
Fig11Contours parse_fig11(std::string_view text, const std::string& name) {
  return contours(Reference::parse(text, name), name);
}

Table fig11_table(const std::vector<PressedShell>& probe, const std::vector<PressedShell>& stylus,
                  double error) {
  const sim::BallParameters ball = sim::ball_set(sim::BallSet::nominal);
  Table table{"deformation_fig11_contour",
              "Contours of the pressed ball",
              {"tip_radius_mm", "depth_mm", "r_mm", "z_mm"},
              {}};
  table.source = fmt::format(
      "Contour of the outer felt surface of a pressed tennis ball (not measured: computed), for VHMR Fig "
      "11.\n"
      "Made by: ./encounter bench deformation --full --out out  (out/{}.csv)\n"
      "Axisymmetric solid, neo-Hookean Q1P0, isothermal gas, Winkler felt, rigid frictionless probe from "
      "above, "
      "clamped beyond {:g} deg of polar angle [sources/ball 2].\n"
      "Ball: outer radius {:g} mm, wall {:g} mm, felt {:g} mm, rubber E {:g} MPa, gauge pressure {:g} kPa, "
      "felt "
      "E_f {:g} MPa (S-nominal).\n"
      "Mesh: {} elements through the wall, {:g} mm long under the probe. Own error (Richardson): {:.4f} mm.",
      table.id, kClamped, kMmPerM * ball.outer_radius, kMmPerM * ball.wall, kMmPerM * ball.felt,
      1e-6 * ball.rubber_modulus, 1e-3 * ball.pressure, 1e-6 * ball.felt_modulus, kFine.through,
      kMmPerM * kFine.fine, kMmPerM * error);
  const auto add = [&](double radius, const std::vector<PressedShell>& states) {
    for (const PressedShell& state : states)
      for (const Vec2& p : state.contour)
        table.rows.push_back({fmt::format("{:g}", kMmPerM * radius),
                              fmt::format("{:g}", kMmPerM * state.depth),
                              fmt::format("{:.4f}", kMmPerM * p[0]), fmt::format("{:.4f}", kMmPerM * p[1])});
  };
  add(probe_radius(), probe);
  add(kStylus, stylus);
  return table;
}

}  // namespace enc::bench::deformation
