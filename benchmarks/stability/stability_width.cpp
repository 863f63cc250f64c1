// Z-width: from the softest to the stiffest that a device renders, by what it is stable with, beside what is
// published of others.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "benchmarks/stability/maps.h"
#include "core/base/units.h"
#include "core/control/scene/steadiness.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/prepare.h"
#include "trial/certificates.h"

namespace enc::bench::stability {
namespace {

struct Width {
  std::string device, what, brief;
  double low, high;  // N/mm; low 0: nothing is too soft
  std::string source;
  const char* kind;  // a series of the plot
};

std::vector<Width> width_of_arm(const Bench& bench) {
  const models::Setup setup = models::load(bench.context.models + "/scenes/wall.toml", {});
  const certificate::Certificate wall =
      trial::certificates_of(setup, trial::prepare_setup(setup)).back().certificate;
  const auto bound = [&](const char* name) {
    return certificate::row_of(wall, name).bound / kNewtonPerMillimetre;
  };
  const std::string device = "arm of VisHap, its law", source = "certificate of wall.toml";
  return {{device, "passive, whatever hand", "arm", 0.0, bound("colgate_schenkel"), source, "passive"},
          {device, "stable alone", "arm", 0.0, bound("exact_alone"), source, "stable alone"},
          {device, "with the hand", "arm", 0.0, bound("exact_with_hand"), source, "with a hand"}};
}

// Stiff is no limit of it: up to the stiffest that is asked of any map it stands still.
std::vector<Width> width_of_hexapod(const Bench& bench) {
  const models::Setup setup = models::load(bench.context.models + "/scenes/stiffness.toml", {});
  const Steadiness loop(setup.rig);
  double stiffest = 0.0;
  const auto decades = static_cast<int>(std::lround(std::log10(kHardest / 1e3)));
  for (int i = 0; i <= decades; ++i) {
    const double k = 1e3 * std::pow(10.0, i);
    const Response spring({{k, 0, 0, 0}, {k, 0, 0, 0}, 23e-3}, 0.0);
    if (loop.swing(spring, std::min(15e-3, 30.0 / k), 23e-3, Steadiness::kSlow) > loop.still()) break;
    stiffest = k;
  }
  const std::string device = "hexapod of VHMR",
                    hand = fmt::format("{:g} N/mm", loop_of(setup.rig).hand_stiffness / kNewtonPerMillimetre);
  return {{device, "linear, with a hand of " + hand, "hexapod",
           lowest_stable_stiffness(loop_of(setup.rig)) / kNewtonPerMillimetre,
           stiffest / kNewtonPerMillimetre, "row admittance", "with a hand"},
          {device, "with all limits, pushed in 2 s", "hexapod",
           loop.softest(15e-3, 30.0, Steadiness::kSlow) / kNewtonPerMillimetre,
           stiffest / kNewtonPerMillimetre, "core/control/scene/steadiness.h", "with a hand, all limits"}};
}

std::vector<Width> published() {
  const char* known = "published";
  const char* recalled = "from memory";
  return {{"hexapod of VHMR, the real one", "rendered; within 2 % from 0.3 N/mm", "VHMR", 0.03, 200.0,
           "[VHMR 2, Fig 3]", known},
          {"PHANToM, textures felt clean", "the stiffest, at 0.25 to 40 kHz", "PHANToM, clean", 0.325, 0.904,
           "Choi and Tan 2004 (studylib.net/doc/18564039)", known},
          {"PHANToM Premium 1.5, its structure", "a wall cannot be stiffer", "Premium 1.5", kUnset, 3.5,
           "SensAble's sheet [sources/arm 1]", known},
          {"omega.3 (Force Dimension)", "closed loop, the stiffest", "omega.3", kUnset, 14.5,
           "vendor's sheet", recalled},
          {"HapticMaster (admittance)", "the stiffest, by the place", "HapticMaster", 10.0, 50.0,
           "Van der Linde 2002", recalled}};
}

}  // namespace

void add_widths(Bench& bench) {
  std::vector<Width> all = width_of_arm(bench);
  for (const auto& more : {width_of_hexapod(bench), published()})
    all.insert(all.end(), more.begin(), more.end());
  Table table{
      "widths", "Z-width: what a device renders", {"device", "what", "from (N/mm)", "to (N/mm)", "source"}};
  Plot plot{.id = "widths",
            .title = "From the softest to the stiffest that is rendered",
            .x_label = "",
            .y_label = "stiffness (N/mm)",
            .log_y = true};
  const auto number = [](double k) { return std::isnan(k) ? std::string("-") : fmt::format("{:.3g}", k); };
  constexpr double kEdge = 1e-3;  // N/mm: where an axis ends that has no 0
  for (const Width& width : all) {
    const bool recalled = std::string_view(width.kind) == "from memory";
    table.add(width.device, width.what, number(width.low), number(width.high),
              width.source + (recalled ? " (from memory)" : ""));
    auto at = std::find_if(plot.series.begin(), plot.series.end(),
                           [&](const Series& s) { return s.name == width.kind; });
    if (at == plot.series.end())
      at = plot.series.insert(plot.series.end(), Series{.name = width.kind, .mark = Mark::points});
    const double low = std::isnan(width.low) ? width.high : std::max(width.low, kEdge);
    at->add(static_cast<double>(plot.x_names.size()), Value(width.high, low, width.high));
    plot.x_names.push_back(width.brief);
  }
  table.note =
      "An arm renders nothing softly without end: from 0; its friction of some 0.05 N hides what is softer "
      "than "
      "0.005 N/mm at 10 mm. A machine that measures force is passive for no stiffness: to each there is a "
      "hand "
      "that makes it swing. It stands still up to the stiffest that was asked.";
  plot.caption =
      "An arm is limited where it is stiff, a machine that measures force where it is soft. From 15 to 42 "
      "N/mm on a "
      "wall is felt to be rigid (Tan et al. 1994). Sources: table `widths`.";
  bench.table(std::move(table));
  bench.plot(std::move(plot));
  bench.figure("widths.arm.decades", std::log10(all[1].high / 5e-3), "",
               "from what the arm's friction hides at 10 mm, 0.005 N/mm, to what is stable alone: decades");
  bench.figure("widths.hexapod.decades", std::log10(all[4].high / all[4].low), "",
               "of the hexapod, with all limits: decades");
}

}  // namespace enc::bench::stability
