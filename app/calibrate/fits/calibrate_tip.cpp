// `encounter calibrate tip POSES.csv`: the position of a tool's tip relative to its markers, from a tool that
// is turned about its resting tip.
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/words.h"
#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "models/identify/tip/pivot_fit.h"
#include "models/identify/tip/pivot_log.h"
#include "models/schema/wording.h"
#include "trial/measure/record_table.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;
using models::PivotFit;
using models::PivotLog;

double length_of(const PivotLog& log) { return log.poses.back().time - log.poses.front().time; }

std::string three(const std::array<double, 3>& x, double unit, int digits) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", x[0] * unit, digits, x[1] * unit, digits, x[2] * unit,
                     digits);
}
std::array<double, 3> halves_of(const PivotFit& fit) {
  return {fit.tip[0].half, fit.tip[1].half, fit.tip[2].half};
}

constexpr std::string_view kMetres =
    "the tip is within 5 mm of the markers' origin, and all poses within 20 mm of the tracker's: if the log "
    "is in metres, multiply its places by 1000";

// Notes for the reader before the numbers.
std::string pivot_notes(const PivotLog& log, const PivotFit& fit) {
  std::string out;
  if (fit.rested > fit.turned)
    out += fmt::format("note        the tool rested for {:.1f} s, most of the log: {:.1f} s tell the tip\n",
                       fit.rested, fit.turned);
  if (models::looks_like_metres(log, fit)) out += fmt::format("note        {}\n", kMetres);
  if (const models::Inversion inverted = models::doubt_of_direction(fit); inverted.doubted)
    out += fmt::format("note        {}\n", inverted.text);
  return out;
}

std::string pivot_text(const PivotLog& log, const PivotFit& fit) {
  std::string out = fmt::format(
      "{} poses{} in {:.1f} s{}\n{}{:6}{:>24}\n", log.poses.size(),
      log.tool.empty() ? "" : " of " + models::printable(log.tool), length_of(log),
      fit.outliers > 0 ? fmt::format("; {} left out, farther than 6 standard deviations", fit.outliers) : "",
      pivot_notes(log, fit), "axis", "tip in T, mm");
  for (std::size_t a = 0; a < 3; ++a)
    out +=
        fmt::format("{:<6}{:>24}\n", "xyz"[a],
                    fmt::format("{:.4f} +- {:.4f}", fit.tip[a].value * kMmPerM, fit.tip[a].half * kMmPerM));
  return out +
         fmt::format(
             "residual    {:.3f} mm rms, {:.3f} mm at most; medians of 0.25 s wander by up to {:.3f} mm\n"
             "swing       three directions of the tool turned by {} deg rms; the first is [{}] in T\n"
             "dimple      [{}] mm in C; a constant bias of the tracker is in it, and not in the tip\n\n"
             "[[tool]]\ntip_mm = [{}]  # +- {}\n\n"
             "note        of a round tip this is the centre of its sphere, as tip_mm wants it\n"
             "intervals   95 % for each axis, of errors that last up to some 0.3 s, from blocks of 0.25 to "
             "2 s, the widest one; by {}\n",
             fit.rms * kMmPerM, fit.most * kMmPerM, fit.wander * kMmPerM, three(fit.swing, kDegPerRad, 1),
             three(fit.least_turned.xyz, 1.0, 2), three(fit.dimple.xyz, kMmPerM, 3),
             three(fit.point().xyz, kMmPerM, 4), three(halves_of(fit), kMmPerM, 4),
             fit.neighbours ? "the rotations of neighbours"
                            : "plain least squares, as neighbours turn too unlike");
}

Json list_of(const std::array<double, 3>& x, double unit) { return {x[0] * unit, x[1] * unit, x[2] * unit}; }

Json pivot_json(const PivotLog& log, const PivotFit& fit) {
  Json json;
  if (!log.tool.empty()) json["tool"] = log.tool;
  json["poses"] = log.poses.size();
  json["time_s"] = length_of(log);
  json["outliers"] = fit.outliers;
  json["tip_mm"] = list_of(fit.point().xyz, kMmPerM);
  json["tip_half_mm"] = list_of(halves_of(fit), kMmPerM);
  json["dimple_mm"] = list_of(fit.dimple.xyz, kMmPerM);
  json["residual_rms_mm"] = fit.rms * kMmPerM;
  json["residual_max_mm"] = fit.most * kMmPerM;
  json["wander_mm"] = fit.wander * kMmPerM;
  json["swing_deg"] = list_of(fit.swing, kDegPerRad);
  json["least_turned"] = list_of(fit.least_turned.xyz, 1.0);
  json["turned_s"] = fit.turned;
  json["rested_s"] = fit.rested;
  json["method"] = fit.neighbours ? "neighbours" : "least_squares";
  if (models::looks_like_metres(log, fit)) json["note"] = kMetres;
  if (const models::Inversion inverted = models::doubt_of_direction(fit); inverted.doubted)
    json["note"] = inverted.text;
  return json;
}

PivotFit fit_of(const PivotLog& log, const std::string& name) {
  PivotFit fit;
  try {
    fit = models::fit_pivot(log.poses);
  } catch (const Error& error) {
    throw Error(
        fmt::format("{}:{}:1: {}{}", name, log.line, error.what(), models::other_convention(log.poses)));
  }
  if (const models::Inversion inverted = models::doubt_of_direction(fit); inverted.sure)
    throw Error(
        fmt::format("{}:{}:1: {}; expected poses of the markers in the tracker's frame; invert each pose",
                    name, log.line, inverted.text));
  return fit;
}

}  // namespace

int calibrate_tip(const TipOptions& options) {
  const std::string csv = trial::read_table(
      options.log, "log",
      "a CSV file with time_s, tool_x_mm, ..., tool_qx, ..., or with markers_x_mm, ... as `encounter export` "
      "writes");
  refuse_pairs(csv, options.log, "poses of a tool that is swung about its tip");
  const PivotLog log = models::parse_pivot_log(csv, options.log);
  const PivotFit fit = fit_of(log, options.log);
  // ASCII only: a name may hold control characters for the terminal.
  fmt::print("{}", options.json ? pivot_json(log, fit).dump(2, ' ', true) + "\n" : pivot_text(log, fit));
  return 0;
}

}  // namespace enc::app
