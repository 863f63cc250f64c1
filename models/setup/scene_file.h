// Everything a run is made of, read from its files: the scene, what its objects' behaviours are, the rig, the
// simulator's truth. Mistakes are Errors of one line that begin with the place; their key() is empty.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/record.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"
#include "models/response_file.h"
#include "models/schema/toml_reader.h"
#include "sim/spec/twin_spec.h"

namespace enc::models {

struct Setup {
  // Made, copied and destroyed in scene_file.cpp: inline, every other file would compile that anew.
  Setup();
  ~Setup();
  Setup(const Setup&);
  Setup(Setup&&) noexcept;
  Setup& operator=(const Setup&);
  Setup& operator=(Setup&&) noexcept;

  SceneSpec scene;
  RigSpec rig;
  sim::TwinSpec twin;
  std::string scene_path, rig_path;
  Places places;                   // of each key that a file or --set gives, under the name that --set takes
  std::vector<std::string> notes;  // what was repaired, and what is doubtful, one line each
  std::string calibration;         // file that the camera's numbers are of; empty: the rig's own
  std::string measured;            // file that tracker's pose and sensor's weight are of; likewise
};

// rig: "sim", or another file in models/rigs without ".toml", or a path; empty: the one in the scene file, or
// that it is made for (a path from the scene's folder), or "sim". overrides: "object.ball.radius_mm=30",
// "rig.force.filter_hz=20", "truth.tracker.bias_mm=[0,0,0]".
Setup load(const std::string& scene_path, const std::string& rig,
           const std::vector<std::string>& overrides = {});

// The whole set-up as one text, response curves included. Needs no other file; resolved(parse_resolved(text,
// ...)) == text.
std::string resolved(const Setup& setup);
Setup parse_resolved(const std::string& text, const std::string& name);

// The scene with only what it builds: no table of rig or truth that nothing in it reads. A scene file that
// load() takes, with its own behaviours, response curves, rig and truth: a run of it has the same bits.
// Meshes alone stay in files of their own.
std::string built_scene(const Setup& setup);
void walk_built(Visitor& visitor, Setup& setup);  // what of it is written

// A record holds the scene as "resolved" and each mesh as "mesh:FILE", so that it needs no other file.
RecordTexts record_texts(const Setup& setup);
Setup setup_of(const RecordTexts& texts, const std::string& record_path);

// Every name that --set takes.
struct Parameter {
  std::string name, unit, value, source, confidence, meaning;
};
std::vector<Parameter> parameters(const Setup& setup);

// "file:line:column" of a key, "object.ball.radius_mm", with or without its unit. Where it is absent: of what
// contains it.
std::string place_of(const Setup& setup, std::string_view key);

// Where behaviours, rigs, responses, meshes and the twin's models are: $ENCOUNTER_MODELS, else `models`
// beside the program or up to two folders above it. What lies beside or above a scene is used only where it
// names it.
std::string models_dir();
ResponseSpec load_response(const std::string& path);
// The rig alone: a name in models_dir/rigs, or a path.
RigSpec load_rig(const std::string& rig);
// The rig with the simulator's truth, and no scene. overrides: as for load(), of rig and truth alone.
Setup load_rig_setup(const std::string& rig, const std::vector<std::string>& overrides = {});
// The files of a folder ("scenes", "rigs", "responses") of models_dir, without ".toml", in order.
std::vector<std::string> files_in(const std::string& models_dir, const std::string& folder);

// Parts of load().
// -------------------------------------------------------------------------------------------------------
void set(Setup& setup, const std::string& override_text);  // one "name=value"
void fill_curves(Setup& setup, const std::string& models_dir);
// Finds, loads and checks the meshes of the objects: beside the scene or in models_dir/meshes, never
// elsewhere.
void fill_meshes(Setup& setup, const std::string& models_dir);
// The calibration that the rig's [camera] names, beside the rig's file. Throws Error where there are numbers
// beside it, too: which are meant?
void fill_camera(Setup& setup);
// The file that the rig's [calibration] names, beside the rig's: what --set names stays. Throws Error where
// it is of another rig.
void fill_measured(Setup& setup);
// Where neither the rig's file nor --set says what camera, sensor and machine truly are ([truth.frames],
// [truth.hexapod.geometry] and what it carries, key by key), they are what the rig believes: a real rig has
// no [truth], and its twin stands where its calibration says.
void fill_truth(Setup& setup);
void mend_normals(Setup& setup);  // to length 1; says so in the notes
void note_stops(Setup& setup);    // time constants that MuJoCo takes for two time steps
void note_props(Setup& setup);    // objects that want another prop than is mounted
void note_views(Setup& setup);    // objects that the camera does not see
void note_pusher(Setup& setup);   // that nobody simulated pushes a real force sensor
void note_unread(Setup& setup);   // what --set names and nothing in the scene reads
void check(const Setup& setup);   // what one key alone does not show; throws
void round_to_text(
    Setup& setup);  // to the numbers that resolved() shows, so that a record repeats a run to the bit

}  // namespace enc::models
