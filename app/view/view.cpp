#include "app/view/view.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "app/view/film.h"
#include "app/view/moment/depict.h"
#include "app/view/recorded/source.h"
#include "app/window/window.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "sim/view/view.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

// Half of the hold is over. A blow, which is not held, is over at once.
bool deepest(const Moment& m, double& held) {
  const double hold_time = m.setup.scene.user->hold_time;
  if (!(hold_time > 0.0)) return touching(m) || m.truth.phase == sim::Phase::release;
  if (m.truth.phase == sim::Phase::hold) held += m.scene.dt;
  return held >= 0.5 * hold_time;
}

// A picture is of the twin, whatever drives the rig.
trial::TrialOptions options_of(const ViewOptions& options) {
  constexpr double kBeyond = 0.01;  // s: the run goes on after its end, for a later moment
  trial::TrialOptions trial;
  trial.seed = options.seed;
  trial.draw_all = true;
  if (options.at) trial.seconds = *options.at + kBeyond;
  return trial;
}

// To the first tick at or after the moment; without one until the person has held the first press for half of
// its time. False: it diverged.
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

// Unset: when the person has pressed.
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

// Options that would do nothing.
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

void leave_out_vision(models::Setup& setup) {
  if (!setup.scene.camera) return;
  setup.scene.camera.reset();
  setup.notes.emplace_back("drawn without vision: the finger is tracked as [tracker] of the rig says");
}

Moment moment_of(trial::Trial& trial) {
  sim::World& world = trial.world();
  return {trial.setup(),
          trial.scene(),
          world.physics().model(),
          world.physics().data(),
          world.machine ? &world.machine->machine() : nullptr,
          world.pusher.has_value(),
          world.X_WR(),
          world.machine ? world.machine->state().pose : Pose<'R', 'H'>(),
          world.q_WT(),
          world.truth(),
          trial.state(),
          trial.outputs(),
          trial.now()};
}

int view(const ViewOptions& options) {
  refuse_idle(options);
  const bool in_file = !options.shot.empty() || !options.video.empty() || !options.through_camera.empty();
  if (options.scene.empty() && in_file)
    throw Error("a picture in a file is of a scene or a record; expected one; name it before the options");
  if (!options.video.empty()) return video(options);
  if (options.shot.empty() && options.through_camera.empty() && !options.at && !options.close_up)
    return window(options);
  if (!options.through_camera.empty()) return through_camera(options);
  return picture(options, options.close_up ? Look::contact : Look::machine);
}

void check(const ViewOptions& options) {
  if (options.shot.empty())
    throw Error("--at-s, --close-up and --through-camera are of a picture in a file: add --shot picture.png");
  const std::string ending = models::lower_case(std::filesystem::path(options.shot).extension().string());
  if (!ending.empty() && ending != ".png")
    throw Error(
        fmt::format("{}: --shot writes a PNG; expected a name that ends in .png; choose one", options.shot));
  if (options.at && !(*options.at >= 0.0 && *options.at <= 3600.0))
    throw Error("--at-s is a time from 0 to 3600 s");
}

int picture(const ViewOptions& options, Look look) {
  const bool close_up = look == Look::contact;
  check(options);
  const auto* module = static_cast<const sim::ViewModule*>(load_module("view").view);
  Source source(options, options_of(options));  // first: what it reads is never written
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

}  // namespace enc::app
