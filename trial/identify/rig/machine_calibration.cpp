#include "trial/identify/rig/machine_calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"

namespace enc::trial {
namespace {

constexpr double kTilt = 10.0 * kDegree, kTurn = 20.0 * kDegree;
constexpr double kAside = 0.015, kUp = 0.008;  // m, of the tip to each side
constexpr std::size_t kFewestPackets = 20;     // of a stand
constexpr double kNotCarried = 0.05;           // rad between two turns of one body
constexpr double kTipOff = 1e-3;               // m: who puts a tip on a tip by hand comes nearer
constexpr double kMassOff = 0.3;       // of what a scale has told: a wrong unit is a factor of 4 or more
constexpr double kLeastMassOff = 0.1;  // kg: of a light load a cable and the tool are a large share

double fraction(double x) { return x - std::floor(x); }

// The i-th of a sequence that fills a line evenly, whatever its length [Roberts 2018, R sequences].
double spread(std::size_t i, double ratio) { return fraction(0.5 + ratio * static_cast<double>(i + 1)); }

// Before anything moves: all ways, and whether a fit of these poses tells weight from zero.
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

// One body turns by one angle, whoever looks at it.
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

// All axes of a sensor may read in another unit: nothing but a scale tells that.
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

// A lever of the machine that is wrong, too: only the tip tells it from the tracker's place.
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
    // Nearer to zero, until it is within reach.
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
  found.stands.reserve(count);
  const CarriedStand* first = nullptr;  // in which the tool was seen
  for (const Pose<'W', 'H'>& pose : poses) {
    if (progress) progress(static_cast<double>(found.stands.size()) / static_cast<double>(count));
    tool.go(pose);
    const CarriedStand& now = found.stands.emplace_back(tool.stand());
    if (now.packets < kFewestPackets) continue;
    if (first == nullptr)
      first = &now;
    else
      check_carried(*first, now);
  }
  tool.go(Pose<'W', 'H'>::identity());
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
