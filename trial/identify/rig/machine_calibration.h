// `encounter calibrate rig RIG`: the machine carries a clamped tool through poses that tilt and rotate to all
// sides, and stands still at each. The data of force sensor and tracker give the calibrated numbers of the
// rig. It works in the twin or with real devices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/machine/hexapod.h"
#include "models/identify/rig/machine_fit.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::trial {

// Means over the time of a stand.
struct CarriedStand {
  double time = kUnset;      // s of experiment, middle of that time
  Pose<'W', 'H'> X_WH;       // measured by the machine's own encoders
  Wrench wrench;             // raw
  std::size_t readings = 0;  // number of the force sensor's readings; 0: no sensor
  Pose<'C', 'T'> X_CT;
  std::size_t packets = 0;  // packets in which the tracker saw the clamped tool
};

// Thrown when the run was asked to end; every moving device has been stopped.
struct MotionInterrupt {};

class CarriedTool {
 public:
  // `setup`: set-up of a scene that clamps a tool. Its rendering is not built: the machine only carries the
  // tool, which is tracked and weighed. Used options: seed, drivers, armed, lockstep, pace, stop. Throws
  // Error for all errors that can be detected before anything moves.
  CarriedTool(models::Setup setup, TrialOptions options);
  CarriedTool(const CarriedTool&) = delete;
  CarriedTool& operator=(const CarriedTool&) = delete;

  // The first call waits until the jaws hold the tool, and begins at the machine's present pose. Throws Error
  // (kind device): no path, no tool held, no rest, a hold, a lost link; or MotionInterrupt.
  void go(const Pose<'W', 'H'>& to);
  [[nodiscard]] CarriedStand stand();  // rests, and measures at its present pose

  [[nodiscard]] const Trial& trial() const { return trial_; }
  [[nodiscard]] double now() const { return now_; }  // s of experiment

 private:
  TrialOptions with_law(TrialOptions options);
  void tick();
  void watch();  // throws if the machine misbehaves
  void begin();
  void rest();
  [[nodiscard]] bool resting() const;

  Pose<'W', 'H'> wanted_;  // pose for the next tick; unset: it waits
  Vec<'F'> first_force_;   // N, raw, at the begin; unset: not yet
  bool out_of_reach_ = false;
  double turned_off_ = 0.0;        // s with a rotation other than commanded
  double now_ = 0.0, held_ = 0.0;  // s of experiment; s in a hold
  Trial trial_;
};

inline constexpr std::size_t kFewestPoses = 12, kUsualPoses = 24, kMostPoses = 500;

// Poses tilted by up to 10 degrees to all sides, rotated by up to 20 both ways, spread over the middle of the
// reach. Neighbours in the list are far from each other, so that a drifting zero cannot pass for a tilt. The
// path between two consecutive poses is within reach, and so are those from zero and back.
[[nodiscard]] std::vector<Pose<'W', 'H'>> calibration_poses(const Reach& reach, const Pose<'W', 'R'>& X_WR,
                                                            std::size_t count = kUsualPoses);

struct MachineCalibration {
  std::vector<CarriedStand> stands;
  std::optional<models::WeightFit> weight;     // unset: no force sensor
  std::optional<models::HandEyeFit> hand_eye;  // unset: no tracker
  std::int32_t clamped_tool = -1;              // index in the scene
  double tool_mass = 0.0;                      // kg, mass of the clamped tool in the scene
  std::size_t unseen = 0;                      // stands in which the tracker did not see the tool
  double time = kUnset;                        // s of experiment
};

// `progress`: share done. Ends at the machine's zero. Throws as CarriedTool does, and Error if the
// measurements do not determine the result.
[[nodiscard]] MachineCalibration calibrate_machine(CarriedTool& tool, std::size_t count = kUsualPoses,
                                                   const std::function<void(double)>& progress = {});

}  // namespace enc::trial
