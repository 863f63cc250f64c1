// A vendor's shared library, loaded at run time: the build needs no SDK, and without the library everything
// else runs.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

namespace enc::arm {

// The library that a driver needs, and the words for a user who lacks it.
struct LibraryRequest {
  std::vector<std::string> files;  // "libHD.so", "libHD.so.3.0": names to try, in this order
  std::string chosen;              // from the rig file: a file, or kFakeLibrary; empty: `files`
  std::string key;                 // "driver.phantom.library"
  std::string product;             // "OpenHaptics 3.4 and the device's driver, of 3D Systems"
};

// Value of `chosen` for the stand-in that is built with the driver: the folder `fakes` beside the modules.
inline constexpr const char* kFakeLibrary = "fake";

class Library {
 public:
  // Throws Error (kind device) with the loader's reason and the remedy. The library stays loaded until the
  // process ends, because vendors' libraries do not survive to be loaded again.
  explicit Library(const LibraryRequest& request);

  [[nodiscard]] const std::string& file() const { return file_; }
  // Sets `function` to the symbol; throws Error (kind device) if the library lacks it.
  template <class Function>
  void find(const char* name, Function*& function) const {
    static_assert(std::is_function_v<Function>);
    // dlsym() returns functions as data pointers, and POSIX makes that conversion valid.
    function = reinterpret_cast<Function*>(symbol(name));
  }

 private:
  [[nodiscard]] void* symbol(const char* name) const;  // never null

  LibraryRequest request_;
  std::string file_;
  void* handle_ = nullptr;
};

}  // namespace enc::arm
