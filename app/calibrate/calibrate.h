// `encounter calibrate SUBJECT`: a file for each subject with its options and its help.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/common/calibrate_options.h"

namespace enc::app {

// What the command line said; lives as long as the parser.
struct CalibrateWords {
  TrackerOptions tracker;
  TipOptions tip;
  CameraOptions camera;
  RigOptions rig;
  StereoOptions stereo;
  SkinOptions skin;
};

// code: gets the exit code of the subcommand that runs.
void add_calibrate(CLI::App& app, CalibrateWords& words, int& code);

void add_tracker(CLI::App& calibrate, TrackerOptions& options, int& code);
void add_tip(CLI::App& calibrate, TipOptions& options, int& code);
void add_camera(CLI::App& calibrate, CameraOptions& options, int& code);
void add_rig(CLI::App& calibrate, RigOptions& options, int& code);
void add_stereo(CLI::App& calibrate, StereoOptions& options, int& code);
void add_skin(CLI::App& calibrate, SkinOptions& options, int& code);

// words: behind `calibrate`. Throws Error where they do not begin with a subject: `calibrate WHAT` was the
// command until it had subjects, and the message names the command that took its place.
void check_subject(const std::vector<std::string>& words);

// Throws Error where a folder of images is expected and something else is there, or nothing.
void check_folder(const std::string& folder);

}  // namespace enc::app
