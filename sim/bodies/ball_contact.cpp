#include "sim/bodies/ball_contact.h"

#include <cmath>

#include "core/base/error.h"

namespace enc::sim {
namespace {

BallParameters checked(const BallTruth& truth, double radius, double probe_radius) {
  BallParameters ball = ball_of(truth, radius);
  if (std::abs(probe_radius - ball.probe_radius) > 1e-9)
    throw Error("the law of the simulated ball holds for a probe of 10 mm radius; write radius_mm = 10",
                "probe.radius");
  return ball;
}

}  // namespace

BallParameters ball_of(const BallTruth& truth, double radius) {
  BallParameters ball = ball_set(truth.set);
  const auto put = [](double& to, double given) {
    if (!std::isnan(given)) to = given;
  };
  ball.outer_radius = radius;
  put(ball.outer_radius, truth.radius);
  put(ball.wall, truth.wall);
  put(ball.felt, truth.felt);
  put(ball.rubber_modulus, truth.rubber_modulus);
  put(ball.pressure, truth.pressure);
  put(ball.felt_modulus, truth.felt_modulus);
  put(ball.friction, truth.friction);
  put(ball.friction_travel, truth.friction_travel);
  for (std::size_t i = 0; i < 3; ++i) {
    put(ball.relaxing[i], truth.relaxing[i]);
    put(ball.relaxation[i], truth.relaxation[i]);
  }
  return ball;
}

BallContact::BallContact(const BallTruth& truth, const Point<'W'>& centre, double radius, double probe_radius)
    : truth_(truth),
      centre_(centre + Vec<'W'>(truth.misplaced)),
      radius_(std::isnan(truth.radius) ? radius : truth.radius),
      probe_radius_(probe_radius),
      plant_(checked(truth, radius, probe_radius)) {}

// A ball is not the same everywhere (the ITF allows 0.76 mm between three axes). The spots over its poles are
// as the parameters say; away from them it is stiffer by `uneven`.
double BallContact::evenness(const Vec3& normal) const {
  constexpr double kSpot = 3e-3;  // m on the surface: about the patch that a probe first touches
  const double away = radius_ * std::asin(std::min(1.0, std::hypot(normal.x(), normal.y()))) / kSpot;
  return 1.0 + truth_.uneven * -std::expm1(-away * away);
}

// s' = v / travel (1 - s along v), Dahl's form: it sticks elastically at first and slides in the end.
void BallContact::drag(const Vec3& travel, const Vec3& normal) {
  const Vec3 across = travel - normal * normal.dot(travel);
  Vec3 stretch = state_.stretch.e() - normal * normal.dot(state_.stretch.e());
  if (const double way = across.norm(); way > 0.0) {
    const Vec3 end = across / way;
    stretch = end - (end - stretch) * std::exp(-way / truth_.surface_travel);
  }
  state_.stretch = Vec<'W'>(stretch);
}

void BallContact::move(const Point<'W'>& probe, double dt) {
  const Vec3 apart = (probe - centre_).e();
  const double distance = apart.norm();
  const Vec3 normal = distance > 0.0 ? Vec3(apart / distance) : Vec3(Vec3::UnitZ());
  state_.penetration = radius_ + probe_radius_ - distance;
  const double pressed = evenness(normal) * plant_.step(state_.ball, state_.penetration, dt);
  if (state_.penetration > 0.0 && state_.probe.finite())
    drag((probe - state_.probe).e(), normal);
  else
    state_.stretch = Vec<'W'>::zero();
  state_.probe = probe;
  state_.force = Vec<'W'>(Vec3(pressed * (normal - truth_.surface_friction * state_.stretch.e())));
  state_.touched = Point<'W'>(Vec3(probe.e() - probe_radius_ * normal));
}

}  // namespace enc::sim
