// `encounter calibrate SUBJECT`: one file for each subject, with its options and its help.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/common/calibrate_options.h"

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

void add_tracker(CLI::App& calibrate, TrackerOptions& options, int& code);
void add_tip(CLI::App& calibrate, TipOptions& options, int& code);
void add_camera(CLI::App& calibrate, CameraOptions& options, int& code);
void add_rig(CLI::App& calibrate, RigOptions& options, int& code);
void add_stereo(CLI::App& calibrate, StereoOptions& options, int& code);
void add_skin(CLI::App& calibrate, SkinOptions& options, int& code);

// words: the words after `calibrate`. Throws Error if they do not begin with a subject. `calibrate WHAT` was
// the command before it had subjects, so the message names the command that replaces it.
void check_subject(const std::vector<std::string>& words);

// Throws Error if a folder of images is expected and the path is missing or something else.
void check_folder(const std::string& folder);

}  // namespace enc::app
