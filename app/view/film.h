// A film of a run, drawn off the screen.
#pragma once

#include <optional>
#include <string>

#include "app/common/options.h"

namespace enc::app {

struct FilmReport {
  int frames = 0;
  double from = 0.0, to = 0.0;  // s of the experiment: first and last frame
  double wall = 0.0;            // s
  int signal = 0;               // signal that ended it early
  bool diverged = false;        // the physics diverged after `to`
};

// Throws Error unless the time is from 0 to 3600 s, as for a picture or a film's beginning.
void check_moment(const std::optional<double>& at);
// Films the run of options.scene into options.video, from options.at (or its beginning) for options.seconds
// (or to its end). Throws Error.
[[nodiscard]] FilmReport film(const ViewOptions& options);
// The text that `encounter view --video` prints.
[[nodiscard]] std::string film_text(const std::string& file, const FilmReport& report);

}  // namespace enc::app
