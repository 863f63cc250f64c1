// Shipped scenes by name: "tennis_ball" is models/scenes/tennis_ball.toml, "camera/wall" is one folder
// deeper.
#pragma once

#include <string>
#include <vector>

#include "core/spec/scene_spec.h"

namespace enc::models {

// The names of all scenes in a models folder, in order: those of subfolders last, as "FOLDER/NAME".
[[nodiscard]] std::vector<std::string> scene_names(const std::string& models_dir);
// The file that a word names: an existing file, else the shipped scene of that name, else the word itself.
[[nodiscard]] std::string scene_file_of(const std::string& word);
// Throws Error: the scene cannot be read for the reason `why`; lists the existing scenes.
[[noreturn]] void refuse_scene(const std::string& path, const std::string& why);

// The content of a scene file alone: without rig, behaviours of the database, overrides and checks of the
// whole.
[[nodiscard]] SceneSpec read_scene_alone(const std::string& path);

// A shipped scene in the list of `encounter scenes`.
struct ListedScene {
  std::string name, title, rig;  // rig: that it is made for; "sim" if it names no rig
  std::string mistake;           // reason why the file cannot be read, else empty
};
[[nodiscard]] std::vector<ListedScene> listed_scenes(const std::string& models_dir);

}  // namespace enc::models
