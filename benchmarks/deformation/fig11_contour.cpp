#include "benchmarks/deformation/fig11_contour.h"

#include <cmath>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "sim/bodies/ball_plant.h"

namespace enc::bench::deformation {
namespace {

constexpr const char* kFile = "fig11_contour.csv";

double probe_radius() { return sim::ball_set(sim::BallSet::nominal).probe_radius; }

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(fmt::format("{}: {}; take the file of the repository anew", name, what));
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

Fig11Contours load_fig11(const std::string& models) {
  return contours(Reference::load(models, kFile), kFile);
}
Fig11Contours parse_fig11(std::string_view text, const std::string& name) {
  return contours(Reference::parse(text, name), name);
}

}  // namespace enc::bench::deformation
