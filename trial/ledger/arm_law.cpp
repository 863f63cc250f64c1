#include "trial/ledger/arm_law.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {
namespace {

// Stiffness along the normal over that of the free tip, and how far the target is behind the surface.
struct Static {
  double gain, sunk;
};
Static static_at(const LawAt& law, double depth) {
  if (!law.felt) return {1.0, 0.0};
  const Felt felt =
      felt_at(law.object->interaction, law.object->stiffness, law.stiffness, std::max(0.0, depth));
  return {felt.stiffness * law.firmness / law.stiffness, felt.sunk};
}

double along(const LawAt& law, double depth) {
  const Static at = static_at(law, depth);
  return at.gain * law.stiffness * (depth - at.sunk);
}

double ball_push(const LawAt& law, double depth) {
  return law.object->stiffness * law.firmness * std::max(0.0, depth);
}

}  // namespace

LawAt law_at(const Glance& glance, const Impedance& law) {
  LawAt at;
  const State& state = *glance.state;
  const Meeting& now = recall<Meeting>(state);
  at.live = glance.out.mode != Mode::hold && glance.out.arm_force.finite() && now.aim.target.finite();
  if (!at.live) return at;
  const bool contact = state.mode == Mode::contact;
  at.object = state.object < 0 ? nullptr : &glance.scene.objects[static_cast<std::size_t>(state.object)];
  at.felt = contact && at.object != nullptr && at.object->stiffness > 0.0;
  at.real = at.object != nullptr && at.object->interaction.kind == Interaction::passive;
  at.hit = contact && at.object != nullptr && at.object->interaction.kind == Interaction::hit;
  if (glance.out.prop_facing.finite()) at.normal = (glance.scene.X_WR * glance.out.prop_facing).e();
  at.target = now.aim.target.e();
  at.target_velocity = now.aim.velocity.e();
  at.gain = now.aim.gain;
  at.sunk = now.aim.sunk;
  if (at.object != nullptr && at.object->moving >= 0 && contact) {
    const Moved& moved = moved_in(state)[static_cast<std::size_t>(at.object->moving)];
    at.firmness = moved.firmness;
    // Where the tick that saw this depth had its surface: by now the ball has gone on.
    const Point<'W'> tip = glance.scene.X_WR * glance.in.arm.value.tip;
    at.ball = tip.e() + moved.depth * at.normal;
  }
  at.stiffness = law.rig.stiffness;
  return at;
}

double ball_depth(const LawAt& law, const Vec3& tip) { return law.normal.dot(law.ball - tip); }

Vec3 asked_force(const LawAt& law, const Vec3& error, const Vec3& rate, double depth) {
  const Vec3 f = law.along + law.stiffness * error + law.damping * rate;
  Vec3 force = gain_matrix(law.normal, law.real ? law.gain : 1.0, law.gain) * f;
  if (law.hit)
    force += law.normal * ((std::isnan(depth) ? 0.0 : ball_push(law, depth)) - law.normal.dot(force));
  return force;
}

Vec3 ideal_force(const LawAt& law, const TipAt& tip) {
  if (!law.live) return Vec3::Zero();
  const Vec3 error = law.target - tip.at;
  const Static at = static_at(law, law.normal.dot(error));
  LawAt ideal = law;
  ideal.gain = at.gain;
  return asked_force(ideal, error - at.sunk * law.normal, law.target_velocity - tip.velocity,
                     ball_depth(law, tip.at));
}

double damped(const LawAt& law, const TipAt& tip) {
  if (!law.live) return 0.0;
  const Vec3 rate = law.target_velocity - tip.velocity;
  const double out = law.normal.dot(rate);
  const double gain = static_at(law, law.normal.dot(law.target - tip.at)).gain;
  const double across = law.real ? gain : 1.0;
  return law.damping * (across * (rate.squaredNorm() - out * out) + (law.hit ? 0.0 : gain) * out * out);
}

double stored(const LawAt& law, const TipAt& tip, int parts) {
  if (!law.live) return 0.0;
  const Vec3 error = law.target - tip.at;
  const double depth = law.normal.dot(error);
  const double across = law.real ? static_at(law, depth).gain : 1.0;
  double sum = 0.5 * across * law.stiffness * (error.squaredNorm() - depth * depth);
  if (law.hit) {
    const double pressed = std::max(0.0, ball_depth(law, tip.at));
    return sum + 0.5 * ball_push(law, pressed) * pressed;
  }
  const double h = depth / parts;
  for (int i = 0; i < parts; ++i)
    sum += h / 6.0 * (along(law, i * h) + 4.0 * along(law, (i + 0.5) * h) + along(law, (i + 1) * h));
  return sum;
}

LawAt between(const LawAt& a, const LawAt& b) {
  LawAt mean = b;
  if (!a.live || !b.live || a.object != b.object || a.felt != b.felt) return a;
  mean.target = 0.5 * (a.target + b.target);
  mean.target_velocity = 0.5 * (a.target_velocity + b.target_velocity);
  mean.normal = (a.normal + b.normal).normalized();
  mean.ball = 0.5 * (a.ball + b.ball);
  mean.firmness = 0.5 * (a.firmness + b.firmness);
  mean.damping = 0.5 * (a.damping + b.damping);
  mean.along = a.along;
  return mean;
}

}  // namespace enc::trial
