// `encounter fit LOOP.csv ... --ball`: which ball was pressed, how well that is known, and what the loops do
// not tell.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/fit/commands.h"
#include "core/base/error.h"
#include "models/identify/response/loop_csv.h"
#include "models/order_statistics.h"
#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"
#include "trial/identify/ball/ball_fit.h"
#include "trial/identify/read_table.h"

namespace enc::app {
namespace {

using trial::BallEstimate;
using trial::BallFit;
using trial::BallFitOptions;
using trial::BallNumber;
using trial::HeldNumber;
using Json = nlohmann::ordered_json;

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

// Seconds from one reading to the next, the middle one of all.
double usual_step(const trial::Pushes& pushes) {
  std::vector<double> steps;
  for (const auto& push : pushes)
    for (std::size_t i = 1; i < push.size(); ++i) steps.push_back(push[i].time - push[i - 1].time);
  return models::median(steps);
}

trial::Pushes read(const std::string& file, double limit, std::vector<std::string>& notes, bool& doubted) {
  constexpr double kDeepest = 8e-3;  // m, of the law's table
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
  const char* known = e.known() == trial::Known::well     ? "yes"
                      : e.known() == trial::Known::poorly ? "poorly"
                                                          : "NO";
  return fmt::format("{:20}{:>10.5g} +- {:<8.2g}{:>9.2g} %{:>10.2g}   {:<8}{} ({:+.2f})\n", n.name,
                     e.interval.value / n.unit, e.interval.half / n.unit, 100.0 * e.width(), e.alone / n.unit,
                     known, number(e.tied).name, e.correlation);
}

// The three estimates that owe the most to it.
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
  constexpr double kUsualWalk = 0.01;  // N / sqrt(s): five times a sensor's (sources/force_sensor 2)
  std::string text;
  for (const BallEstimate& e : fit.estimates)
    if (e.number != trial::kNearer && e.known() != trial::Known::well)
      text += fmt::format("note        {} is {}known from these loops: {}\n", number(e.number).name,
                          e.known() == trial::Known::poorly ? "poorly " : "not ", number(e.number).remedy);
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
    if (e.number != trial::kNearer && e.known() != trial::Known::not_at_all)
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

Json number_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string json_text(const trial::BallLoops& loops, const BallFit& fit,
                      const std::vector<std::string>& notes) {
  Json json;
  json["pushes"] = loops.pushes();
  json["readings"] = loops.readings();
  for (const BallEstimate& e : fit.estimates) {
    const BallNumber& n = number(e.number);
    json["numbers"][std::string(n.name)] = {{"value", e.interval.value / n.unit},
                                            {"half", number_or_null(e.interval.half / n.unit)},
                                            {"alone_half", number_or_null(e.alone / n.unit)},
                                            {"known", e.known() == trial::Known::well     ? "well"
                                                      : e.known() == trial::Known::poorly ? "poorly"
                                                                                          : "no"},
                                            {"tied_to", std::string(number(e.tied).name)},
                                            {"correlation", e.correlation}};
  }
  for (const HeldNumber& held : fit.held)
    json["held"][std::string(number(held.number).name)] = held.value / number(held.number).unit;
  json["noise_N"] = fit.noise;
  json["walk_N_per_sqrt_s"] = fit.walk;
  json["rms_N"] = fit.rms;
  json["condition"] = number_or_null(fit.condition);
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
