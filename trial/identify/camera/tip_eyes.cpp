#include "trial/identify/camera/tip_eyes.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "core/vision/vision_module.h"
#include "sim/camera/stage.h"
#include "trial/assemble/vision.h"

namespace enc::trial {

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
  // In the middle between two exposures, so that each is due once.
  const Time now(from_seconds((static_cast<double>(frames_++) + 0.5) * period_));
  Stamped<StereoFrame> frame;
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
    auto shown = std::make_shared<sim::Shown>();
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
