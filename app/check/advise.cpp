#include "app/check/advise.h"

#include <fmt/format.h>

#include "core/error.h"

namespace enc::app {
namespace {

std::string settings_text(const trial::Precision& all, const trial::PrecisionPoint& point) {
  std::string text;
  for (const std::string& set : all.settings(point)) text += fmt::format(" --set {}", set);
  return text;
}

std::string row(const trial::PrecisionPoint& point) {
  const std::string name = fmt::format("  {:<12} {:>6g} us ", point.integrator, point.step * 1e6);
  if (!point.failure.empty()) return fmt::format("{}  failed: {}\n", name, point.failure);
  return fmt::format("{} {:>7.4f} N {:>8.2f} um {:>7.0f} x real time{}\n", name, point.error, point.way * 1e6,
                     1.0 / point.cpu, point.shipped ? "  as it is" : "");
}

std::string advised(const trial::Precision& all, double error) {
  const trial::PrecisionPoint* best = cheapest(all.points, error);
  if (best == nullptr) return fmt::format("advice      none of these errs by less than {:g} N\n", error);
  std::string text =
      fmt::format("advice     {}\n            errs by {:.4f} of {:g} N, {:.0f} x real time{}\n",
                  best->shipped ? " as it is:" + settings_text(all, *best) : settings_text(all, *best),
                  best->error, error, 1.0 / best->cpu, "");
  if (const trial::PrecisionPoint* next = next_cheaper(all.points, *best))
    text += fmt::format("            the next cheaper, {} at {:g} us, errs by {:.4f} N, {:.0f} x real time\n",
                        next->integrator, next->step * 1e6, next->error, 1.0 / next->cpu);
  else
    text += "            nothing cheaper was found: no step is longer than the haptic period\n";
  return text;
}

}  // namespace

std::string advice_text(const trial::Precision& all, double error) {
  std::string text = fmt::format(
      "\nprecision   of the true force on what is held, rms while it touches; and of the tip's path\n"
      "            {:g} s of the scene, {:.1f} s touched, judged by {} at {:g} us and another one; floor "
      "about {:.4f} N\n",
      all.seconds, static_cast<double>(all.touched) * all.tick, all.converged.integrator,
      all.converged.step * 1e6, all.second.error);
  for (const trial::PrecisionPoint& point : all.points) text += row(point);
  return text + advised(all, error) +
         "            judged by the force alone: what is stable, `encounter bench stability` says\n";
}

void refuse_below_floor(const trial::Precision& all, double error) {
  const double floor = all.second.error;
  if (error >= floor || cheapest(all.points, error) != nullptr) return;
  throw Error(
      fmt::format("an error of {:g} N is below what this scene can tell, {:.4f} N: two converged runs "
                  "({} at {:g} us, {} at {:g} us) differ by that, as counts of its sensors fall "
                  "the other way; expected at least that",
                  error, floor, all.converged.integrator, all.converged.step * 1e6, all.second.integrator,
                  all.second.step * 1e6),
      "--error-N");
}

}  // namespace enc::app
