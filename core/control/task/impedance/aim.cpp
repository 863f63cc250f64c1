#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/rotation.h"
#include "core/control/safety/inside.h"
#include "core/control/task/impedance/finger.h"
#include "core/control/task/impedance/impedance_spec.h"

namespace enc::stages {

// ---- Predicted touch of an approaching finger, renewed with every picture. The longer the finger has not
// touched, the farther along its path it must be.

namespace {

using Vec2 = Eigen::Vector2d;

// s, assumed times of the touch after the newest picture was evaluated; denser for an early touch.
constexpr std::array<double, ReachPrediction::kTimes> kAfter{0.0, 0.02, 0.044, 0.074, 0.114, 0.17, 0.25};
// s: the weight of a later touch falls e-fold in that time, because the prop can still move there later.
// Chosen.
constexpr double kSoon = 0.03;
constexpr double kApart = 0.03;  // s, between pictures
constexpr double kOften = 5e-3;  // s: least time between predictions, as one takes up to half a millisecond
constexpr double kUneven = 1.4;  // times the noise of a picture, because no hand follows minimum jerk exactly
constexpr double kUnevenLeast = 0.3e-3;  // m, least value of that noise
constexpr double kLying = 1e-3;          // m: a nearer finger lies on the prop
constexpr double kFarthest = 0.05;       // m: a predicted touch farther from the finger is rejected

// Earlier pictures are of use as long as no long gap lies between them. If the finger is seen more often than
// its path needs, the pictures in between are skipped.
bool take_picture(const ArmContext& context, const CommonState& state, ReachPrediction& now) {
  const Time exposed_at = exposed(context.scene.tracker, state.tool.t);
  const double gap = now.count > 0 ? age(exposed_at, now.exposed[0]) : kOften;
  const bool another = state.tool.value.tool != now.tool;
  if (!another && gap >= 0.0 && gap < kOften) return false;
  now.tool = state.tool.value.tool;
  if (another || gap < 0.0 || gap > context.scene.tracker.longest_prediction) {
    now.count = 0;
    now.clear = false;  // of other pictures
  }
  if (now.count < 2 || age(now.exposed[0], now.exposed[1]) > kApart) {
    std::shift_right(now.at.begin(), now.at.end(), 1);
    std::shift_right(now.exposed.begin(), now.exposed.end(), 1);
    now.count = std::min<std::int32_t>(now.count + 1, kSightings);
  }
  now.at[0] = context.tip_newest;
  now.exposed[0] = exposed_at;
  return true;
}

double noise_of_newest(const ArmContext& context, const CommonState& state) {  // m rms, each axis
  return std::sqrt(noise_of(context.scene.tracker, state.tool.value, context.scene.X_WC).mean_square());
}

// A hysteresis: pictures whose noise is close to the limit do not switch the prediction on and off.
bool clear(const ArmContext& context, const CommonState& state, const ReachPrediction& now) {
  const double vaguest = context.scene.tracker.reach.vaguest;
  return noise_of_newest(context, state) <=
         (now.clear ? ReachPredictionSpec::kStaysClear * vaguest : vaguest);
}

// A reaching hand is never slower than its speed at touch, except for a moment between its movements. No
// picture shows how a hovering finger moves on, and neither does a picture with too much noise. In both cases
// the prop meets the finger at its present position.
bool reaches(const ArmContext& context, const ReachPrediction& now) {
  if (now.count < 3 || !now.clear) return false;
  const auto first = static_cast<std::size_t>(now.count - 1);
  const double down =
      dot(now.at[first] - now.at[0], context.normal) / age(now.exposed[0], now.exposed[first]);
  return down > context.scene.tracker.reach.touch_slowest;
}

// The prediction uses the axes of the surface under the finger.
void ask(const ArmContext& context, const CommonState& state, ReachPrediction& now) {
  now.object = state.object;
  now.told = context.tick.t;
  const Object& object = context.scene.objects[static_cast<std::size_t>(state.object)];
  now.X_WN = object.met_in_its_middle()
                 ? Pose<'W', 'N'>(object.X_WO.q(), object.X_WO.origin())  // of its face
                 : Pose<'W', 'N'>(rotation_z_to(context.normal.e()), context.surface_point);
  const Pose<'N', 'W'> X_NW = now.X_WN.inverse();
  const TrackerRig& rig = context.scene.tracker;
  const double known = std::max(kUnevenLeast, kUneven * noise_of_newest(context, state));
  const TipMotion& motion = state.tip_motion;
  const bool steady = rig.prediction == Prediction::constant_velocity;
  std::array<Sighting, kSightings> seen;
  const std::span<Sighting> all(seen.data(), static_cast<std::size_t>(now.count));
  for (std::size_t i = 0; i < all.size(); ++i)
    seen[i].at = (X_NW * now.at[i]).e() - context.tool_radius * Vec3::UnitZ();
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

// The integrals of exp(-x s) and of s exp(-x s) over s from 0 to 1, for x >= 0.
Vec2 decay(double x) {
  if (x < 1e-3) return {1.0 - 0.5 * x, 0.5 - x / 3.0};
  const double whole = -std::expm1(-x) / x;
  return {whole, (whole - std::exp(-x)) / x};
}

// The integral of place times weight and of weight from `begin` on, between two neighbours of kAfter, in
// closed form: sampled times would shake the goal from tick to tick, and the arm would pass that on to a
// touching finger. The place goes evenly from one to the other, and so does the logarithm of the weight,
// which falls by `discount`, 1/s, besides. To a time without evidence the weight itself goes evenly to
// nothing.
Vec3 touches_between(const ReachPrediction& now, std::size_t i, double begin, double most, double discount) {
  Vec3 a = Vec3::Map(now.touches[i].data()), b = Vec3::Map(now.touches[i + 1].data());
  const bool begins = std::isinf(a[2]), ends = std::isinf(b[2]);
  const double to = kAfter[i + 1], from = std::clamp(begin, kAfter[i], to);
  if ((begins && ends) || !(from < to)) return Vec3::Zero();
  if (begins) a = b;
  if (ends) b = a;
  const double share = (from - kAfter[i]) / (to - kAfter[i]);
  a += share * (b - a);
  const double at_a = a[2] - most - discount * (from - begin), at_b = b[2] - most - discount * (to - begin);
  const Vec2 part = (to - from) * std::exp(std::max(at_a, at_b)) * decay(std::abs(at_b - at_a));
  const double whole = part[0], late = at_a >= at_b ? part[1] : part[0] - part[1];
  const Vec3 here(a[0], a[1], 1.0);
  if (begins) return (share * whole + (1.0 - share) * late) * here;
  if (ends) return (1.0 - share) * (whole - late) * here;
  return whole * here + late * Vec3(b[0] - a[0], b[1] - a[1], 0.0);
}

// The mean over the times that are still to come, weighted by their fit and by how soon they are. Given in
// the surface's axes; unset if none fits or if passing by is more probable.
Vec2 expected(const ReachPrediction& now, double passed) {
  const double begin = std::max(passed, kAfter.front());
  double most = now.passes;
  for (std::size_t i = 0; i + 1 < kAfter.size(); ++i)
    if (kAfter[i + 1] > begin) most = std::max({most, now.touches[i][2], now.touches[i + 1][2]});
  if (std::isinf(most)) return {kUnset, kUnset};
  Vec3 sum = Vec3::Zero();
  double touches = 0.0;
  for (std::size_t i = 0; i + 1 < kAfter.size(); ++i) {
    touches += touches_between(now, i, begin, most, 0.0)[2];
    sum += touches_between(now, i, begin, most, 1.0 / kSoon);
  }
  if (touches < std::exp(now.passes - most) || !(sum[2] > 0.0)) return {kUnset, kUnset};
  return sum.head<2>() / sum[2];
}

Point<'W'> on_surface(const ArmContext& context, const CommonState& state, const ReachPrediction& now,
                      double passed) {
  const Vec2 at = expected(now, passed);
  if (!at.allFinite()) return {};
  ObjectHint hint = state.hints.tool[0];
  return nearest(context.scene, state.object, now.X_WN * Point<'N'>(at.x(), at.y(), 0.0), hint).point;
}

}  // namespace

Goal predicted_touch(const ArmContext& context, const CommonState& state, ImpedanceState& memory) noexcept {
  ReachPrediction& now = memory.coming;
  const Object* object = nearest_object(context, state);
  const TrackerRig& rig = context.scene.tracker;
  const bool asked = rig.foresight == TouchPrediction::reach && rig.prediction != Prediction::hold;
  if (!asked || object == nullptr || !context.tool_known) {
    now.object = -1;
    return {};
  }
  const bool news = take_picture(context, state, now);
  if (news) {
    now.object = -1;  // earlier predictions are void
    now.clear = clear(context, state, now);
  }
  // The prop meets a moving object at the object's position.
  const bool comes = context.tool_fresh && object->moving < 0 && reaches(context, now);
  if (!comes || presses(state, memory.contact)) return {};
  // Once for each picture. In the plane of another object the prediction may differ, and so may the first
  // touch on that object.
  if (now.object < 0) {
    if (!news && age(context.tick.t, now.told) < kOften) return {};
    ask(context, state, now);
  }
  const double passed = age(context.tick.t, now.told), dt = context.scene.dt;
  const Point<'W'> at = on_surface(context, state, now, passed);
  const Point<'W'> then = on_surface(context, state, now, passed + dt);
  if (!at.finite() || !then.finite()) return {at, Vec<'W'>::zero(), true};
  return {at, (1.0 / dt) * (then - at), true};
}

Point<'W'> comes_to(const ArmContext& context, const ImpedanceState& memory) noexcept {
  const ReachPrediction& now = memory.coming;
  const double passed = age(context.tick.t, now.told);
  if (now.object < 0 || passed > kAfter.back()) return {};
  const Vec2 at = expected(now, passed);
  if (!at.allFinite()) return {};
  return now.X_WN * Point<'N'>(at.x(), at.y(), ReachPredictionSpec::kAbove);
}

// ---- Target of an arm's prop [VisHap 2.2, 2.3].

namespace {

// True if the prop represents the surface itself, as deep as it is pressed.
bool tells_depth(const Object& object) {
  const Interaction kind = object.interaction.kind;
  return kind == Interaction::slide || kind == Interaction::click || kind == Interaction::spin;
}

// True if the waiting prop is pushed back. The arm measures that in the tick in which it begins; a camera
// sees it a picture or more later.
bool felt_first(const ArmContext& context, const CommonState& state, const ImpedanceState& now,
                const Object& object) {
  const bool behind = dot(context.X_WH.origin() - context.surface_point, context.normal) < 0.0;
  return now.aim.caught_up && tells_depth(object) && context.tool_fresh && behind && !context.in.withheld &&
         pushed_back(state, context.normal) && context.gap < context.scene.contact.leave_gap;
}

// A pressing finger lies on the prop as long as the camera sees it within leave_gap of it. Each tick the arm
// measures its prop to 0.03 mm, while a camera measures the finger to 0.5 mm, late and seldom. The prop gives
// the finger's depth, the camera its presence. The finger is never behind the prop. A prediction that says so
// ran on past the contact.
void lie_on_prop(ArmContext& context, CommonState& state, const ImpedanceState& now) {
  const Object* object = nearest_object(context, state);
  if (state.mode != Mode::contact || object == nullptr || !context.tool_known) return;
  // The prop is on its way to another position, unless a picture jumps sideways while it is pressed.
  const bool pressed = presses(state, now.contact) && !context.in.withheld;
  if (!tells_depth(*object) || !(now.aim.caught_up || pressed)) return;
  const double prop = dot(context.X_WH.origin() - context.surface_point, context.normal);
  const double near = context.scene.contact.leave_gap;
  const double slack = pressed ? AimSpec::kSpringsBack * near : near;
  const double beyond = context.gap - prop;
  // A prop that is lifted off the surface from the side does not carry the finger behind it.
  context.gap = beyond < -near ? std::min(prop, 0.0) : prop + std::max(0.0, beyond - slack);
  // The prop shows how the finger moves on, long before a picture shows that it was stopped. If the picture
  // itself is behind the prop, the finger is beside it or vision is wrong.
  const double shown = dot(context.tip_newest - context.X_WH.origin(), context.normal) - context.tool_radius;
  if (pressed && beyond < slack && shown > -near)
    correct_now(context.scene.tracker, context.tick.t, -beyond * context.normal, state.tip_motion);
}

// An arm measures no force: the gap decides what is touched, or the pushed prop does. "Prepare" is the motion
// from away to follow.
void choose_mode(const ArmContext& context, CommonState& state, ImpedanceState& now) {
  const FollowSpec& follow = context.scene.follow;
  const Object* object = nearest_object(context, state);
  if (object == nullptr || !context.tool_known) {
    state.mode = Mode::away;
    return;
  }
  if (state.mode == Mode::away && context.gap < follow.resume) state.mode = Mode::follow;
  if (object->interaction.kind == Interaction::hit) {  // the prop decides when the touch begins and ends
    if (state.mode == Mode::contact && !now.contact.anchored) state.mode = Mode::follow;
    if (state.mode == Mode::follow && context.gap > follow.pause) state.mode = Mode::away;
    return;
  }
  if (state.mode == Mode::contact && context.gap > context.scene.contact.leave_gap) state.mode = Mode::follow;
  if (state.mode == Mode::follow && context.gap > follow.pause) state.mode = Mode::away;
  if (state.mode == Mode::follow && (context.gap <= 0.0 || felt_first(context, state, now, *object))) {
    state.mode = Mode::contact;
    ++state.contacts;
    now.contact = Contact{};
    now.contact.object = state.object;
    now.contact.tool = state.tool.value.tool;
  }
  if (state.mode == Mode::contact)
    now.contact.X_WN = Pose<'W', 'N'>(rotation_z_to(context.normal.e()), context.surface_point);
}

// A flying ball is no longer touched. Its prop clears the finger's path and moves to the ball's waiting
// position.
Vec<'W'> rest_of_flight(const ArmContext& context, const Object& object) {
  if (object.interaction.kind != Interaction::hit) return Vec<'W'>::zero();
  const MoverState& ball = context.moved[static_cast<std::size_t>(object.moving)];
  const double flown = ball.shift.norm();
  if (!(flown > 0.0)) return Vec<'W'>::zero();
  return (context.movers[static_cast<std::size_t>(object.moving)].travel / flown - 1.0) * ball.shift;
}

bool touches_belt(const CommonState& state, const Object* object) {
  return state.mode == Mode::contact && object != nullptr && object->interaction.kind == Interaction::spin;
}

// The finger's projection on the surface moves with the finger and with the object. The surface determines
// its speed: on a small ball it is slower than the finger, and beyond the edge of a button it stands still.
Goal goal_of(const ArmContext& context, const CommonState& state, ImpedanceState& memory,
             const Object& object) {
  const Goal touch = predicted_touch(context, state, memory);
  if (object.met_in_its_middle()) return {object.X_WO.origin(), Vec<'W'>::zero(), touch.predicted};
  if (touch.point.finite()) return touch;
  const Vec<'W'> none = Vec<'W'>::zero();
  if (const Vec<'W'> rest = rest_of_flight(context, object); !rest.e().isZero())
    return {context.surface_point + rest};
  const bool predicted = context.scene.tracker.prediction != Prediction::hold;
  const bool known = predicted && context.tool_fresh && state.tip_motion.velocity.finite();
  const Vec<'W'> finger = known ? state.tip_motion.velocity : none;
  // A belt is slower than pictures jump: a running prop moves along at the usual speed limit, and is wide
  // enough.
  if (touches_belt(state, &object)) return {context.surface_point};
  const bool shifts = object.moving >= 0 && object.interaction.kind != Interaction::spin;
  const Vec<'W'> face = shifts ? context.moved[static_cast<std::size_t>(object.moving)].velocity : none;
  const Vec<'W'> shift = shifts ? shift_of(object, context.moved) : none;
  const double dt = context.scene.dt;
  ObjectHint hint = state.hints.tool[0];
  const Point<'W'> now = context.tool_tip - shift;
  const Point<'W'> at = nearest(context.scene, state.object, now, hint).point;
  const Point<'W'> then = nearest(context.scene, state.object, now + dt * (finger - face), hint).point;
  return {context.surface_point, face + (1.0 / dt) * (then - at)};
}

// Limits of the target's motion; they are raised where a reach may touch.
struct TargetLimits {
  double acceleration, settle;
  TargetLimits(const ArmRig& rig, bool hurries)
      : acceleration(hurries ? rig.reach_acceleration : rig.acceleration),
        settle(hurries ? rig.reach_settle : rig.settle) {}
};

// If the nearest point jumps to another part of the object, the straight path may leave a hollow object,
// where the finger is. Then the target waits at the last point of its path that is inside, or moves along the
// surface while that is nearer.
Vec3 not_through_a_hollow(const ArmContext& context, double acceleration, double speed, CommonState& state,
                          const Aim& now, const Object& object, const Vec3& wanted) {
  Inside inside(context.scene, state.object, -AimSpec::kOutside, shift_of(object, context.moved),
                state.hints.command);
  const Brake brake{now.target, now.velocity.e(), acceleration, speed, context.scene.dt};
  const double here = inside.depth(brake.at);
  state.entered = state.entered || here >= -AimSpec::kOutside;
  return state.entered ? inside.velocity(brake, here, wanted) : wanted;
}

// The target always keeps within speed and acceleration. It first moves straight to the goal and then follows
// it. The goal jumps with each new picture of the finger; `settle` smooths these jumps.
void move_target(ArmContext& context, const ArmRig& rig, CommonState& state, Aim& now, const Goal& goal,
                 const Object* object) {
  const double dt = context.scene.dt;
  const Vec3 way = (goal.point - now.target).e();
  const double far = way.norm();
  const bool runs = touches_belt(state, object);
  if (far > AimSpec::kLeap && !runs) now.caught_up = false;
  // Motion under the raised limits brakes under the raised limits.
  now.hurried =
      goal.predicted || (now.hurried && now.velocity.norm() > braking_speed(far, rig.acceleration, dt));
  const TargetLimits target_limits(rig, now.hurried);
  const double stops =
      std::min(AimSpec::kBrakingShare * braking_speed(far, target_limits.acceleration, dt), far / dt);
  const double settle = runs ? AimSpec::kBeltSettle : target_limits.settle;
  const double speed = now.caught_up ? std::min(far / settle, stops) : std::min(rig.speed, stops);
  Vec3 velocity = goal.velocity.e();
  if (far > 0.0) velocity += way * (speed / far);
  if (velocity.norm() > rig.speed) velocity *= rig.speed / velocity.norm();
  const double most = target_limits.acceleration * dt;
  const Vec3 change = velocity - now.velocity.e();
  if (change.norm() > most) velocity = now.velocity.e() + change * (most / change.norm());
  const bool on_its_way = !now.caught_up;
  if (on_its_way) {
    if (object != nullptr)
      velocity =
          not_through_a_hollow(context, target_limits.acceleration, rig.speed, state, now, *object, velocity);
    now.caught_up = far < AimSpec::kThere && change.norm() <= 2.0 * most;
  }
  context.target_change = (velocity - now.velocity.e()) / dt;
  if (on_its_way || now.hurried) context.target_acceleration = context.target_change;
  // Under a touching finger the raised limits apply sideways only: along the normal the user would feel them.
  if (!on_its_way && state.mode == Mode::contact && context.normal.finite())
    context.target_acceleration -= context.normal.e() * context.normal.e().dot(context.target_acceleration);
  now.velocity = Vec<'W'>(velocity);
  now.target = now.target + dt * now.velocity;
}

// Moves the target to a point under the finger. A point out of reach stops the target.
void go_to(Goal goal, ArmContext& context, const Impedance& task, CommonState& state, Aim& now,
           const Object& object) {
  const Arm& arm = task.arm;
  PerJoint q = context.in.arm.value.joints;
  if (arm.reaches(context.scene.X_WR.inverse() * goal.point, task.rig.least_dexterity, q)) {
    // A machine with fewer than three joints moves to the nearest point that it can reach.
    if (arm.joints() < kMostJoints) goal.point = context.scene.X_WR * arm.tip(q);
    move_target(context, task.rig, state, now, goal, &object);
    return;
  }
  context.why |= kUnreachable;
  now.caught_up = false;
  move_target(context, task.rig, state, now, {now.target}, nullptr);
  now.caught_up = false;
}

// Only the ball pushes its prop while it is pressed (render_impedance), and along the normal the target is
// where the finger has pushed it. So there is no step when they part. The target's speed is that of the prop,
// smoothed, and at most what the distance so far allows: one wrong reading sets nothing in motion. Sideways
// the target comes to rest.
void go_with_prop(const ArmContext& context, const ArmRig& rig, const Contact& contact, Aim& now) {
  const double dt = context.scene.dt;
  const Vec3 normal = contact.X_WN.q() * Vec3::UnitZ();
  const double ticks = 1.0 + std::round(age(context.tick.t, contact.began) / dt);
  const double way = normal.dot((context.X_WH.origin() - contact.X_WN.origin()).e());
  const double most = std::min(rig.speed, 2.0 * std::abs(way) / (ticks * dt));
  const double before = ticks > 1.0 ? normal.dot(now.velocity.e()) : 0.0;
  const double speed =
      before + (normal.dot(context.tip_velocity.e()) - before) / std::min(ticks, AimSpec::kPropTicks);
  Vec3 across = now.velocity.e() - normal * normal.dot(now.velocity.e());
  across *= std::max(0.0, 1.0 - rig.acceleration * dt / std::max(across.norm(), 1e-9));
  now.velocity = Vec<'W'>(Vec3(across + std::clamp(speed, -most, most) * normal));
  now.target = now.target +
               Vec<'W'>(Vec3(across * dt + normal * normal.dot((context.X_WH.origin() - now.target).e())));
}

// Checks that the arm follows its commands. A finger may push the tip away from its target, so the distance
// is evidence only without a finger nearby. Accepted lag: an even motion lags by K_v / K_p.
void check_following(ArmContext& context, const Impedance& law, Aim& now) {
  if (context.in.withheld) {
    now.deviation = PathDeviation{};
    return;
  }
  const ArmRig& rig = law.rig;
  const double lag = std::min(rig.damping / rig.stiffness, AimSpec::kLongestLag);
  const double dt = context.scene.dt;
  double near = AimSpec::kFriction + now.deviation.excused(now.velocity.norm(), lag, dt);
  if (rig.gravity == GravityForm::none) {
    const PerJoint weight = law.arm.gravity(context.in.arm.value.joints, law.prop_mass, Payload::exact);
    near += law.arm.force(context.jacobian, weight).norm() / rig.stiffness;  // the tip hangs below its target
  }
  const bool free =
      !context.tool_known || (context.tool_tip - context.X_WH.origin()).norm() > AimSpec::kBesideProp;
  const bool off = free && (now.target - context.X_WH.origin()).norm() > near;
  if (!now.deviation.too_long(off, AimSpec::kPatience, dt)) return;
  now.stuck = true;
  context.why |= kNotFollowing;
}

// The hold of a stuck arm lasts until the finger has gone: a new attempt would push with full force.
void hold_stuck(ArmContext& context, Aim& now) {
  if (!now.stuck) return;
  const bool gone = !context.tool_known || context.gap > context.scene.follow.pause;
  if (gone)
    now.stuck = false;
  else
    context.why |= kNotFollowing;
}

// m: how deep the finger has pushed its prop in. The finger lies on it even where a picture shows it somewhat
// above. Beside a button, whose prop waits in its middle, the prop tells nothing.
double pushed_in(const ArmContext& context, const Aim& now, const Object& object) {
  if (!now.caught_up || !tells_depth(object)) return 0.0;
  const auto behind = [&](const Point<'W'>& from) {
    return dot(from - context.X_WH.origin(), context.normal);
  };
  return std::max(0.0, std::min(behind(context.surface_point), behind(now.target)));
}

// True if the object's stiffness acts: in contact, and after a picture has ended the contact, until the prop
// is back at the surface. A change of the stiffness of a pushed prop would be felt. The passivity controller
// acts in contact alone, and so does its stiffness.
bool stiffness_acts(const ArmContext& context, const ArmRig& rig, const CommonState& state, Contact& contact,
                    double pushed) {
  const Time now = context.tick.t;
  const bool touched = state.mode == Mode::contact;
  const bool lasts = state.mode == Mode::follow && contact.object == state.object &&
                     rig.passivity == PassivityForm::none && contact.loaded > Time{} &&
                     age(now, contact.loaded) < AimSpec::kLetsGo;
  if (pushed <= 0.0 || !(touched || lasts))
    contact.loaded = Time{};
  else if (touched)
    contact.loaded = now;
  return touched || contact.loaded > Time{};
}

// Blends from one stiffness to the next over `gradual_time`, without a step.
void change_gain(const ArmContext& context, const ArmRig& rig, const CommonState& state, const Object* object,
                 ImpedanceState& memory) {
  const double free = rig.stiffness;
  Aim& now = memory.aim;
  RenderedStiffness felt{free, 0.0};
  if (object == nullptr) {
    now.gain = 1.0;
    now.sunk = 0.0;
    return;
  }
  const InteractionSpec& does = object->interaction;
  const double pushed = pushed_in(context, now, *object);
  const bool touched = state.mode == Mode::contact;
  const bool acts = stiffness_acts(context, rig, state, memory.contact, pushed);
  const double depth = touched ? std::max({0.0, -context.gap, pushed}) : pushed;
  if (acts && object->stiffness > 0.0) felt = felt_at(does, object->stiffness, free, depth);
  if (object->moving >= 0 && touched)
    felt.stiffness *= context.moved[static_cast<std::size_t>(object->moving)].firmness;
  const double whole = std::max({free, object->stiffness, std::isnan(does.floor) ? 0.0 : does.floor}) / free;
  const double share = does.gradual_time > 0.0 ? context.scene.dt / does.gradual_time : 1e9;
  const auto towards = [](double from, double to, double most) {
    return from + std::clamp(to - from, -most, most);
  };
  now.gain = towards(now.gain, felt.stiffness / free, whole * share);
  now.sunk = towards(now.sunk, felt.sunk, does.bottom * share);
  now.triggered = does.kind == Interaction::click && acts && depth >= does.trigger;
}

}  // namespace

void aim(ArmContext& context, const Impedance& task, CommonState& state, ImpedanceState& memory) noexcept {
  Aim& now = memory.aim;
  if (!context.X_WH
           .valid()) {  // one missed reading changes nothing; after more of them the tip may be anywhere
    now.blind += context.scene.dt;
    if (now.blind > task.rig.stale) now = Aim{};
    return;
  }
  now.blind = 0.0;
  if (!holding(context) && now.target.finite()) check_following(context, task, now);
  hold_stuck(context, now);
  if (holding(context) || !now.target.finite()) {  // no force is requested, and none jumps afterwards
    const bool stuck = now.stuck;
    now = Aim{};
    now.target = context.X_WH.origin();
    now.stuck = stuck;
    if (holding(context)) return;
  }
  lie_on_prop(context, state, memory);
  choose_mode(context, state, memory);
  const Object* object = nearest_object(context, state);
  if (hit_now(context, state) != nullptr) {
    go_with_prop(context, task.rig, memory.contact, now);
  } else if (state.mode == Mode::away || object == nullptr) {
    move_target(context, task.rig, state, now,
                {context.guide_target.finite() ? context.guide_target : now.target}, nullptr);
  } else {
    go_to(goal_of(context, state, memory, *object), context, task, state, now, *object);
  }
  change_gain(context, task.rig, state, object, memory);
}

}  // namespace enc::stages
