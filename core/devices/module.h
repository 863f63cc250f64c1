// A module's export. A module is a shared object beside the program, loaded when a scene, rig or command
// names it. Heavy libraries (OpenGL, OpenCV, vendors' drivers) live in modules, so the plain program maps
// none of them.
#pragma once

#include <cstdint>

#include <encounter_border.h>
#include <encounter_version.h>

#include "core/devices/driver.h"
#include "core/devices/rig.h"

namespace enc {

// Number of the interface itself: ModuleInfo and the search for a module. `border` covers all declarations
// that cross the interface, so no number must be raised by hand for them. The program refuses a module with
// another number, border or version, and never tries it.
inline constexpr std::uint32_t kModuleInterface = 4;

// Export of the images module besides playback: writing an image to a file.
struct FrameFiles {
  // The bytes of a PNG without loss of pixels. Throws Error.
  std::string (*png)(const ImageView& image) = nullptr;
};

struct ModuleInfo {
  std::uint32_t interface = kModuleInterface;
  std::uint64_t border = ENCOUNTER_BORDER;  // hash of all declarations that cross (cmake/border.cmake)
  const char* version = ENCOUNTER_VERSION;
  const char* name = "";  // "view", "sample"
  const DriverModule* driver = nullptr;
  const void* view = nullptr;         // sim::ViewModule, view module only
  const void* window = nullptr;       // sim::WindowModule, window module only
  const void* vision = nullptr;       // VisionModule, vision module only
  const void* camera = nullptr;       // sim::CameraModule, camera module only
  const void* frames = nullptr;       // FrameFiles, images module only
  const void* peers = nullptr;        // bench::PeersModule, peers module only
  const void* bench = nullptr;        // trial::BenchModule, bench module only
  const void* benchmark = nullptr;    // bench::BenchmarkModule, modules of encounter_benchmark() only
  const void* live = nullptr;         // app::LiveModule, live module only
  const void* fit = nullptr;          // app::FitModule, fit module only
  const void* calibration = nullptr;  // app::CalibrationModule, calibration module only
};

// The only exported symbol: extern "C" const enc::ModuleInfo* encounter_module();
inline constexpr const char* kModuleSymbol = "encounter_module";
// The module "bench_press" holds the benchmark "press" of somebody else, and no driver.
inline constexpr const char* kBenchmarkPrefix = "bench_";
using ModuleEntry = const ModuleInfo* (*)();

}  // namespace enc
