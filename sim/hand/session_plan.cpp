#include "sim/hand/session_plan.h"

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
// The stiffness that an arm renders; 0 for a real object.
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

// A random point: on a plane near its origin, on a button in the middle half of its face, where people aim,
// on a ball on its cap.
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

namespace {

constexpr double kSessionWait = 0.8;  // s before the first reach, at least: meanwhile the force zero is found
constexpr double kAfter = 0.5;        // s after the last reach
constexpr double kSessionClear = 0.002;  // m above the surface, end of a release
constexpr double kTakeUp = 0.15;  // s until the person has answered the touch with force [sources/hand 2]
constexpr double kCarry = 1.2;    // s to carry a tool to the tray or from it
constexpr double kSwap = 0.8;     // s with an empty hand
constexpr double kCrosses = 0.7;  // share of a correction's time at which it crosses the surface
constexpr double kOverlap = 0.8;  // least share of the primary's time before a correction begins

double draw(Stream& draws, const std::vector<double>& range) {
  return range[0] + (range[1] - range[0]) * draws.uniform();
}

// Standard normal, redrawn beyond two standard deviations.
double draw_bounded(Stream& draws) {
  while (true) {
    const double x = draws.normal();
    if (std::abs(x) <= 2.0) return x;
  }
}

std::int32_t index_of(const SceneSpec& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.tools.size(); ++i)
    if (scene.tools[i].name == name) return static_cast<std::int32_t>(i);
  return name.empty() ? 0 : -1;
}

// Unit vector at an angle from an axis, in a uniformly random direction around it.
Vec3 beside(const Vec3& axis, double angle, Stream& draws) {
  const Vec3 x = axis.unitOrthogonal();
  const double turn = 2.0 * std::numbers::pi * draws.uniform();
  return std::cos(angle) * axis +
         std::sin(angle) * (std::cos(turn) * x + std::sin(turn) * Vec3(axis.cross(x)));
}

}  // namespace

SessionPlan::SessionPlan(const SceneSpec& scene, const Scene& prepared, const HandTruth& hand)
    : session_(scene.user->session),
      reaches_(scene.user->reaches),
      hand_(hand),
      scene_(prepared),
      places_(scene, prepared) {
  ranges_ = session_ ? static_cast<const ReachRanges&>(*session_) : *reaches_;
  tools_[0] = index_of(scene, scene.user->tool);
  if (session_ && !session_->other_tool.empty()) tools_[1] = index_of(scene, session_->other_tool);
}

std::int32_t SessionPlan::tool(const State& state) const { return state.held < 0 ? -1 : tools_[state.held]; }

Point<'W'> SessionPlan::spot(std::int32_t which) const {
  return Point<'W'>(Vec3(session_->tray + SessionSpec::kTrayBeside * which * Vec3::UnitY()));
}

// A bare finger starts where no object is near.
void SessionPlan::draw_start(Stream& draws, const Tool& tool, Press& press) const {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    const Place place = places_.draw(draws, tool);
    press.object = place.object;
    press.at = place.at;
    press.touch = press.at.point + tool.tip.radius * press.at.normal;
    const Vec3 away = beside(press.at.normal.e(), draw(draws, ranges_.tilt), draws);
    press.start = press.touch + Vec<'W'>(Vec3(draw(draws, ranges_.reach) * away));
    if (session_ || places_.gap(press.start, tool) > scene_.follow.pause) return;
  }
  throw Error("a reach begins nowhere farther than follow.pause from every object; lower tilt or raise reach",
              "user.reaches.reach");
}

void SessionPlan::draw_reach(Stream& draws, Press& press) const {
  const Vec3 way = (press.touch - press.start).e();
  const double distance = way.norm();
  const Vec3 along = way / distance;
  const double gain = hand_.primary_share + hand_.primary_scatter * draw_bounded(draws);
  const Vec3 across = along.unitOrthogonal();
  const double x = draw_bounded(draws);
  const double y = draw_bounded(draws);
  const Vec3 aside = x * across + y * Vec3(along.cross(across));
  const Vec3 primary = gain * way + hand_.aside_scatter * distance * aside;
  const double peak = draw(draws, ranges_.peak_speed);
  press.primary = {0.0, 1.875 * primary.norm() / peak, Vec<'W'>(primary)};
  press.touch_speed = draw(draws, ranges_.touch_speed);
  press.aborted = draws.uniform() < hand_.aborted;
  const double onset = draws.uniform();
  if (press.aborted) {
    press.second = {(0.3 + 0.3 * onset) * press.primary.time, press.primary.time, Vec<'W'>(-primary)};
    press.reach_time = press.second.end();
    return;
  }
  const Vec3 n = press.at.normal.e();
  const Vec3 left = way - primary;
  const double above = -n.dot(left);  // m above the surface, end of the primary; negative: below
  const MinimumJerk crossing(kCrosses);
  const double down = std::max(0.0, above) / crossing.x;
  press.second = {(kOverlap + (1.0 - kOverlap) * onset) * press.primary.time,
                  std::max(hand_.shortest, down * crossing.v / press.touch_speed),
                  Vec<'W'>(Vec3(left + above * n - down * n))};
  press.reached = down - above;
  press.reach_time = std::max(press.primary.end(), press.second.end());
}

void SessionPlan::draw_press(State& state, std::int32_t which) const {
  Press& press = state.press;
  Stream& draws = state.draws;
  const Tool& tool = scene_.tools[static_cast<std::size_t>(tools_[which])];
  draw_start(draws, tool, press);
  draw_reach(draws, press);
  press.depth = std::fmax(draw(draws, ranges_.depth), press.reached);
  press.press_time = press.depth / draw(draws, ranges_.press_speed);
  press.hold_time = draw(draws, ranges_.hold);
  press.release_time = (press.depth + kSessionClear) / draw(draws, ranges_.press_speed);
  press.transit = std::max(0.3, 1.875 * (press.start - state.from).norm() / press.primary.peak_speed());
  press.rest = draw(draws, ranges_.rest);
}

SessionPlan::State SessionPlan::begin(std::uint64_t seed) const {
  State state;
  state.draws = Stream(seed, "session");
  state.change_at = tools_[1] >= 0 ? draw(state.draws, session_->change) * session_->duration : kUnset;
  draw_press(state, 0);  // the hand begins over the first point, so this path has no length
  state.from = state.press.start;
  state.from_normal = state.press.at.normal;
  state.press.transit = 0.0;
  state.press.rest = std::max(kSessionWait, state.press.rest);
  return state;
}

double SessionPlan::phase_time(const State& state) const {
  const Press& press = state.press;
  switch (state.phase) {
    case Phase::wait:
      return press.transit + press.rest;
    case Phase::approach:
      return press.reach_time;
    case Phase::press:
      return press.press_time;
    case Phase::hold:
      return press.hold_time;
    case Phase::release:
      return press.release_time;
    case Phase::retreat:
      return press.primary.time;
    case Phase::change:
      return 2.0 * kCarry + kSwap;
  }
  return 0.0;
}

void SessionPlan::next_press(State& state) const {
  state.from = state.press.start;
  state.from_normal = state.press.at.normal;
  const bool change = !state.changed && state.phase_start >= state.change_at;  // never if change_at is unset
  draw_press(state, state.changed || change ? 1 : 0);
  const Press& p = state.press;
  const double rest =
      p.reach_time + (p.aborted ? 0.0 : p.press_time + p.hold_time + p.release_time + p.primary.time);
  const double begin = change ? 2.0 * kCarry + kSwap : p.transit;
  state.phase = change ? Phase::change : Phase::wait;
  if (session_ ? state.phase_start + begin + p.rest + rest > session_->duration
               : state.count + 1 >= reaches_->count) {
    state.finished = true;
    state.phase = Phase::wait;
  }
  ++state.count;
}

void SessionPlan::next(State& state) const {
  state.phase_start += phase_time(state);
  if (state.phase == Phase::retreat || (state.phase == Phase::approach && state.press.aborted)) {
    next_press(state);
  } else if (state.phase == Phase::change) {
    state.changed = true;
    state.held = 1;
    state.phase = Phase::wait;
    state.from = state.press.start;
    state.from_normal = state.press.at.normal;
    state.press.transit = 0.0;
  } else {
    state.phase = static_cast<Phase>(static_cast<std::uint8_t>(state.phase) + 1);
  }
}

void SessionPlan::advance(double t, State& state) const {
  while (!state.finished && t - state.phase_start >= phase_time(state)) next(state);
  if (state.phase != Phase::change) return;
  const double since = t - state.phase_start;
  state.held = since < kCarry ? 0 : since < kCarry + kSwap ? -1 : 1;
}

Vec<'W'> SessionPlan::shaft(double t, const State& state) const {
  const Press& press = state.press;
  const double time = state.phase == Phase::change ? 2.0 * kCarry + kSwap : press.transit;
  const bool on_the_way = (state.phase == Phase::wait || state.phase == Phase::change) && time > 0.0;
  const double share = on_the_way ? MinimumJerk((t - state.phase_start) / time).x : 1.0;
  return Vec<'W'>(Vec3(((1.0 - share) * state.from_normal.e() + share * press.at.normal.e()).normalized()));
}

double SessionPlan::duration(const State& begun) const {
  if (session_) return session_->duration;
  State state = begun;
  while (!state.finished) next(state);
  return state.phase_start + state.press.transit + kAfter;
}

namespace {

// Straight from one point to another within `time`, starting at `begin`.
HandPlan on_the_way(const Point<'W'>& from, const Point<'W'>& to, double begin, double time, double since) {
  HandPlan plan{from.e()};
  if (time > 0.0) Submovement{begin, time, to - from}.add_to(plan, since);
  return plan;
}

}  // namespace

HandPlan SessionPlan::at(double t, const State& state) const {
  const Press& press = state.press;
  const double since = t - state.phase_start;
  const Vec3 n = press.at.normal.e();
  const auto moved = [&](const Point<'W'>& from, const Point<'W'>& to, double begin, double time) {
    return on_the_way(from, to, begin, time, since);
  };
  const auto along_normal = [&](double from, double to, double time) {
    HandPlan plan =
        moved(press.touch - from * press.at.normal, press.touch - to * press.at.normal, 0.0, time);
    plan.depth = n.dot(press.touch.e() - plan.position);
    return plan;
  };
  switch (state.phase) {
    case Phase::wait:
      return moved(state.from, press.start, 0.0, press.transit);
    case Phase::approach: {
      HandPlan plan{press.start.e()};
      press.primary.add_to(plan, since);
      press.second.add_to(plan, since);
      return plan;
    }
    case Phase::press: {
      HandPlan plan = along_normal(press.reached, press.depth, press.press_time);
      plan.load = MinimumJerk(since / kTakeUp).x;
      return plan;
    }
    case Phase::hold:
      return along_normal(press.depth, press.depth, 0.0);
    case Phase::release:
      return along_normal(press.depth, -kSessionClear, press.release_time);
    case Phase::retreat:
      return moved(press.touch + kSessionClear * press.at.normal, press.start, 0.0, press.primary.time);
    case Phase::change:
      if (since < kCarry) return moved(state.from, spot(0), 0.0, kCarry);
      if (since < kCarry + kSwap) return moved(spot(0), spot(1), kCarry, 0.7 * kSwap);
      return moved(spot(1), press.start, kCarry + kSwap, kCarry);
  }
  return {};
}

}  // namespace enc::sim
