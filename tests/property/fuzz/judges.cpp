#include "tests/property/fuzz/judges.h"

#include <cmath>

#include <fmt/format.h>

namespace enc::test {
namespace {

constexpr double kGuard = 50e-6;  // m

}  // namespace

std::string Modes::judge(const Scene& scene, const State& state, const Outputs& out, bool well) {
  const bool tool_known = std::isfinite(out.gap);
  const double dt = scene.dt;
  well_ = well ? well_ + dt : 0.0;
  judged += well_ > 1.5 ? 1 : 0;
  // After all has been well for so long, nothing is held: but an arm that is stuck, while the finger is
  // there, and a tip that is outside and on its way back.
  if (out.mode == Mode::hold && well_ > 1.5 && !recall<Meeting>(state).aim.stuck &&
      !recall<Commanded>(state).following.lost && (out.why & kOutsideObject) == 0)
    return "hold goes on: " + why_text(out.why);
  if ((out.mode == Mode::hold) != ((out.why & kHoldReasons) != 0))
    return "hold without a reason, or a reason without";
  if (out.mode == Mode::hold) return {};
  const bool far =
      state.mode == Mode::follow && scene.has_tracker && tool_known && out.gap > scene.follow.pause;
  far_ = far ? far_ + dt : 0.0;
  if (far_ > 1.5 * dt) return "follow beyond the pause distance";
  restore_ = state.mode == Mode::restore ? restore_ + dt : 0.0;
  if (restore_ > 2.0 + 2.0 * dt) return "restore goes on";
  if (scene.impedance()) {
    if (state.mode == Mode::contact && out.gap > scene.contact.leave_gap)
      return "contact beyond the leave gap";
    return {};
  }
  if (state.mode != Mode::contact) {
    loose_ = in_contact_ = alone_ = 0.0;
    return {};
  }
  in_contact_ += dt;
  const double force = -out.force.xyz[2];
  const bool own = tool_known && (!scene.has_tracker || state.tool.value.tool == contact_of(state).tool);
  const bool near = own && out.gap <= scene.contact.leave_gap;
  const bool elsewhere = !own && (!tool_known || out.gap > scene.force.tare_clearance);
  const bool same = std::abs(force - same_force_) <= 0.15 * scene.force.contact;
  if (!same) same_force_ = force;
  alone_ = !own && same ? alone_ + dt : 0.0;
  // Late poses do not count, and how late they are is not seen here: half as long again.
  const double longest = elsewhere && force <= 3.0 * scene.force.contact ? 7.5 : 90.0;
  const bool pressed = force >= 0.5 * scene.force.contact && (own ? out.gap <= 10e-3 : alone_ <= longest);
  const bool coming = in_contact_ < 0.5 && tool_known && out.gap <= 10e-3;
  loose_ = near || pressed || coming ? 0.0 : loose_ + dt;
  const bool damped = scene.render()->damping && !(tool_known && out.gap > 10e-3);
  if (loose_ > scene.contact.leave_time + (damped ? 5.0 : 0.0) + 3.0 * dt)
    return fmt::format("contact goes on: force {} N, gap {} mm", force, out.gap * 1e3);
  return {};
}

std::string Limits::judge(const Scene& scene, const State& state, const Outputs& out) {
  return scene.impedance() ? judge_arm(scene, state, out) : judge_machine(scene, state, out);
}

std::string Limits::judge_machine(const Scene& scene, const State& state, const Outputs& out) {
  if (!state.started) return {};
  if (!out.tip.valid()) return "the command is not a pose";
  if (!scene.reach.contains(out.tip)) return "the command is out of reach";
  const Vec3 at = out.tip.p();
  if (!known_) before_ = at - scene.dt * recall<Commanded>(state).command_velocity.e();
  const Vec3 velocity = (at - before_) / scene.dt;
  const double change = (velocity - velocity_).norm() / scene.dt;
  known_ = true;
  before_ = at;
  velocity_ = velocity;
  if (velocity.norm() > scene.reach.speed * (1 + 1e-9)) return fmt::format("{} m/s", velocity.norm());
  if (change > scene.reach.acceleration * (1 + 1e-6)) return fmt::format("{} m/s^2", change);
  if (!state.entered || state.object < 0) return {};
  const Object& object = scene.objects[static_cast<std::size_t>(state.object)];
  const double outside =
      object.surface.nearest(object.X_WO.inverse() * (scene.X_WR * recall<Commanded>(state).command))
          .distance +
      scene.tip_radius;
  if (outside > kGuard) return fmt::format("the tip is sent {:.1f} um outside", outside * 1e6);
  return {};
}

std::string Limits::judge_arm(const Scene& scene, const State& state, const Outputs& out) {
  if (!out.arm_force.finite()) return {};
  const ArmRig& rig = scene.impedance()->rig;
  if (!(out.felt.norm() <= rig.peak * (1 + 1e-9))) return "more force than the arm has";
  const Vec3 velocity = recall<Meeting>(state).aim.velocity.e(), at = recall<Meeting>(state).aim.target.e();
  // Along the normal of a ball that is hit the finger moves the prop, and the target is where that is.
  const bool hit = out.mode == Mode::contact && state.object >= 0 &&
                   scene.objects[static_cast<std::size_t>(state.object)].interaction.kind == Interaction::hit;
  const Vec3 normal = hit ? Vec3(contact_of(state).X_WN.q() * Vec3::UnitZ()) : Vec3(Vec3::Zero());
  const auto of_the_arm = [&](const Vec3& v) { return Vec3(v - normal * normal.dot(v)); };
  if (velocity.norm() > rig.speed * (1 + 1e-9)) return fmt::format("target at {} m/s", velocity.norm());
  std::string what;
  // A hold, or an arm that was not heard of, begins anew where the arm is.
  if (known_ && !anew(out) && of_the_arm(at - before_).norm() > rig.speed * scene.dt * (1 + 1e-6))
    what = fmt::format("target leaps by {} mm", 1e3 * (at - before_).norm());
  const double change = of_the_arm(velocity - velocity_).norm();
  const double most = recall<Meeting>(state).aim.hurried ? rig.reach_acceleration : rig.acceleration;
  if (known_ && !anew(out) && change > most * scene.dt * (1 + 1e-6))
    what = fmt::format("target at {} m/s^2", change / scene.dt);
  known_ = recall<Meeting>(state).aim.target.finite() && !anew(out);
  before_ = at;
  velocity_ = velocity;
  return what;
}

}  // namespace enc::test
