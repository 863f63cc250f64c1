// Everything that defines a run, read from its files: the scene, the behaviours of its objects, the rig, the
// simulator's truth. Faults are Errors of one line that begin with the place; their key() is empty.
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
  // Defined in scene_file.cpp: inline, every including file would compile them anew.
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
  // Place of each key that a file or --set gives, under the name that --set takes.
  Places places;
  std::vector<std::string> notes;  // repairs and doubts, one line each
  std::string calibration;         // file of the camera's numbers; empty: the rig's own
  std::string measured;            // file of tracker pose and sensor weight; empty: the rig's own
};

// rig: "sim", or another file in models/rigs without ".toml", or a path; empty: the rig in the scene file, or
// the one that the scene is made for (a path from the scene's folder), or "sim". overrides:
// "object.ball.radius_mm=30", "rig.force.filter_hz=20", "truth.tracker.bias_mm=[0,0,0]".
Setup load(const std::string& scene_path, const std::string& rig,
           const std::vector<std::string>& overrides = {});

// The whole set-up as one text, including response curves. It needs no other file;
// resolved(parse_resolved(text, ...)) == text.
std::string resolved(const Setup& setup);
Setup parse_resolved(const std::string& text, const std::string& name);

// The scene with only the tables of rig and truth that it uses. The result is a scene file for load(), with
// its own behaviours, response curves, rig and truth: a run of it has the same bits. Only meshes stay in
// their own files.
std::string built_scene(const Setup& setup);
void walk_built(Visitor& visitor, Setup& setup);  // walks the written parts

// A record holds the scene as "resolved" and each mesh as "mesh:FILE", so that it needs no other file.
RecordTexts record_texts(const Setup& setup);
Setup setup_of(const RecordTexts& texts, const std::string& record_path);

// Every name that --set takes.
struct Parameter {
  std::string name, unit, value, source, confidence, meaning;
};
std::vector<Parameter> parameters(const Setup& setup);

// "file:line:column" of a key, "object.ball.radius_mm", with or without its unit. If the key is absent: the
// place of its table.
std::string place_of(const Setup& setup, std::string_view key);

// Folder of behaviours, rigs, responses, meshes and the twin's models: $ENCOUNTER_MODELS, else `models`
// beside the program or up to two folders above it. Files beside or above a scene are used only if the scene
// names them.
std::string models_dir();
ResponseSpec load_response(const std::string& path);
// The rig alone: a name in models_dir/rigs, or a path.
RigSpec load_rig(const std::string& rig);
// The rig with the simulator's truth, without a scene. overrides: as for load(), only of rig and truth.
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
// Loads the calibration that the rig's [camera] names, beside the rig's file. Throws Error if the rig also
// has its own numbers, because the choice is then ambiguous.
void fill_camera(Setup& setup);
// Loads the file that the rig's [calibration] names, beside the rig file; values from --set stay. Throws
// Error if it belongs to another rig.
void fill_measured(Setup& setup);
// Sets the truth of camera, sensor and machine ([truth.frames], [truth.hexapod.geometry] and its load, key by
// key) to the rig's values, unless the rig file or --set gives it. A real rig has no [truth], and its twin is
// placed by its calibration.
void fill_truth(Setup& setup);
void mend_normals(Setup& setup);  // scales to length 1; adds a note
void note_stops(Setup& setup);    // time constants that MuJoCo replaces by two time steps
void note_props(Setup& setup);    // objects that need another prop than the mounted one
void note_views(Setup& setup);    // objects outside of the camera's view
void note_pusher(Setup& setup);   // a real force sensor needs a real pusher
void note_unread(Setup& setup);   // names in --set that the scene does not use
void check(const Setup& setup);   // conditions on several keys; throws
// Rounds to the numbers that resolved() writes, so that a record repeats a run to the bit.
void round_to_text(Setup& setup);

}  // namespace enc::models
