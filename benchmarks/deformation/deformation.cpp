// Fig 11 as a number: the contour of the seen ball against that of a ball that is pressed by the rig's probe,
// at 2, 4 and 6 mm [VHMR 4.3].
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/deformation/deformation_full.h"
#include "benchmarks/kit/kit.h"
#include "core/base/units.h"
#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::bench::deformation {
namespace {

struct Seen {
  Contour contour;
  ContourGap gap;
  Overlap common;
};

void add_depth(BenchResult& result, std::size_t depth, const Seen& probe, const Seen& stylus) {
  const int mm = static_cast<int>(std::lround(kMmPerM * fig11_depths()[depth]));
  const Role role = mm == 4 ? Role::predicted : Role::calibrated;
  const std::string from =
      mm == 4 ? "not used in the calibration" : "two constants of the seen ball are from here";
  const auto add = [&](const std::string& id, double twin, const char* unit, Role how, double low,
                       double high, const std::string& note) {
    result.figures.push_back({"deformation." + id, kUnset, twin, unit, how, low, high, note});
  };
  add(fmt::format("contour.{}.rms_mm", mm), kMmPerM * probe.gap.rms, "mm", role, kUnset, 0.25,
      fmt::format("seen ball to pressed ball where either is off the undeformed by {:g} mm; {}",
                  kMmPerM * kDented, from));
  add(fmt::format("contour.{}.half_rms_mm", mm), kMmPerM * probe.gap.half_rms, "mm", role, kUnset, kUnset,
      "over the whole visible half");
  add(fmt::format("contour.{}.max_mm", mm), kMmPerM * probe.gap.largest, "mm", role, kUnset, kUnset, "");
  add(fmt::format("dent.{}.iou", mm), probe.common.area, "", role, 0.9, kUnset, "in the section");
  add(fmt::format("volume.{}.iou", mm), probe.common.volume, "", role, 0.9, kUnset,
      "of the solids of revolution");
  add(fmt::format("stylus.{}.rms_mm", mm), kMmPerM * stylus.gap.rms, "mm", Role::predicted, kUnset, kUnset,
      fmt::format("the same under a tip of {:g} mm; nothing was fitted to it", kMmPerM * kStylus));
}

void add_reference(BenchResult& result, const std::array<std::vector<PressedShell>, 2>& coarse,
                   const Fig11Contours& reference) {
  const double error =
      std::max(own_error(coarse[0], reference.probe), own_error(coarse[1], reference.stylus));
  result.figures.push_back({"deformation.reference.error_mm", kUnset, kMmPerM * error, "mm", Role::ours,
                            kUnset, 0.02, "largest distance to elements of double size, over 3"});
  const sim::BallPlant plant;
  for (const PressedShell& state : coarse[0])
    result.figures.push_back({fmt::format("deformation.reference.force.{:g}.ratio", kMmPerM * state.depth),
                              kUnset, state.force / plant.elastic(state.depth), "", Role::ours, 0.9, 1.1,
                              fmt::format("{:.2f} N at rest over that of the rig's ball", state.force)});
}

Series line(const std::string& name, const Contour& contour, double radius) {
  Series series{name, {}, {}};
  for (const Vec2& p : contour) {
    if (p[1] < 0.5 * radius) break;
    series.x.push_back(kMmPerM * p[0]);
    series.y.push_back(kMmPerM * p[1]);
  }
  return series;
}

void add_plots(BenchResult& result, double radius, const Fig11Contours& reference,
               const std::vector<Seen>& probe, const std::vector<Seen>& stylus) {
  Contour round;
  for (int i = 0; i <= 180; ++i)
    round.emplace_back(radius * std::sin(0.5 * M_PI * i / 180), radius * std::cos(0.5 * M_PI * i / 180));
  const auto contours = [&](const std::string& id, const std::string& title, const Contour& pressed,
                            const Seen& seen) {
    Plot plot{id, title, "from the axis (mm)", "height over the ball's middle (mm)", false, false, {}};
    plot.series = {line("pressed ball", pressed, radius), line("seen ball", seen.contour, radius),
                   line("undeformed", round, radius)};
    plot.equal = true;
    plot.caption = "Half of the section. The pressed ball is computed, its felt rides on the wall.";
    result.plots.push_back(std::move(plot));
  };
  Plot gaps{"deformation_residual",
            "Pressed ball outside of the seen ball",
            "along the seen contour (mm)",
            "distance (mm)",
            false,
            false,
            {}};
  for (std::size_t d = 0; d < fig11_depths().size(); ++d) {
    const double mm = kMmPerM * fig11_depths()[d];
    contours(fmt::format("deformation_fig11_{:g}mm", mm), fmt::format("Fig 11: {:g} mm under the probe", mm),
             reference.probe[d], probe[d]);
    const GapAlong gap = gap_along(probe[d].contour, reference.probe[d]);
    Series series{fmt::format("{:g} mm deep", mm), {}, {}};
    for (std::size_t i = 0; i < gap.length.size(); i += 4) {
      series.x.push_back(kMmPerM * gap.length[i]);
      series.y.push_back(kMmPerM * gap.outside[i]);
    }
    gaps.series.push_back(std::move(series));
  }
  gaps.caption =
      "Positive: the pressed ball is outside. Far from the probe it bulges, which the seen ball does not.";
  result.plots.push_back(std::move(gaps));
  contours("deformation_stylus_6mm", "6 mm under a stylus of 2 mm", reference.stylus.back(), stylus.back());
}

}  // namespace

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const models::Setup setup = models::load(context.models + "/scenes/tennis_ball.toml", "sim", context.set);
  const Scene scene = prepare(setup.scene, setup.rig);
  const Surface& ball = scene.objects.front().surface;
  const double radius = ball.bound().radius;
  const double probe_radius = sim::BallParameters{}.probe_radius;
  const Fig11Contours reference =
      context.full ? add_anew(result, context.models) : load_fig11(context.models);

  std::array<std::vector<PressedShell>, 2> coarse;  // under the probe, under the stylus
  in_parallel(coarse.size(),
              [&](std::size_t i) { coarse[i] = press_fig11(i == 0 ? probe_radius : kStylus, kCoarse); });
  const auto seen = [&](double tip_radius, double depth, const Contour& pressed) {
    const Contour contour = seen_contour(ball, tip_radius, depth);
    return Seen{contour, contour_gap(contour, pressed, radius), overlap(contour, pressed, radius)};
  };
  std::vector<Seen> probe;
  std::vector<Seen> stylus;
  for (std::size_t d = 0; d < fig11_depths().size(); ++d) {
    probe.push_back(seen(probe_radius, fig11_depths()[d], reference.probe[d]));
    stylus.push_back(seen(kStylus, fig11_depths()[d], reference.stylus[d]));
    add_depth(result, d, probe[d], stylus[d]);
  }
  add_reference(result, coarse, reference);
  add_plots(result, radius, reference, probe, stylus);
  if (context.full) add_full(result, context, ball, reference);
  result.note =
      "The paper's figure is two rows of photographs; the pressed ball is computed "
      "(docs/notes/deformation.md).";
}

const Entry kEntry{"deformation", "tennis_ball",
                   "the seen ball's contour against that of a pressed ball (VHMR Fig 11)", run};

}  // namespace enc::bench::deformation
