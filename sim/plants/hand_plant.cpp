#include "sim/plants/hand_plant.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/rotation.h"

namespace enc::sim {
namespace {

// A right hand that points: x from the wrist to the fingers, y to the thumb, z out of its back, mm
// [sources/hand 7].
constexpr std::array<std::array<double, 3>, kHandJoints> kJoints{
    {{0, 0, 0},       {25, 30, -10},  {55, 45, -15},   {85, 48, -22},  {108, 42, -30}, {90, 25, 0},
     {130, 25, 0},    {154, 25, 0},   {178, 25, 0},    {92, 4, 0},     {120, 4, -30},  {100, 4, -48},
     {82, 4, -40},    {88, -15, -2},  {112, -15, -30}, {94, -15, -46}, {78, -15, -38}, {82, -33, -5},
     {100, -33, -26}, {86, -33, -38}, {74, -33, -32}}};
constexpr double kUnit = 1e-3;  // m

Vec3 joint(std::size_t i) { return kUnit * Vec3(kJoints[i][0], kJoints[i][1], kJoints[i][2]); }

constexpr double kHeldAbove = 0.06;  // m, of a tool's tip, assumed (sources/hand 7)

}  // namespace

HandPlace holding(const Point<'W'>& tool_tip, const Vec<'W'>& pointing, double tool) {
  return {tool_tip - std::min(kHeldAbove, tool) * pointing, pointing};
}

HandSample skeleton(const Pose<'W', 'L'>& X_WL, const HandPlace& place, double skin) {
  const Vec3 x = place.pointing.e().normalized();
  const Vec3 up = std::abs(x.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitY());
  const Vec3 z = (up - up.dot(x) * x).normalized();
  Mat3 axes;
  axes << x, z.cross(x), z;
  const Quat q(axes);
  const Pose<'W', 'K'> X_WK(q, Vec3(place.tip.e() - q * joint(kIndexTip)));
  HandSample hand;
  hand.wrist = X_WL.inverse() * X_WK;
  for (std::size_t i = 0; i < kHandJoints; ++i) hand.joints[i] = hand.wrist * Point<'K'>(joint(i));
  hand.skin = skin;
  return hand;
}

HandPlant::HandPlant(const HandTrackerTruth& truth, const Pose<'W', 'L'>& X_WL, std::uint64_t seed)
    : truth_(truth), X_WL_(X_WL) {
  if (truth.latency * truth.rate > 60.0)
    throw Error("at most 60 frames can be on their way at once", "truth.hand_tracker.latency");
  state_.noise = Stream(seed, "hand tracker");
  state_.exposure = {truth.rate, 0, from_seconds(state_.noise.uniform() / truth.rate)};
}

void HandPlant::expose(Time t, const HandPlace& place) {
  HandSample hand = skeleton(X_WL_, place, truth_.skin);
  for (Point<'L'>& at : hand.joints) at = Point<'L'>(Vec3(at.e() + truth_.noise * state_.noise.normal3()));
  const Vec3 turned = truth_.turn_noise * state_.noise.normal3();
  hand.wrist = {rotation_xyz(turned) * hand.wrist.q(), hand.joints[0].e()};
  if (state_.noise.uniform() < truth_.loss) return;
  auto* slot = std::min_element(
      state_.on_wire.begin(), state_.on_wire.end(),
      [](const Frame& a, const Frame& b) { return a.waiting != b.waiting ? !a.waiting : a.due < b.due; });
  *slot = {{hand, t, Health::ok}, t + from_seconds(truth_.latency), true};
}

void HandPlant::advance(Time t, const HandPlace& place) {
  bool exposed = false;
  while (state_.exposure.due(t)) exposed = true;
  if (exposed && place.tip.finite()) expose(t, place);
  for (Frame& frame : state_.on_wire) {
    if (!frame.waiting || frame.due > t) continue;
    frame.waiting = false;
    if (state_.arrived.health != Health::absent && frame.sample.t <= state_.arrived.t) continue;
    state_.arrived = frame.sample;
    state_.news = true;
  }
}

bool HandPlant::poll(Measurement<HandSample>& newest) noexcept {
  if (!state_.news) return false;
  state_.news = false;
  newest = state_.arrived;
  return true;
}

}  // namespace enc::sim
