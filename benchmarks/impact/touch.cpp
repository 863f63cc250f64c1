#include "benchmarks/impact/touch.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "benchmarks/kit/statistics.h"
#include "core/base/error.h"
#include "sim/hand/user.h"
#include "trial/assemble/assemble.h"
#include "trial/family.h"
#include "trial/trial.h"

namespace enc::bench::impact {
namespace {

constexpr double kBefore = 0.02;  // s, recorded before the touch

// Listener of MuJoCo's callback. There is one callback for the whole program, so each thread has its own
// listener.
struct Listener {
  int tip_geom = -1, tool_qpos = 0, tool_qvel = 0;
  std::vector<Step> steps;
  double heard = -1.0;  // s
};
thread_local Listener* listening = nullptr;

mjfGeneric before_us = nullptr;  // the legs of a structural machine use this callback, too

void listen(const mjModel* m, mjData* d) {
  if (before_us != nullptr) before_us(m, d);
  Listener* to = listening;
  if (to == nullptr || d->time <= to->heard) return;  // later stages of an integrator step
  to->heard = d->time;
  const auto three = [](const double* from) { return Vec3(from[0], from[1], from[2]); };
  to->steps.push_back({d->time, three(d->geom_xpos + 3 * to->tip_geom), three(d->qpos + to->tool_qpos),
                       three(d->qvel + to->tool_qvel), three(d->qfrc_constraint + to->tool_qvel)});
}

std::mutex one_at_a_time;

class Ear {
 public:
  Ear(Listener& to, sim::Physics& physics, bool arm) {
    const mjModel* m = physics.model();
    to.tip_geom = physics.id(mjOBJ_GEOM, arm ? "prop_front" : "haptic_tip");
    const int joint = m->body_jntadr[physics.id(mjOBJ_BODY, "tool")];
    to.tool_qpos = m->jnt_qposadr[joint];
    to.tool_qvel = m->jnt_dofadr[joint];
    const std::scoped_lock lock(one_at_a_time);
    if (mjcb_control != listen) before_us = std::exchange(mjcb_control, listen);
    listening = &to;
  }
  ~Ear() { listening = nullptr; }
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;
};

// Judges the twin and the reference law by equal criteria.
class Judge {
 public:
  Judge(double at, double tick) : at_(at), tick_(tick) {}
  void see(double t, double force, double grip, double h) {
    if (t < at_ || t > at_ + kWindow) return;
    const bool touching = force > 0.0;
    touch.peak = std::fmax(touch.peak, force);
    touch.grip = std::fmax(touch.grip, grip);
    touch.push = (std::isnan(touch.push) ? 0.0 : touch.push) + force * h;
    touch.breaks += before_ && !touching ? 1 : 0;
    constexpr double kLong = 5e-3;  // s
    const double gone = gone_;
    gone_ = touching ? 0.0 : gone_ + h;
    touch.long_breaks += touching && gone >= kLong ? 1 : 0;
    touch.lost += touching ? 0.0 : h;
    before_ = touching;
    if (std::abs(std::remainder(t + h, tick_)) < 0.5 * h) touch.sampled = std::fmax(touch.sampled, force);
  }
  FirstTouch touch;

 private:
  double at_, tick_;
  bool before_ = false;
  double gone_ = 0.0;  // s, since contact was lost
};

void judge_steps(const models::Setup& setup, TouchRecord& watched, double step) {
  const auto touched = std::find_if(watched.steps.begin(), watched.steps.end(),
                                    [](const Step& s) { return s.push.norm() > 0.0; });
  if (touched == watched.steps.end()) return;
  const double grip = watched.touch.grip, tick = 1.0 / setup.rig.loop.rate;
  Judge judge(touched->t - step, tick);
  judge.touch.at = touched->t - step;
  // A step's force is that of the step that ends at its time.
  for (const Step& s : watched.steps) judge.see(s.t - step, s.push.norm(), 0.0, step);
  const auto before = touched - watched.steps.begin() >= 3 ? touched - 2 : touched;
  judge.touch.speed = before->tool_v.norm();
  const Vec3 tip_v = (before->tip - std::prev(before)->tip) / step;
  judge.touch.moving = tip_v.norm();
  const Vec3 apart = before->tool - before->tip;
  judge.touch.closing = (tip_v - before->tool_v).dot(apart.normalized());
  judge.touch.grip = grip;
  watched.touch = judge.touch;
  std::erase_if(watched.steps, [at = judge.touch.at](const Step& s) { return s.t < at - kBefore; });
}

}  // namespace

TouchRecord watch_touch(const models::Setup& setup, std::uint64_t seed) {
  TouchRecord watched;
  const double h = setup.twin.stepping(setup.scene).timestep;
  try {
    Listener listener;
    trial::Trial trial(setup, {.seed = seed});
    const Ear ear(listener, trial.world().physics(), trial::family_of(setup).takes_force);
    const double start = thread_seconds();
    double touched = kUnset;
    while (trial.tick()) {
      const sim::Truth& truth = trial.world().truth();
      const double now = seconds(truth.t.time_since_epoch());
      if (truth.touching && std::isnan(touched)) touched = now;
      if (!std::isnan(touched)) watched.touch.grip = std::fmax(watched.touch.grip, truth.hand_force.norm());
      if (now > touched + kWindow + 2e-3) break;
    }
    watched.simulated = trial.result().simulated;
    watched.cpu = (thread_seconds() - start) / std::max(1e-9, listener.heard);
    if (trial.world().diverged_at() >= 0) watched.failure = trial.world().divergence();
    watched.steps = std::move(listener.steps);
  } catch (const Error& e) {
    watched.failure = e.what();
  }
  judge_steps(setup, watched, h);
  return watched;
}

namespace {

// The machine's path between the steps at which it is known.
class Way {
 public:
  explicit Way(const std::vector<Step>& steps) : steps_(steps) {}
  // Centre and velocity, m and m/s; t must not go back.
  std::pair<Vec3, Vec3> at(double t) {
    while (next_ + 1 < steps_.size() && steps_[next_].t <= t) ++next_;
    const Step& a = steps_[next_ - 1];
    const Step& b = steps_[next_];
    const Vec3 v = (b.tip - a.tip) / (b.t - a.t);
    return {a.tip + v * (t - a.t), v};
  }

 private:
  const std::vector<Step>& steps_;
  std::size_t next_ = 1;
};

struct Contact {
  const Law& law;
  double radii;
  Vec3 bristle = Vec3::Zero();
  double depth = 0.0;
  // N on the tool.
  Vec3 push(const Vec3& apart, const Vec3& moving, double h) {
    const double distance = apart.norm();
    depth = radii - distance;
    if (depth <= 0.0) {
      bristle.setZero();
      return Vec3::Zero();
    }
    const Vec3 n = apart / distance;
    const double into = -moving.dot(n);
    const double force = std::max(
        0.0, law.stiffness * std::pow(depth, law.exponent) * (1.0 + law.damping * into) + law.viscous * into);
    bristle += h * (moving + into * n);
    bristle -= n * n.dot(bristle);
    const double stiff = law.exponent == 1.0 ? law.stiffness : 1.5 * law.stiffness * std::sqrt(depth);
    const double most = law.friction * force / stiff;
    if (bristle.norm() > most) bristle *= most / bristle.norm();
    return n * force - stiff * bristle;
  }
};

}  // namespace

FirstTouch refer(const models::Setup& setup, std::uint64_t seed, const TouchRecord& measured, const Law& law,
                 double step) {
  const Scene prepared = trial::prepare_setup(setup);
  sim::User user(setup.scene, prepared, setup.twin.hand, seed);
  const ToolSpec& tool = setup.scene.tools[static_cast<std::size_t>(user.tool())];
  const double coarse = setup.twin.stepping(setup.scene).timestep, fine_from = measured.steps.at(1).t;
  Way way(measured.steps);
  Contact contact{law, tool.tip_radius + setup.twin.hexapod.tip_radius};
  Point<'W'> at = user.start();
  Vec3 v = Vec3::Zero();
  Judge judge(measured.touch.at, 1.0 / setup.rig.loop.rate);
  bool touching = false, touched = false;
  const double end = measured.steps.back().t;
  for (double t = 0.0; t < end;) {
    const bool fine = t >= fine_from - 1e-9;
    const double h = fine ? step : coarse;
    Vec3 push = Vec3::Zero();
    if (fine) {
      const auto [tip, tip_v] = way.at(t);
      push = contact.push(at.e() - tip, v - tip_v, h);
    }
    touching = push.norm() > 0.0;
    if (touching && !touched) {
      touched = true;
      judge = Judge(t, 1.0 / setup.rig.loop.rate);
      judge.touch.at = t;
      judge.touch.speed = v.norm();
    }
    const Vec<'W'> grip = user.act(t, h, at, Vec<'W'>(v), touching);
    if (touched) judge.see(t, push.norm(), grip.e().norm(), h);
    judge.touch.depth = std::max(judge.touch.depth, contact.depth);
    v += h / tool.mass * (grip.e() + push);
    at = at + Vec<'W'>(Vec3(h * v));
    t += h;
  }
  return judge.touch;
}

}  // namespace enc::bench::impact
