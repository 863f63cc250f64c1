#include "core/safety/certificate/certificate.h"

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
  } figures[] = {{"mass", loop.mass, loop.hand.mass <= 0.0},
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
  return loop.known() ? "" : "ticks, filter or delay";
}

Class class_of(const SampledLoop& loop, const Steps& steps, const Asked& asked, const Certificate& found) {
  const double stiffness = asked.stiffness, damper = asked.damper.at(stiffness);
  const bool counted = stiffness * steps.encoder <= 2.0 * steps.friction;
  if (counted && needed_damping(loop.alone(), stiffness, damper) <= loop.damping) return Class::passive;
  if (stable(loop.alone(), stiffness, damper)) return Class::alone;
  if (stable(loop, stiffness, damper)) return Class::held;
  return found.small.rest == Rest::still ? Class::local : Class::unstable;
}

}  // namespace

Certificate certify(const SampledLoop& loop, const Steps& steps, const Asked& asked) {
  Certificate found;
  found.rows = bounds(loop, steps, asked);
  found.plane = plane_of(loop, steps, asked.stiffness);
  found.missing = missing_of(loop, steps, asked);
  if (!found.missing.empty()) return found;
  const double damper = asked.damper.at(asked.stiffness);
  found.small = release(loop.alone(), steps, asked.stiffness, damper, kSmall);
  found.large = release(loop.alone(), steps, asked.stiffness, damper, kLarge);
  found.verdict = class_of(loop, steps, asked, found);
  return found;
}

const Row& row_of(const Certificate& certificate, const std::string& name) {
  const auto found = std::find_if(certificate.rows.begin(), certificate.rows.end(),
                                  [&](const Row& row) { return row.name == name; });
  if (found == certificate.rows.end()) throw std::out_of_range("no row " + name);
  return *found;
}

}  // namespace enc::certificate
