// Where a finger that comes will touch, asked anew with every picture and every few ticks: the longer it has
// not touched, the farther it is on its way.
#include <algorithm>
#include <cmath>

#include "core/rotation.h"
#include "core/task/meet/finger.h"

namespace enc::stages {
namespace {

// The touch may come so long after the newest picture, s: more closely where it is soon.
constexpr std::array<double, Coming::kTimes> kAfter{0.055, 0.075, 0.098, 0.126, 0.165, 0.22, 0.30};
constexpr double kArm = 0.06;    // s: what comes later can still be met later
constexpr double kApart = 0.03;  // s, between pictures
constexpr double kUneven = 1.4;  // times the noise of a picture: no hand is of minimum jerk to the last,
constexpr double kUnevenLeast = 0.3e-3;  // m, and by this at least
constexpr double kLying = 1e-3;          // m: nearer, it lies on the prop
constexpr double kFarthest = 0.05;       // m: a place of touch farther from the finger is not believed

// What came before a picture is of use as long as none was missed for long. Of a finger that is seen more
// often than its way needs, those in between are passed over.
bool take_picture(const Walk& walk, const State& state, Coming& now) {
  const Time exposed_at = exposed(walk.scene.tracker, state.tool.t);
  if (now.count > 0 && exposed_at == now.exposed[0]) return false;
  const double gap = now.count > 0 ? age(exposed_at, now.exposed[0]) : 0.0;
  if (gap < 0.0 || gap > walk.scene.tracker.longest_prediction) now.count = 0;
  if (now.count < 2 || age(now.exposed[0], now.exposed[1]) > kApart) {
    std::shift_right(now.at.begin(), now.at.end(), 1);
    std::shift_right(now.exposed.begin(), now.exposed.end(), 1);
    now.count = std::min<std::int32_t>(now.count + 1, kSightings);
  }
  now.at[0] = walk.tip_newest;
  now.exposed[0] = exposed_at;
  return true;
}

// One of the times, in axes of the surface.
void ask(const Walk& walk, Coming& now) {
  const Pose<'N', 'W'> X_NW = now.X_WN.inverse();
  const auto which = static_cast<std::size_t>(now.asked++);
  std::array<Sighting, kSightings> seen;
  for (std::size_t i = 0; i < static_cast<std::size_t>(now.count); ++i)
    seen[i] = {(X_NW * now.at[i]).e() - walk.tool_radius * Vec3::UnitZ(),
               age(now.exposed[0], now.exposed[i]) + kAfter[which]};
  const Touch touch = touch_then(walk.scene.tracker.reach, {seen.data(), static_cast<std::size_t>(now.count)},
                                 std::max(kUnevenLeast, kUneven * walk.scene.tracker.measurement_noise));
  const bool believed = touch.place.allFinite() && (touch.place - seen[0].at.head<2>()).norm() < kFarthest &&
                        seen[0].at.z() > kLying;
  now.touches[which] = {touch.place.x(), touch.place.y(), believed ? touch.evidence : -HUGE_VAL};
}

// The times that are still to come, weighted by how well they fit, and the sooner the more.
Point<'W'> expected(const Walk& walk, const State& state, const Coming& now) {
  const double passed = age(walk.tick.t, now.exposed[0]);
  std::array<double, Coming::kTimes> weight{};
  double most = -HUGE_VAL;
  for (std::size_t i = 0; i < kAfter.size(); ++i) {
    const double until = i + 1 < kAfter.size() ? 0.5 * (kAfter[i] + kAfter[i + 1]) : 2.0 * kAfter[i];
    const double from = i > 0 ? 0.5 * (kAfter[i - 1] + kAfter[i]) : 0.0;
    const double left = std::min(until - from, until - passed);  // s, of what this one stands for
    weight[i] = left > 0.0 ? now.touches[i][2] + std::log(left) - std::max(0.0, kAfter[i] - passed) / kArm
                           : -HUGE_VAL;
    most = std::max(most, weight[i]);
  }
  if (!(most > -1e300)) return {};
  double x = 0.0, y = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double w = std::exp(weight[i] - most);
    if (!(w > 0.0)) continue;
    x += w * now.touches[i][0];
    y += w * now.touches[i][1];
    sum += w;
  }
  ObjectHint hint = state.hints.tool[0];
  return nearest(walk.scene, state.object, now.X_WN * Point<'N'>(x / sum, y / sum, 0.0), hint).point;
}

}  // namespace

Point<'W'> foreseen_touch(const Walk& walk, const State& state, Meeting& memory) noexcept {
  Coming& now = memory.coming;
  const Object* object = nearest_object(walk, state);
  const TrackerRig& rig = walk.scene.tracker;
  const bool asked = rig.foresight == Foresight::reach && rig.prediction != Prediction::hold;
  if (!asked || object == nullptr || !walk.tool_known) return {};
  const bool news = take_picture(walk, state, now);
  const bool comes = state.mode != Mode::away && walk.tool_fresh && object->moving < 0 && now.count >= 3;
  if (!comes || presses(state, memory.contact)) {
    now.asked = 0;
    now.object = -1;
    return now.touch = {};
  }
  if (news || state.object != now.object) {
    now.object = state.object;
    now.asked = 0;
    now.X_WN = Pose<'W', 'N'>(rotation_z_to(walk.normal.e()), walk.surface_point);
  }
  if (now.asked <
      static_cast<std::int32_t>(kAfter.size())) {  // a tick each; until all are known the last answer holds
    ask(walk, now);
    return now.touch;
  }
  return now.touch = expected(walk, state, now);
}

}  // namespace enc::stages
