#include "trial/limits.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace enc::trial {
namespace {

bool is_pressed(const models::Setup& setup, std::size_t i) {
  const std::optional<UserSpec>& user = setup.scene.user;
  return user && user->kind == UserKind::press_release &&
         pressed_object(setup.scene.objects, user->object, "user") == i;
}

PressPoint touched_point(const models::Setup& setup, const Scene& scene, std::size_t i) {
  if (is_pressed(setup, i)) return press_point(setup.scene, *setup.scene.user);
  const Object& object = scene.objects[i];
  const Nearest near = object.surface.nearest(object.X_OW * Point<'W'>(0, 0, 0));
  return {object.X_WO * near.point, object.X_WO * near.normal};
}

// The force of a press to a depth, the most on the way.
double asked_at(const Impedance& law, const Object& object, double depth) {
  constexpr int kSteps = 50;
  double most = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const double d = depth * i / kSteps;
    const Felt felt = felt_at(object.interaction, object.stiffness, law.rig.stiffness, d);
    most = std::max(most, felt.stiffness * (d - felt.sunk));
  }
  return most;
}

ArmStrength strength_at(const models::Setup& setup, const Scene& scene, std::size_t i) {
  const Impedance& law = impedance_of(scene);
  const Object& object = scene.objects[i];
  const std::optional<UserSpec>& user = setup.scene.user;
  const bool pressed = is_pressed(setup, i);
  const TouchedPlace at = touched_place(setup, scene, i);
  const PerJoint& q = at.joints;
  const PerJoint held = law.arm.gravity(q, law.prop_mass, Payload::exact);
  const Vec<'R'>& out = at.way;
  const Motors::Strength strength = law.motors.strength(law.arm, q, held, out);
  ArmStrength found{setup.scene.objects[i].name, strength.peak, strength.lasting};
  if (!pressed || object.interaction.kind == Interaction::passive) return found;
  const double deepest =
      user->depths.empty() ? user->depth : *std::max_element(user->depths.begin(), user->depths.end());
  found.asked = std::isnan(user->push) ? asked_at(law, object, deepest) : user->push;
  found.asked_for = user->hold_time + 0.5 * (user->press_time + user->release_time);
  found.holds_for = law.motors.holds_for(law.arm, q, held, out, found.asked);
  found.presses = static_cast<std::int64_t>(user->approach.size()) * user->repeats;
  const double fastest = *std::max_element(user->approach.begin(), user->approach.end());
  const double pause = user->rest_time + user->approach_from / fastest;
  found.gives_way_in =
      law.motors.gives_way_in(law.arm, q, held, out, found.asked, {found.asked_for, pause, found.presses});
  return found;
}

}  // namespace

TouchedPlace touched_place(const models::Setup& setup, const Scene& scene, std::size_t i) {
  TouchedPlace found{touched_point(setup, scene, i), {}, {}, is_pressed(setup, i)};
  const Arm& arm = impedance_of(scene).arm;
  found.joints = arm.zero();
  static_cast<void>(arm.inverse(scene.X_WR.inverse() * found.at.point, found.joints));
  found.way = scene.X_WR.inverse() * found.at.normal;
  return found;
}

double stiffest_asked(const Impedance& law, const Object& object) {
  const double floor = object.interaction.kind == Interaction::click ? object.interaction.floor : 0.0;
  return std::max(std::isnan(object.stiffness) ? law.rig.stiffness : object.stiffness, floor);
}

std::vector<ArmStrength> arm_strengths(const models::Setup& setup, const Scene& scene) {
  std::vector<ArmStrength> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) found.push_back(strength_at(setup, scene, i));
  return found;
}

std::string beyond_text(const ArmStrength& at) {
  if (at.asked > at.peak)
    return fmt::format(
        "object '{}' is pressed with {:.2f} N, and there the motors push with at most {:.2f} N; press "
        "less deep, or make it softer",
        at.object, at.asked, at.peak);
  if (at.gives_way_in > 0)
    return fmt::format(
        "object '{}' is pressed with {:.2f} N for {:.0f} s{}, and cold motors hold that for {:.0f} s (for "
        "hours {:.2f} N); press less deep, or shorter{}",
        at.object, at.asked, at.asked_for,
        at.presses > 1 ? fmt::format(", press {} of {}", at.gives_way_in, at.presses) : "", at.holds_for,
        at.lasting, at.presses > 1 ? ", or rest longer" : "");
  return {};
}

}  // namespace enc::trial
