#include "models/setup/scene_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/roles.h"
#include "models/directions/directions.h"
#include "models/files.h"
#include "models/schema/schema_walk.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/driver_table.h"
#include "models/setup/scene_check.h"
#include "models/setup/scene_names.h"
#include "models/setup/scene_sizes.h"

namespace enc::models {

Setup::Setup() = default;
Setup::~Setup() = default;
Setup::Setup(const Setup&) = default;
Setup::Setup(Setup&&) noexcept = default;
Setup& Setup::operator=(const Setup&) = default;
Setup& Setup::operator=(Setup&&) noexcept = default;
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongest = 16U << 20U;  // bytes: a larger file is no text of ours

// `what`: "scene"; `names`: existing files.
std::string text_of_file(const std::string& path, const std::string& what,
                         const std::vector<std::string>& names) {
  std::string why;
  std::string text = read_file(path, kLongest, why);
  if (why.empty()) return text;
  throw Error(fmt::format("{}:1:1: cannot read this {}: {}; expected a TOML file; {}", path, what, why,
                          names.empty() ? "set ENCOUNTER_MODELS to the folder that has it"
                                        : advice(fs::path(path).stem().string(), names)));
}

bool has_behaviours(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "behaviours.toml", ignored);
}

void read_scene(Setup& setup) {
  std::string why;
  const std::string text = read_file(setup.scene_path, kLongest, why);
  if (!why.empty()) refuse_scene(setup.scene_path, why);
  setup.places = read_toml(text, setup.scene_path, [&](Visitor& visitor) {
    describe(visitor, setup.scene);
    // A file that stands alone, as `encounter check --resolved` prints it, also has its response curves.
    const bool alone = table_if(visitor, "rig", false, [&] { describe(visitor, setup.rig); });
    describe_behaviours(visitor, setup.scene.behaviours, alone);
    if (alone) table(visitor, "truth", [&] { describe(visitor, setup.twin); });
  });
}

bool has_rig(const Setup& setup) { return setup.places.contains("rig"); }

// A role whose table is missing has no driver; the struct's default is for rigs made in code.
void clear_absent_drivers(Setup& setup) {
  each_device([&](const auto& role) {
    if (!setup.places.contains(fmt::format("rig.{}", role.table))) (setup.rig.*role.rig).driver = "none";
  });
}

// True for a path; otherwise it is a name in models/rigs.
bool is_path(const std::string& rig) { return rig.find('/') != std::string::npos || rig.ends_with(".toml"); }

void read_rig(Setup& setup, const std::string& rig) {
  setup.rig = RigSpec{};
  setup.twin = sim::TwinSpec{};
  std::erase_if(setup.places,
                [](const auto& p) { return p.first.starts_with("rig") || p.first.starts_with("truth"); });
  const std::string models = models_dir();
  setup.rig_path =
      is_path(rig) ? rig : (fs::path(models) / "rigs" / (rig + ".toml")).lexically_normal().string();
  const std::string text = text_of_file(setup.rig_path, "rig", files_in(models, "rigs"));
  const Places places = read_toml(text, setup.rig_path, [&](Visitor& visitor) {
    describe(visitor, setup.rig);
    table(visitor, "truth", [&] { describe(visitor, setup.twin); });
  });
  for (const auto& [key, place] : places)
    setup.places[key.starts_with("truth") ? key : fmt::format("rig.{}", key)] = place;
  clear_absent_drivers(setup);
  refuse_driverless(setup);
}

// A path in a scene starts at the scene's folder, wherever the program was started.
std::string rig_of_scene(const Setup& setup) {
  const std::string& rig = setup.scene.rig;
  if (rig.empty()) return "sim";
  if (!is_path(rig)) return rig;
  const fs::path file = (fs::path(setup.scene_path).parent_path() / rig).lexically_normal();
  return is_path(file.string()) ? file.string() : "./" + file.string();
}

void read_rig_of(Setup& setup, const std::string& rig) {
  if (!rig.empty()) return read_rig(setup, rig);
  if (!has_rig(setup)) return read_rig(setup, rig_of_scene(setup));
  setup.rig_path = setup.scene_path;
  clear_absent_drivers(setup);
}

// The entries of models/behaviours.toml, and their places.
struct BehaviourList {
  std::string path;
  std::vector<BehaviourSpec> all;
  Places places;
};

BehaviourList shipped_behaviours() {
  BehaviourList list;
  list.path = (fs::path(models_dir()) / "behaviours.toml").lexically_normal().string();
  const std::string text = text_of_file(list.path, "list of behaviours", {});
  list.places =
      read_toml(text, list.path, [&](Visitor& visitor) { describe_behaviours(visitor, list.all, false); });
  return list;
}

const BehaviourSpec* named(const std::vector<BehaviourSpec>& behaviours, const std::string& name) {
  const auto found = std::find_if(behaviours.begin(), behaviours.end(),
                                  [&](const BehaviourSpec& b) { return b.name == name; });
  return found == behaviours.end() ? nullptr : &*found;
}

// One name means one behaviour in every scene.
void refuse_second_meaning(const Setup& setup, const BehaviourList& shipped) {
  for (const BehaviourSpec& own : setup.scene.behaviours) {
    if (named(shipped.all, own.name) == nullptr) continue;
    const std::string key = fmt::format("behaviour.{}.name", own.name);
    throw Error(
        fmt::format("{}: behaviour {} has the name of an entry of {} ({}); expected a name of its own; "
                    "rename it and the objects that name it",
                    place_of(setup, key), quoted(own.name), shipped.path, shipped.places.at(key)));
  }
}

// Objects use behaviours of their scene file and of models/behaviours.toml. `alone`: for a file that holds a
// rig, as `check --resolved` prints it, with the behaviours that were in use.
void read_behaviours(Setup& setup, bool alone) {
  std::vector<BehaviourSpec>& used = setup.scene.behaviours;
  // check() reports an empty one.
  const auto is_there = [&](const ObjectSpec& o) {
    return o.behaviour.empty() || named(used, o.behaviour) != nullptr;
  };
  if (has_rig(setup) && std::all_of(setup.scene.objects.begin(), setup.scene.objects.end(), is_there)) return;
  const BehaviourList shipped = shipped_behaviours();
  if (!alone) refuse_second_meaning(setup, shipped);
  std::vector<std::string> names;
  names.reserve(used.size() + shipped.all.size());
  for (const BehaviourSpec& b : used) names.push_back(b.name);
  for (const BehaviourSpec& b : shipped.all) names.push_back(b.name);
  for (const ObjectSpec& object : setup.scene.objects) {
    if (is_there(object)) continue;
    const BehaviourSpec* found = named(shipped.all, object.behaviour);
    if (found == nullptr) {
      throw Error(fmt::format(
          "{}: there is no behaviour {}; expected an entry of {} or a [[behaviour]] of this scene; {}",
          place_of(setup, fmt::format("object.{}.behaviour", object.name)), quoted(object.behaviour),
          shipped.path, advice(object.behaviour, names)));
    }
    used.push_back(*found);
  }
  setup.places.insert(shipped.places.begin(),
                      shipped.places.end());  // the scene file's entries are already present
}

}  // namespace

SceneSpec read_scene_alone(const std::string& path) {
  Setup setup;
  setup.scene_path = path;
  read_scene(setup);
  return setup.scene;
}

std::vector<std::string> files_in(const std::string& models_dir, const std::string& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fs::path(models_dir) / folder, none)) {
    if (entry.path().extension() == ".toml" && entry.is_regular_file(none))
      names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string models_dir() {
  if (const char* set = std::getenv("ENCOUNTER_MODELS"); set != nullptr && *set != '\0') return set;
  std::error_code none;
  const fs::path beside = fs::read_symlink("/proc/self/exe", none).parent_path();
  fs::path models = beside / "models";
  // An installed program is in DIR/bin, a built one in build/release.
  for (const fs::path& at : {beside.parent_path(), beside.parent_path().parent_path()})
    if (!has_behaviours(models) && has_behaviours(at / "models")) models = at / "models";
  // As short as a person would type it.
  const fs::path from_here = models.lexically_relative(fs::current_path(none));
  return (from_here.empty() || *from_here.begin() == ".." ? models : from_here).string();
}

namespace {

ResponseFile read_response(const std::string& path, Places& places) {
  const std::string folder = fs::path(path).parent_path().string();
  ResponseFile file;
  places = read_toml(text_of_file(path, "response", files_in(folder, "")), path,
                     [&](Visitor& visitor) { describe(visitor, file); });
  return file;
}

void check_form(const Setup& setup, const std::string& models_dir) {
  if (!setup.scene.questionnaire) return;
  const std::string& form = setup.scene.questionnaire->form;
  const std::vector<std::string> names = files_in(models_dir, "questionnaires");
  if (std::find(names.begin(), names.end(), form) != names.end()) return;
  throw Error(fmt::format("{}: there is no questionnaire {}; expected a file in {}; {}",
                          place_of(setup, "questionnaire.form"), quoted(form),
                          (fs::path(models_dir) / "questionnaires").lexically_normal().string(),
                          advice(form, names)));
}

}  // namespace

ResponseSpec load_response(const std::string& path) {
  Places places;
  return read_response(path, places).response;
}

namespace {

// Reads a file of models/directions and mixes it for the press that [user] plans.
ResponseSpec mixed_response(const Setup& setup, const BehaviourSpec& b, const std::string& path,
                            const std::string& models_dir) {
  const std::string place = place_of(setup, fmt::format("behaviour.{}.response", b.name));
  const SceneSpec& scene = setup.scene;
  if (!scene.user || !presses_sphere(scene, b.name))
    throw Error(
        fmt::format("{}: behaviour {} depends on the direction of the press; expected a [user] that presses "
                    "a sphere with it; "
                    "name the sphere in [user], or choose a behaviour with one response",
                    place, quoted(b.name)));
  const std::vector<Direction> directions = load_directions(path);
  std::vector<ResponseSpec> parts;
  parts.reserve(directions.size());
  for (const Direction& d : directions)
    parts.push_back(load_response((fs::path(models_dir) / "responses" / (d.response + ".toml")).string()));
  try {
    return mixed(parts, weights(directions, planned_way(scene)));
  } catch (const Error& e) {
    throw Error(fmt::format(
        "{}:1:1: {}; expected responses with one limit and the same stops; fit them alike", path, e.what()));
  }
}

}  // namespace

namespace {

// A file that stands alone has the curves of its responses, unless --set names another response.
bool has_curves(const Setup& setup, const BehaviourSpec& b) {
  const auto response = setup.places.find(fmt::format("behaviour.{}.response", b.name));
  return setup.places.contains(fmt::format("behaviour.{}.curves", b.name)) &&
         (response == setup.places.end() || !response->second.starts_with("--set"));
}

}  // namespace

void fill_curves(Setup& setup, const std::string& models_dir) {
  for (BehaviourSpec& b : setup.scene.behaviours) {
    if (b.interaction.kind != Interaction::press) continue;  // rendered by its stiffness alone
    if (b.response.empty()) {
      b.curves = {{b.stiffness, 0, 0, 0}, {b.stiffness, 0, 0, 0}, b.limit};
      continue;
    }
    if (has_curves(setup, b)) continue;
    if (b.response.find('/') != std::string::npos)  // a scene may name no file outside of models/
      throw Error(fmt::format("{}: 'response' is {}; expected the name of a file in {}, without a path; {}",
                              place_of(setup, fmt::format("behaviour.{}.response", b.name)),
                              models::quoted(b.response),
                              (fs::path(models_dir) / "responses").lexically_normal().string(),
                              advice(b.response, files_in(models_dir, "responses"))));
    std::error_code none;
    const fs::path directions = fs::path(models_dir) / "directions" / (b.response + ".toml");
    if (fs::exists(directions, none)) {
      b.curves = mixed_response(setup, b, directions.lexically_normal().string(), models_dir);
      continue;
    }
    const fs::path path = (fs::path(models_dir) / "responses" / (b.response + ".toml")).lexically_normal();
    if (!fs::exists(path, none)) {
      throw Error(fmt::format("{}: there is no response file {}; expected a file in {}; {}",
                              place_of(setup, fmt::format("behaviour.{}.response", b.name)),
                              quoted(path.string()), path.parent_path().string(),
                              advice(b.response, files_in(models_dir, "responses"))));
    }
    Places places;
    b.curves = read_response(path.string(), places).response;
    // A fault of a curve is a fault of the response file.
    for (const auto& [key, place] : places)
      setup.places[fmt::format("behaviour.{}.curves.{}", b.name, key)] = place;
  }
}

RigSpec load_rig(const std::string& rig) { return load_rig_setup(rig).rig; }

Setup load_rig_setup(const std::string& rig, const std::vector<std::string>& overrides) {
  Setup setup;
  read_rig(setup, rig);
  for (const std::string& text : overrides) set(setup, text);
  settle_drivers(setup);
  fill_truth(setup);
  return setup;
}

std::string place_of(const Setup& setup, std::string_view key) {
  for (std::string_view at = key; !at.empty();) {
    if (const auto exact = setup.places.find(at); exact != setup.places.end()) return exact->second;
    for (auto i = setup.places.lower_bound(at); i != setup.places.end() && i->first.starts_with(at); ++i) {
      if (stem_of(i->first) == at) return i->second;
    }
    const auto dot = at.rfind('.');
    at = at.substr(0, dot == std::string_view::npos ? 0 : dot);
  }
  const bool in_rig = key.starts_with("rig.") || key.starts_with("truth.");
  return fmt::format("{}:1:1", in_rig ? setup.rig_path : setup.scene_path);
}

namespace {

// Checks also if --rig names another rig: a wrong scene is wrong everywhere.
void check_made_for(const Setup& setup) {
  const std::string& rig = setup.scene.rig;
  const std::vector<std::string> names = files_in(models_dir(), "rigs");
  if (rig.empty() || is_path(rig) || std::find(names.begin(), names.end(), rig) != names.end()) return;
  fail(setup, "made_for",
       fmt::format("there is no rig {}; expected a file in {}; {}", quoted(rig),
                   (fs::path(models_dir()) / "rigs").lexically_normal().string(), advice(rig, names)));
}

}  // namespace

Setup load(const std::string& scene_path, const std::string& rig, const std::vector<std::string>& overrides) {
  Setup setup;
  setup.scene_path = scene_file_of(scene_path);
  read_scene(setup);
  check_made_for(setup);
  const bool alone = has_rig(setup);
  read_rig_of(setup, rig);
  // Behaviours come second, because --set may name another one for an object.
  const auto of_behaviour = [](const std::string& text) { return text.starts_with("behaviour."); };
  for (const std::string& text : overrides) {
    if (!of_behaviour(text)) set(setup, text);
  }
  settle_drivers(setup);
  read_behaviours(setup, alone);
  for (const std::string& text : overrides) {
    if (of_behaviour(text)) set(setup, text);
  }
  fill_camera(setup);
  fill_measured(setup);
  fill_truth(setup);
  mend_normals(setup);
  check(setup);
  note_stops(setup);
  note_props(setup);
  note_views(setup);
  note_pusher(setup);
  note_unread(setup);
  const std::string models = models_dir();
  fill_curves(setup, models);
  fill_meshes(setup, models);
  note_sizes(setup);
  check_form(setup, models);
  check(setup);
  round_to_text(setup);
  return setup;
}

}  // namespace enc::models
