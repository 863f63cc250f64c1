#include "hw_drivers/arm/library.h"

#include <cstdlib>
#include <filesystem>

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::arm {
namespace {

namespace fs = std::filesystem;

// Folders that may hold the fakes: beside this code's module, below the program's folder, and below the
// folder of ENCOUNTER_MODULES.
std::vector<fs::path> fake_folders() {
  std::vector<fs::path> all;
  if (const char* modules = std::getenv("ENCOUNTER_MODULES")) all.emplace_back(fs::path(modules) / "fakes");
  Dl_info here{};
  if (dladdr(reinterpret_cast<void*>(&fake_folders), &here) != 0 && here.dli_fname != nullptr) {
    const fs::path folder = fs::absolute(here.dli_fname).parent_path();
    all.push_back(folder / "fakes");
    all.push_back(folder / "modules" / "fakes");
  }
  return all;
}

std::vector<std::string> candidates(const LibraryRequest& request) {
  if (request.chosen.empty()) return request.files;
  if (request.chosen != kFakeLibrary) return {request.chosen};
  for (const fs::path& folder : fake_folders())
    if (const fs::path file = folder / request.files.front(); fs::exists(file)) return {file.string()};
  throw Error(fmt::format("there is no fake {} beside the modules; build it (cmake --build --preset release "
                          "--target program), or set {} to the vendor's library",
                          request.files.front(), request.key),
              {}, ErrorKind::device);
}

}  // namespace

Library::Library(const LibraryRequest& request) : request_(request) {
  std::string why;
  for (const std::string& file : candidates(request)) {
    // Global, because the vendor's library loads parts that look for its symbols.
    handle_ = dlopen(file.c_str(), RTLD_LAZY | RTLD_GLOBAL);
    file_ = file;
    if (handle_ != nullptr) return;
    const char* reason = dlerror();
    const std::string said = reason != nullptr ? reason : file;
    // A file that is there and does not load says more than one that is absent.
    if (why.empty() || !said.starts_with(file + ": cannot open shared object file")) why = said;
  }
  throw Error(fmt::format("{}; expected {}; install it, or set {} to its file, to \"{}\" for the fake", why,
                          request.product, request.key, kFakeLibrary),
              {}, ErrorKind::device);
}

void* Library::symbol(const char* name) const {
  if (void* found = dlsym(handle_, name); found != nullptr) return found;
  throw Error(fmt::format("{} lacks {}: it is too old, or another library; expected {}; install that, or set "
                          "{} to its file",
                          file_, name, request_.product, request_.key),
              {}, ErrorKind::device);
}

}  // namespace enc::arm
