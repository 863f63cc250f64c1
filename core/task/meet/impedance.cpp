#include "core/task/meet/impedance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace enc {
namespace {

// From 0 to 1 over `width` beyond `from`, without a kink at either end; a step where there is no width.
double gradually(double depth, double from, double width) {
  if (!(width > 0.0)) return depth >= from ? 1.0 : 0.0;
  const double s = std::clamp((depth - from) / width, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

// Three springs one after another: each force k (d - sunk) takes over gradually from the one before.
Felt button_at(const InteractionSpec& button, double resistance, double depth) {
  // The bottom's spring begins where it carries what is carried at d2 already.
  const double board = button.bottom * (1.0 - button.after / button.floor);
  const double triggered = gradually(depth, button.trigger, button.gradual);
  const double bottomed = gradually(depth, button.bottom, button.gradual);
  const double above = resistance + triggered * (button.after - resistance);
  const double stiffness = above + bottomed * (button.floor - above);
  return {stiffness, bottomed * button.floor * board / stiffness};
}

}  // namespace

double corner_frequency(double a, double dt) {
  // |H|^2 = a^2 / (a^2 + 2 (1 + a) (1 - cos w dt)) of y = (a x + y_before) / (1 + a): half at this cosine.
  const double cosine = 1.0 - a * a / (2.0 * (1.0 + a));
  return cosine > -1.0 ? std::acos(cosine) / (2.0 * std::numbers::pi * dt)
                       : 0.5 / dt;  // passes half or more of everything that a tick can carry
}

namespace {

// Whether a tip that is let go beside its target comes to rest.
bool settles(const ArmRig& rig, double gain, double mass, double dt) {
  constexpr int kTicks = 2000, kBegun = 200;
  const double a = 2.0 * std::numbers::pi * rig.filter * dt;
  double x = 1.0, v = 0.0, error = 0.0, rate = 0.0, early = 0.0, late = 0.0;
  double seen[2] = {1.0, 1.0};  // one and two ticks ago
  for (int i = 0; i < kTicks; ++i) {
    error = low_pass(a, -x, error);
    rate = low_pass(a, -(x - seen[1]) / (2.0 * dt), rate);
    seen[1] = seen[0];
    seen[0] = x;
    const double push = gain * (rig.stiffness * error + rig.damping * rate) / mass;
    x += dt * v + 0.5 * dt * dt * push;
    v += dt * push;
    if (!(std::abs(x) < 1e6)) return false;
    double& most = i < kTicks / 2 ? early : late;
    if (i >= kBegun) most = std::max(most, std::abs(x));
  }
  return late < early || late < 1e-9;
}

}  // namespace

double stiffest(const ArmRig& rig, double mass, double dt) {
  double low = 0.3, high = 1e3;  // gains
  if (!settles(rig, low, mass, dt)) return 0.0;
  while (high / low > 1.001) {
    const double middle = std::sqrt(low * high);
    (settles(rig, middle, mass, dt) ? low : high) = middle;
  }
  return low * rig.stiffness;
}

Mat3 gain_matrix(const Vec3& normal, double across, double along) {
  return across * Mat3::Identity() + (along - across) * (normal * normal.transpose());
}

Felt felt_at(const InteractionSpec& interaction, double stiffness, double free, double depth) {
  const double touched = gradually(depth, 0.0, interaction.gradual);
  const double first = free + touched * (stiffness - free);
  if (interaction.kind == Interaction::click) return button_at(interaction, first, depth);
  return {first, 0.0};
}

}  // namespace enc
