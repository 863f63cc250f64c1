#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"
#include "models/setup/unread.h"

namespace enc::bench {
namespace {

using Names = std::vector<std::string>;

// The first declaration creates the map, because the order of initialisation between files is not specified.
std::map<std::string, ReadParts, std::less<>>& declared() {
  static std::map<std::string, ReadParts, std::less<>> all;
  return all;
}

const ReadParts& parts_of(std::string_view benchmark) {
  static const ReadParts kPlain;
  const auto at = declared().find(benchmark);
  return at == declared().end() ? kPlain : at->second;
}

std::string scene_path(const std::string& models, const std::string& scene) {
  return models + "/scenes/" + scene + ".toml";
}
std::string rig_path(const std::string& models, const std::string& rig) {
  return models + "/rigs/" + rig + ".toml";
}

std::string name_of(const std::string& setting) { return setting.substr(0, setting.find('=')); }

bool is_in(std::string_view name, const Names& tables) {
  return std::any_of(tables.begin(), tables.end(),
                     [&](const std::string& table) { return models::stands_in(name, table); });
}

// Names of a scene or rig, and the tables that a run of it does not read.
struct SceneNames {
  std::set<std::string, std::less<>> all;
  Names unread;
};
const SceneNames& names_of(const std::string& models, const std::string& scene) {
  static std::mutex turn;
  static std::map<std::string, SceneNames> known;
  const std::lock_guard lock(turn);
  const std::string path = scene_path(models, scene);
  const auto [at, added] = known.try_emplace(path);
  if (!added) return at->second;
  const bool is_scene = std::filesystem::exists(path);
  const models::Setup setup =
      is_scene ? models::load(path, {}) : models::load_rig_setup(rig_path(models, scene));
  for (const models::Parameter& p : models::parameters(setup)) at->second.all.insert(p.name);
  if (is_scene) at->second.unread = models::unread_tables(setup);
  return at->second;
}

std::size_t common_tokens(const std::string& a, const std::string& b) {
  std::set<std::string> of_a;
  for (std::size_t i = 0, end = 0; end != a.npos; i = end + 1)
    of_a.insert(a.substr(i, (end = a.find('.', i)) - i));
  std::size_t common = 0;
  for (std::size_t i = 0, end = 0; end != b.npos; i = end + 1)
    common += of_a.count(b.substr(i, (end = b.find('.', i)) - i));
  return common;
}

// If no name reads like a misspelling: the one that shares most of its tokens.
std::string closest(const std::string& name, const Names& names) {
  const std::string near = models::nearest_name(name, names);
  if (!near.empty() || names.empty()) return near;
  return *std::max_element(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return common_tokens(a, name) < common_tokens(b, name);
  });
}

}  // namespace

Reads::Reads(const char* benchmark, ReadParts parts) { declared()[benchmark] = std::move(parts); }

Names scenes_read(const Benchmark& benchmark, const std::string& models) {
  Names scenes = parts_of(benchmark.name).scenes;
  if (scenes.empty()) scenes = {benchmark.scene};
  if (scenes == Names{"*"}) scenes = models::scene_names(models);
  std::erase_if(scenes, [&](const std::string& scene) {
    return !std::filesystem::exists(scene_path(models, scene)) &&
           !std::filesystem::exists(rig_path(models, scene));
  });
  return scenes;
}

Names names_read(const Benchmark& benchmark, const std::string& models) {
  const ReadParts& parts = parts_of(benchmark.name);
  std::set<std::string> names;
  for (const std::string& scene : scenes_read(benchmark, models)) {
    const SceneNames& its = names_of(models, scene);
    for (const std::string& name : its.all)
      if (is_in(name, parts.also) ||
          (parts.only.empty() ? !is_in(name, its.unread) : is_in(name, parts.only)))
        names.insert(name);
  }
  return {names.begin(), names.end()};
}

void check_settings(const Benchmark& benchmark, const std::string& models, const Names& set) {
  const Names names = names_read(benchmark, models);
  for (const std::string& setting : set) {
    const std::string name = name_of(setting);
    if (setting.find('=') == std::string::npos || std::binary_search(names.begin(), names.end(), name))
      continue;
    throw Error(
        fmt::format("--set {}: {} reads no parameter {}; expected one that it reads; the closest is '{}'",
                    models::printable(setting), benchmark.name, models::quoted(name), closest(name, names)));
  }
}

Names settings_for(const BenchContext& context, const std::string& scene, const Names& held) {
  const Names& declared_scenes = parts_of(context.benchmark).scenes;
  const bool all = declared_scenes == Names{"*"};
  if (!declared_scenes.empty() && !all &&
      std::find(declared_scenes.begin(), declared_scenes.end(), scene) == declared_scenes.end())
    throw std::logic_error(fmt::format("benchmark {} loads the scene {}, which its Reads does not name",
                                       context.benchmark, scene));
  Names used;
  for (const std::string& setting : context.set.all()) {
    const std::string name = name_of(setting);
    if ((all || declared_scenes.size() > 1) && !names_of(context.models, scene).all.contains(name)) continue;
    used.push_back(setting);
    const bool overridden = std::any_of(held.begin(), held.end(),
                                        [&](const std::string& other) { return name_of(other) == name; });
    if (!overridden) context.set.use(setting);
  }
  return used;
}

void UserSettings::use(const std::string& one) const {
  const std::lock_guard lock(record_->turn);
  record_->used.insert(one);
}

std::vector<std::string> UserSettings::unused() const {
  const std::lock_guard lock(record_->turn);
  std::vector<std::string> names;
  for (const std::string& one : all_)
    if (!record_->used.contains(one)) names.push_back(one);
  return names;
}

}  // namespace enc::bench
