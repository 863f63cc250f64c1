// Where a finger that comes will touch, asked anew with every picture: the longer it has not touched, the
// farther it is on its way.
#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/rotation.h"
#include "core/control/task/meet/finger.h"
#include "core/control/task/meet/meet_spec.h"

namespace enc::stages {
namespace {

using Vec2 = Eigen::Vector2d;

// The touch may come so long after the newest picture is told, s: more closely where it is soon.
constexpr std::array<double, Coming::kTimes> kAfter{0.0, 0.02, 0.044, 0.074, 0.114, 0.17, 0.25};
// s: the weight of what comes later falls e-fold in that time, because it can still be met later. Chosen.
constexpr double kSoon = 0.03;
constexpr double kApart = 0.03;  // s, between pictures
constexpr double kOften = 5e-3;  // s: no sooner is asked anew, as that takes up to half a millisecond
constexpr double kUneven = 1.4;  // times the noise of a picture: no hand is of minimum jerk to the last,
constexpr double kUnevenLeast = 0.3e-3;  // m, and by this at least
constexpr double kLying = 1e-3;          // m: nearer, it lies on the prop
constexpr double kFarthest = 0.05;       // m: a place of touch farther from the finger is not believed

// What came before a picture is of use as long as none was missed for long. Of a finger that is seen more
// often than its way needs, those in between are passed over.
bool take_picture(const Walk& walk, const CommonState& state, Coming& now) {
  const Time exposed_at = exposed(walk.scene.tracker, state.tool.t);
  const double gap = now.count > 0 ? age(exposed_at, now.exposed[0]) : kOften;
  const bool another = state.tool.value.tool != now.tool;
  if (!another && gap >= 0.0 && gap < kOften) return false;
  now.tool = state.tool.value.tool;
  if (another || gap < 0.0 || gap > walk.scene.tracker.longest_prediction) {
    now.count = 0;
    now.clear = false;  // of other pictures
  }
  if (now.count < 2 || age(now.exposed[0], now.exposed[1]) > kApart) {
    std::shift_right(now.at.begin(), now.at.end(), 1);
    std::shift_right(now.exposed.begin(), now.exposed.end(), 1);
    now.count = std::min<std::int32_t>(now.count + 1, kSightings);
  }
  now.at[0] = walk.tip_newest;
  now.exposed[0] = exposed_at;
  return true;
}

double noise_of_newest(const Walk& walk, const CommonState& state) {  // m rms, of each axis
  return std::sqrt(noise_of(walk.scene.tracker, state.tool.value, walk.scene.X_WC).mean_square());
}

// Where pictures are about as vague as may be, it is not asked now and then.
bool clear(const Walk& walk, const CommonState& state, const Coming& now) {
  const double vaguest = walk.scene.tracker.reach.vaguest;
  return noise_of_newest(walk, state) <= (now.clear ? ComingSpec::kStaysClear * vaguest : vaguest);
}

// A hand that reaches does not come slower than it wants to touch, but for a moment between its movements.
// How one goes on that hovers no picture shows, nor a picture that is too vague: it is met under where it is.
bool reaches(const Walk& walk, const Coming& now) {
  if (now.count < 3 || !now.clear) return false;
  const auto first = static_cast<std::size_t>(now.count - 1);
  const double down = dot(now.at[first] - now.at[0], walk.normal) / age(now.exposed[0], now.exposed[first]);
  return down > walk.scene.tracker.reach.touch_slowest;
}

// In axes of the surface that is under it.
void ask(const Walk& walk, const CommonState& state, Coming& now) {
  now.object = state.object;
  now.told = walk.tick.t;
  const Object& object = walk.scene.objects[static_cast<std::size_t>(state.object)];
  now.X_WN = object.met_in_its_middle()
                 ? Pose<'W', 'N'>(object.X_WO.q(), object.X_WO.origin())  // of its face
                 : Pose<'W', 'N'>(rotation_z_to(walk.normal.e()), walk.surface_point);
  const Pose<'N', 'W'> X_NW = now.X_WN.inverse();
  const TrackerRig& rig = walk.scene.tracker;
  const double known = std::max(kUnevenLeast, kUneven * noise_of_newest(walk, state));
  const TipMotion& motion = state.tip_motion;
  const bool steady = rig.prediction == Prediction::constant_velocity;
  std::array<Sighting, kSightings> seen;
  const std::span<Sighting> all(seen.data(), static_cast<std::size_t>(now.count));
  for (std::size_t i = 0; i < all.size(); ++i)
    seen[i].at = (X_NW * now.at[i]).e() - walk.tool_radius * Vec3::UnitZ();
  for (std::size_t k = 0; k < kAfter.size(); ++k) {
    for (std::size_t i = 0; i < all.size(); ++i) seen[i].age = age(now.told, now.exposed[i]) + kAfter[k];
    const double ahead = age(now.told, motion.t) + kAfter[k];
    const Vec2 even = (X_NW * (motion.position + ahead * motion.velocity)).e().head<2>();
    const Touch touch = touch_then(rig.reach, all, known, steady ? even : Vec2(kUnset, kUnset));
    const bool believed = touch.place.allFinite() &&
                          (touch.place - seen[0].at.head<2>()).norm() < kFarthest && seen[0].at.z() > kLying;
    now.touches[k] = {touch.place.x(), touch.place.y(), believed ? touch.evidence : -HUGE_VAL};
  }
  for (std::size_t i = 0; i < all.size(); ++i) seen[i].age = age(now.told, now.exposed[i]);
  now.passes = passes_by(all, known, kAfter.back());
}

// If it touches so long after the newest picture is told: between the two times next to that. The nearer it
// is to one that says nothing, the less it counts.
Vec3 touch_at(const Coming& now, double after) {
  std::size_t i = 0;
  while (i + 2 < kAfter.size() && kAfter[i + 1] < after) ++i;
  const Vec3 a = Vec3::Map(now.touches[i].data()), b = Vec3::Map(now.touches[i + 1].data());
  const double share = std::clamp((after - kAfter[i]) / (kAfter[i + 1] - kAfter[i]), 0.0, 1.0);
  if (std::isinf(a[2])) return {b[0], b[1], b[2] + std::log(share)};
  if (std::isinf(b[2])) return {a[0], a[1], a[2] + std::log(1.0 - share)};
  return a + share * (b - a);
}

// The mean over the times that are still to come, weighted by how well they fit, and the sooner the more. In
// the surface's axes; unset: none fits, or that it passes by is more probable.
Vec2 expected(const Coming& now, double passed) {
  constexpr std::size_t kSteps = 60;
  const double first = std::clamp(passed, kAfter.front(), kAfter.back());
  const double each = (kAfter.back() - first) / kSteps;
  std::array<Vec3, kSteps> at;
  double most = now.passes;
  for (std::size_t i = 0; i < kSteps; ++i) {
    at[i] = touch_at(now, first + (static_cast<double>(i) + 0.5) * each);
    most = std::max(most, at[i][2]);
  }
  if (std::isinf(most)) return {kUnset, kUnset};
  Vec3 sum = Vec3::Zero();
  double touches = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double w = std::exp(at[i][2] - most);
    if (!(w > 0.0)) continue;
    touches += w * each;
    sum += w * std::exp(-(static_cast<double>(i) + 0.5) * each / kSoon) * Vec3(at[i][0], at[i][1], 1.0);
  }
  if (touches < std::exp(now.passes - most) || !(sum[2] > 0.0)) return {kUnset, kUnset};
  return sum.head<2>() / sum[2];
}

Point<'W'> on_surface(const Walk& walk, const CommonState& state, const Coming& now, double passed) {
  const Vec2 at = expected(now, passed);
  if (!at.allFinite()) return {};
  ObjectHint hint = state.hints.tool[0];
  return nearest(walk.scene, state.object, now.X_WN * Point<'N'>(at.x(), at.y(), 0.0), hint).point;
}

}  // namespace

Goal foreseen_touch(const Walk& walk, const CommonState& state, Meeting& memory) noexcept {
  Coming& now = memory.coming;
  const Object* object = nearest_object(walk, state);
  const TrackerRig& rig = walk.scene.tracker;
  const bool asked = rig.foresight == Foresight::reach && rig.prediction != Prediction::hold;
  if (!asked || object == nullptr || !walk.tool_known) {
    now.object = -1;
    return {};
  }
  const bool news = take_picture(walk, state, now);
  if (news) {
    now.object = -1;  // what was said before it is worth nothing
    now.clear = clear(walk, state, now);
  }
  // What moves is met where it is.
  const bool comes = walk.tool_fresh && object->moving < 0 && reaches(walk, now);
  if (!comes || presses(state, memory.contact)) return {};
  // Once for each picture: asked of another object's plane it may say another place, and of that one the
  // first.
  if (now.object < 0) {
    if (!news && age(walk.tick.t, now.told) < kOften) return {};
    ask(walk, state, now);
  }
  const double passed = age(walk.tick.t, now.told), dt = walk.scene.dt;
  const Point<'W'> at = on_surface(walk, state, now, passed);
  const Point<'W'> then = on_surface(walk, state, now, passed + dt);
  if (!at.finite() || !then.finite()) return {at, Vec<'W'>::zero(), true};
  return {at, (1.0 / dt) * (then - at), true};
}

Point<'W'> comes_to(const Walk& walk, const Meeting& memory) noexcept {
  const Coming& now = memory.coming;
  const double passed = age(walk.tick.t, now.told);
  if (now.object < 0 || passed > kAfter.back()) return {};
  const Vec2 at = expected(now, passed);
  if (!at.allFinite()) return {};
  return now.X_WN * Point<'N'>(at.x(), at.y(), ComingSpec::kAbove);
}

}  // namespace enc::stages
