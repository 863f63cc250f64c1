#include "sim/hand/places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"
#include "core/control/scene/press_check.h"

namespace enc::sim {
namespace {

double expected_of_ball(const Object&) {
  constexpr double kBall = 1900.0;  // N/m: mean of the ball's press curve
  return kBall;
}
// Of what an arm renders, its stiffness; of a real thing nothing.
double expected_of_rendered(const Object& object) {
  return std::isnan(object.stiffness) ? 0.0 : object.stiffness;
}

bool hexapod_presses(const Scene& scene, const Place& place, const Tool& tool) {
  const Object& object = scene.objects[static_cast<std::size_t>(place.object)];
  return in_the_way(scene, place.at.normal, tool) == Obstacle::none && carried_to(scene, place.at, 0.0) &&
         carried_to(scene, place.at, object.limit);
}
bool arm_reaches(const Scene& scene, const Place& place, const Tool&) {
  PerJoint q{};
  return scene.impedance()->arm.inverse(scene.X_WR.inverse() * place.at.point, q);
}

constexpr PerMachine<HandAtMachine> kHands{.hexapod = {expected_of_ball, hexapod_presses},
                                           .arm = {expected_of_rendered, arm_reaches}};

}  // namespace

const HandAtMachine& hand_at(const SceneSpec& scene) { return kHands.of(scene); }

Places::Places(const SceneSpec& scene, const Scene& prepared)
    : hand_(hand_at(scene)),
      scene_(prepared),
      everywhere_(scene.user->reaches.has_value()),
      ball_(static_cast<std::int32_t>(pressed_object(scene.objects, scene.user->object, "user"))),
      lowest_(std::cos(everywhere_ ? scene.user->reaches->polar_most : scene.user->session->polar_most)),
      spread_(everywhere_ ? scene.user->reaches->spread : 0.0) {}

// Of a plane round about its origin, of a button on the middle half of its face, at which people aim, of a
// ball on its cap.
PressPoint Places::on(const Object& object, Stream& draws) const {
  const Vec<'O'> up(0, 0, 1);
  if (const auto* sphere = std::get_if<Sphere>(&object.surface.shape())) {
    const double z = 1.0 - (1.0 - lowest_) * draws.uniform();
    const double turn = 2.0 * std::numbers::pi * draws.uniform();
    const double out = std::sqrt(std::max(0.0, 1.0 - z * z));
    const Vec<'W'> normal(out * std::cos(turn), out * std::sin(turn), z);
    return {object.X_WO.origin() + sphere->radius * normal, normal};
  }
  const auto* button = std::get_if<Button>(&object.surface.shape());
  const double x = draws.uniform() - 0.5, y = draws.uniform() - 0.5;
  const Point<'O'> at = button != nullptr ? Point<'O'>(0.5 * x * button->width, 0.5 * y * button->height, 0.0)
                                          : Point<'O'>(2.0 * x * spread_, 2.0 * y * spread_, 0.0);
  return {object.X_WO * at, object.X_WO * up};
}

Place Places::draw(Stream& draws, const Tool& tool) const {
  constexpr int kTries = 1000;
  const auto count = static_cast<double>(scene_.objects.size());
  for (int i = 0; i < kTries; ++i) {
    Place place{ball_, {}};
    if (everywhere_) place.object = static_cast<std::int32_t>(std::min(count - 1.0, count * draws.uniform()));
    place.at = on(scene_.objects[static_cast<std::size_t>(place.object)], draws);
    if (hand_.pressable(scene_, place, tool)) return place;
  }
  if (everywhere_) throw Error("the machine reaches none of the objects", "user.reaches");
  throw Error("the machine can press the ball nowhere within polar_max_deg", "user.session.polar_max");
}

double Places::gap(const Point<'W'>& tip, const Tool& tool) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Object& object : scene_.objects)
    least = std::min(least, object.surface.nearest(object.X_WO.inverse() * tip).distance);
  return least - tool.tip.radius;
}

}  // namespace enc::sim
