#include "app/modules/modules.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <elf.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/common/options.h"
#include "core/base/error.h"
#include "encounter_version.h"
#include "models/schema/wording.h"
#include "trial/assemble/assemble.h"
#include "trial/bench_module.h"

namespace enc::app {
namespace {

std::string all_quoted(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + models::quoted(name);
  return list;
}

bool fills(const std::string& driver, const trial::DrivenRole& role) {
  const ModuleInfo& module = load_module(driver);
  return module.driver != nullptr && role.filled_by(*module.driver);
}

// The available drivers that fill a role. A driver that cannot be loaded fills no role.
std::vector<std::string> who_fill(const trial::DrivenRole& role, const std::vector<std::string>& there) {
  std::vector<std::string> names{"sim"};
  for (const std::string& driver : there) {
    try {
      if (fills(driver, role)) names.push_back(driver);
    } catch (const Error&) {
    }
  }
  return names;
}

std::string unknown(const std::string& driver, std::vector<std::string> there) {
  there.insert(there.begin(), "sim");
  const std::string near = models::nearest_name(driver, there);
  return fmt::format("there is no driver {}; expected one of {}; {}", models::quoted(driver),
                     all_quoted(there),
                     near.empty() ? "correct the name, or build it (cmake --build --preset release)"
                                  : fmt::format("did you mean {}?", models::quoted(near)));
}

// Throws Error with the place if a role of the scene has an unavailable driver, or one that does not fill it.
// Without any available driver no name can be judged: the module is then missing, which matters only for a
// run.
void check_driver_names(const models::Setup& setup) {
  const std::vector<std::string> there = drivers_there();
  if (there.empty()) return;
  for (const trial::DrivenRole& role : trial::driven_roles(setup)) {
    const std::string place = models::place_of(setup, role.key);
    if (std::find(there.begin(), there.end(), role.driver) == there.end())
      throw Error(fmt::format("{}: {}", place, unknown(role.driver, there)));
    if (!fills(role.driver, role))
      throw Error(fmt::format("{}: driver {} is for no {}; expected one of {}; name one of them", place,
                              models::quoted(role.driver), role.name, all_quoted(who_fill(role, there))));
  }
}

namespace fs = std::filesystem;
constexpr std::string_view kPrefix = "encounter_";
constexpr std::string_view kSuffix = ".so";

[[noreturn]] void refuse(const std::string& file, const std::string& why, const std::string& advice) {
  const std::vector<std::string> there = modules_there();
  const std::string list = there.empty() ? "none" : fmt::format("{}", fmt::join(there, ", "));
  throw Error(fmt::format("{}: {}; {} (modules there: {})", file, why, advice, list), {}, ErrorKind::device);
}

// The linker's message begins with the file name, which our message already has.
std::string loader_words(const std::string& file) {
  const char* words = dlerror();
  std::string text = words != nullptr ? words : "unknown reason";
  if (text.starts_with(file + ": ")) text.erase(0, file.size() + 2);
  return text;
}

// The user's modules folder may hold only drivers. The program's own modules are always found beside the
// program.
std::string beside_program() {
  std::error_code none;
  return (fs::read_symlink("/proc/self/exe", none).parent_path() / "modules").string();
}
bool ours(const std::string& name) {
  constexpr std::array<std::string_view, 7> kOurs{"bench", "calibration", "camera", "fit",
                                                  "live",  "peers",       "vision"};
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
  std::erase_if(names, [](const std::string& name) {
    return ours(name) || name == "view" || name == "window" || name.starts_with(kBenchmarkPrefix);
  });
  return names;
}

std::vector<std::string> benchmarks_there() {
  const std::string_view prefix = kBenchmarkPrefix;
  std::vector<std::string> names;
  for (const std::string& name : modules_there())
    if (name.size() > prefix.size() && name.starts_with(prefix)) names.push_back(name.substr(prefix.size()));
  return names;
}

SceneOptions with_scene(const SceneOptions& options) {
  SceneOptions with = options;
  if (!with.scene.empty()) return with;
  const RigSpec rig = with.rig.empty() ? RigSpec{} : models::load_rig(with.rig);
  const bool arm = rig.manipulator.driver == "none" && rig.arm.driver != "none";
  const bool camera = rig.camera.driver != "sim" && rig.camera.driver != "none";
  with.scene = fmt::format("{}/scenes/{}.toml", models::models_dir(),
                           !arm     ? "tennis_ball"
                           : camera ? "camera/wall"
                                    : "wall");
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

std::string cut_off(std::string_view head, std::uint64_t size) {
  Elf64_Ehdr header{};
  if (head.size() < sizeof(header)) return {};
  std::memcpy(&header, head.data(), sizeof(header));
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64 ||
      header.e_phentsize != sizeof(Elf64_Phdr))
    return {};
  const auto ends = [&](std::uint64_t at, std::uint64_t length) {
    return at > size || length > size - at
               ? fmt::format("is cut off: it has {} bytes, and a part of {} at byte {}", size, length, at)
               : std::string();
  };
  const std::uint64_t table = header.e_phnum * sizeof(Elf64_Phdr);
  std::string why = ends(header.e_phoff, table);
  if (!why.empty() || header.e_phoff > head.size() || table > head.size() - header.e_phoff) return why;
  for (std::uint64_t i = 0; i < header.e_phnum && why.empty(); ++i) {
    Elf64_Phdr segment{};
    std::memcpy(&segment, head.data() + header.e_phoff + i * sizeof(segment), sizeof(segment));
    if (segment.p_type == PT_LOAD && segment.p_filesz > 0) why = ends(segment.p_offset, segment.p_filesz);
  }
  return why;
}

std::string cut_off(const std::string& path) {
  constexpr std::uint64_t kMostHead = 1U << 20U;  // bytes: linkers put the table right behind the header
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(path, failed);
  if (failed) return {};
  std::string head(std::min(size, kMostHead), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return cut_off(head, size);
}

// ---- the subcommands that live in modules, because few users need their libraries

namespace {

// A module that was not built is not a broken device: the message names the command that builds it.
const ModuleInfo& own_module(const std::string& name, const std::string& command) {
  try {
    return load_module(name);
  } catch (const Error& e) {
    throw Error(fmt::format("{}; './encounter {}' builds it", e.what(), command));
  }
}

const trial::BenchModule& benchmarks() {
  return *static_cast<const trial::BenchModule*>(own_module("bench", "bench").bench);
}

const ModuleInfo* module_if_there(const std::string& name) {
  return module_there(name) ? &load_module(name) : nullptr;
}

}  // namespace

const FitModule& fit_module() { return *static_cast<const FitModule*>(own_module("fit", "fit").fit); }

const LiveModule& live_module() { return *static_cast<const LiveModule*>(load_module("live").live); }

const CalibrationModule& calibration_module() {
  return *static_cast<const CalibrationModule*>(
      own_module("calibration", "calibrate stereo FOLDER").calibration);
}

const ModuleInfo& module_for_pictures(const std::string& name) {
  if (name != "vision" && name != "camera") return load_module(name);
  return own_module(name, "calibrate camera RIG --through-images");
}

int bench(const BenchOptions& options) {
  return benchmarks().bench(options, module_if_there, benchmarks_there());
}

int fit(const FitOptions& options) { return fit_module().fit(options); }

int shadow(const ShadowOptions& options) { return fit_module().shadow(options); }

int questionnaire(const QuestionnaireOptions& options) { return benchmarks().questionnaire(options); }

}  // namespace enc::app
