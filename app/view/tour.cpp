// encounter tour: a film of each shipped scene.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "app/common/options.h"
#include "app/process.h"
#include "app/view/film.h"
#include "app/view/film_file.h"
#include "app/view/moment/moment.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/printable.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;

constexpr double kBefore = 1.0;      // s of the film before the first touch
constexpr double kSearched = 120.0;  // s in which a touch is looked for

// When something is touched first; 0: not soon.
double first_touch(const ViewOptions& options) {
  models::Setup setup = models::load(options.scene, options.rig, options.set);
  leave_out_vision(setup);
  trial::TrialOptions how;
  how.seed = options.seed;
  trial::Trial trial(setup, how);
  while (trial.tick()) {
    const double now = seconds(trial.now().t.time_since_epoch());
    if (trial.truth().touching && trial.truth().contact_force.norm() > 0.01) return now;
    if (now > kSearched) break;
  }
  return 0.0;
}

// "camera/wall" is camera_wall.mp4; where ffmpeg is not installed, camera_wall is a folder.
std::string film_name(const std::string& folder, std::string scene) {
  std::replace(scene.begin(), scene.end(), '/', '_');
  const std::string film = (fs::path(folder) / (scene + ".mp4")).string();
  return film_format(film).folder ? (fs::path(folder) / scene).string() : film;
}

// Before the first of an hour of films is made.
void refuse_existing(const std::string& film, bool force) {
  std::error_code none;
  if (force || !fs::exists(film, none)) return;
  throw Error(fmt::format(
      "{}: is there already; expected a folder without these films; choose another --out, or give "
      "--force to replace them",
      film));
}

}  // namespace

int tour(const TourOptions& options) {
  if (!(options.seconds > 0.0 && options.seconds <= 3600.0))
    throw Error("--for-s: expected a positive number of seconds, at most 3600 for a film");
  const std::vector<models::ListedScene> listed = models::listed_scenes(models::models_dir());
  if (listed.empty())
    throw Error(
        fmt::format("{}/scenes: there are no scenes; expected the models of Encounter; see to "
                    "ENCOUNTER_MODELS, or leave it unset",
                    models::models_dir()));
  for (const models::ListedScene& scene : listed)
    refuse_existing(film_name(options.out, scene.name), options.force);
  const models::OutFolder folder(options.out);
  int code = 0;
  for (const models::ListedScene& scene : listed) {
    ViewOptions one;
    one.scene = scene.name;
    one.video = film_name(options.out, scene.name);
    one.seconds = options.seconds;
    one.force = options.force;
    try {
      one.at = std::max(0.0, first_touch(one) - kBefore);
      const FilmReport report = film(one);
      fmt::print("{}", film_text(one.video, report));
      std::fflush(stdout);
      if (report.signal != 0) return 128 + report.signal;
      if (report.diverged) code = 4;
    } catch (const Error& e) {  // one scene; the others may do
      fmt::print(stderr, "encounter: {}: {}\n", scene.name, models::printable(e.what()));
      code = std::max(code, static_cast<int>(e.kind()));
    }
  }
  return code;
}

}  // namespace enc::app
