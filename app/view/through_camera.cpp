// What the left camera of a scene sees at a moment: as it comes, without the arm, or with the virtual objects
// in the arm's place.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "app/view/moment/believed.h"
#include "app/view/view.h"
#include "core/base/error.h"
#include "core/vision/vision_module.h"
#include "models/files.h"
#include "sim/view/view.h"
#include "trial/trial.h"

namespace enc::app {

namespace {

void check_camera(const models::Setup& setup) {
  if (!setup.scene.camera)
    throw Error(
        fmt::format("{}:1:1: the scene has no camera; expected [camera] beside [tracker]; leave out "
                    "--through-camera or take models/scenes/camera/wall.toml",
                    setup.scene_path));
}

// Where nothing of the background is known the arm is left in.
void note_unknown(const std::vector<std::uint8_t>& known) {
  if (std::all_of(known.begin(), known.end(), [](auto on) { return on == 0; }))
    print_notes({"warning: the background is not known yet, so the arm was left in; choose a later --at-s"});
}

}  // namespace

int through_camera(const ViewOptions& options) {
  check(options);
  const models::Setup setup = load_setup(options);
  check_camera(setup);
  const auto& vision = *static_cast<const VisionModule*>(load_module("vision").vision);
  const auto& pictures = *static_cast<const sim::ViewModule*>(load_module("view").view);
  models::OutFile file(options.shot, models::existing(options.force));
  std::optional<Image> left;  // of this tick
  trial::TrialOptions how;
  how.seed = options.seed;
  how.seconds = options.at.value_or(4.0);
  how.drivers = load_module;
  how.look = [&](const Stamped<StereoFrame>& frame) {
    const ImageView& from = frame.value.left;
    left.emplace(from.width, from.height);
    std::copy_n(from.rgb, left->rgb.size(), left->rgb.begin());
  };
  trial::Trial trial(setup, how);
  print_notes(setup.notes);
  const auto view = vision.augmented(believed_spec(setup, trial.scene()), trial.scene().objects);
  BelievedMoment moment;
  Image raw;
  double exposed = kUnset;
  while (trial.tick()) {
    if (!left) continue;
    raw = std::move(*left);
    left.reset();
    view->see(raw.view(), moment.of(trial));
    exposed = seconds(trial.now().t.time_since_epoch());
  }
  if (std::isnan(exposed))
    throw Error("the camera gave no image until then; expected a later --at-s", {}, ErrorKind::device);
  const bool removed = options.through_camera == "removed", augmented = options.through_camera == "augmented";
  if (removed || augmented) note_unknown(view->known().on);
  file.write(pictures.png(removed ? view->removed() : augmented ? view->augmented() : raw));
  file.keep();
  fmt::print("{}: {} x {} pixels, the left camera's at {:.3f} s\n", options.shot, raw.width, raw.height,
             exposed);
  return 0;
}

}  // namespace enc::app
