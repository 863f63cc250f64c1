// Sources of inputs: files of the repository, words of TOML, a folder like models/ in memory.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::fuzz {

// Files of the repository. "models/scenes/*.toml" gives all of them, in order; files longer than `most` bytes
// are left out.
[[nodiscard]] std::string file_text(const std::string& name);
[[nodiscard]] std::vector<std::string> file_texts(const std::string& folder, const std::string& ending,
                                                  std::size_t most = 1U << 16U);

// A scene whose object is the mesh `small.obj`, and that file.
[[nodiscard]] std::string mesh_scene();
[[nodiscard]] std::string small_mesh();
// The loaded mesh scene.
[[nodiscard]] models::Setup mesh_setup();

// Uses the data as commands do: runs `record` again and exports it with its scene. Throws Error if the scene
// cannot be prepared.
void use(const models::Setup& setup, RecordReader& record);

[[nodiscard]] const std::vector<std::string>& toml_tokens();
[[nodiscard]] const std::vector<std::string>& jpeg_tokens();  // markers

// A temporary folder, in memory if there is a file system for that; removed with the program.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  // Writes a file and returns its path. It replaces an existing file or link.
  std::string write(const std::string& name, const std::string& bytes) const;
  [[nodiscard]] std::string path(const std::string& name) const { return (root_ / name).string(); }

 private:
  std::filesystem::path root_;
};

// A folder with links to all of models/, in subfolders; and the small mesh.
struct ModelsFolder : Folder {
  ModelsFolder();
};

}  // namespace enc::fuzz
