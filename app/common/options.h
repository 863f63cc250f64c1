// The options of the command line, one struct for each subcommand; app/command_line fills them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/common/module_options.h"
#include "core/base/frames.h"
#include "trial/bench_module.h"

namespace enc::app {

struct SceneOptions {
  std::string scene;
  std::string rig;               // empty: the scene's own
  std::vector<std::string> set;  // "name=value"
  std::uint64_t seed = 1;
};

struct RunOptions : SceneOptions {
  std::string pace = "free";
  std::optional<double> seconds;  // length; unset: until the user or the probe is done
  std::string record;
  std::string mcap;    // file; empty: none
  std::string live;    // [ADDRESS:]PORT for viewers; empty: none
  std::string frames;  // folder for the frames of its camera
  std::string hand;    // record whose steered hand replaces the scene's own; empty: none
  bool json = false;
  bool armed = false;
  bool lockstep = false;
  bool yes = false, not_real_time = false;
  bool force = false;  // replaces an existing file; also below
};
struct CheckOptions : SceneOptions {
  bool resolved = false;  // print the self-contained scene file instead of the answer
  bool advise = false;    // also print the time step for these errors
  std::optional<double> error_N, error_um;
};
struct ViewOptions : RunOptions {  // without a file: a run in a window
  std::string shot;                // file; empty: a window or a film
  std::string video;               // file or folder of a film; empty: a window or a picture
  std::optional<double> at;        // s; unset: the middle of the first hold; for a film: its beginning
  bool close_up = false;
  std::string through_camera;  // "raw", "removed", "augmented"; empty: the world from beside
};
struct TourOptions {
  std::string out = "tour";  // folder
  double seconds = 20.0;     // each film
  bool force = false;
};
struct LaboratoryOptions : SceneOptions {
  bool lockstep = false;            // `fake` only
  double seconds = 1.0;             // `devices` only
  std::vector<std::string> faults;  // `fake` only
};
struct ReplayOptions {
  std::string record;
  std::string frames;  // folder of `run --frames`: vision evaluates it again too
  bool partial = false;
};
struct ExportOptions {
  std::string record;            // a record, or a scene to export as `xml`
  std::string xml;               // file; empty: a record is exported
  std::string csv;               // file; "-" or empty: standard output
  std::string mcap;              // file; empty: a table
  std::string rig;               // scene only; empty: its own
  std::vector<std::string> set;  // scene only, "name=value"
  bool partial = false, force = false;
  bool ledger = false;                      // record only: export its energy balance instead of its ticks
  bool truth = false;                       // table only: with the twin's ground truth
  bool ros2 = false, uncompressed = false;  // MCAP only
};
struct PlotOptions {
  std::string record;
  std::string svg;  // file; "-": standard output
  bool partial = false, force = false;
};
struct ParamsOptions : SceneOptions {
  bool json = false;
};
using trial::BenchOptions;
struct NearestOptions {
  std::string what;  // a mesh file, or SCENE#object
  std::string points;
};
using trial::QuestionnaireOptions;
struct MeshOptions {
  std::string name, out;
  std::optional<int> fine;
  bool force = false;
};

// main(): converts the words of the command line to an exit code.
int command_line(int argc, char** argv);

int run(const RunOptions& options);
int check(const CheckOptions& options);
int fake(const LaboratoryOptions& options);
int devices(const LaboratoryOptions& options);
int replay(const ReplayOptions& options);
int export_record(const ExportOptions& options);
int plot(const PlotOptions& options);
int params(const ParamsOptions& options);
int doctor();
int scenes();
int bench(const BenchOptions& options);
int view(const ViewOptions& options);
int tour(const TourOptions& options);
int fit(const FitOptions& options);
int shadow(const ShadowOptions& options);
int nearest(const NearestOptions& options);
int mesh(const MeshOptions& options);
int questionnaire(const QuestionnaireOptions& options);

}  // namespace enc::app
