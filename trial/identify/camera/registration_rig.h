// The rig of a guided registration: the positions of the tip, the arm in its true motion, and the eyes that
// see the tip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/devices/device.h"
#include "core/vision/ball/ball_finder.h"
#include "models/setup/scene_file.h"
#include "sim/camera/camera_scene.h"
#include "trial/assemble/assemble.h"
#include "trial/identify/camera/guided.h"
#include "trial/trial.h"

namespace enc::trial {

// The rig of a registration: the arm's model and the true arm, and the true pose of the camera.
struct RegistrationRig {
  ArmMachine believed;
  sim::ArmTruth arm;
  double least_dexterity = 0.15;
  Pose<'W', 'C'> X_WC;
  sim::CameraTruth camera;
};

// The positions of the tip that a rig offers, and those used and judged.
struct RegistrationPlaces {
  std::vector<Point<'W'>> visited;  // well spread, the most that are used
  std::vector<Point<'W'>> targets;  // spread over the volume in view
  std::vector<double> distance;     // distance of each target from the middle of the volume, m
};
[[nodiscard]] RegistrationPlaces places_of(const RegistrationRig& rig, std::size_t most_pairs);

// Throws Error if the rig has no arm, or no simulated arm.
[[nodiscard]] RegistrationRig registration_rig(const models::Setup& setup);

// The arm under the core's own law, in the twin:
//
//   place -> core (target, law, gravity) -> motors -> physics -> encoders -> core
//                                             physics -> true tip -> the camera's frames
//                                            encoders -> rig's kinematics -> the device's reading
//
// The arm moves alone: a bare tip, no object, no finger. It uses only the device's readings, as a real
// procedure must.
class DrivenArm final : public MovedArm {
 public:
  // `rig`: read without a scene. Throws Error with the place in the rig file.
  explicit DrivenArm(models::Setup rig);
  DrivenArm(const DrivenArm&) = delete;
  DrivenArm& operator=(const DrivenArm&) = delete;

  // Throws Error if the tip does not come to rest there in time, with the place and the remaining distance.
  double go(const Point<'W'>& wanted) override;
  TipStand read(double later) override;
  // The camera's pose as the arm would measure it: the arm's W follows from the rig's pose of its base.
  [[nodiscard]] Pose<'W', 'C'> as_it_believes(const Pose<'W', 'C'>& X_WC) const {
    return trial_.scene().X_WR * (trial_.world().X_WR().inverse() * X_WC);
  }

 private:
  [[nodiscard]] TrialOptions for_ever();
  void tick();
  void bring(const Point<'W'>& to, double still_time);
  [[nodiscard]] bool straight_way(const Point<'W'>& to) const;
  [[nodiscard]] double time_limit(const Point<'W'>& to) const;  // s
  [[noreturn]] void give_up(const Point<'W'>& at, double after) const;
  [[nodiscard]] Point<'W'> reading() const { return trial_.scene().X_WR * trial_.inputs().arm.value.tip; }

  Point<'W'> sent_;
  Trial trial_;
  double now_ = 0.0, due_ = 0.0;  // s: newest tick; newest requested reading
  int places_ = 0;                // places commanded so far
};

// The things in front of the twin's camera while a tip stands still: the ball, and any additions.
using TipThings = std::function<std::vector<sim::Thing>(const TipStand& tip)>;
[[nodiscard]] TipThings ball_at_tip(const Pose<'W', 'C'>& X_WC, const sim::CameraTruth& camera);

// Finds the ball in the frames of any stereo camera, one after the other at its rate. For the twin's camera,
// `show` first receives the tip.
class PictureEyes final : public TipEyes {
 public:
  using Show = std::function<void(const TipStand& tip)>;
  PictureEyes(std::unique_ptr<StereoCamera> camera, std::unique_ptr<BallFinder> finder, double rate,
              Show show = {});

  std::optional<Point<'C'>> see(const TipStand& tip) override;
  // Reason for the newest frame without a ball.
  [[nodiscard]] BallLoss loss() const { return loss_; }

 private:
  std::unique_ptr<StereoCamera> camera_;
  std::unique_ptr<BallFinder> finder_;
  double period_;  // s
  Show show_;
  std::int64_t frames_ = 0;
  BallLoss loss_ = BallLoss::none;
};

// Uses the twin's camera at its pose in truth.frames, and the rig's model of the head. Throws Error if a
// module is missing, the rig has no simulated camera, or a number is impossible.
[[nodiscard]] PictureEyes twin_eyes(const models::Setup& setup, const DriverSource& modules,
                                    std::uint64_t seed);

}  // namespace enc::trial
