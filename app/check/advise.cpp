#include "app/check/advise.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"

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

// Those of the two that were asked for: "0.0518 N", "12.30 um", or both.
std::string both(const trial::Accuracy& asked, const std::string& force, const std::string& way) {
  if (std::isnan(asked.way)) return force;
  return std::isnan(asked.force) ? way : force + " and " + way;
}
std::string errs_by(const trial::PrecisionPoint& point, const trial::Accuracy& asked) {
  return both(asked, fmt::format("{:.4f} N", point.error), fmt::format("{:.2f} um", point.way * 1e6));
}
// The range in which another converged run may put the error.
std::string spread_of(const trial::Precision& all, const trial::PrecisionPoint& point,
                      const trial::Accuracy& asked) {
  const trial::Spread force = all.error_spread(point), way = all.way_spread(point);
  return both(asked, fmt::format("{:.4f} to {:.4f} N", force.least, force.most),
              fmt::format("{:.2f} to {:.2f} um", way.least * 1e6, way.most * 1e6));
}
bool may_be_more(const trial::Precision& all, const trial::PrecisionPoint& point,
                 const trial::Accuracy& asked) {
  return all.error_spread(point).most > asked.force || all.way_spread(point).most > asked.way;
}
std::string words(const trial::Accuracy& asked) {
  return both(asked, fmt::format("{:g} N", asked.force), fmt::format("{:g} um", asked.way * 1e6));
}

std::string advised(const trial::Precision& all, const trial::Accuracy& asked) {
  const trial::PrecisionPoint* best = cheapest(all.points, asked);
  if (best == nullptr) return fmt::format("advice      none of these errs by less than {}\n", words(asked));
  std::string text = fmt::format(
      "advice     {}\n            errs by {}, allowed {}, {:.0f} x real time\n            by another "
      "converged run {}{}\n",
      (best->shipped ? " as it is:" : "") + settings_text(all, *best), errs_by(*best, asked), words(asked),
      1.0 / best->cpu, spread_of(all, *best, asked),
      may_be_more(all, *best, asked) ? ": that may be more than allowed" : "");
  if (const trial::PrecisionPoint* next = next_cheaper(all.points, *best))
    text += fmt::format("            the next cheaper, {} at {:g} us, errs by {}, {:.0f} x real time\n",
                        next->integrator, next->step * 1e6, errs_by(*next, asked), 1.0 / next->cpu);
  else
    text += "            nothing cheaper was found: no step is longer than the haptic period\n";
  return text;
}

}  // namespace

std::string advice_text(const trial::Precision& all, const trial::Accuracy& asked) {
  std::string text = fmt::format(
      "\nprecision   of the true force on what is held, rms while it touches; and of the tip's path\n"
      "            {:g} s of the scene, {:.1f} s touched, judged by {} at {:g} us and another one; floor "
      "about {:.4f} N, {:.2f} um\n",
      all.seconds, static_cast<double>(all.touched) * all.tick, all.converged.integrator,
      all.converged.step * 1e6, all.second.error, all.second.way * 1e6);
  for (const trial::PrecisionPoint& point : all.points) text += row(point);
  return text + advised(all, asked) +
         "            judged by these errors alone: what is stable, `encounter bench stability` says\n";
}

void refuse_below_floor(const trial::Precision& all, const trial::Accuracy& asked) {
  if (all.second.meets(asked) || cheapest(all.points, asked) != nullptr) return;
  throw Error(fmt::format("an error of {} is below what this scene can tell, {}: two converged runs "
                          "({} at {:g} us, {} at {:g} us) differ by that, as counts of its sensors fall "
                          "the other way; expected at least that",
                          words(asked), errs_by(all.second, asked), all.converged.integrator,
                          all.converged.step * 1e6, all.second.integrator, all.second.step * 1e6),
              all.second.error > asked.force ? "--error-N" : "--error-um");
}

}  // namespace enc::app
