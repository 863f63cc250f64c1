// `encounter view`: a picture of the simulated world at a moment, from beside or through the scene's camera.
#include "sim/view/view.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "app/built.h"
#include "app/common/options.h"
#include "app/modules/modules.h"
#include "app/view/film.h"
#include "app/view/moment/depict.h"
#include "app/view/moment/moment.h"
#include "app/view/recorded/source.h"
#include "app/window/window.h"
#include "core/base/error.h"
#include "core/vision/vision_module.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

// Throws Error for options that a picture cannot have.
void check_picture(const ViewOptions& options) {
  if (options.shot.empty())
    throw Error("--at-s, --close-up and --through-camera are of a picture in a file: add --shot picture.png");
  const std::string ending = models::lower_case(std::filesystem::path(options.shot).extension().string());
  if (!ending.empty() && ending != ".png")
    throw Error(
        fmt::format("{}: --shot writes a PNG; expected a name that ends in .png; choose one", options.shot));
  check_moment(options.at);
}

void check_camera(const models::Setup& setup) {
  if (!setup.scene.camera)
    throw Error(
        fmt::format("{}:1:1: the scene has no camera; expected [camera] beside [tracker]; leave out "
                    "--through-camera or take models/scenes/camera/wall.toml",
                    setup.scene_path));
}

// Without a known background, the augmented view keeps the arm.
void note_unknown(const std::vector<std::uint8_t>& known) {
  if (std::all_of(known.begin(), known.end(), [](auto on) { return on == 0; }))
    print_notes({"warning: the background is not known yet, so the arm was left in; choose a later --at-s"});
}

// Handles --through-camera: the image of the scene's left camera.
int through_camera(const ViewOptions& options) {
  check_picture(options);
  const models::Setup setup = load_setup(options);
  check_camera(setup);
  const auto& vision = *static_cast<const VisionModule*>(load_module("vision").vision);
  const auto& pictures = *static_cast<const sim::ViewModule*>(load_module("view").view);
  models::OutFile file(options.shot, models::existing(options.force));
  std::optional<Image> left;  // image of this tick
  trial::TrialOptions how;
  how.seed = options.seed;
  how.seconds = options.at.value_or(4.0);
  how.drivers = load_module;
  how.look = [&](const Measurement<StereoFrame>& frame) {
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

// True after half of the hold. A blow has no hold: it counts at once.
bool deepest(const Moment& m, double& held) {
  const double hold_time = m.setup.scene.user->hold_time;
  if (!(hold_time > 0.0)) return touching(m.truth) || m.truth.phase == sim::Phase::release;
  if (m.truth.phase == sim::Phase::hold) held += m.scene.dt;
  return held >= 0.5 * hold_time;
}

// A picture always shows the twin, whatever drivers the rig has.
trial::TrialOptions options_of(const ViewOptions& options) {
  constexpr double kBeyond = 0.01;  // s: lets the run pass a moment at its end
  trial::TrialOptions trial;
  trial.seed = options.seed;
  trial.draw_all = true;
  if (options.at) trial.seconds = *options.at + kBeyond;
  return trial;
}

// Runs to the first tick at or after the moment. Unset: until half of the first press's hold is over. Returns
// false if the physics diverged.
bool run_until(Source& source, std::optional<double> at) {
  constexpr double kRounding = 1e-9;  // s
  double held = 0.0;
  while (source.tick()) {
    if (source.trial().world().diverged_at() >= 0) return false;
    if (at ? source.now() >= *at - kRounding : deepest(source.moment(), held)) return true;
  }
  if (at && source.now() < *at - kRounding)
    throw Error(
        fmt::format("--at-s {:g}: it ends at {:.3f} s; expected a moment before that; choose an earlier one",
                    *at, source.now()));
  return true;
}

// The moment of the picture; unset: during the person's press.
std::optional<double> moment_for(const ViewOptions& options, const Source& source) {
  if (options.at) return options.at;
  if (is_record(options.scene)) return deepest_moment(options.scene);
  return source.person() ? std::nullopt : std::optional(4.0);
}

int video(const ViewOptions& options) {
  if (!options.through_camera.empty())
    throw Error(
        "--through-camera is of a picture, and a film shows the world from beside; expected --video alone; "
        "give --shot picture.png for a picture, or run --frames DIR for all that the camera sees");
  const FilmReport report = film(options);
  fmt::print("{}", film_text(options.video, report));
  if (report.signal != 0) return 128 + report.signal;
  return report.diverged ? 4 : 0;
}

// Writes options.shot. options.at unset: during the hold of the first press, else at 4 s.
int picture(const ViewOptions& options) {
  const bool close_up = options.close_up;
  check_picture(options);
  const auto* module = static_cast<const sim::ViewModule*>(load_module("view").view);
  Source source(options, options_of(options));  // first: an input is never overwritten
  models::OutFile file(options.shot, models::existing(options.force));
  if (!run_until(source, moment_for(options, source))) {
    fmt::print(stderr, "encounter: the physics diverged at tick {}: {}\n",
               source.trial().world().diverged_at(), source.trial().world().divergence());
    return 4;
  }
  const Moment moment = source.moment();
  sim::ViewRequest request = depict(moment, camera_for(moment, close_up), close_up);
  show(moment, source.data(), request);
  file.write(module->png(module->open(request, sim::Finish::still)->draw(request)));
  file.keep();
  if (!source.doubt().empty()) print_notes({options.scene + ": " + source.doubt()});
  fmt::print("{}: {} x {} pixels, the world at {:.3f} s\n", options.shot, request.width, request.height,
             seconds(moment.now.t.time_since_epoch()));
  return 0;
}

// Refuses options without effect.
void refuse_idle(const ViewOptions& options) {
  const bool in_file = !options.shot.empty() || !options.video.empty();
  if (options.scene.empty() && (options.armed || !options.set.empty() || !options.rig.empty()))
    throw Error("--rig, --set and --armed are of a scene; expected one; name it before the options");
  if (in_file && options.armed)
    throw Error("--armed is of a window; a picture in a file is of the twin; leave one of them out");
  if (!is_record(options.scene)) return;
  if (!options.rig.empty() || !options.set.empty() || options.armed || !options.record.empty() ||
      options.seed != SceneOptions{}.seed)
    throw Error(
        fmt::format("{}: a record has its rig, numbers and seed, and moves nothing; leave --rig, --set, "
                    "--seed, --armed and --record out",
                    options.scene));
  if (!options.through_camera.empty())
    throw Error(options.scene +
                ": a record keeps no images; leave --through-camera out; `run --frames DIR` keeps them");
}

}  // namespace

int view(const ViewOptions& options) {
  refuse_idle(options);
  const bool in_file = !options.shot.empty() || !options.video.empty() || !options.through_camera.empty();
  if (options.scene.empty() && in_file)
    throw Error("a picture in a file is of a scene or a record; expected one; name it before the options");
  if (!options.video.empty()) return video(options);
  if (options.shot.empty() && options.through_camera.empty() && !options.at && !options.close_up)
    return window(options);
  if (!options.through_camera.empty()) return through_camera(options);
  return picture(options);
}

}  // namespace enc::app
