// Where a finger that comes will touch, asked anew with every picture and every few ticks: the longer it has
// not touched, the farther it is on its way.
#include <algorithm>
#include <cmath>

#include "core/rotation.h"
#include "core/task/meet/finger.h"

namespace enc::stages {
namespace {

constexpr double kEvery = 5e-3;  // s: so often at most
constexpr double kApart = 0.03;  // s, between pictures
constexpr double kSoon = 0.3;    // s: a finger that is farther from its touch goes on as the filter says
constexpr double kSlowing =
    0.8;  // a hand only slows down: in less than this share of its way over speed it is not there
constexpr double kLying = 1e-3;  // m: nearer, it lies on the prop
constexpr double kUneven = 1.4;  // times the noise of a picture: no hand is of minimum jerk to the last,
constexpr double kUnevenLeast = 0.3e-3;  // m, and by this at least
constexpr double kFarthest = 0.05;       // m: a place of touch farther from the finger is not believed

// What came before a picture is of use as long as none was missed for long. Of a finger that is seen more
// often than its way needs, those in between are passed over.
void take_picture(const Walk& walk, const State& state, Coming& now) {
  const Time exposed_at = exposed(walk.scene.tracker, state.tool.t);
  if (now.count > 0 && exposed_at == now.exposed[0]) return;
  const double gap = now.count > 0 ? age(exposed_at, now.exposed[0]) : 0.0;
  if (gap < 0.0 || gap > walk.scene.tracker.longest_prediction) now.count = 0;
  if (now.count < 2 || age(now.exposed[0], now.exposed[1]) > kApart) {
    std::shift_right(now.at.begin(), now.at.end(), 1);
    std::shift_right(now.exposed.begin(), now.exposed.end(), 1);
    now.count = std::min<std::int32_t>(now.count + 1, kSightings);
  }
  now.at[0] = walk.tip_newest;
  now.exposed[0] = exposed_at;
}

// The pictures over the surface under the finger, and the time until it can touch at the soonest, s.
double sight(const Walk& walk, const Pose<'N', 'W'>& X_NW, const Coming& now,
             std::array<Sighting, kSightings>& seen) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(now.count); ++i)
    seen[i] = {(X_NW * now.at[i]).e() - walk.tool_radius * Vec3::UnitZ(), age(walk.tick.t, now.exposed[i])};
  const double comes = (seen[1].at.z() - seen[0].at.z()) / (seen[1].age - seen[0].age);
  return comes > 0.0 ? std::max(0.0, kSlowing * seen[0].at.z() / comes - seen[0].age) : 1e9;
}

Point<'W'> ask(const Walk& walk, const State& state, const Coming& now) {
  const Pose<'W', 'N'> X_WN(rotation_z_to(walk.normal.e()), walk.surface_point);
  std::array<Sighting, kSightings> seen;
  const double soonest = sight(walk, X_WN.inverse(), now, seen);
  if (!(soonest < kSoon) || seen[0].at.z() < kLying) return {};
  for (Sighting& one : seen) one.age += soonest;
  const auto place =
      place_of_touch(walk.scene.tracker.reach, {seen.data(), static_cast<std::size_t>(now.count)},
                     walk.scene.tracker.measurement_noise);
  if (!place.allFinite() || (place - seen[0].at.head<2>()).norm() > kFarthest) return {};
  ObjectHint hint = state.hints.tool[0];
  return nearest(walk.scene, state.object, X_WN * Point<'N'>(place.x(), place.y(), 0.0), hint).point;
}

}  // namespace

Point<'W'> foreseen_touch(const Walk& walk, const State& state, Meeting& memory) noexcept {
  Coming& now = memory.coming;
  const Object* object = nearest_object(walk, state);
  const TrackerRig& rig = walk.scene.tracker;
  const bool asked = rig.foresight == Foresight::reach && rig.prediction != Prediction::hold;
  if (!asked || object == nullptr || !walk.tool_known) return {};
  take_picture(walk, state, now);
  const bool comes = state.mode != Mode::away && walk.tool_fresh && object->moving < 0 && now.count >= 3;
  if (!comes || presses(state, memory.contact)) return now.touch = {};
  if (state.object == now.object && age(walk.tick.t, now.asked) < kEvery) return now.touch;
  now.object = state.object;
  now.asked = walk.tick.t;
  return now.touch = ask(walk, state, now);
}

}  // namespace enc::stages
