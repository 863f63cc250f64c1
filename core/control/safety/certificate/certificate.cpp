#include "core/control/safety/certificate/certificate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace enc::certificate {
namespace {

// The first figure that is no number, or none that can be.
std::string missing_of(const SampledLoop& loop, const Steps& steps, const Asked& asked) {
  const struct {
    const char* name;
    double value;
    bool above;  // must not be 0
  } figures[] = {{"mass", loop.mass, true},
                 {"damping", loop.damping, false},
                 {"period", loop.period, true},
                 {"delay", loop.delay, false},
                 {"friction", steps.friction, false},
                 {"encoder step", steps.encoder, false},
                 {"hand's mass", loop.hand.mass, false},
                 {"hand's damping", loop.hand.damping, false},
                 {"hand's stiffness", loop.hand.stiffness, false},
                 {"stiffness", asked.stiffness, true}};
  for (const auto& figure : figures)
    if (!std::isfinite(figure.value) || figure.value < 0.0 || (figure.above && figure.value == 0.0))
      return figure.name;
  if (!std::isfinite(asked.damper.at(asked.stiffness))) return "damper";
  if (loop.ticks < 1) return "ticks";
  if (loop.delay / loop.period + loop.ticks > kMostPeriods + 1.0) return "delay: more than 600 periods";
  return loop.known() ? "" : "filter";
}

// What is in a row's own range is stable; beyond it one look tells.
bool rests(const SampledLoop& loop, const Row& row, double stiffness, double damper) {
  return (stiffness > row.low && stiffness < row.bound) || stable(loop, stiffness, damper);
}

// Sideways the law of an arm has a damper above what the device has: some hand makes it swing.
bool passive(const SampledLoop& loop, const Steps& steps, double stiffness, double damper) {
  return loop.around.count == 0 && holds_counts(loop, steps, stiffness, damper) &&
         needed_damping(loop.alone(), stiffness, damper) <= loop.damping;
}

Class class_of(const SampledLoop& loop, const Steps& steps, const Asked& asked, const Certificate& found) {
  const double stiffness = asked.stiffness, damper = asked.damper.at(stiffness);
  if (passive(loop, steps, stiffness, damper)) return Class::passive;
  const bool alone = rests(loop.alone(), row_of(found, "exact_alone"), stiffness, damper);
  const bool held = rests(loop, row_of(found, "exact_with_hand"), stiffness, damper);
  if (alone) return held ? Class::alone : Class::unheld;
  if (held) return Class::held;
  const bool seen = found.small.rest != Rest::unknown || loop.around.count == 0;
  if (!(steps.friction > 0.0) || !seen || found.small.rest == Rest::cycle || found.small.rest == Rest::away)
    return Class::unstable;
  return found.small.rest == Rest::still ? Class::local : Class::unknown;
}

}  // namespace

Certificate certify(const SampledLoop& loop, const Steps& steps, const Asked& asked) {
  Certificate found;
  found.rows = bounds(loop, steps, asked);
  found.plane = plane_of(loop, steps, asked);
  found.missing = missing_of(loop, steps, asked);
  if (!found.missing.empty()) return found;
  const double damper = asked.damper.at(asked.stiffness);
  // The release is along the normal: it tells nothing where what is sideways decides.
  const SampledLoop along = loop.alone().along();
  const Row& alone = row_of(found, "exact_alone");
  if (loop.around.count == 0 ||
      (alone.bound > 0.0 &&
       stable(along, asked.stiffness, damper) == rests(loop.alone(), alone, asked.stiffness, damper))) {
    found.small = release(along, steps, asked.stiffness, damper, kSmall);
    found.large = release(along, steps, asked.stiffness, damper, kLarge);
  }
  found.verdict = class_of(loop, steps, asked, found);
  if (found.verdict == Class::unknown) found.missing = "what a release does: too slow to be simulated";
  return found;
}

Class linear_class(const SampledLoop& loop, const Steps& steps, const Asked& asked) {
  if (!missing_of(loop, steps, asked).empty()) return Class::unknown;
  const double stiffness = asked.stiffness, damper = asked.damper.at(stiffness);
  if (passive(loop, steps, stiffness, damper)) return Class::passive;
  const bool held = stable(loop, stiffness, damper);
  if (stable(loop.alone(), stiffness, damper)) return held ? Class::alone : Class::unheld;
  return held ? Class::held : Class::unknown;
}

const Row& row_of(const Certificate& certificate, const std::string& name) {
  const auto found = std::find_if(certificate.rows.begin(), certificate.rows.end(),
                                  [&](const Row& row) { return row.name == name; });
  if (found == certificate.rows.end()) throw std::out_of_range("no row " + name);
  return *found;
}

}  // namespace enc::certificate
