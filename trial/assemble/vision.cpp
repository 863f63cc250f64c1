#include "trial/assemble/vision.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/vision/vision_module.h"
#include "sim/camera/camera_scene.h"
#include "sim/camera/stage.h"
#include "trial/assemble/driver_device.h"
#include "trial/camera/drawn_camera.h"
#include "trial/camera/kept_frames.h"
#include "trial/trackers/threaded_tracker.h"

namespace enc::trial {

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

namespace {

// The simulated user's hand and the arm that comes to touch it, in the true camera's view.
sim::Show show(const models::Setup& setup, const sim::World& world) {
  const sim::TwinSpec& twin = setup.twin;
  const Pose<'W', 'C'> X_WC = pose_of<'W', 'C'>(twin.frames.W_C);
  const Pose<'W', 'C'> moved(X_WC.q(), X_WC.origin() + Vec<'W'>(twin.camera.moved));
  sim::CameraScene shown;
  shown.look.skin = sim::skin_colour(twin.camera.skin);
  return [&world, before = X_WC.inverse(), after = moved.inverse(), shown, from = twin.camera.hand_from,
          moves = twin.camera.moved_at, machine = twin.arm.machine,
          prop = setup.scene.prop](Time exposed) mutable {
    const sim::Truth& truth = world.truth();
    const double now = seconds(exposed.time_since_epoch());
    const Pose<'C', 'W'>& X_CW = now < moves ? before : after;
    shown.hand = truth.tool >= 0 && now >= from;
    shown.pose.tip = X_CW * truth.tool_tip;
    shown.pose.along = X_CW * world.pointing();
    shown.look.finger_width = 2.0 * truth.tool_radius;
    shown.things.clear();
    if (!world.arm) return shown;
    for (const ArmPart& part : arm_shape(machine, truth.joints, world.X_WR()))
      shown.things.push_back(thing_of(part, X_CW));
    if (prop) shown.things.push_back(thing_of(prop_shape(prop->size, truth.tip, world.arm->facing()), X_CW));
    return shown;
  };
}

// A camera with a second observer besides the tracker.
class ObservedCamera final : public StereoCamera {
 public:
  ObservedCamera(std::unique_ptr<StereoCamera> camera, Look look)
      : camera_(std::move(camera)), look_(std::move(look)) {}
  [[nodiscard]] std::string describe() const override { return camera_->describe(); }
  [[nodiscard]] bool linked() const noexcept override { return camera_->linked(); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return camera_->remarks(); }
  [[nodiscard]] ImageSize size() const override { return camera_->size(); }
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
    if (!camera_->poll(now, newest)) return false;
    if (newest.health == Health::ok) look_(newest);
    return true;
  }

 private:
  std::unique_ptr<StereoCamera> camera_;
  Look look_;
};

const sim::CameraModule& camera_module(const DriverSource& modules) {
  return *static_cast<const sim::CameraModule*>(modules("camera").camera);
}

sim::TwinCameraSpec twin_camera_spec(const models::Setup& setup, std::uint64_t seed) {
  sim::TwinCameraSpec spec;
  spec.stage = stage_of(setup.twin.camera, seed);
  const sim::CameraTruth& truth = setup.twin.camera;
  const auto at = [](double s) { return std::isnan(s) ? Time::max() : Time(from_seconds(s)); };
  spec.stalls = at(truth.stalls_at);
  spec.back = at(truth.back_at);
  spec.swaps = at(truth.swapped_at);
  return spec;
}

// Vision in its own thread, through the twin's camera. The loop, to which the twin's world belongs, exposes.
class TwinVision final : public PoseTracker {
 public:
  // `camera` belongs to `tracker`.
  TwinVision(std::unique_ptr<PoseTracker> tracker, DrawnCamera& camera)
      : tracker_(std::move(tracker)), camera_(camera) {}
  [[nodiscard]] std::string describe() const override { return tracker_->describe(); }
  [[nodiscard]] bool linked() const noexcept override { return tracker_->linked(); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return tracker_->remarks(); }
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    camera_.expose(now);
    return tracker_->poll(now, newest);
  }

 private:
  std::unique_ptr<PoseTracker> tracker_;
  DrawnCamera& camera_;
};

std::unique_ptr<StereoCamera> real_camera(const models::Setup& setup, const DriverSource& modules,
                                          const VisionOffer& offer) {
  try {
    return driver_device(setup.rig.camera.driver, &DriverModule::camera, "stereo camera", setup, modules,
                         offer.log, TimingMode{offer.waits, offer.lockstep});
  } catch (const Error& e) {
    throw of_role(setup, "camera", e);
  }
}

}  // namespace

std::unique_ptr<StereoCamera> make_drawn_camera(const models::Setup& setup, const DriverSource& modules,
                                                const sim::World& world, std::uint64_t seed, bool waits) {
  sim::TwinCameraSpec spec;
  spec.stage = stage_of(setup.twin.camera, seed);
  return std::make_unique<DrawnCamera>(
      camera_module(modules), spec, show(setup, world),
      waits ? DrawnCamera::Exposure::awaited : DrawnCamera::Exposure::polled);
}

std::unique_ptr<PoseTracker> make_vision(const models::Setup& setup, const DriverSource& modules,
                                         const VisionOffer& offer) {
  const bool simulated = setup.rig.camera.driver == "sim";
  if (simulated && offer.world == nullptr)
    throw Error("the rig's camera is simulated and nothing else is; expected a driver; name one in [camera]",
                {}, ErrorKind::device);
  try {
    std::vector<Time> exposed;
    if (!offer.kept.empty()) exposed = exposures_in(offer.kept);
    DrawnCamera* drawn = nullptr;
    std::unique_ptr<StereoCamera> camera;
    if (!simulated) {
      camera = real_camera(setup, modules, offer);
    } else if (!offer.threaded) {
      camera = camera_module(modules).camera(twin_camera_spec(setup, offer.seed), show(setup, *offer.world));
    } else {
      auto of_twin =
          std::make_unique<DrawnCamera>(camera_module(modules), twin_camera_spec(setup, offer.seed),
                                        show(setup, *offer.world), DrawnCamera::Exposure::called);
      drawn = of_twin.get();
      camera = std::move(of_twin);
    }
    if (!offer.keep.empty())
      camera = std::make_unique<KeepingCamera>(std::move(camera), offer.keep,
                                               *static_cast<const FrameFiles*>(modules("images").frames));
    if (!offer.kept.empty()) camera = std::make_unique<KeptCamera>(std::move(camera), std::move(exposed));
    if (offer.look) camera = std::make_unique<ObservedCamera>(std::move(camera), offer.look);
    const auto& vision = *static_cast<const VisionModule*>(modules("vision").vision);
    const Release release = offer.threaded ? Release::when_done : Release::when_due;
    auto tracker = vision.tracker(std::move(camera), setup.rig.camera, setup.rig.vision, release);
    if (!offer.threaded) return tracker;
    tracker = std::make_unique<ThreadedTracker>(std::move(tracker));
    if (drawn == nullptr) return tracker;
    return std::make_unique<TwinVision>(std::move(tracker), *drawn);
  } catch (const Error& e) {
    if (e.key().empty()) throw;
    throw Error(models::place_of(setup, e.key()) + ": " + e.what(), {}, e.kind());
  }
}

}  // namespace enc::trial
