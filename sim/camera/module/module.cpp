// The module encounter_camera: the twin's stereo head. It alone maps OpenGL.
#include "core/devices/module.h"

#include "sim/camera/context.h"
#include "sim/camera/stage.h"
#include "sim/camera/twin_camera.h"

namespace enc::sim {
namespace {

std::unique_ptr<Stage> stage(const StageSpec& spec) { return std::make_unique<Stage>(spec); }

std::unique_ptr<StereoCamera> camera(const TwinCameraSpec& spec, Show show) {
  return std::make_unique<TwinCamera>(spec, std::move(show));
}

constexpr CameraModule kCamera{stage, camera, renderer_problem, renderer_name};
constexpr ModuleInfo kInfo{.name = "camera", .camera = &kCamera};

}  // namespace
}  // namespace enc::sim

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sim::kInfo;
}
