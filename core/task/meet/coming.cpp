// Where a finger that comes will touch, asked anew with every picture: the longer it has not touched, the
// farther it is on its way.
#include <algorithm>
#include <cmath>

#include "core/rotation.h"
#include "core/task/meet/finger.h"

namespace enc::stages {
namespace {

// The touch may come so long after the newest picture, s: more closely where it is soon.
constexpr std::array<double, Coming::kTimes> kAfter{0.055, 0.075, 0.098, 0.126, 0.165, 0.22, 0.30};
// s: the weight of what comes later falls e-fold in that time, because it can still be met later. Chosen.
constexpr double kSoon = 0.06;
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
void ask(const Walk& walk, const State& state, Coming& now) {
  const Pose<'N', 'W'> X_NW = now.asking.X_WN.inverse();
  const auto which = static_cast<std::size_t>(now.asked++);
  const TrackerRig& rig = walk.scene.tracker;
  const double noise = std::sqrt(noise_of(rig, state.tool.value, walk.scene.X_WC).mean_square());
  std::array<Sighting, kSightings> seen;
  for (std::size_t i = 0; i < static_cast<std::size_t>(now.count); ++i)
    seen[i] = {(X_NW * now.at[i]).e() - walk.tool_radius * Vec3::UnitZ(),
               age(now.exposed[0], now.exposed[i]) + kAfter[which]};
  const Touch touch = touch_then(rig.reach, {seen.data(), static_cast<std::size_t>(now.count)},
                                 std::max(kUnevenLeast, kUneven * noise));
  const bool believed = touch.place.allFinite() && (touch.place - seen[0].at.head<2>()).norm() < kFarthest &&
                        seen[0].at.z() > kLying;
  now.asking.touches[which] = {touch.place.x(), touch.place.y(), believed ? touch.evidence : -HUGE_VAL};
}

// If it touches so long after the newest picture: between the two times next to that. The nearer it is to one
// that says nothing, the less it counts.
Vec3 touch_at(const Coming::Answer& now, double after) {
  std::size_t i = 0;
  while (i + 2 < kAfter.size() && kAfter[i + 1] < after) ++i;
  const Vec3 a = Vec3::Map(now.touches[i].data()), b = Vec3::Map(now.touches[i + 1].data());
  const double share = std::clamp((after - kAfter[i]) / (kAfter[i + 1] - kAfter[i]), 0.0, 1.0);
  if (std::isinf(a[2])) return {b[0], b[1], b[2] + std::log(share)};
  if (std::isinf(b[2])) return {a[0], a[1], a[2] + std::log(1.0 - share)};
  return a + share * (b - a);
}

// The mean over the times that are still to come, weighted by how well they fit, and the sooner the more. In
// the surface's axes; unset: none fits.
Eigen::Vector2d expected(const Coming::Answer& now, double passed) {
  constexpr std::size_t kSteps = 60;
  const double first = std::clamp(passed, kAfter.front(), kAfter.back());
  std::array<Vec3, kSteps> at;
  double most = -HUGE_VAL;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / kSteps;
    const double after = first + share * (kAfter.back() - first);
    at[i] = touch_at(now, after);
    at[i][2] -= (after - first) / kSoon;
    most = std::max(most, at[i][2]);
  }
  if (std::isinf(most)) return {kUnset, kUnset};
  Vec3 sum = Vec3::Zero();
  for (const Vec3& one : at)
    if (const double w = std::exp(one[2] - most); w > 0.0) sum += w * Vec3(one[0], one[1], 1.0);
  return sum.head<2>() / sum[2];
}

Point<'W'> on_surface(const Walk& walk, const State& state, const Coming::Answer& now, double passed) {
  const Eigen::Vector2d at = expected(now, passed);
  if (!at.allFinite()) return {};
  ObjectHint hint = state.hints.tool[0];
  return nearest(walk.scene, state.object, now.X_WN * Point<'N'>(at.x(), at.y(), 0.0), hint).point;
}

}  // namespace

Goal foreseen_touch(const Walk& walk, const State& state, Meeting& memory) noexcept {
  Coming& now = memory.coming;
  const Object* object = nearest_object(walk, state);
  const TrackerRig& rig = walk.scene.tracker;
  const bool asked = rig.foresight == Foresight::reach && rig.prediction != Prediction::hold;
  const auto nowhere = [&now] {
    now.object = -1;
    now.asked = 0;
    now.known = {};
    return Goal{};
  };
  if (!asked || object == nullptr || !walk.tool_known) return nowhere();
  // What is being asked for is finished first, of its own pictures: a fast tracker would never let it be.
  constexpr auto kAll = static_cast<std::int32_t>(kAfter.size());
  const bool asks = now.object >= 0 && now.asked < kAll;
  const bool news = !asks && take_picture(walk, state, now);
  const bool comes = walk.tool_fresh && object->moving < 0 && now.count >= 3;
  if (!comes || presses(state, memory.contact)) return nowhere();
  const bool other = state.object != now.object;
  if (other) now.known = {};
  if (news || other) {
    now.object = state.object;
    now.asked = 0;
    now.asking.newest = now.exposed[0];
    now.asking.X_WN = Pose<'W', 'N'>(rotation_z_to(walk.normal.e()), walk.surface_point);
  }
  // One in a tick, because each takes some 0.2 ms. Until all are known the last answer goes on.
  if (now.asked < kAll) {
    ask(walk, state, now);
    if (now.asked == kAll) now.known = now.asking;
  }
  if (!now.known.X_WN.valid()) return {};
  const double passed = age(walk.tick.t, now.known.newest), dt = walk.scene.dt;
  const Point<'W'> at = on_surface(walk, state, now.known, passed);
  const Point<'W'> then = on_surface(walk, state, now.known, passed + dt);
  if (!at.finite() || !then.finite()) return {at};
  return {at, (1.0 / dt) * (then - at)};
}

}  // namespace enc::stages
