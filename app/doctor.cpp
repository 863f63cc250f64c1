#include <exception>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/common/options.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "core/base/error.h"
#include "core/devices/roles.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/mujoco.h"
#include "sim/camera/stage.h"
#include "trial/time/real_time.h"

namespace enc::app {
namespace {

enum class Need { must, may };

struct Doctor {
  bool ready = true;
  void say(bool ok, Need need, const std::string& what, const std::string& advice) {
    fmt::print("{:8}{}{}\n",
               ok                   ? "ok"
               : need == Need::must ? "MISSING"
                                    : "note",
               what, ok ? "" : ": " + models::printable(advice));
    if (!ok && need == Need::must) ready = false;
  }
};

// Opens the library and closes it again, so that it does not stay mapped.
bool library_there(const char* name) {
  void* handle = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (handle != nullptr) dlclose(handle);
  return handle != nullptr;
}

// Requests real-time priority and releases it, because only the kernel decides whether they suffice.
void say_real_time(Doctor& doctor) {
  const trial::RealTime tried(true);
  doctor.say(tried.granted(), Need::may,
             fmt::format("real-time priority for hardware (SCHED_FIFO {})", trial::RealTime::kPriority),
             tried.refusal() + "; simulation does not need it");
}

// The keys of a driver's table.
class Keys final : public Settings {
 public:
  std::vector<std::string> names;
  void value(const Setting& key, double&) override { add(key); }
  void value(const Setting& key, std::int64_t&) override { add(key); }
  void value(const Setting& key, std::string&) override { add(key); }
  void value(const Setting& key, std::vector<double>&) override { add(key); }

 private:
  void add(const Setting& key) { names.emplace_back(key.name); }
};

// Prints the roles that a driver fills, and its keys.
void say_driver(Doctor& doctor, const std::string& name) {
  try {
    const ModuleInfo& module = load_module(name);
    if (module.driver == nullptr) return;
    std::vector<std::string_view> roles;
    each_device([&](const auto& role) {
      if (module.driver->*role.make != nullptr) roles.emplace_back(role.name);
    });
    if (module.driver->camera != nullptr) roles.emplace_back("stereo camera");
    Keys keys;
    if (module.driver->settings != nullptr) module.driver->settings(keys);
    doctor.say(
        true, Need::may,
        fmt::format("driver {}: {}; {}", name, fmt::join(roles, ", "),
                    keys.names.empty() ? "no keys of its own"
                                       : fmt::format("[driver.{}] {}", name, fmt::join(keys.names, ", "))),
        "");
  } catch (const Error& e) {
    doctor.say(false, Need::may, "driver " + name, e.what());
  }
}

// Reason why an existing module cannot be loaded; empty: it loads.
std::string module_problem(const std::string& name) {
  try {
    (void)load_module(name);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

void say_module(Doctor& doctor, const std::string& name, const std::string& what, const std::string& builds) {
  const std::string problem =
      module_there(name) ? module_problem(name) : fmt::format("not built; {} builds it", builds);
  doctor.say(problem.empty(), Need::may, fmt::format("{} (module {})", what, name), problem);
}

void say_vision(Doctor& doctor) {
  say_module(doctor, "vision", "vision, for scenes with a camera", "./encounter run with such a scene");
  say_module(doctor, "calibration", "OpenCV, for calibration from images",
             "./encounter calibrate stereo FOLDER");
  doctor.say(!program_path("ffmpeg").empty(), Need::may, "ffmpeg, for videos as a stereo camera",
             "apt-get install ffmpeg; folders of images need no ffmpeg");
}

// Looks like ": llvmpipe (LLVM 15.0.6, 256 bits), in software".
std::string words_of(const std::string& renderer) {
  if (renderer.empty()) return {};
  const bool software = renderer.find("llvmpipe") != std::string::npos ||
                        renderer.find("softpipe") != std::string::npos ||
                        renderer.find("swrast") != std::string::npos;
  return ": " + renderer + (software ? ", in software" : "");
}

// Prints the available renderers for the twin's camera; one is enough.
void say_renderers(Doctor& doctor) {
  if (!module_there("camera")) return;
  try {
    const auto* camera = static_cast<const sim::CameraModule*>(load_module("camera").camera);
    for (const auto& [kind, name] : {std::pair{"egl", "EGL"}, {"osmesa", "OSMesa"}}) {
      const std::string problem = camera->renderer_problem(kind);
      doctor.say(problem.empty(), Need::may,
                 std::string(name) + " draws for the twin's camera" + words_of(camera->renderer_name(kind)),
                 problem);
    }
  } catch (const Error& e) {
    doctor.say(false, Need::may, "the twin's camera", e.what());
  }
}

std::string models_problem() {
  try {
    const std::string folder = models::models_dir();
    models::load(folder + "/scenes/tennis_ball.toml", "sim");
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

}  // namespace

int doctor() {
  Doctor doctor;
  const std::string unfit = sim::mujoco_problem();
  doctor.say(unfit.empty(), Need::must, "MuJoCo " + sim::mujoco_version(), unfit);
  const std::string problem = models_problem();
  doctor.say(problem.empty(), Need::must, "scenes, rigs and responses in " + models::models_dir(), problem);
  const std::vector<std::string> modules = modules_there();
  doctor.say(!modules.empty(), Need::may, fmt::format("modules: {}", fmt::join(modules, ", ")),
             "no module beside the program; pictures and drivers need modules");
  for (const std::string& name : drivers_there()) say_driver(doctor, name);
  doctor.say(library_there("libEGL.so.1"), Need::may, "EGL for pictures", "./encounter view installs it");
  say_renderers(doctor);
  say_vision(doctor);
  doctor.say(!program_path("gnuplot").empty(), Need::may, "gnuplot for the plots of a report",
             "./encounter bench installs it");
  say_real_time(doctor);
  doctor.say(std::thread::hardware_concurrency() >= 2, Need::may,
             fmt::format("{} cores", std::thread::hardware_concurrency()), "real devices need two");
  fmt::print("{}\n", doctor.ready ? "ready" : "not ready");
  return doctor.ready ? 0 : 1;
}

}  // namespace enc::app
