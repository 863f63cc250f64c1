#include "app/view/film.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "app/built.h"
#include "app/common/options.h"
#include "app/common/words.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "app/view/film_file.h"
#include "app/view/moment/depict.h"
#include "app/view/moment/moment.h"
#include "app/view/recorded/source.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/printable.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"
#include "sim/view/view.h"
#include "trial/operator/signals.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

using Wall = std::chrono::steady_clock;

constexpr double kLongest = 3600.0;  // s: 108,000 frames

void check_length(double seconds) {
  if (!(seconds > 0.0 && seconds <= kLongest))
    throw Error("--for-s: expected a positive number of seconds, at most 3600 for a film");
}

// Films a run with one OpenGL context.
class FilmRecorder {
 public:
  FilmRecorder(const ViewOptions& options, const FilmFormat& format, const sim::ViewModule& module,
               Source& source)
      : options_(options), format_(format), module_(module), source_(source) {}

  // Films to the end of the run, or of the requested part.
  FilmReport run(FilmFile& file) {
    const Wall::time_point began = Wall::now();
    const bool terminal = isatty(STDERR_FILENO) != 0;
    FilmReport report;
    while (source_.tick()) {
      report.diverged = source_.trial().world().diverged_at() >= 0;
      const double now = source_.now();
      if (report.diverged || !due(report.frames, now)) continue;
      file.add(frame());
      if (report.frames++ == 0) report.from = now;
      report.to = now;
      if (terminal) show_progress((now - from_) / (to_ - from_));
    }
    if (terminal) clear_progress();
    report.signal = trial::Signals::caught();
    report.wall = std::chrono::duration<double>(Wall::now() - began).count();
    return report;
  }

 private:
  // A frame shows the first tick at or after its moment.
  [[nodiscard]] bool due(int frame, double now) const {
    constexpr double kRounding = 1e-9;  // s
    const double moment = from_ + frame / static_cast<double>(format_.rate);
    const bool over = options_.seconds && moment > to_ - kRounding;
    return !over && now >= moment - kRounding;
  }
  Image frame() {
    const Moment moment = source_.moment();
    if (!camera_) camera_ = camera_for(moment, options_.close_up);
    sim::ViewRequest request = depict_frame(moment, *camera_, options_.close_up);
    show(moment, source_.data(), request);
    request.width = format_.width;
    request.height = format_.height;
    if (!pictures_) pictures_ = module_.open(request, sim::Finish::film);
    return pictures_->draw(request);
  }

  const ViewOptions& options_;
  const FilmFormat& format_;
  const sim::ViewModule& module_;
  Source& source_;
  double from_ = options_.at.value_or(0.0);
  double to_ = options_.seconds ? from_ + *options_.seconds : source_.end();
  std::optional<sim::Camera> camera_;  // camera of the first frame
  std::unique_ptr<sim::Pictures> pictures_;
};

trial::TrialOptions trial_options_of(const ViewOptions& options) {
  trial::TrialOptions trial;
  trial.seed = options.seed;
  trial.draw_all = true;
  trial.stop = [] { return trial::Signals::caught() != 0; };
  if (options.seconds) trial.seconds = options.at.value_or(0.0) + *options.seconds;
  return trial;
}

}  // namespace

void check_moment(const std::optional<double>& at) {
  if (at && !(*at >= 0.0 && *at <= kLongest)) throw Error("--at-s is a time from 0 to 3600 s");
}

FilmReport film(const ViewOptions& options) {
  check_moment(options.at);
  if (options.seconds) check_length(*options.seconds);
  const FilmFormat format = film_format(options.video);
  const auto& module = *static_cast<const sim::ViewModule*>(load_module("view").view);
  Source source(options, trial_options_of(options));  // first: an input is never overwritten
  trial::Signals signals;
  signals.begin();  // a signal must not leave an unfinished file
  const std::unique_ptr<FilmFile> file =
      open_film(options.video, format, models::existing(options.force), module.png);
  if (format.folder && !format.ending.empty())
    print_notes({fmt::format(
        "ffmpeg is not installed: {} becomes a folder of PNGs; install ffmpeg for a film", options.video)});
  const FilmReport report = FilmRecorder(options, format, module, source).run(*file);
  if (report.frames == 0 && report.signal == 0)
    throw Error(
        fmt::format("{}: the run ends at {:.3f} s; expected --at-s before that; choose an earlier one",
                    options.scene, source.now()));
  if (report.frames > 0) file->keep();
  if (!source.doubt().empty()) print_notes({options.scene + ": " + source.doubt()});
  if (report.diverged)
    fmt::print(stderr, "encounter: the physics diverged at tick {}: {}; the film ends there\n",
               source.trial().world().diverged_at(), source.trial().world().divergence());
  return report;
}

std::string film_text(const std::string& file, const FilmReport& report) {
  if (report.frames == 0)
    return fmt::format("{}: not written, the run was stopped before its first frame\n", file);
  return fmt::format("{}: {} frames, the world from {:.3f} to {:.3f} s{}; {:.0f} ms a frame\n", file,
                     report.frames, report.from, report.to,
                     report.signal != 0 ? ", where it was stopped" : "", 1e3 * report.wall / report.frames);
}

// ---- `encounter tour`: a film of each shipped scene

namespace {

namespace fs = std::filesystem;

constexpr double kBefore = 1.0;      // s of the film before the first touch
constexpr double kSearched = 120.0;  // s to search for a touch

// Time of the first touch, s; 0: none within kSearched.
double first_touch(const ViewOptions& options) {
  models::Setup setup = models::load(options.scene, options.rig, options.set);
  leave_out_vision(setup);
  trial::TrialOptions how;
  how.seed = options.seed;
  trial::Trial trial(setup, how);
  while (trial.tick()) {
    const double now = seconds(trial.now().t.time_since_epoch());
    if (touching(trial.truth())) return now;
    if (now > kSearched) break;
  }
  return 0.0;
}

// The scene "camera/wall" becomes camera_wall.mp4, or the folder camera_wall without ffmpeg.
std::string film_name(const std::string& folder, std::string scene) {
  std::replace(scene.begin(), scene.end(), '/', '_');
  const std::string film = (fs::path(folder) / (scene + ".mp4")).string();
  return film_format(film).folder ? (fs::path(folder) / scene).string() : film;
}

// Refuses existing films before making the first one: the films take an hour.
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
  check_length(options.seconds);
  const std::vector<models::ListedScene> listed = models::listed_scenes(models::models_dir());
  if (listed.empty()) throw no_scenes();
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
    } catch (const Error& e) {  // other scenes may still succeed
      fmt::print(stderr, "encounter: {}: {}\n", scene.name, models::printable(e.what()));
      code = std::max(code, static_cast<int>(e.kind()));
    }
  }
  return code;
}

}  // namespace enc::app
