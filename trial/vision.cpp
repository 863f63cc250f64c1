#include "trial/vision.h"

#include <algorithm>

#include "core/error.h"
#include "core/vision/vision_module.h"
#include "sim/camera/skin_tones.h"
#include "sim/camera/stage.h"
#include "trial/driver_device.h"
#include "trial/kept_frames.h"

namespace enc::trial {
namespace {

sim::StageSpec stage_of(const sim::CameraTruth& truth, std::uint64_t seed) {
  sim::StageSpec stage;
  StereoRig& head = stage.camera;
  head.width = truth.width;
  head.height = truth.height;
  head.rate = truth.rate;
  for (Lens* lens : {&head.left, &head.right}) {
    *lens = pinhole(truth.width, truth.height, truth.focal);
    lens->distortion = truth.distortion;
  }
  head.X_CD = Pose<'C', 'D'>::shift(truth.baseline, 0.0, 0.0);
  stage.scenery = truth.scenery;
  stage.seed = seed;
  stage.sensor.noise = truth.noise;
  stage.sensor.exposure = truth.exposure;
  return stage;
}

// The hand of the simulated user, as the true camera has it before it.
sim::Show show(const sim::TwinSpec& twin, const sim::World& world) {
  const Pose<'W', 'C'> X_WC = pose_of<'W', 'C'>(twin.frames.W_C);
  const Pose<'W', 'C'> moved(X_WC.q(), X_WC.origin() + Vec<'W'>(twin.camera.moved));
  sim::Shown shown;
  shown.look.skin = sim::skin_colour(twin.camera.skin);
  return [&world, before = X_WC.inverse(), after = moved.inverse(), shown, from = twin.camera.hand_from,
          moves = twin.camera.moved_at](Time exposed) mutable {
    const sim::Truth& truth = world.truth();
    const double now = seconds(exposed.time_since_epoch());
    const Pose<'C', 'W'>& X_CW = now < moves ? before : after;
    shown.hand = truth.tool >= 0 && now >= from;
    shown.pose.tip = X_CW * truth.tool_tip;
    shown.pose.along = X_CW * world.pointing();
    shown.look.finger_width = 2.0 * truth.tool_radius;
    return shown;
  };
}

std::unique_ptr<StereoCamera> twin_camera(const models::Setup& setup, const DriverSource& modules,
                                          const sim::World& world, std::uint64_t seed) {
  const auto& module = *static_cast<const sim::CameraModule*>(modules("camera").camera);
  sim::TwinCameraSpec spec;
  spec.stage = stage_of(setup.twin.camera, seed);
  const sim::CameraTruth& truth = setup.twin.camera;
  const auto at = [](double s) { return std::isnan(s) ? Time::max() : Time(from_seconds(s)); };
  spec.stalls = at(truth.stalls_at);
  spec.back = at(truth.back_at);
  spec.swaps = at(truth.swapped_at);
  return module.camera(spec, show(setup.twin, world));
}

}  // namespace

std::unique_ptr<PoseTracker> make_vision(const models::Setup& setup, const DriverSource& modules,
                                         const VisionOffer& offer) {
  const bool simulated = setup.rig.camera.driver == "sim";
  if (simulated && offer.world == nullptr)
    throw Error("the rig's camera is simulated and nothing else is; expected a driver; name one in [camera]",
                {}, ErrorKind::device);
  try {
    std::vector<Time> exposed;
    if (!offer.kept.empty()) exposed = exposures_in(offer.kept);
    auto camera = simulated ? twin_camera(setup, modules, *offer.world, offer.seed)
                            : driver_device(setup.rig.camera.driver, &DriverModule::camera, "stereo camera",
                                            setup, modules, offer.log, offer.waits);
    if (!offer.keep.empty())
      camera = std::make_unique<KeepingCamera>(std::move(camera), offer.keep,
                                               *static_cast<const FrameFiles*>(modules("images").frames));
    if (!offer.kept.empty()) camera = std::make_unique<KeptCamera>(std::move(camera), std::move(exposed));
    const auto& vision = *static_cast<const VisionModule*>(modules("vision").vision);
    return vision.tracker(std::move(camera), setup.rig.camera, setup.rig.vision);
  } catch (const Error& e) {
    if (e.key().empty()) throw;
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

}  // namespace enc::trial
