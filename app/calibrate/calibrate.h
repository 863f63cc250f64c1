// `encounter calibrate SUBJECT`: the options of all subjects, and the check of the first word.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/common/module_options.h"

namespace enc::app {

// The options of all subjects; they must live as long as the parser.
struct CalibrateWords {
  TrackerOptions tracker;
  TipOptions tip;
  CameraOptions camera;
  RigOptions rig;
  StereoOptions stereo;
  SkinOptions skin;
};

// code: receives the exit code of the subcommand that runs.
void add_calibrate(CLI::App& app, CalibrateWords& words, int& code);

// words: the words after `calibrate`. Throws Error if they do not begin with a subject. The earlier command
// was `calibrate WHAT`, without subjects. The message names the command that replaces it.
void check_subject(const std::vector<std::string>& words);

}  // namespace enc::app
