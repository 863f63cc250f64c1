// `encounter fit LOOP.csv`: turns a measured loop into a response file, with intervals. `encounter fit
// LOOP.csv ... --ball`: fits the pressed ball, with intervals and the limits of these loops.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "models/files.h"
#include "models/identify/response/loop_csv.h"
#include "models/identify/response/loop_fit.h"
#include "models/order_statistics.h"
#include "models/response_file.h"
#include "models/schema/printable.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"
#include "trial/identify/ball/ball_fit.h"
#include "trial/measure/record_table.h"

namespace enc::app {
namespace {

// ---- a response

using models::BranchEstimate;
using models::LoopFit;

std::string branch_text(const char* name, const BranchEstimate& known, double rmse, double rmse_free) {
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

// Warns if the release returns more energy than the press took: no passive response can do that.
std::string energy_text(const models::LoopData& loop) {
  double in = 0.0, out = 0.0;  // J
  for (const auto& press : loop.presses)
    for (std::size_t k = 1; k < press.size(); ++k) {
      const double work =
          0.5 * (press[k].force + press[k - 1].force) * (press[k].deflection - press[k - 1].deflection);
      (work > 0.0 ? in : out) += std::abs(work);
    }
  constexpr double kNoise = 1.02;  // covers noise and the lag of the force in a lossless loop
  if (!(out > kNoise * in)) return "";
  return fmt::format(
      "note        the release gives {:.2f} mJ back and the press took {:.2f} mJ: nothing passive does that; "
      "see to the sign and the zero of the force, or to a force that comes late\n",
      out * 1e3, in * 1e3);
}

// Warns if the constraints move the curve away from the readings.
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
  std::optional<models::OutFile> file;  // refuse it before the work
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

namespace {

// ---- the ball behind the loops

using trial::BallEstimate;
using trial::BallFit;
using trial::BallFitOptions;
using trial::BallNumber;
using trial::HeldNumber;
using Json = nlohmann::ordered_json;  // prints NaN as null

const BallNumber& number(std::size_t i) { return trial::ball_numbers()[i]; }

std::size_t number_named(const std::string& option, const std::string& name) {
  std::vector<std::string> names;
  for (const BallNumber& n : trial::ball_numbers()) names.emplace_back(n.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw Error(fmt::format("{}: unknown number {}; expected one of the ball's; {}", option,
                            models::quoted(name), models::advice(name, names)));
  return static_cast<std::size_t>(found - names.begin());
}

double value_in(const std::string& text, const std::string& name, bool positive) {
  double value = 0.0;
  const auto [stop, bad] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (bad != std::errc() || stop != text.data() + text.size() || !std::isfinite(value) ||
      (positive && value <= 0.0))
    throw Error(fmt::format("--hold: {} is {}; expected a {}number such as {}=1.5; correct it", name,
                            models::quoted(text), positive ? "positive " : "", name));
  return value;
}

BallFitOptions asked(const FitOptions& options) {
  BallFitOptions how;
  for (const std::string& name : options.free) how.free[number_named("--free", name)] = true;
  for (const std::string& text : options.hold) {
    const std::size_t equal = std::min(text.find('='), text.size());
    const std::size_t which = number_named("--hold", text.substr(0, equal));
    const BallNumber& n = number(which);
    how.free[which] = false;
    if (equal < text.size())
      n.of(how.start) = n.unit * value_in(text.substr(equal + 1), std::string(n.name), n.positive);
  }
  if (std::none_of(how.free.begin(), how.free.end(), [](bool free) { return free; }))
    throw Error("--hold: nothing is left to be found; expected at least one number; hold fewer");
  return how;
}

// Median time between two readings, s.
double usual_step(const trial::Pushes& pushes) {
  std::vector<double> steps;
  for (const auto& push : pushes)
    for (std::size_t i = 1; i < push.size(); ++i) steps.push_back(push[i].time - push[i - 1].time);
  return models::median(steps);
}

trial::Pushes read(const std::string& file, double limit, std::vector<std::string>& notes, bool& doubted) {
  constexpr double kDeepest = 8e-3;  // m, range of the law's table
  constexpr double kSlowest = 0.5;   // s: the ball's relaxation is over between two readings
  models::LoopData loop = models::parse_loop(
      trial::read_table(file, "loop", "a CSV file with time_s, deflection_mm, force_N, repeat"), file, limit);
  for (const std::string& note : loop.notes) notes.push_back(fmt::format("{}: {}", file, note));
  doubted = doubted || loop.doubted;
  trial::Pushes pushes = std::move(loop.presses);
  if (const double step = usual_step(pushes); step >= kSlowest)
    throw Error(
        fmt::format("{}:1:1: rows are {:.3g} s apart: milliseconds? The ball relaxes within 0.05 to 5 s; "
                    "expected at least 2 rows a second; multiply time_s by 0.001, or record faster",
                    file, step));
  for (const auto& push : pushes)
    for (const models::LoopPoint& p : push)
      if (p.deflection > kDeepest)
        throw Error(
            fmt::format("{}:1:1: at {} s the deflection is {:.3f} mm; expected at most 8 mm, to which the "
                        "ball's law is meant; push less deep",
                        file, p.time, p.deflection * 1e3));
  return pushes;
}

std::string line(const BallEstimate& e) {
  const BallNumber& n = number(e.number);
  const char* known = e.known() == trial::EstimateQuality::well     ? "yes"
                      : e.known() == trial::EstimateQuality::poorly ? "poorly"
                                                                    : "NO";
  return fmt::format("{:20}{:>10.5g} +- {:<8.2g}{:>9.2g} %{:>10.2g}   {:<8}{} ({:+.2f})\n", n.name,
                     e.interval.value / n.unit, e.interval.half / n.unit, 100.0 * e.width(), e.alone / n.unit,
                     known, number(e.tied).name, e.correlation);
}

// The held number, and the three estimates that depend on it most.
std::string line(const BallFit& fit, const HeldNumber& held) {
  const BallNumber& n = number(held.number);
  std::string text = fmt::format("held        {} = {:.4g}", n.name, held.value / n.unit);
  std::vector<std::size_t> order(held.moves.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::erase_if(order, [&](std::size_t i) { return fit.estimates[i].number == trial::kNearer; });
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(held.moves[a]) > std::abs(held.moves[b]);
  });
  for (std::size_t k = 0; k < std::min<std::size_t>(3, order.size()); ++k)
    text += fmt::format("{}{} {:+.1f} %", k == 0 ? "; if it is 1 % more: " : ", ",
                        number(fit.estimates[order[k]].number).name, held.moves[order[k]]);
  return text + "\n";
}

std::string remarks(const BallFit& fit) {
  constexpr double kUsualWalk = 0.01;  // N / sqrt(s): five times that of a sensor (sources/force_sensor 2)
  std::string text;
  for (const BallEstimate& e : fit.estimates)
    if (e.number != trial::kNearer && e.known() != trial::EstimateQuality::well)
      text += fmt::format("note        {} is {}known from these loops: {}\n", number(e.number).name,
                          e.known() == trial::EstimateQuality::poorly ? "poorly " : "not ",
                          number(e.number).remedy);
  if (fit.walk > kUsualWalk)
    text += fmt::format(
        "note        what is left wanders by {:.2g} N/sqrt(s), far more than a sensor: this ball is not "
        "quite the "
        "law; the intervals have grown with it\n",
        fit.walk);
  return text +
         "note        intervals know of noise, not of a wrong law: that is within 1.1 % rms of a solver "
         "(docs/guide/identification.md)\n";
}

std::string settings(const BallFit& fit) {
  std::string text;
  for (const BallEstimate& e : fit.estimates)
    if (e.number != trial::kNearer && e.known() != trial::EstimateQuality::not_at_all)
      text += fmt::format("set         truth.ball.{}={:.5g}\n", number(e.number).name,
                          std::max(0.0, e.interval.value / number(e.number).unit));
  return text;
}

std::string report(const trial::BallLoops& loops, const BallFit& fit, const std::vector<std::string>& notes) {
  std::string text = fmt::format("{} pushes, {} readings\n{:20}{:>10}    {:<8}{:>11}{:>10}   {:<8}{}\n",
                                 loops.pushes(), loops.readings(), "number", "value", "95 %", "full width",
                                 "alone", "known", "tied most to");
  for (const BallEstimate& e : fit.estimates) text += line(e);
  for (const std::string& note : notes) text += fmt::format("note        {}\n", note);
  text += fmt::format("alone       half width if all the others were given; condition number {:.2g}\n",
                      fit.condition);
  for (const HeldNumber& held : fit.held) text += line(fit, held);
  text += fmt::format(
      "noise       {:.4f} N rms of a reading on a zero that wanders by {:.4f} N/sqrt(s), both from what the "
      "law "
      "leaves: {:.4f} N rms of means over 10 ms\n",
      fit.noise, fit.walk, fit.rms);
  return text + remarks(fit) + settings(fit);
}

std::string json_text(const trial::BallLoops& loops, const BallFit& fit,
                      const std::vector<std::string>& notes) {
  Json json;
  json["pushes"] = loops.pushes();
  json["readings"] = loops.readings();
  for (const BallEstimate& e : fit.estimates) {
    const BallNumber& n = number(e.number);
    json["numbers"][std::string(n.name)] = {{"value", e.interval.value / n.unit},
                                            {"half", e.interval.half / n.unit},
                                            {"alone_half", e.alone / n.unit},
                                            {"known", e.known() == trial::EstimateQuality::well     ? "well"
                                                      : e.known() == trial::EstimateQuality::poorly ? "poorly"
                                                                                                    : "no"},
                                            {"tied_to", std::string(number(e.tied).name)},
                                            {"correlation", e.correlation}};
  }
  for (const HeldNumber& held : fit.held)
    json["held"][std::string(number(held.number).name)] = held.value / number(held.number).unit;
  json["noise_N"] = fit.noise;
  json["walk_N_per_sqrt_s"] = fit.walk;
  json["rms_N"] = fit.rms;
  json["condition"] = fit.condition;
  if (!notes.empty()) json["notes"] = notes;
  return json.dump(2);
}

}  // namespace

int fit_ball(const FitOptions& options) {
  if (!(options.limit_mm > 0.0 && options.limit_mm <= 8.0))
    throw Error("--limit-mm: expected 0 to 8 mm, to which the ball's law is meant");
  if (!options.out.empty() || options.ceiling)
    throw Error("--out and --ceiling-N-per-mm are of a response; expected them without --ball; remove one");
  const BallFitOptions how = asked(options);
  std::vector<trial::Pushes> runs;
  runs.reserve(options.loops.size());
  std::vector<std::string> notes;
  bool doubted = false;
  for (const std::string& file : options.loops)
    runs.push_back(read(file, options.limit_mm * 1e-3, notes, doubted));
  const trial::BallLoops loops(std::move(runs));
  BallFit fit;
  try {
    fit = trial::fit_ball(loops, how);
  } catch (const Error& e) {
    throw Error(fmt::format("{}:1:1: {}", options.loops.front(), e.what()));
  }
  fmt::print("{}", options.json ? json_text(loops, fit, notes) + "\n" : report(loops, fit, notes));
  return doubted ? 1 : 0;
}

}  // namespace enc::app
