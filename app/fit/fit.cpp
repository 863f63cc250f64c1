// `encounter fit LOOP.csv`: a measured loop becomes a response file, and what is known about it is said.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "models/files.h"
#include "models/identify/response/loop_fit.h"
#include "models/response_file.h"
#include "models/schema/printable.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"
#include "trial/identify/read_table.h"

namespace enc::app {
namespace {

using models::BranchKnown;
using models::LoopFit;

std::string branch_text(const char* name, const BranchKnown& known, double rmse, double rmse_free) {
  std::string text =
      fmt::format("{:11} RMSE {:.4f} N; without constraints {:.4f} N\n", name, rmse, rmse_free);
  double scale = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    scale *= 1e-3;
    text += fmt::format("  d^{}       {:11.6f} +- {:.6f} N/mm^{}\n", k + 1,
                        known.coefficients[k].value * scale, known.coefficients[k].half * scale, k + 1);
  }
  text += "  curve    ";
  for (std::size_t i = 0; i < known.curve.size(); ++i)
    text += fmt::format("{}{:.2f}+-{:.3f}", i == 0 ? " " : ", ", known.curve[i].value, known.curve[i].half);
  text += " N at 1, 2, ... mm\n";
  const auto is_known = [](double half) { return !std::isnan(half); };
  if (std::any_of(known.repeats.begin(), known.repeats.end(), is_known)) {
    text += "  repeats  ";
    for (std::size_t i = 0; i < known.repeats.size(); ++i)
      text += (i == 0 ? " " : ", ") +
              (is_known(known.repeats[i]) ? fmt::format("+-{:.3f}", known.repeats[i]) : "unknown");
    text += " N of their mean there\n";
  }
  if (!known.curve.empty())
    text += fmt::format("  deepest   full width of the interval at {} mm: {:.3f} N, {:.1f} % of the force\n",
                        known.curve.size(), 2.0 * known.curve.back().half,
                        200.0 * known.curve.back().half / known.curve.back().value);
  return text + fmt::format(
                    "  tied      d^{} and d^{} go together (correlation {:.4f}; condition "
                    "number {:.2g}): the curve is known, these two singly are not\n",
                    known.tied[0], known.tied[1], known.correlation, known.condition);
}

std::string stops_text(const LoopFit& fit) {
  const StopsSpec& stops = *fit.response.stops;
  std::string text = fmt::format(
      "stops       RMSE {:.4f} N; without constraints {:.4f} N (Prandtl-Ishlinskii, both branches)\n",
      fit.stops.rmse, fit.stops.rmse_free);
  std::string none;
  for (std::size_t i = 0; i < stops.radii.size(); ++i) {
    if (stops.weights[i] > 0.0)
      text +=
          fmt::format("  r         {:7.4f} mm: {:.4f} N/mm\n", stops.radii[i] * 1e3, stops.weights[i] * 1e-3);
    else
      none += fmt::format("{}{:.4f}", none.empty() ? "" : ", ", stops.radii[i] * 1e3);
  }
  return text + fmt::format("  no weight {} mm\n", none.empty() ? "none of the radii" : none);
}

// More came back than was put in: no response can do that.
std::string energy_text(const models::LoopData& loop) {
  double in = 0.0, out = 0.0;  // J
  for (const auto& press : loop.presses)
    for (std::size_t k = 1; k < press.size(); ++k) {
      const double work =
          0.5 * (press[k].force + press[k - 1].force) * (press[k].deflection - press[k - 1].deflection);
      (work > 0.0 ? in : out) += std::abs(work);
    }
  constexpr double kNoise = 1.02;  // and what a lag of the force makes of a loop without loss
  if (!(out > kNoise * in)) return "";
  return fmt::format(
      "note        the release gives {:.2f} mJ back and the press took {:.2f} mJ: nothing passive does that; "
      "see to the sign and the zero of the force, or to a force that comes late\n",
      out * 1e3, in * 1e3);
}

// The constraints may make of the readings what nobody measured.
std::string moved_text(const LoopFit& fit) {
  // The curve may be moved by this share of the force at the limit.
  constexpr double kMost = 0.05;
  // A hand presses with this force at most, N.
  constexpr double kHardest = 100.0;
  const models::ResponseFit& curves = fit.curves;
  const double limit = fit.response.limit, end = curves.measured_end;
  if (!(std::abs(curves.fitted - curves.measured) > kMost * std::abs(end))) return "";
  std::string why =
      "no curve that a scene plays rises so slowly, or has its release above its press: see to the "
      "zero of the force, or to a force that comes late";
  if (end < fit.floor * limit)
    why = fmt::format("the object is softer than this rig renders, {:.3f} N/mm; give another --rig{}",
                      fit.floor * 1e-3,
                      1e3 * end >= fit.floor * limit && 1e3 * end <= kHardest
                          ? ", or, if force_N is in kN, multiply it by 1000"
                          : "");
  return fmt::format(
      "note        at {:.2f} mm the {} is {:.3f} N by the readings and {:.3f} N by the curve, which is kept "
      "within "
      "what can be rendered: {}\n",
      curves.moved_at * 1e3, curves.moved_press ? "press" : "release", curves.measured, curves.fitted, why);
}

std::string notes_text(const models::LoopData& loop) {
  std::string text;
  for (const std::string& note : loop.notes) text += fmt::format("note        {}\n", note);
  return text;
}

std::string report(const LoopFit& fit, const models::LoopData& loop) {
  return fmt::format("{} presses, {} readings; slope kept within {:.4f} and {:.3f} N/mm\n", fit.presses,
                     fit.readings, fit.floor * 1e-3, fit.ceiling * 1e-3) +
         notes_text(loop) +
         branch_text("press", fit.press, fit.curves.rmse_press, fit.curves.rmse_press_free) +
         branch_text("release", fit.release, fit.curves.rmse_release, fit.curves.rmse_release_free) +
         stops_text(fit) +
         "intervals   95 %: block bootstrap over twelfths of each branch with a fixed seed; those of the "
         "curve also hold what repeats differ by and what the polynomial leaves over\n" +
         (fit.presses > 1 ? fmt::format("repeats     differ by at most {:.3f} N, at {:.2f} mm\n",
                                        fit.repeatability, fit.repeatability_at * 1e3)
                          : std::string("repeats     only one: nothing is known about repeatability\n"));
}

}  // namespace

int fit_loop(const FitOptions& options) {
  if (options.loops.size() != 1)
    throw Error("fit: a response comes from one loop; expected one file; give --ball to use several");
  if (options.json || !options.hold.empty() || !options.free.empty())
    throw Error("fit: --hold, --free and --json are of the ball; expected them with --ball; add it");
  const std::string& file_name = options.loops.front();
  if (!(options.limit_mm > 0.0 && options.limit_mm < 1e3))
    throw Error("--limit-mm: expected a positive number of millimetres");
  models::LoopFitOptions how;
  how.limit = options.limit_mm * 1e-3;
  how.floor = models::fit_floor(loop_of(models::load_rig(options.rig)));
  if (options.ceiling) {
    how.ceiling = *options.ceiling * 1e3;
    if (!(how.ceiling > how.floor))
      throw Error(
          fmt::format("--ceiling-N-per-mm: expected more than {:.3f} N/mm, the softest that the loop renders",
                      how.floor * 1e-3));
  }
  const models::LoopData loop = models::parse_loop(
      trial::read_table(file_name, "loop", "a CSV file with time_s, deflection_mm, force_N, repeat"),
      file_name, how.limit);
  std::optional<models::OutFile> file;  // refused before the work, not after it
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  LoopFit fit;
  try {
    fit = models::fit_loop(loop, how);
  } catch (const Error& e) {
    throw Error(
        fmt::format("{}:1:1: {}; record the loop again, or give another --limit-mm", file_name, e.what()));
  }
  const std::string moved = moved_text(fit);
  const bool doubted = loop.doubted || !moved.empty();
  fmt::print("{}{}{}", report(fit, loop), energy_text(loop), moved);
  if (doubted && file) fmt::print("not written {}: see the notes\n", models::printable(options.out));
  if (doubted) return 1;
  if (!file) return 0;
  file->write(models::response_text(fit.response, fit.source));
  file->keep();
  return 0;
}

}  // namespace enc::app
