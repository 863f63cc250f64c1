#include "app/view/film.h"

#include <chrono>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "app/view/film_file.h"
#include "app/view/moment/depict.h"
#include "app/view/recorded/source.h"
#include "app/view/view.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/scene_file.h"
#include "sim/view/view.h"
#include "trial/operator/signals.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

using Wall = std::chrono::steady_clock;

constexpr double kLongest = 3600.0;  // s: 108,000 frames

void check_film(const ViewOptions& options) {
  if (options.at && !(*options.at >= 0.0 && *options.at <= kLongest))
    throw Error("--at-s is a time from 0 to 3600 s");
  if (options.seconds && !(*options.seconds > 0.0 && *options.seconds <= kLongest))
    throw Error("--for-s: expected a positive number of seconds, at most 3600 for a film");
}

// Films a run with one OpenGL context.
class Filming {
 public:
  Filming(const ViewOptions& options, const FilmFormat& format, const sim::ViewModule& module, Source& source)
      : options_(options), format_(format), module_(module), source_(source) {}

  // To the end of the run, or of its part that is filmed.
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
  // A frame belongs to the first tick at or after its moment.
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
  std::optional<sim::Camera> camera_;  // that of the first frame
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

FilmReport film(const ViewOptions& options) {
  check_film(options);
  const FilmFormat format = film_format(options.video);
  const auto& module = *static_cast<const sim::ViewModule*>(load_module("view").view);
  Source source(options, trial_options_of(options));  // first: what it reads is never written
  trial::Signals signals;
  signals.begin();  // from here on there is a file to finish
  const std::unique_ptr<FilmFile> file =
      open_film(options.video, format, models::existing(options.force), module.png);
  if (format.folder && !format.ending.empty())
    print_notes({fmt::format(
        "ffmpeg is not installed: {} becomes a folder of PNGs; install ffmpeg for a film", options.video)});
  const FilmReport report = Filming(options, format, module, source).run(*file);
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

}  // namespace enc::app
