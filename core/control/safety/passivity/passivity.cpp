#include "core/control/safety/passivity/passivity.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// The largest f with f (u + g f) <= left, which is not below 0.
double largest(double left, double u, double g) {
  const double root = std::sqrt(u * u + 4.0 * g * left);
  return u > 0.0 ? 2.0 * left / (u + root) : (root - u) / (2.0 * g);
}

// A reading is within half an encoder count of the tip. The bound grants the law that half count while the
// energy deficit is small. A push that gives out no energy is always allowed.
double bound(double left, double u, double g, double count) {
  return left > -kForgiven ? largest(std::max(0.0, left), u - 0.5 * count, g) : largest(0.0, u, g);
}

}  // namespace

void begin(Passivity& now, const PassivityTick& tick, double left) noexcept {
  now = Passivity{};
  now.on = true;
  renew(now, tick);
  now.left = std::min(left, now.stored);
  now.given = -now.left;
  now.moved = tick.moved;
}

void renew(Passivity& now, const PassivityTick& tick) noexcept {
  now.depth = tick.depth;
  now.spring = tick.spring;
  now.stored = std::max(0.0, 0.5 * tick.spring * tick.depth);
}

// Counts: a shorter reversal is attributed to the encoder (assumed: more than one count, and less than two).
constexpr double kTurnCounts = 1.5;

void observe(Passivity& now, const PassivityTick& tick, double count) noexcept {
  const double apart = now.slack + tick.moved;
  const bool turns = apart * now.way <= 0.0 && std::abs(apart) < kTurnCounts * count;
  now.moved = turns ? 0.0 : apart;
  now.slack = turns ? apart : 0.0;
  if (now.moved != 0.0) now.way = now.moved > 0.0 ? 1.0 : -1.0;
  const double work = now.pushed * now.moved;
  now.given += work;
  now.dissipated += std::max(0.0, now.taken * now.moved);
  // Exact while the stiffness is constant. A spring at rest holds no energy.
  const double held = now.stored + 0.5 * (tick.spring + now.spring) * (tick.depth - now.depth);
  const double anew = 0.5 * tick.spring * tick.depth;
  now.stored = std::max(0.0, tick.depth * now.depth > 0.0 ? held : anew);
  now.left = std::min(now.left - work, now.stored);
  now.depth = tick.depth;
  now.spring = tick.spring;
}

double passive(const Passivity& now, double wanted, double per_newton, double count) noexcept {
  const double u = now.moved + per_newton * now.pushed;
  const double most = bound(now.left, wanted > 0.0 ? u : -u, per_newton, count);
  return std::copysign(std::min(std::abs(wanted), most), wanted);
}

double way_left(const Passivity& now, double forgiven, double push, double stiffness) noexcept {
  return largest(std::max(0.0, now.left + forgiven), std::max(0.0, push), 0.5 * stiffness);
}

void hold(Passivity& now, double pushed, double wanted) noexcept {
  now.pushed = pushed;
  now.taken = wanted - pushed;
  now.most = std::max(now.most, std::abs(now.taken));
}

}  // namespace enc
