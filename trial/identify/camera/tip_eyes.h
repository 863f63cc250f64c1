// The sensors of the tip in the guided registration: points with the noise of CameraTruth, or pictures in
// which the ball at the tip is found.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/devices/stereo_camera.h"
#include "core/vision/ball/ball_finder.h"
#include "models/setup/scene_file.h"
#include "sim/camera/shown.h"
#include "trial/assemble/assemble.h"
#include "trial/identify/camera/guided.h"

namespace enc::trial {

// The things in front of the twin's camera while a tip stands still: the ball, and any additions.
using TipThings = std::function<std::vector<sim::Thing>(const TipStand& tip)>;
[[nodiscard]] TipThings ball_at_tip(const Pose<'W', 'C'>& X_WC, const sim::CameraTruth& camera);

// The ball in the frames of any stereo camera, one after the other at its rate. For the twin's camera, `show`
// first receives the tip.
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
