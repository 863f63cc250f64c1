// A file name in a new folder that is ours alone; both go when this does.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/base/error.h"

namespace enc::bench {

class ScratchFile {
 public:
  explicit ScratchFile(const char* name) {
    std::string folder = (std::filesystem::temp_directory_path() / "encounter_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw Error(folder + ": this folder cannot be made; set TMPDIR");
    folder_ = folder;
    path_ = (folder_ / name).string();
  }
  ~ScratchFile() {
    std::error_code none;
    std::filesystem::remove_all(folder_, none);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

}  // namespace enc::bench
