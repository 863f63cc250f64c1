// What the command line said, one struct for each subcommand. main.cpp fills them; nothing else knows the
// parser.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/common/fit_options.h"
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
  std::optional<double> seconds;  // length; none: until the user or the probe is done
  std::string record;
  std::string frames;  // folder in which what its camera sees is kept
  std::string hand;    // record whose steered hand moves in place of the scene's own; empty: none
  bool json = false;
  bool armed = false;
  bool lockstep = false;
  bool yes = false, not_real_time = false;
  bool force = false;  // replaces a file that is there; so below
};
struct CheckOptions : SceneOptions {
  bool resolved = false;  // the scene file that stands alone, instead of the answer
  bool advise = false;    // and how fine the twin need step, for
  std::optional<double> error_N, error_um;
};
struct ViewOptions : RunOptions {  // of a window: a run
  std::string shot;                // file; empty: a window or a film
  std::string video;               // file or folder of a film; empty: a window or a picture
  std::optional<double> at;        // s; none: in the middle of the first hold; of a film: its beginning
  bool close_up = false;
  std::string through_camera;  // "raw", "removed", "augmented"; empty: the world from beside
};
struct TourOptions {
  std::string out = "tour";  // folder
  double seconds = 20.0;     // of each film
  bool force = false;
};
struct ReplayOptions {
  std::string record;
  std::string frames;  // folder of `run --frames`: vision looks at it again, too
  bool partial = false;
};
struct ExportOptions {
  std::string record;            // or a scene, whose simulated world `xml` shall be
  std::string xml;               // file; empty: a record is exported
  std::string csv;               // file; "-" or empty: standard output
  std::string mcap;              // file; empty: a table
  std::string rig;               // of a scene; empty: its own
  std::vector<std::string> set;  // likewise, "name=value"
  bool partial = false, force = false;
  bool ledger = false;  // of a record: its energy ledger, and not its ticks
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

// main(): the words of the command line to an exit code.
int command_line(int argc, char** argv);

int run(const RunOptions& options);
int check(const CheckOptions& options);
int replay(const ReplayOptions& options);
int export_record(const ExportOptions& options);
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
