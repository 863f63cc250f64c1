#include "trial/identify/camera/registration_rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "core/control/scene/scene.h"
#include "core/control/step.h"
#include "core/devices/mode.h"
#include "core/vision/vision_module.h"
#include "sim/camera/stage.h"
#include "trial/assemble/vision.h"

namespace enc::trial {
namespace {

constexpr std::size_t kTargets = 240;

}  // namespace

RegistrationRig registration_rig(const models::Setup& setup) {
  if (setup.rig.arm.driver == "none")
    throw Error(
        fmt::format("{}:1:1: this rig has no arm; expected [arm] with a driver, because the arm carries the "
                    "tip through the camera's view; name another rig, such as vishap",
                    setup.rig_path));
  if (setup.rig.arm.driver != "sim")
    throw Error(
        fmt::format("{}: this rig's arm is driven by '{}', and the guided procedure moves a simulated one; "
                    "expected driver "
                    "\"sim\"; of a real arm record the places and give them as POINTS.csv",
                    models::place_of(setup, "rig.arm.driver"), setup.rig.arm.driver));
  if (!setup.twin.arm.there)
    throw Error(fmt::format(
        "{}: the rig's arm is simulated and nothing says what it is; expected [truth.arm]; add it",
        models::place_of(setup, "rig.arm")));
  RegistrationRig rig;
  rig.camera = setup.twin.camera;
  rig.believed = setup.rig.arm.machine;
  rig.arm = setup.twin.arm;
  rig.least_dexterity = setup.rig.arm.least_dexterity;
  rig.X_WC = {rotation_xyz(setup.twin.frames.W_C.rotation), setup.twin.frames.W_C.position};
  return rig;
}

RegistrationPlaces places_of(const RegistrationRig& rig, std::size_t most_pairs) {
  const Arm arm(rig.believed);
  const std::vector<Point<'W'>> all = places_in_view(arm, rig.least_dexterity, rig.X_WC, rig.camera);
  RegistrationPlaces places;
  places.visited = well_spread(all, most_pairs);
  Vec3 middle = Vec3::Zero();
  for (const Point<'W'>& p : all) middle += p.e() / static_cast<double>(all.size());
  const std::size_t step = std::max<std::size_t>(1, all.size() / kTargets);
  for (std::size_t i = 0; i < all.size(); i += step) places.targets.push_back(all[i]);
  // Sort from the middle outwards, so that the nearest and the farthest are at the ends of the list.
  const auto distance = [&](const Point<'W'>& p) { return (p.e() - middle).norm(); };
  std::stable_sort(places.targets.begin(), places.targets.end(),
                   [&](const Point<'W'>& a, const Point<'W'>& b) { return distance(a) < distance(b); });
  for (const Point<'W'>& p : places.targets) places.distance.push_back(distance(p));
  return places;
}

namespace {

constexpr double kNear = 10e-3;     // m: less than the distance of places from the images' edges
constexpr double kStill = 0.1e-3;   // m: some steps of the encoders
constexpr double kStillTime = 0.5;  // s, rest time of the tip within that distance
constexpr double kPatience = 3.0;   // s, in addition to the target's travel time

// Keeps only the arm. The core needs a tracker, but there is no finger.
models::Setup bare(models::Setup rig) {
  rig.scene = SceneSpec{};
  rig.scene.arm.emplace();
  rig.scene.tracker.emplace();
  rig.scene_path = rig.rig_path;
  return rig;
}

std::string in_mm(const Point<'W'>& p) {
  return fmt::format("[{:.1f}, {:.1f}, {:.1f}]", p.xyz[0] * kMmPerM, p.xyz[1] * kMmPerM, p.xyz[2] * kMmPerM);
}

}  // namespace

DrivenArm::DrivenArm(models::Setup rig) : trial_(bare(std::move(rig)), for_ever()) { tick(); }

TrialOptions DrivenArm::for_ever() {
  TrialOptions options;
  options.seed = 0;
  options.seconds = std::numeric_limits<double>::infinity();
  options.law = [this](const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) {
    guide(scene, tick, in, sent_, state, out);
  };
  return options;
}

void DrivenArm::tick() {
  trial_.tick();
  now_ = seconds(trial_.now().t.time_since_epoch());
  const sim::World& world = trial_.world();
  if (world.diverged_at() >= 0)
    throw Error(
        fmt::format("{}: the physics diverged at tick {}: {}; try a smaller truth.arm.timestep_us",
                    models::place_of(trial_.setup(), "truth.arm"), world.diverged_at(), world.divergence()),
        {}, ErrorKind::device);
}

// True if all joints stay within their limits on a straight path, and none jumps. Beyond the turret's axis,
// or around a fold, an arm pulled straight ahead gets stuck.
bool DrivenArm::straight_way(const Point<'W'>& to) const {
  constexpr double kStep = 5e-3;  // m
  constexpr double kLeap = 0.5;   // rad or m
  const Arm& arm = impedance_of(trial_.scene()).arm;
  const Point<'W'> from = reading();
  const int steps = static_cast<int>(std::ceil((to - from).norm() / kStep));
  PerJoint before = trial_.inputs().arm.value.joints;
  for (int i = 1; i <= steps; ++i) {
    PerJoint q = before;
    const Point<'W'> at = from + (static_cast<double>(i) / steps) * (to - from);
    if (!arm.inverse(trial_.scene().X_WR.inverse() * at, q)) return false;
    for (std::size_t j = 0; j < arm.joints(); ++j)
      if (std::abs(q[j] - before[j]) > kLeap) return false;
    before = q;
  }
  return true;
}

double DrivenArm::go(const Point<'W'>& wanted) {
  ++places_;
  const double began = now_;
  if (!straight_way(wanted)) bring(Point<'W'>(0, 0, 0), 0.0);  // passes its zero, W's origin
  bring(wanted, kStillTime);
  due_ = now_;
  return now_ - began;
}

double DrivenArm::time_limit(const Point<'W'>& to) const {
  const ArmRig& rig = trial_.setup().rig.arm;
  return (to - reading()).norm() / rig.speed + rig.speed / rig.acceleration + kPatience;
}

void DrivenArm::bring(const Point<'W'>& to, double still_time) {
  sent_ = to;
  const double began = now_, limit = time_limit(to);
  Point<'W'> stood = reading();  // position at the last motion, and its time below
  double since = now_;
  while (now_ - since < still_time || (reading() - to).norm() > kNear) {
    if (now_ - began > limit) give_up(to, limit);
    tick();
    if ((reading() - stood).norm() <= kStill) continue;
    stood = reading();
    since = now_;
  }
}

void DrivenArm::give_up(const Point<'W'>& at, double after) const {
  const double away = (reading() - at).norm();
  const bool far = away > kNear;
  const std::string holds = trial_.outputs().mode == Mode::hold
                                ? ", in hold: " + why_text(trial_.outputs().why & kHoldReasons)
                                : "";
  throw Error(fmt::format(
      "{}: the tip did not come to rest for place {}, at {} mm in W: after {:.1f} s it {} {:.1f} mm away{}; "
      "expected it within {:.0f} mm, and {:.1f} s long within {:.1f} mm; {}",
      models::place_of(trial_.setup(), "rig.arm"), places_, in_mm(at), after, far ? "is" : "still moves,",
      away * kMmPerM, holds, kNear * kMmPerM, kStillTime, kStill * kMmPerM,
      far ? "raise rig.arm.stiffness_N_per_m, or see rig.arm.gravity and what the motors of truth.arm can"
          : "lower rig.arm.stiffness_N_per_m, or see friction and counts of truth.arm, which let it rest"));
}

// Advances to the due tick. Periods that are not whole ticks then do not add up to a drift.
TipStand DrivenArm::read(double later) {
  due_ += later;
  while (now_ < due_ - 0.5 * trial_.scene().dt) tick();
  return {trial_.truth().tip, reading(), trial_.truth().joints};
}

TipThings ball_at_tip(const Pose<'W', 'C'>& X_WC, const sim::CameraTruth& camera) {
  sim::Thing ball;
  ball.half = Vec3::Constant(camera.ball_radius);
  for (std::size_t c = 0; c < 3; ++c) ball.colour[c] = static_cast<float>(camera.ball_rgb[c]);
  return [X_CW = X_WC.inverse(), ball](const TipStand& tip) {
    std::vector<sim::Thing> things{ball};
    things.front().at = X_CW * tip.truth;
    return things;
  };
}

PictureEyes::PictureEyes(std::unique_ptr<StereoCamera> camera, std::unique_ptr<BallFinder> finder,
                         double rate, Show show)
    : camera_(std::move(camera)), finder_(std::move(finder)), period_(1.0 / rate), show_(std::move(show)) {}

std::optional<Point<'C'>> PictureEyes::see(const TipStand& tip) {
  if (show_) show_(tip);
  // The time is in the middle between two exposures, so that each frame is due once.
  const Time now(from_seconds((static_cast<double>(frames_++) + 0.5) * period_));
  Measurement<StereoFrame> frame;
  if (!camera_->poll(now, frame) || frame.health != Health::ok) {
    loss_ = BallLoss::no_frame;
    return {};
  }
  const FoundBall ball = finder_->find(frame.value);
  if (ball.found()) return ball.centre;
  loss_ = ball.loss;
  return {};
}

PictureEyes twin_eyes(const models::Setup& setup, const DriverSource& modules, std::uint64_t seed) {
  if (setup.rig.camera.driver != "sim")
    throw Error(
        fmt::format("{}: this rig's camera is driven by '{}', and no real one sees a simulated arm; expected "
                    "driver \"sim\"; "
                    "without --through-images no camera is needed",
                    models::place_of(setup, "rig.camera.driver"), setup.rig.camera.driver));
  try {
    const auto& vision = *static_cast<const VisionModule*>(modules("vision").vision);
    const auto& camera = *static_cast<const sim::CameraModule*>(modules("camera").camera);
    const sim::CameraTruth& truth = setup.twin.camera;
    auto shown = std::make_shared<sim::CameraScene>();
    const TipThings things = ball_at_tip(pose_of<'W', 'C'>(setup.twin.frames.W_C), truth);
    return {camera.camera({stage_of(truth, seed), Time::max()}, [shown](Time) { return *shown; }),
            vision.ball(setup.rig.camera, setup.rig.vision.ball), truth.rate,
            [shown, things](const TipStand& tip) { shown->things = things(tip); }};
  } catch (const Error& e) {
    if (e.key().empty()) throw;
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

}  // namespace enc::trial
