#include "trial/carried/machine_calibration.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/rotation.h"

namespace enc::trial {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kTilt = 10.0 * kDegree, kTurn = 20.0 * kDegree;
constexpr double kAside = 0.015, kUp = 0.008;  // m, of the tip to each side
constexpr std::size_t kFewestPackets = 20;     // of a stand

double fraction(double x) { return x - std::floor(x); }

// The i-th of a sequence that fills a line evenly, whatever its length [Roberts 2018, R sequences].
double spread(std::size_t i, double ratio) { return fraction(0.5 + ratio * static_cast<double>(i + 1)); }

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
  MachineCalibration found;
  for (const Pose<'W', 'H'>& pose : calibration_poses(scene.reach, scene.X_WR, count)) {
    if (progress) progress(static_cast<double>(found.stands.size()) / static_cast<double>(count));
    tool.go(pose);
    found.stands.push_back(tool.stand());
  }
  tool.go(Pose<'W', 'H'>::identity());
  found.time = tool.now();
  found.clamped_tool = scene.clamped_tool;
  found.tool_mass = tool.trial().setup().scene.tools[static_cast<std::size_t>(scene.clamped_tool)].mass;

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
    if (found.weight->mass.value < found.tool_mass)
      throw Error(
          fmt::format("{:.3f} kg are behind the sensor and the scene's tool weighs {:.3f} kg; expected a "
                      "tool that is lighter than all of it; correct its mass_kg",
                      found.weight->mass.value, found.tool_mass));
  }
  if (scene.has_tracker) found.hand_eye = models::fit_hand_eye(seen);
  return found;
}

}  // namespace enc::trial
