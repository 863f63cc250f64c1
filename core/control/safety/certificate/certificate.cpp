#include "core/control/safety/certificate/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace enc::certificate {

namespace {

// Motion over h, s, from speed v under a constant pull: v' = pull - a v. The position changes by v reach +
// pull sag, and the speed becomes v + (pull - a v) reach.
struct Span {
  double h, reach, sag;
  Span(double span, double a) : h(span), reach(span), sag(0.5 * span * span) {
    constexpr double kSlight = 1e-3;
    const double x = a * span;
    if (x <= 0.0) return;
    reach = -std::expm1(-x) / a;
    sag = x < kSlight ? span * span * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0)))
                      : (span - reach) / a;
  }
};

// The device. Its motion is exact except for the hand's spring, which is evaluated in the middle of a step.
struct Slide {
  double mass = 1.0, a = 0.0, spring = 0.0, friction = 0.0;  // a: damping over mass, 1/s
  double x = 0.0, v = 0.0;

  // Time to standstill under that pull, s; infinite if the device does not stop.
  [[nodiscard]] double stops_after(double pull) const {
    const double straight = v / -pull;
    if (!(straight >= 0.0)) return std::numeric_limits<double>::infinity();
    return a * straight < 1e-12 ? straight : std::log1p(a * straight) / a;
  }
  // If the device stops within the span, friction is evaluated anew from there.
  void glide(double force, const Span& given) {
    Span over = given;
    for (;;) {
      const double push = force - spring * x;
      if (v == 0.0 && std::abs(push) <= friction) return;
      const double sign = v != 0.0 ? std::copysign(1.0, v) : std::copysign(1.0, push);
      double pull = (push - friction * sign) / mass;
      if (spring > 0.0) {
        const Span half(0.5 * over.h, a);
        pull = (force - spring * (x + v * half.reach + pull * half.sag) - friction * sign) / mass;
      }
      const double stops = v != 0.0 ? stops_after(pull) : std::numeric_limits<double>::infinity();
      const bool stopped = stops < over.h;
      const double after = v + (pull - a * v) * over.reach;
      if (v == 0.0 && after * sign <= 0.0) return;
      const Span moved = stopped ? Span(stops, a) : over;
      x += v * moved.reach + pull * moved.sag;
      v = stopped ? 0.0 : after;
      if (!stopped) return;
      over = Span(over.h - stops, a);
    }
  }
};

// The control law with all of its state.
struct Law {
  const SampledLoop& loop;
  double stiffness, damper, count;
  LoopDelay delay = late(loop);
  double error = 0.0, rate = 0.0;
  std::vector<double> readings{}, forces{};  // newest first

  [[nodiscard]] double read(double x) const {
    return count > 0.0 ? count * (std::floor(x / count) + 0.5) : x;
  }
  void begin(double x) {
    error = read(x);
    readings.assign(static_cast<std::size_t>(loop.ticks), error);
    forces.assign(static_cast<std::size_t>(delay.whole) + 2, -stiffness * error);
  }
  void tick(double x) {
    const double now = read(x), speed = (now - readings.back()) / (loop.ticks * loop.period);
    std::rotate(readings.begin(), readings.end() - 1, readings.end());
    readings.front() = now;
    const double a = loop.filter;
    error = std::isnan(a) ? now : (a * now + error) / (1.0 + a);
    rate = std::isnan(a) ? speed : (a * speed + rate) / (1.0 + a);
    std::rotate(forces.begin(), forces.end() - 1, forces.end());
    forces.front() = -(stiffness * error + damper * rate);
  }
};

// Range of an oscillation, peak to peak.
struct Swing {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void see(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  [[nodiscard]] double of() const { return high - low; }
};

// s: a hundred oscillations, plus the time that a damper takes to creep to rest.
struct Watch {
  static constexpr double kMost = 1e5;  // periods
  double wanted, least;                 // periods
  Watch(const SampledLoop& loop, double stiffness, double damper) {
    constexpr double kSwings = 100.0, kFew = 20.0, kShortest = 0.5, kPeriods = 400.0;
    const double spring = stiffness + loop.hand.stiffness;
    const double swing = 6.3 * std::sqrt((loop.mass + loop.hand.mass) / spring);
    const double creeps = 8.0 * std::abs(loop.damping + loop.hand.damping + damper) / spring;
    least = std::max({kFew * swing, creeps, 40.0 * loop.delay}) / loop.period;
    wanted = std::max({kSwings * swing / loop.period, least, kShortest / loop.period, kPeriods});
  }
  [[nodiscard]] std::size_t quarter() const {
    return static_cast<std::size_t>(std::clamp(wanted, 0.0, kMost)) / 4;
  }
};

// One period of law and device.
class Run {
 public:
  // Number of parts of a step that are short for the hand's spring; 1 without a spring, 0 if there would be
  // too many.
  static int parts_of(const SampledLoop& loop, double span) {
    constexpr double kFine = 0.02, kMany = 4000.0;
    const double mass = loop.mass + loop.hand.mass, damper = loop.damping + loop.hand.damping;
    const double spring = loop.hand.stiffness;
    if (spring == 0.0) return 1;
    // If the damper is stiff for the mass, the device follows no faster than spring over damper.
    const double swings = std::sqrt(spring / mass);
    const double quickest = damper > 0.0 ? std::min(swings, spring / damper) : swings;
    const double parts = std::ceil(span * quickest / kFine);
    return parts <= kMany ? static_cast<int>(std::max(parts, 4.0)) : 0;
  }
  Run(const SampledLoop& loop, const Steps& steps, double stiffness, double damper, double from)
      : law_{loop, stiffness, damper, steps.encoder},
        early_(law_.delay.part * loop.period),
        parts_{early_ > 0.0 ? parts_of(loop, early_) : 0, parts_of(loop, loop.period - early_)} {
    slide_.mass = loop.mass + loop.hand.mass;
    slide_.a = (loop.damping + loop.hand.damping) / slide_.mass;
    slide_.spring = loop.hand.stiffness;
    slide_.friction = steps.friction;
    slide_.x = from;
    first_ = Span(early_ / std::max(1, parts_[0]), slide_.a);
    rest_ = Span((loop.period - early_) / std::max(1, parts_[1]), slide_.a);
    law_.begin(from);
  }
  [[nodiscard]] bool affordable() const { return parts_[1] > 0 && (early_ == 0.0 || parts_[0] > 0); }
  double tick() {
    law_.tick(slide_.x);
    const auto whole = static_cast<std::size_t>(law_.delay.whole);
    for (int k = 0; k < parts_[0]; ++k) slide_.glide(law_.forces[whole + 1], first_);
    for (int k = 0; k < parts_[1]; ++k) slide_.glide(law_.forces[whole], rest_);
    return slide_.x;
  }

 private:
  Law law_;
  double early_;  // s, part of a period in which the previous force still acts
  int parts_[2];
  Slide slide_{};
  Span first_{0.0, 0.0}, rest_{0.0, 0.0};
};

bool can_be(const SampledLoop& loop, const Steps& steps, double stiffness, double damper,
            double disturbance) {
  return loop.known() && std::isfinite(steps.friction) && steps.friction >= 0.0 &&
         std::isfinite(steps.encoder) && steps.encoder >= 0.0 && std::isfinite(stiffness) &&
         stiffness >= 0.0 && std::isfinite(damper) && std::isfinite(disturbance) && disturbance > 0.0;
}

}  // namespace

ReleaseResult release(const SampledLoop& loop, const Steps& steps, double stiffness, double damper,
                      double disturbance) {
  if (!can_be(loop, steps, stiffness, damper, disturbance)) return {};
  if (stiffness + loop.hand.stiffness == 0.0) return {Rest::still, 0.0, 0.0};  // nothing pulls
  const bool linear = steps.friction == 0.0 && steps.encoder == 0.0;
  const auto by_eigenvalues = [&] { return stable(loop, stiffness, damper) ? Rest::still : Rest::away; };
  const Watch watch(loop, stiffness, damper);
  Run run(loop, steps, stiffness, damper, disturbance);
  if (!run.affordable() || (linear && watch.least > Watch::kMost))
    return {linear ? by_eigenvalues() : Rest::unknown};
  const bool holds = holds_counts(loop, steps, stiffness, damper);
  const std::size_t quarter = watch.quarter();
  bool moved = false;
  double before = kUnset;
  for (std::size_t quarters = 1;; ++quarters) {
    Swing swing;
    const auto after = [&](std::size_t i) {
      return static_cast<double>((quarters - 1) * quarter + i) * loop.period;
    };
    for (std::size_t i = 0; i < quarter; ++i) {
      swing.see(run.tick());
      if (!(std::max(-swing.low, swing.high) < 20.0 * disturbance))
        return {Rest::away, 2.0 * std::max(-swing.low, swing.high), after(i + 1)};
    }
    moved = moved || swing.low != disturbance || swing.high != disturbance;
    const double last = swing.of(), time = after(quarter);
    if (quarters >= 4) {
      // A device that has not moved by then never will, because the law gets no new reading.
      if (moved && watch.least > Watch::kMost) return {Rest::unknown, last, time};
      if (last <= 0.01 * disturbance) return {Rest::still, last, time};
      if (last > 1.1 * before) return {Rest::away, last, time};
      if (last > 0.9 * before) return {linear ? by_eigenvalues() : Rest::cycle, last, time};
      if (holds) return {Rest::still, last, time};
      if (static_cast<double>((quarters + 1) * quarter) > Watch::kMost) return {Rest::unknown, last, time};
    }
    before = last;
  }
}

namespace {

// The first figure that is not a number or has an impossible value.
std::string missing_of(const SampledLoop& loop, const Steps& steps, const Request& asked) {
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

// Stiffnesses in a row's own range are stable; any other one needs one look at the eigenvalues.
bool rests(const SampledLoop& loop, const Row& row, double stiffness, double damper) {
  return (stiffness > row.low && stiffness < row.bound) || stable(loop, stiffness, damper);
}

// Sideways, the law of an arm has more damping than the device, so some hand makes it oscillate.
bool passive(const SampledLoop& loop, const Steps& steps, double stiffness, double damper) {
  return loop.around.count == 0 && holds_counts(loop, steps, stiffness, damper) &&
         needed_damping(loop.alone(), stiffness, damper) <= loop.damping;
}

Class class_of(const SampledLoop& loop, const Steps& steps, const Request& asked, const Certificate& found) {
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

Certificate certify(const SampledLoop& loop, const Steps& steps, const Request& asked) {
  Certificate found;
  found.rows = bounds(loop, steps, asked);
  found.plane = plane_of(loop, steps, asked);
  found.missing = missing_of(loop, steps, asked);
  if (!found.missing.empty()) return found;
  const double damper = asked.damper.at(asked.stiffness);
  // The release runs along the normal, so it is no evidence if sideways motion decides.
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

Class linear_class(const SampledLoop& loop, const Steps& steps, const Request& asked) {
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
