// What inputs are made of: files of the repository, words of TOML, a folder like models/ in memory.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::fuzz {

// Of the repository. "models/scenes/*.toml": all of them, in order; longer than `most` bytes are left out.
[[nodiscard]] std::string file_text(const std::string& name);
[[nodiscard]] std::vector<std::string> file_texts(const std::string& folder, const std::string& ending,
                                                  std::size_t most = 1U << 16U);

// A scene whose object is the mesh `small.obj`, and that file.
[[nodiscard]] std::string mesh_scene();
[[nodiscard]] std::string small_mesh();
// That scene, loaded.
[[nodiscard]] models::Setup mesh_setup();

// What commands do with what they have read: `record` is run again and exported with its scene. Throws Error
// where the scene cannot be prepared.
void use(const models::Setup& setup, RecordReader& record);

[[nodiscard]] const std::vector<std::string>& toml_tokens();

// A folder of its own, in memory where there is a file system for that; gone with the program.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  // Writes a file and gives its path. What was there, also a link, is replaced.
  std::string write(const std::string& name, const std::string& bytes) const;
  [[nodiscard]] std::string path(const std::string& name) const { return (root_ / name).string(); }

 private:
  std::filesystem::path root_;
};

// One with links to all of models/, in folders of its own; and the small mesh.
struct ModelsFolder : Folder {
  ModelsFolder();
};

}  // namespace enc::fuzz
