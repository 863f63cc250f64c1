#include "core/control/task/meet/impedance.h"

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
