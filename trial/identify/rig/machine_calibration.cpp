#include "trial/identify/rig/machine_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "core/control/step.h"
#include "core/control/track/reach.h"
#include "core/devices/mode.h"
#include "core/machine/arm.h"

namespace enc::trial {
namespace {

constexpr double kSpeed = 0.020;       // m/s, speed of the tip as in [VHMR 4.1]
constexpr double kTurning = 0.10;      // rad/s: the platform is 0.2 m below the tip, so its joints do 20 mm/s
constexpr double kPeak = 1.875;        // peak over mean speed of a minimum-jerk motion
constexpr double kShareOfSpeed = 0.8;  // share of the machine's limits
constexpr double kAcceleration = 0.1;  // m/s^2, a quarter of the machine's limit
constexpr double kPeakAcceleration = 5.7735;  // peak of a minimum-jerk motion, over length / time^2
constexpr double kClosing = 5.0;              // s: no gripper takes longer
constexpr double kPatience = 5.0;             // s, to come to rest
constexpr double kTurnOff = M_PI / 180.0;     // rad, in addition to the servo's lag
constexpr double kTurnPatience = 0.050;       // s
// Largest change of the force, as a share of the weight: a tilt by 10 degrees gives 2 sin(5 degrees), 0.174,
// and an acceleration of 0.1 m/s^2 gives 0.01.
constexpr double kWeightTurned = 0.22;
constexpr double kTouched = 10.0;       // N: more than a cable's; a person in the way feels no more
constexpr double kLongestHold = 1.0;    // s
constexpr double kStillSpeed = 0.2e-3;  // m/s
constexpr double kNear = 0.2e-3;        // m, distance of the resting tip from its target
constexpr double kNearTurn = 2e-3;      // rad
constexpr double kStillTime = 0.3;      // s of rest before the measurement
constexpr double kMeasured = 1.0;       // s

// Keeps only the tool and the devices that carry, watch and weigh it.
models::Setup bare(models::Setup setup) {
  SceneSpec& scene = setup.scene;
  if (!scene.gripper || !scene.manipulator)
    throw Error(
        fmt::format("{}: no tool is clamped in this scene; expected [manipulator], [gripper] and a "
                    "[[tool]]; give another --scene, such as clamped_tool.toml",
                    models::place_of(setup, "manipulator")));
  scene.objects.clear();
  scene.behaviours.clear();
  scene.user.reset();
  scene.probe.reset();
  scene.pusher.reset();
  scene.display.reset();
  if (setup.rig.force.driver != "none" && !scene.force) scene.force.emplace();
  if (setup.rig.tracker.driver != "none" && !scene.tracker) scene.tracker.emplace();
  // Replaces the scene's own path, because this file commands the machine.
  scene.travel.emplace();
  scene.travel->speed = std::min(scene.travel->speed, setup.rig.manipulator.speed);
  scene.travel->start = Vec3::Zero();
  scene.travel->stops = {0.0, 1e-3};
  return setup;
}

Pose<'W', 'H'> between(const Pose<'W', 'H'>& from, const Pose<'W', 'H'>& to, double share) {
  return {from.q().slerp(share, to.q()), Vec3(from.p() + share * (to.p() - from.p()))};
}

// Time of a motion, s. A slow rig moves and turns slowly.
double way_time(const Pose<'W', 'H'>& from, const Pose<'W', 'H'>& to, const Reach& reach) {
  const double length = (to.p() - from.p()).norm();
  const double speed = std::min(kSpeed, kShareOfSpeed * reach.speed);
  const double acceleration = std::min(kAcceleration, kShareOfSpeed * reach.acceleration);
  const double turning = kTurning * speed / kSpeed;
  return std::max({0.2, kPeak * length / speed, kPeak * from.q().angularDistance(to.q()) / turning,
                   std::sqrt(kPeakAcceleration * length / acceleration)});
}

// Mean of rotations that differ little.
class MeanTurn {
 public:
  void add(const Quat& q) { sum_ += sum_.dot(q.coeffs()) < 0.0 ? Eigen::Vector4d(-q.coeffs()) : q.coeffs(); }
  [[nodiscard]] Quat mean() const { return Quat(sum_).normalized(); }

 private:
  Eigen::Vector4d sum_ = Eigen::Vector4d::Zero();
};

// Sums of a stand, tick by tick.
class StandSums {
 public:
  void add_place(const Pose<'W', 'H'>& X_WH) {
    place_ += X_WH.p();
    turn_.add(X_WH.q());
    ++places_;
  }
  void add_wrench(const Wrench& wrench) {
    force_ += wrench.force.e();
    torque_ += wrench.torque.e();
    ++readings_;
  }
  void add_tool(const Pose<'C', 'T'>& X_CT) {
    seen_ += X_CT.p();
    seen_turn_.add(Quat(X_CT.q()));
    ++packets_;
  }

  // time: s of experiment, middle of the stand.
  [[nodiscard]] CarriedStand means(double time) const {
    CarriedStand stand;
    stand.time = time;
    stand.readings = readings_;
    stand.packets = packets_;
    stand.X_WH = {turn_.mean(), Vec3(place_ / static_cast<double>(places_))};
    if (readings_ > 0) {
      const auto n = static_cast<double>(readings_);
      stand.wrench = {Vec<'F'>(Vec3(force_ / n)), Vec<'F'>(Vec3(torque_ / n))};
    }
    if (packets_ > 0) stand.X_CT = {seen_turn_.mean(), Vec3(seen_ / static_cast<double>(packets_))};
    return stand;
  }

 private:
  Vec3 place_ = Vec3::Zero(), seen_ = Vec3::Zero(), force_ = Vec3::Zero(), torque_ = Vec3::Zero();
  MeanTurn turn_, seen_turn_;
  std::size_t places_ = 0, readings_ = 0, packets_ = 0;
};

// True if the whole path of go() between two poses is within reach.
bool way_in_reach(const Reach& reach, const Pose<'W', 'R'>& X_WR, const Pose<'W', 'H'>& from,
                  const Pose<'W', 'H'>& to) {
  constexpr int kSteps = 100;
  const Pose<'R', 'W'> X_RW = X_WR.inverse();
  for (int i = 0; i <= kSteps; ++i)
    if (!reach.contains(X_RW * between(from, to, static_cast<double>(i) / kSteps))) return false;
  return true;
}

}  // namespace

CarriedTool::CarriedTool(models::Setup setup, TrialOptions options)
    : trial_(bare(std::move(setup)), with_law(std::move(options))) {}

TrialOptions CarriedTool::with_law(TrialOptions options) {
  options.seconds = std::numeric_limits<double>::infinity();
  // The core limits the position to the reach, but not the rotation added to it.
  options.law = [this](const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) {
    const Pose<'R', 'H'> before = out.manipulator.tip;
    carry(scene, tick, in, wanted_, state, out);
    if (!out.manipulator.tip.valid() || scene.reach.contains(out.manipulator.tip)) return;
    out_of_reach_ = true;
    out.manipulator.tip = before;
  };
  return options;
}

void CarriedTool::tick() {
  const double dt = trial_.scene().dt;
  if (!trial_.tick()) throw MotionInterrupt{};
  now_ = seconds(trial_.now().t.time_since_epoch());
  if (trial_.has_world() && trial_.world().diverged_at() >= 0)
    throw Error(fmt::format("the physics diverged at tick {}: {}", trial_.world().diverged_at(),
                            trial_.world().divergence()),
                {}, ErrorKind::device);
  if (trial_.gate().lost())
    throw Error(fmt::format("{}: the link is lost; nothing moves any more; see to it and calibrate again",
                            trial_.gate().links().back().role),
                {}, ErrorKind::device);
  held_ = trial_.outputs().mode == Mode::hold ? held_ + dt : 0.0;
  watch();
}

// Ends the calibration at the first problem. The operator removes the cause and starts again.
void CarriedTool::watch() {
  const auto fail = [](const std::string& what) { throw Error(what, {}, ErrorKind::device); };
  const Scene& scene = trial_.scene();
  const Inputs& in = trial_.inputs();
  if (held_ > (wanted_.valid() ? 0.0 : kLongestHold))
    fail(fmt::format(
        "the machine is in hold: {}; expected it to carry the tool; see docs/guide/troubleshooting.md, "
        "turn it back to zero and calibrate again",
        why_text(trial_.outputs().why & kHoldReasons)));
  if (out_of_reach_) fail("the machine was sent out of its reach; see rig.manipulator.geometry");
  if (!wanted_.valid()) return;
  if (!in.grip.value.holding)
    fail(
        "the jaws do not hold the tool any more; expected them closed on it to the end; put it between them, "
        "turn the machine back to zero and calibrate again");
  const Quat turn = (scene.X_WR * in.tip.value.X_RH).q();
  const double late = 2.0 * scene.servo.lag * kTurning + kTurnOff;
  turned_off_ = turn.angularDistance(wanted_.q()) > late ? turned_off_ + scene.dt : 0.0;
  if (turned_off_ > kTurnPatience)
    fail(fmt::format(
        "the machine is turned by {:.1f} degrees from where it was sent; expected {:.1f} at most; see "
        "the order of its rotations and its pivot, turn it back to zero and calibrate again",
        turn.angularDistance(wanted_.q()) * 180.0 / M_PI, late * 180.0 / M_PI));
  if (!scene.has_force || in.wrench.health != Health::ok) return;
  if (!first_force_.finite()) first_force_ = in.wrench.value.force;
  const double more = (in.wrench.value.force - first_force_).norm();
  const double most = kWeightTurned * scene.force.mass * kStandardGravity + kTouched;
  if (more > most)
    fail(fmt::format(
        "the force has changed by {:.1f} N since it began; expected {:.1f} N at most, of a weight "
        "that is tilted; something is in the way: free it, turn the machine back to zero and "
        "calibrate again",
        more, most));
}

// Waits at the machine's present pose until the jaws hold the tool.
void CarriedTool::begin() {
  const double began = now_;
  const auto ready = [&] {
    const Inputs& in = trial_.inputs();
    return trial_.scene().X_WR.valid() && in.tip.health == Health::ok && in.tip.value.X_RH.valid() &&
           trial_.outputs().manipulator.tip.valid() && in.grip.value.holding &&
           trial_.outputs().mode != Mode::hold;
  };
  do {
    if (now_ - began > kClosing)
      throw Error(
          fmt::format("after {:.0f} s the jaws do not hold the tool, or the machine does not say where "
                      "it is; put the tool between them and calibrate again",
                      kClosing),
          {}, ErrorKind::device);
    tick();
    const Measurement<TipSample>& tip = trial_.inputs().tip;
    const Quat turn = (trial_.scene().X_WR * tip.value.X_RH).q();
    if (tip.health == Health::ok && turn.angularDistance(Quat::Identity()) > kNearTurn)
      throw Error(
          fmt::format("the machine stands turned by {:.1f} degrees; expected it upright; turn it back to "
                      "zero by its own means, with the tool clear, and calibrate again",
                      turn.angularDistance(Quat::Identity()) * 180.0 / M_PI),
          {}, ErrorKind::device);
  } while (!ready());
  wanted_ = trial_.scene().X_WR * trial_.outputs().manipulator.tip;
}

void CarriedTool::go(const Pose<'W', 'H'>& to) {
  if (!wanted_.valid()) begin();
  const Pose<'W', 'H'> from = wanted_;
  const Scene& scene = trial_.scene();
  if (!way_in_reach(scene.reach, scene.X_WR, from, to))
    throw Error("the way to the next pose leads out of the machine's reach; see rig.manipulator.geometry", {},
                ErrorKind::device);
  const double time = way_time(from, to, scene.reach);
  for (double gone = 0.0; gone < time;) {
    gone += scene.dt;
    wanted_ = between(from, to, MinimumJerk(gone / time).x);
    tick();
  }
  wanted_ = to;
  rest();
}

bool CarriedTool::resting() const {
  const Measurement<TipSample>& tip = trial_.inputs().tip;
  const Pose<'W', 'H'> X_WH = trial_.scene().X_WR * tip.value.X_RH;
  return held_ == 0.0 && tip.health == Health::ok && tip.value.velocity.norm() < kStillSpeed &&
         (X_WH.p() - wanted_.p()).norm() < kNear && X_WH.q().angularDistance(wanted_.q()) < kNearTurn;
}

void CarriedTool::rest() {
  const double began = now_;
  double since = now_;
  while (now_ - since < kStillTime) {
    if (now_ - began > kPatience)
      throw Error(
          fmt::format(
              "the machine does not come to rest within {:.0f} s: it is {:.2f} mm and {:.2f} "
              "degrees from where it was sent; expected {:.1f} mm and {:.1f} degrees; see its "
              "servo, load and limits",
              kPatience,
              1e3 * (trial_.scene().X_WR * trial_.inputs().tip.value.X_RH.origin() - wanted_.origin()).norm(),
              180.0 / M_PI *
                  (trial_.scene().X_WR * trial_.inputs().tip.value.X_RH).q().angularDistance(wanted_.q()),
              1e3 * kNear, 180.0 / M_PI * kNearTurn),
          {}, ErrorKind::device);
    tick();
    if (!resting()) since = now_;
  }
}

CarriedStand CarriedTool::stand() {
  const RigSpec& rig = trial_.setup().rig;
  const Scene& scene = trial_.scene();
  // Packets still under way show the moving machine, so start later.
  const double first = now_, begin = now_ + (scene.has_tracker ? rig.tracker.usual_age : 0.0);
  StandSums sums;
  std::size_t moved = 0;  // number of ticks
  constexpr std::size_t kMostMoved = 100;
  Time told_force = trial_.inputs().wrench.t, told_tool = trial_.inputs().tool.t;
  while (now_ < begin + kMeasured) {
    tick();
    const Inputs& in = trial_.inputs();
    const bool news = in.tool.t != told_tool, sample = in.wrench.t != told_force;
    told_tool = in.tool.t;
    told_force = in.wrench.t;
    if (now_ < begin) continue;
    if (!resting()) {
      if (++moved > kMostMoved)
        throw Error(
            "the machine moved while it was measured; expected it to stand; see its servo and what "
            "shakes it",
            {}, ErrorKind::device);
      continue;
    }
    sums.add_place(scene.X_WR * in.tip.value.X_RH);
    if (scene.has_force && sample && in.wrench.health == Health::ok) sums.add_wrench(in.wrench.value);
    const bool of_now = seconds(in.tool.t.time_since_epoch()) >= first;
    if (scene.has_tracker && news && of_now && in.tool.health == Health::ok &&
        in.tool.value.tool == scene.clamped_tool && in.tool.value.X_CT.valid())
      sums.add_tool(in.tool.value.X_CT);
  }
  return sums.means(0.5 * (begin + now_));
}

namespace {

constexpr double kTilt = 10.0 * kDegree, kTurn = 20.0 * kDegree;
constexpr double kAside = 0.015, kUp = 0.008;  // m, motion of the tip to each side
constexpr std::size_t kFewestPackets = 20;     // fewest packets for each stand
constexpr double kNotCarried = 0.05;           // rad, between two rotations of one body
constexpr double kTipOff = 1e-3;               // m: tips put together by hand are nearer
constexpr double kMassOff = 0.3;       // share of the mass by a scale: a wrong unit is a factor of 4 or more
constexpr double kLeastMassOff = 0.1;  // kg: cable and tool are a large share of a light load

double fraction(double x) { return x - std::floor(x); }

// The i-th number of a sequence that fills a line evenly, whatever its length [Roberts 2018, R sequences].
double spread(std::size_t i, double ratio) { return fraction(0.5 + ratio * static_cast<double>(i + 1)); }

// Checks before any motion: all paths within reach, and poses that separate weight from zero.
void check_poses(const std::vector<Pose<'W', 'H'>>& poses, const Scene& scene) {
  const Reach& reach = scene.reach;
  const Pose<'W', 'R'>& X_WR = scene.X_WR;
  const auto n = static_cast<double>(poses.size());
  Vec3 mean = Vec3::Zero(), squares = Vec3::Zero();
  Pose<'W', 'H'> before = Pose<'W', 'H'>::identity();
  for (const Pose<'W', 'H'>& pose : poses) {
    if (!way_in_reach(reach, X_WR, before, pose) ||
        !way_in_reach(reach, X_WR, pose, Pose<'W', 'H'>::identity()))
      throw Error(
          "the machine does not reach the poses of a calibration, however near to its zero; expected room "
          "for a tilt of some degrees; see to rig.manipulator.geometry",
          "manipulator.geometry");
    const Vec3 down = pose.q().conjugate() * Vec3::UnitZ();
    mean += down / n;
    squares += down.cwiseAbs2() / n;
    before = pose;
  }
  const Vec3 swing = (squares - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  const double least = std::min(swing.x(), swing.y());
  if (scene.has_force && least < models::kLeastWeightSwing)
    throw Error(fmt::format("the machine tilts by {:.1f} degrees rms to one side in the poses that it "
                            "reaches; expected {:.1f}, which tell weight from zero; see to "
                            "rig.manipulator.geometry, tilt_limit_deg above all",
                            least / kDegree, models::kLeastWeightSwing / kDegree),
                "manipulator.geometry");
}

// Machine and tracker must report equal rotation angles, because they observe one body.
void check_carried(const CarriedStand& first, const CarriedStand& now) {
  const double machine = first.X_WH.q().angularDistance(now.X_WH.q()),
               tool = first.X_CT.q().angularDistance(now.X_CT.q());
  if (!(std::abs(machine - tool) < kNotCarried))
    throw Error(
        fmt::format("the machine has turned by {:.1f} degrees between two stands, and the tool is "
                    "seen turned by {:.1f}; expected the tool between the jaws, and nothing else that "
                    "carries its markers; clamp it, turn the machine back to zero and calibrate again",
                    machine / kDegree, tool / kDegree),
        {}, ErrorKind::device);
}

// All axes of a sensor may have a wrong unit, which only a scale reveals.
void check_mass(const MachineCalibration& found, double believed) {
  const double mass = found.weight->mass.value - found.tool_mass;
  if (mass < 0.0)
    throw Error(
        fmt::format("{:.3f} kg are behind the sensor and the scene's tool weighs {:.3f} kg; expected a "
                    "tool that is lighter than all of it; correct its mass_kg",
                    found.weight->mass.value, found.tool_mass));
  const double most = std::max(kMassOff * believed, kLeastMassOff) + found.weight->mass.half;
  if (!(std::abs(mass - believed) <= most))
    throw Error(
        fmt::format("by the force sensor {:.3f} kg are behind it, without the tool's {:g} kg, and the "
                    "rig has {:.3f} kg; expected it to within {:.2f} kg; put on a scale what the "
                    "sensor carries: see to the sensor's unit and gain, or correct rig.force.mass_kg "
                    "or the tool's mass_kg",
                    mass, found.tool_mass, believed, most));
}

// Also detects a wrong lever of the machine: only the tip separates it from the tracker's position.
void check_tip(const MachineCalibration& found, const Vec3& tip) {
  const Vec3 off = tip - found.hand_eye->tip.value;
  if (off.norm() <= kTipOff + found.hand_eye->tip.half.norm()) return;
  const Vec3 in_H = 1e3 * (found.hand_eye->X_HT.q() * off), there = 1e3 * found.hand_eye->tip.value;
  throw Error(
      fmt::format("the tool's tip stands at [{:.2f}, {:.2f}, {:.2f}] mm of the haptic-tip, known to "
                  "{:.2f} mm; expected its middle, to {:g} mm; see to "
                  "rig.manipulator.geometry.tip_height_mm, to how the tool is clamped, and to its "
                  "tip_mm, which is [{:.2f}, {:.2f}, {:.2f}] if it stands there: what is wrong of "
                  "them would be in the tracker's place",
                  in_H.x(), in_H.y(), in_H.z(), 1e3 * found.hand_eye->tip.half.norm(), 1e3 * kTipOff,
                  there.x(), there.y(), there.z()));
}

// Stands at each pose, then goes back to zero.
std::vector<CarriedStand> stands_at(const std::vector<Pose<'W', 'H'>>& poses, CarriedTool& tool,
                                    const std::function<void(double)>& progress) {
  std::vector<CarriedStand> stands;
  stands.reserve(poses.size());
  const CarriedStand* first = nullptr;  // first stand with a tracked tool
  for (const Pose<'W', 'H'>& pose : poses) {
    if (progress) progress(static_cast<double>(stands.size()) / static_cast<double>(poses.size()));
    tool.go(pose);
    const CarriedStand& now = stands.emplace_back(tool.stand());
    if (now.packets < kFewestPackets) continue;
    if (first == nullptr)
      first = &now;
    else
      check_carried(*first, now);
  }
  tool.go(Pose<'W', 'H'>::identity());
  return stands;
}

}  // namespace

std::vector<Pose<'W', 'H'>> calibration_poses(const Reach& reach, const Pose<'W', 'R'>& X_WR,
                                              std::size_t count) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr std::array<double, 4> kRatios{0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                          0.5385972572236101};
  const Pose<'W', 'H'> zero = Pose<'W', 'H'>::identity();
  std::vector<Pose<'W', 'H'>> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double to = 2.0 * M_PI * spread(i, kGolden);
    const double tilt = kTilt * std::sqrt(0.3 + 0.7 * spread(i, kRatios[0]));
    const double turn = kTurn * (2.0 * spread(i, kRatios[1]) - 1.0);
    const Vec3 place(kAside * (2.0 * spread(i, kRatios[2]) - 1.0),
                     kAside * (2.0 * spread(i, kRatios[3]) - 1.0),
                     kUp * (2.0 * spread(i, kGolden * kRatios[0]) - 1.0));
    const Vec3 axis(std::cos(to), std::sin(to), 0.0);
    const Pose<'W', 'H'> before = poses.empty() ? zero : poses.back();
    // Shrink the pose until it is within reach.
    double size = 1.0;
    Pose<'W', 'H'> pose;
    do {
      pose = {Quat(Eigen::AngleAxisd(size * tilt, axis) * Eigen::AngleAxisd(size * turn, Vec3::UnitZ())),
              Vec3(size * place)};
      size *= 0.9;
    } while (size > 0.1 &&
             !(way_in_reach(reach, X_WR, before, pose) && way_in_reach(reach, X_WR, pose, zero)));
    poses.push_back(pose);
  }
  return poses;
}

MachineCalibration calibrate_machine(CarriedTool& tool, std::size_t count,
                                     const std::function<void(double)>& progress) {
  const Scene& scene = tool.trial().scene();
  const std::vector<Pose<'W', 'H'>> poses = calibration_poses(scene.reach, scene.X_WR, count);
  check_poses(poses, scene);
  MachineCalibration found;
  found.stands = stands_at(poses, tool, progress);
  found.time = tool.now();
  found.clamped_tool = scene.clamped_tool;
  const ToolSpec& clamped = tool.trial().setup().scene.tools[static_cast<std::size_t>(scene.clamped_tool)];
  found.tool_mass = clamped.mass;

  std::vector<models::WeightStand> weighed;
  std::vector<models::EyeStand> seen;
  for (const CarriedStand& stand : found.stands) {
    if (stand.readings > 0) weighed.push_back({stand.time, stand.X_WH, stand.wrench});
    if (stand.packets >= kFewestPackets)
      seen.push_back({stand.X_WH, stand.X_CT});
    else if (scene.has_tracker)
      ++found.unseen;
  }
  if (scene.has_force && weighed.size() < found.stands.size())
    throw Error(
        fmt::format("the force sensor said nothing usable in {} of {} stands; see `encounter devices`",
                    found.stands.size() - weighed.size(), found.stands.size()),
        {}, ErrorKind::device);
  if (scene.has_force) {
    found.weight = models::fit_weight(weighed, found.time);
    check_mass(found, tool.trial().setup().rig.force.mass);
  }
  if (scene.has_tracker) {
    found.hand_eye = models::fit_hand_eye(seen);
    check_tip(found, clamped.tip);
  }
  return found;
}

}  // namespace enc::trial
