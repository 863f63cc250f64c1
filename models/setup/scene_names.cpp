#include "models/setup/scene_names.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;

fs::path file_in(const std::string& models_dir, const std::string& name) {
  return (fs::path(models_dir) / "scenes" / (name + ".toml")).lexically_normal();
}

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

}  // namespace

std::vector<std::string> scene_names(const std::string& models_dir) {
  std::vector<std::string> names = files_in(models_dir, "scenes");
  std::vector<std::string> folders;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fs::path(models_dir) / "scenes", none))
    if (entry.is_directory(none)) folders.push_back(entry.path().filename().string());
  std::sort(folders.begin(), folders.end());
  for (const std::string& folder : folders)
    for (const std::string& name : files_in(models_dir, "scenes/" + folder))
      names.push_back(folder + "/" + name);
  return names;
}

std::string scene_file_of(const std::string& word) {
  if (word.empty() || word.ends_with(".toml") || is_file(word)) return word;
  const std::string models = models_dir();
  const std::vector<std::string> names = scene_names(models);
  return std::find(names.begin(), names.end(), word) == names.end() ? word : file_in(models, word).string();
}

void refuse_scene(const std::string& path, const std::string& why) {
  const std::string models = models_dir();
  std::vector<std::string> names = scene_names(models);
  if (!path.ends_with(".toml"))
    throw Error(fmt::format(
        "{}:1:1: cannot read this scene: {}; expected a TOML file or the name of a shipped scene; {}", path,
        why, advice(path, names)));
  const std::string near = nearest_name(fs::path(path).stem().string(), names);
  for (std::string& name : names) name = file_in(models, name).string();
  throw Error(fmt::format("{}:1:1: cannot read this scene: {}; expected a TOML file; {}", path, why,
                          near.empty()
                              ? advice("", names)
                              : fmt::format("did you mean {}?", quoted(file_in(models, near).string()))));
}

std::vector<ListedScene> listed_scenes(const std::string& models_dir) {
  std::vector<ListedScene> listed;
  for (const std::string& name : scene_names(models_dir)) {
    const std::string path = file_in(models_dir, name).string();
    ListedScene& scene = listed.emplace_back();
    scene.name = name;
    try {
      const SceneSpec spec = read_scene_alone(path);
      scene.title = spec.title;
      scene.rig = spec.rig.empty() ? "sim" : spec.rig;
    } catch (const Error& e) {
      scene.mistake = e.what();
    }
  }
  return listed;
}

}  // namespace enc::models
