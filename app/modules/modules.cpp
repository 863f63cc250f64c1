#include "app/modules/modules.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/modules/driver_names.h"
#include "app/modules/module_file.h"
#include "core/base/error.h"
#include "encounter_version.h"
#include "trial/assemble/assemble.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPrefix = "encounter_";
constexpr std::string_view kSuffix = ".so";

[[noreturn]] void refuse(const std::string& file, const std::string& why, const std::string& advice) {
  const std::vector<std::string> there = modules_there();
  const std::string list = there.empty() ? "none" : fmt::format("{}", fmt::join(there, ", "));
  throw Error(fmt::format("{}: {}; {} (modules there: {})", file, why, advice, list), {}, ErrorKind::device);
}

// The linker's words begin with the file, which stands in front already.
std::string loader_words(const std::string& file) {
  const char* words = dlerror();
  std::string text = words != nullptr ? words : "unknown reason";
  if (text.starts_with(file + ": ")) text.erase(0, file.size() + 2);
  return text;
}

// A folder of one's own holds drivers; what belongs to the program is found beside it all the same.
std::string beside_program() {
  std::error_code none;
  return (fs::read_symlink("/proc/self/exe", none).parent_path() / "modules").string();
}
bool ours(const std::string& name) {
  constexpr std::array<std::string_view, 6> kOurs{"bench", "calibration", "camera", "fit", "peers", "vision"};
  return std::find(kOurs.begin(), kOurs.end(), name) != kOurs.end();
}
std::string file_of(const std::string& name) {
  const auto in = [&](const std::string& folder) {
    return fmt::format("{}/{}{}{}", folder, kPrefix, name, kSuffix);
  };
  std::error_code none;
  return ours(name) && !fs::exists(in(modules_dir()), none) ? in(beside_program()) : in(modules_dir());
}

const char* const kRebuild = "build program and modules together: cmake --build --preset release";

}  // namespace

std::string modules_dir() {
  const char* given = std::getenv("ENCOUNTER_MODULES");
  if (given != nullptr && *given != '\0') return given;
  return beside_program();
}

std::string module_name(const std::string& file) {
  if (file.size() <= kPrefix.size() + kSuffix.size() || !file.starts_with(kPrefix) ||
      !file.ends_with(kSuffix))
    return {};
  return file.substr(kPrefix.size(), file.size() - kPrefix.size() - kSuffix.size());
}

std::vector<std::string> modules_there() {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(modules_dir(), none)) {
    if (const std::string name = module_name(entry.path().filename().string()); !name.empty())
      names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool module_there(const std::string& name) {
  std::error_code none;
  return fs::exists(file_of(name), none);
}

std::vector<std::string> drivers_there() {
  std::vector<std::string> names = modules_there();
  std::erase_if(names,
                [](const std::string& name) { return ours(name) || name == "view" || name == "window"; });
  return names;
}

SceneOptions with_scene(const SceneOptions& options) {
  SceneOptions with = options;
  if (with.scene.empty()) with.scene = models::models_dir() + "/scenes/tennis_ball.toml";
  return with;
}

models::Setup load_setup(const SceneOptions& options) {
  models::Setup setup = models::load(options.scene, options.rig, options.set);
  check_driver_names(setup);
  trial::read_driver_tables(
      setup, [](const std::string& name) { return module_there(name) ? &load_module(name) : nullptr; });
  return setup;
}

const ModuleInfo& load_module(const std::string& name) {
  const std::string file = file_of(name);
  if (name.find('/') != std::string::npos)
    refuse(file, "a module's name has no '/'", "give the name alone, such as \"sample\"");
  std::error_code none;
  if (!fs::exists(file, none))
    refuse(file, fmt::format("there is no module '{}'", name),
           "build it (cmake --build --preset release) or set ENCOUNTER_MODULES to the folder that holds it");
  if (const std::string why = cut_off(file); !why.empty())
    refuse(file, fmt::format("cannot be loaded: {}", why), "copy or build it again");
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr)
    refuse(file, fmt::format("cannot be loaded: {}", loader_words(file)),
           "install what it needs or build it again");
  const auto entry = reinterpret_cast<ModuleEntry>(dlsym(library, kModuleSymbol));
  const ModuleInfo* info = entry != nullptr ? entry() : nullptr;
  if (info == nullptr)
    refuse(file, fmt::format("is no Encounter module: it has no {}()", kModuleSymbol),
           "build it from this tree");
  if (info->interface != kModuleInterface)
    refuse(file,
           fmt::format("has module interface {}, this program expects {}", info->interface, kModuleInterface),
           kRebuild);
  if (info->border != ENCOUNTER_BORDER)
    refuse(file,
           "was built from other declarations than this program (core/devices/module.h and what it includes)",
           kRebuild);
  if (std::string_view(info->version) != ENCOUNTER_VERSION)
    refuse(file, fmt::format("is of version {}, this program is {}", info->version, ENCOUNTER_VERSION),
           kRebuild);
  if (name != info->name) refuse(file, fmt::format("calls itself '{}'", info->name), "do not rename modules");
  return *info;
}

}  // namespace enc::app
