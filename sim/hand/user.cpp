#include "sim/hand/user.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/track/reach.h"

namespace enc::sim {
namespace {

constexpr double kWait = 0.6;      // s before the first approach: meanwhile the force zero is found
constexpr double kClear = 0.002;   // m above the surface, end of a release
constexpr double kSettle = 0.020;  // s in which the person stops after the touch
constexpr double kSpeedUp = 0.3;   // s to reach approach speed
constexpr double kRetreat = 0.8;   // s to go back to the start
constexpr std::size_t kSines = 4;  // sines of a tremor band, for each axis

// Time of one stroke of the slide, s: the peak speed of a minimum-jerk motion is 1.875 times its mean.
double slide_time(const UserSpec& spec) { return 1.875 * spec.slide / spec.slide_speed; }

// Each sine has a quarter of the band to itself, so that they beat and no two coincide.
void draw_band(const HandTruth& hand, Stream draws, User::State& state) {
  for (std::size_t i = 0; i < state.band_rate.size(); ++i) {
    const double share = (static_cast<double>(i % kSines) + draws.uniform()) / kSines;
    state.band_rate[i] = 2.0 * std::numbers::pi * (hand.tremor_rate + hand.tremor_band * share);
    state.band_phase[i] = 2.0 * std::numbers::pi * draws.uniform();
  }
}

}  // namespace

std::int32_t held_tool(const SceneSpec& scene) {
  const auto named = std::find_if(scene.tools.begin(), scene.tools.end(),
                                  [&](const ToolSpec& t) { return t.name == scene.user->tool; });
  return named == scene.tools.end() ? 0 : static_cast<std::int32_t>(named - scene.tools.begin());
}

User::User(const SceneSpec& scene, const Scene& prepared, const HandTruth& hand, std::uint64_t seed)
    : spec_(*scene.user),
      scene_(prepared),
      hand_(hand),
      tool_(held_tool(scene)),
      press_(enc::press_point(scene, spec_)) {
  const bool drawn = spec_.kind != UserKind::press_release;
  const Vec3 n = press_.normal.e();
  const Vec3 side = Vec3::UnitX() - n * n.x();
  const Vec3 across = side.norm() > 1e-6 ? Vec3(side.normalized()) : n.unitOrthogonal();
  away_ = std::cos(spec_.approach_tilt) * n + std::sin(spec_.approach_tilt) * across;
  touch_ = press_.point + prepared.tools[static_cast<std::size_t>(tool_)].tip.radius * press_.normal;
  start_ = touch_ + Vec<'W'>(Vec3(spec_.approach_from * away_));
  object_ = static_cast<std::int32_t>(pressed_object(scene.objects, spec_.object, "user"));
  for (const Object& object : prepared.objects) expected_.push_back(hand_at(scene).expected(object));
  if (drawn) {
    session_.emplace(scene, prepared, hand);
    state_.session = session_->begin(seed);
    start_ = state_.session.press.start;
  }
  state_.hand = start_;
  state_.noise = Stream(seed, "hand");
  for (double& phase : state_.tremor_phase) phase = 2.0 * std::numbers::pi * state_.noise.uniform();
  if (spec_.tremor == TremorForm::band) draw_band(hand_, Stream(seed, "tremor"), state_);
}

double User::approach_speed() const {
  if (session_) return state_.session.press.touch_speed;
  return spec_.approach[static_cast<std::size_t>(state_.press) % spec_.approach.size()];
}

double User::wanted_depth() const {
  if (spec_.depths.empty()) return spec_.depth;
  return spec_.depths[std::min(static_cast<std::size_t>(state_.press), spec_.depths.size() - 1)];
}

bool User::done() const {
  if (state_.steered.on) return false;
  if (session_) return state_.session.finished;
  return state_.press >=
         static_cast<std::int32_t>(spec_.approach.size() * static_cast<std::size_t>(spec_.repeats));
}

double User::phase_time(Phase phase) const {
  const double v = approach_speed();
  switch (phase) {
    case Phase::wait:
      return state_.press == 0 ? kWait : spec_.rest_time;
    case Phase::approach: {
      const double speed_up = std::min(kSpeedUp, spec_.approach_from / v);
      return speed_up + (spec_.approach_from - 0.5 * v * speed_up) / v;
    }
    case Phase::press:
      return spec_.press_time;
    case Phase::hold:
      return std::max(spec_.hold_time, 2.0 * slide_time(spec_));
    case Phase::release:
      return spec_.release_time;
    case Phase::retreat:
      return kRetreat;
    case Phase::change:
      break;  // only in a drawn session
  }
  return 0.0;
}

double User::duration() const {
  if (session_) return session_->duration(state_.session);
  double total = 1.5;
  User probe(*this);
  for (probe.state_.press = 0; !probe.done(); ++probe.state_.press)
    for (const Phase phase :
         {Phase::wait, Phase::approach, Phase::press, Phase::hold, Phase::release, Phase::retreat})
      total += probe.phase_time(phase);
  return total;
}

// Speeds up smoothly, then keeps the approach speed until the touch.
HandPlan User::approach(double since) const {
  const double v = approach_speed();
  const double speed_up = std::min(kSpeedUp, spec_.approach_from / v);
  const double s = std::min(1.0, since / speed_up);
  // The speed follows a half cosine; the distance is its integral.
  const double angle = std::numbers::pi * s;
  const double way = since < speed_up ? v * speed_up * 0.5 * (s - std::sin(angle) / std::numbers::pi)
                                      : v * (0.5 * speed_up + since - speed_up);
  const double speed = since < speed_up ? 0.5 * v * (1.0 - std::cos(angle)) : v;
  const double gain = since < speed_up ? 0.5 * v * std::numbers::pi / speed_up * std::sin(angle) : 0.0;
  return {start_.e() - away_ * way, -away_ * speed, -away_ * gain, 0.0};
}

// There and back.
void User::slide(double since, HandPlan& plan) const {
  const Vec<'W'> way(Vec3(spec_.slide * (rotation_z_to(press_.normal.e()) * Vec3::UnitX())));
  const double time = slide_time(spec_);
  Submovement{0.0, time, way}.add_to(plan, since);
  if (since > time) Submovement{time, time, -way}.add_to(plan, since);
}

HandPlan User::plan(double since) const {
  const Vec3 n = press_.normal.e();
  const auto along_normal = [&](double from, double to, double time, double at) {
    const MinimumJerk m(at / time);
    const double depth = from + (to - from) * m.x;
    return HandPlan{touch_.e() - n * depth, -n * ((to - from) * m.v / time),
                    -n * ((to - from) * m.a / (time * time)), depth};
  };
  const double depth = std::isnan(spec_.push) ? wanted_depth() : 0.0;
  switch (state_.phase) {
    case Phase::wait:
      return {start_.e(), Vec3::Zero(), Vec3::Zero(), 0.0};
    case Phase::approach:
      return approach(since);
    case Phase::press: {
      HandPlan p = along_normal(0.0, depth, spec_.press_time, since);
      const double left = std::exp(-since / kSettle);
      p.position -= away_ * (approach_speed() * kSettle * (1.0 - left));
      p.velocity -= away_ * (approach_speed() * left);
      p.acceleration += away_ * (approach_speed() * left / kSettle);
      return p;
    }
    case Phase::hold: {
      HandPlan p = along_normal(depth, depth, 1.0, since);
      if (spec_.slide > 0.0) slide(since, p);
      return p;
    }
    case Phase::release:
      return along_normal(depth, -kClear, spec_.release_time, since);
    case Phase::retreat: {
      const MinimumJerk m(since / kRetreat);
      const Vec3 from = touch_.e() + kClear * n;
      const Vec3 way = start_.e() - from;
      return {from + way * m.x, way * (m.v / kRetreat), way * (m.a / (kRetreat * kRetreat)), 0.0};
    }
    case Phase::change:
      break;
  }
  return {};
}

void User::next_phase(double t) {
  if (done() || t - state_.phase_start < phase_time(state_.phase)) return;
  state_.phase_start += phase_time(state_.phase);
  if (state_.phase == Phase::retreat) {
    state_.phase = Phase::wait;
    ++state_.press;
  } else {
    state_.phase = static_cast<Phase>(static_cast<std::uint8_t>(state_.phase) + 1);
  }
}

HandPlan User::planned(double t) {
  if (session_) {
    session_->advance(t, state_.session);
    return session_->at(t, state_.session);
  }
  next_phase(t);
  return done() ? HandPlan{start_.e()} : plan(t - state_.phase_start);
}

// One sine for each axis, or a band of them with the same rms.
Vec3 User::tremor(double t, double h) {
  Vec3 tremor = Vec3::Zero();
  if (spec_.tremor == TremorForm::band) {
    for (std::size_t i = 0; i < state_.band_rate.size(); ++i)
      tremor(static_cast<Eigen::Index>(i / kSines)) +=
          std::sin(state_.band_rate[i] * t + state_.band_phase[i]);
    return hand_.tremor * std::sqrt(2.0 / kSines) * tremor;
  }
  for (int i = 0; i < 3; ++i) {
    state_.tremor_phase[i] += 2.0 * std::numbers::pi * hand_.tremor_rate * h;
    tremor(i) = hand_.tremor * std::numbers::sqrt2 * std::sin(state_.tremor_phase[i]);
  }
  return tremor;
}

// Low-passed noise of the wanted rms below 2 Hz. One value each millisecond, linear in between, so the hand
// does not depend on the step of the physics.
Vec3 User::drift(double t) {
  constexpr double kGrid = 1e-3;                                 // s
  constexpr double kDriftCorner = 2.0 * std::numbers::pi * 1.0;  // rad/s
  const double keep = std::exp(-kDriftCorner * kGrid);
  const double at = t / kGrid, next = std::ceil(at - 1e-6);
  for (; static_cast<double>(state_.drift_drawn) < next; ++state_.drift_drawn) {
    state_.drift_from = state_.drift;
    state_.drift = Vec<'W'>(
        Vec3(keep * state_.drift.e() + hand_.drift * std::sqrt(1.0 - keep * keep) * state_.noise.normal3()));
  }
  const double rest = next - at;
  return (rest < 1e-6 ? state_.drift : state_.drift + rest * (state_.drift_from - state_.drift)).e();
}

// The intent's error in a step h from t on, m.
Vec3 User::unsteadiness(double t, double h) { return tremor(t, h) + drift(t + h); }

Vec3 User::grip(const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity) const {
  return hand_.grip_stiffness * (state_.hand - tool_tip).e() +
         hand_.grip_damping * (state_.hand_velocity - tool_velocity).e();
}

Vec3 User::arm(const HandPlan& plan, const Vec3& intent) const {
  return hand_.stiffness * (intent - state_.hand.e()) +
         hand_.damping * (plan.velocity - state_.hand_velocity.e()) + hand_.mass * plan.acceleration;
}

void User::move(double h, const Vec3& arm, const Vec3& grip) {
  const Vec3 velocity = state_.hand_velocity.e() + h * (arm - grip) / hand_.mass;
  state_.hand_velocity = Vec<'W'>(velocity);
  state_.hand = state_.hand + Vec<'W'>(Vec3(h * velocity));
}

// The normal of the nearest object.
Vec<'W'> User::normal_at(const Point<'W'>& tip) const {
  Vec<'W'> normal(0, 0, 1);
  double least = std::numeric_limits<double>::infinity();
  for (const Object& object : scene_.objects) {
    const SurfacePoint near = object.surface.nearest(object.X_WO.inverse() * tip);
    if (!(near.distance < least)) continue;
    least = near.distance;
    normal = object.X_WO * near.normal;
  }
  return normal;
}

void User::steer(const Point<'W'>& place, const Point<'W'>& tip) {
  if (state_.change.stage == ToolChange::Stage::none)
    state_.steered.steer(place, tip.finite() ? tip : state_.hand);
  else
    state_.change.wanted = place;
}

void User::change_tool(const Point<'W'>& tip) {
  if (other_tool() < 0 || state_.touching || state_.change.stage != ToolChange::Stage::none) return;
  const bool empty = state_.session.held < 0;  // taken over during a change: both tools lie down
  if (!state_.steered.on) steer(tip, tip);
  state_.change = {empty ? ToolChange::Stage::empty : ToolChange::Stage::away,
                   empty ? 0 : state_.session.held, 0.0, state_.steered.to};
  state_.steered.to = spot(empty ? 1 : state_.session.held);
}

void User::go_on_changing(double h) {
  ToolChange& change = state_.change;
  change.since += h;
  const bool there = (state_.steered.to - state_.hand).norm() < ToolChange::kThere &&
                     state_.hand_velocity.norm() < ToolChange::kRests;
  if (!there || (change.stage == ToolChange::Stage::empty && change.since < ToolChange::kSwap)) return;
  if (change.stage == ToolChange::Stage::away) {
    change.stage = ToolChange::Stage::empty;
    change.since = 0.0;
    state_.session.held = -1;
    state_.steered.to = spot(1 - change.from);
  } else {
    change.stage = ToolChange::Stage::none;
    state_.session.held = 1 - change.from;
    state_.steered.to = change.wanted;
  }
}

Vec<'W'> User::act_steered(double t, double h, const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity,
                           bool touching) {
  if (state_.change.stage != ToolChange::Stage::none) go_on_changing(h);
  if (touching && !state_.steered.touched) state_.steered.touch(tool_tip, normal_at(tool_tip));
  const HandPlan p = state_.steered.advance(h, tool_tip, touching, hand_.stiffness, hand_.integral_time);
  const Vec3 gripped = grip(tool_tip, tool_velocity);
  Vec3 pulled = arm(p, p.position + unsteadiness(t, h));
  const double most = touching ? std::min(hand_.strength, SteeredPlan::kStrongest) : hand_.strength;
  pulled *= std::min(1.0, most / std::max(1e-9, pulled.norm()));
  move(h, pulled, gripped);
  state_.touching = touching;
  return Vec<'W'>(gripped);
}

// Along the normal the arm acts as a damped force instead of a spring to a position.
void User::push_along(const Vec3& n, double since, Vec3& pulled) const {
  const double share = state_.phase == Phase::press ? MinimumJerk(since / spec_.press_time).x
                       : state_.phase == Phase::release
                           ? 1.0 - MinimumJerk(since / (0.5 * spec_.release_time)).x
                           : 1.0;
  const double free = std::min(1.0, 4.0 * share);
  pulled -=
      n * (free * (n.dot(pulled) + hand_.damping * n.dot(state_.hand_velocity.e())) + spec_.push * share);
}

Vec<'W'> User::act(double t, double h, const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity,
                   bool touching) {
  if (state_.steered.on) return act_steered(t, h, tool_tip, tool_velocity, touching);
  const HandPlan p = planned(t);
  const Vec<'W'>& normal = session_ ? state_.session.press.at.normal : press_.normal;
  const Point<'W'>& touch = session_ ? state_.session.press.touch : touch_;
  const Vec3 n = normal.e();
  const bool pressing = phase() == Phase::press || phase() == Phase::hold || phase() == Phase::release;
  const bool pushing = pressing && !session_ && !std::isnan(spec_.push);

  // Intent: the plan, plus the ball's resistance by experience, plus the correction of the depth loop.
  const double depth = dot(touch - tool_tip, normal);
  const double before = state_.integral;
  if (touching && pressing && !pushing)
    state_.integral += p.load * h * (p.depth - depth) / hand_.integral_time;
  else
    state_.integral *= std::exp(-h / hand_.integral_time);
  const double series = hand_.stiffness * hand_.grip_stiffness / (hand_.stiffness + hand_.grip_stiffness);
  const double stiffness = expected_[static_cast<std::size_t>(object())];
  const double expected = pressing ? p.load * std::max(0.0, p.depth) * stiffness / series : 0.0;
  const Vec3 intent = p.position + unsteadiness(t, h) - n * (expected + state_.integral);

  const Vec3 gripped = grip(tool_tip, tool_velocity);
  Vec3 pulled = arm(p, intent);
  if (pushing) push_along(n, t - state_.phase_start, pulled);
  // A person who pushes at full strength does not push harder to reach the depth.
  const double effort = pulled.norm();
  if (effort > hand_.strength) {
    pulled *= hand_.strength / effort;
    state_.integral = before;
  }
  move(h, pulled, gripped);
  state_.touching = touching;
  return Vec<'W'>(gripped);
}

}  // namespace enc::sim
