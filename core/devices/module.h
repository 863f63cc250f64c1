// What a module exports: a shared object beside the program that is loaded when a scene, rig or command names
// it. Heavy libraries (OpenGL, OpenCV, vendors' drivers) live in modules, so the plain program maps none of
// them.
#pragma once

#include <cstdint>

#include <encounter_border.h>
#include <encounter_version.h>

#include "core/devices/driver.h"
#include "core/devices/rig.h"

namespace enc {

// Of the border itself: ModuleInfo and how a module is found. What crosses it is in `border`, so that nobody
// has to think of raising a number. A module of another number, border or version is refused, never tried.
inline constexpr std::uint32_t kModuleInterface = 4;

struct ModuleInfo {
  std::uint32_t interface = kModuleInterface;
  std::uint64_t border = ENCOUNTER_BORDER;  // a hash of all declarations that cross (cmake/border.cmake)
  const char* version = ENCOUNTER_VERSION;
  const char* name = "";  // "view", "sample"
  const DriverModule* driver = nullptr;
  const void* view = nullptr;         // sim::ViewModule, of the view module only
  const void* window = nullptr;       // sim::WindowModule, of the window module only
  const void* vision = nullptr;       // VisionModule, of the vision module only
  const void* camera = nullptr;       // sim::CameraModule, of the camera module only
  const void* frames = nullptr;       // FrameFiles, of the images module only
  const void* peers = nullptr;        // bench::PeersModule, of the peers module only
  const void* bench = nullptr;        // trial::BenchModule, of the bench module only
  const void* fit = nullptr;          // app::FitModule, of the fit module only
  const void* calibration = nullptr;  // app::CalibrationModule, of the calibration module only
};

// The one symbol: extern "C" const enc::ModuleInfo* encounter_module();
inline constexpr const char* kModuleSymbol = "encounter_module";
using ModuleEntry = const ModuleInfo* (*)();

}  // namespace enc
