// A live stereo camera through V4L2 (docs/reference/devices.md).
#include "core/base/error.h"
#include "core/devices/module.h"
#include "hw_drivers/v4l2/drive/live_camera.h"
#include "hw_drivers/v4l2/drive/lockstep_camera.h"
#include "hw_drivers/v4l2/fake/server.h"

namespace enc::v4l2 {
namespace {

std::unique_ptr<StereoCamera> make_camera(const Offer& offer) {
  V4l2Settings settings;
  settings.declare(offer.table);
  const bool fake = is_relayed(settings.left);
  if (!settings.right.empty() && is_relayed(settings.right) != fake)
    throw Error(settings.left + " and " + settings.right +
                    ": one is a fake; expected two devices of one kind; correct `left` or `right` of "
                    "[driver.v4l2]",
                {}, ErrorKind::device);
  // In lockstep no answer is late, so the patience only ends a run whose fake is gone.
  constexpr std::chrono::seconds kGone{30};
  if (offer.lockstep && fake) return std::make_unique<LockstepCamera>(offer, settings, relayed(kGone));
  return std::make_unique<LiveCamera>(offer, settings, fake ? relayed() : kernel());
}

constexpr DriverModule kDriver{.settings = [](Settings& table) { V4l2Settings{}.declare(table); },
                               .camera = make_camera,
                               .lockstep = true,
                               .fake = served};
constexpr ModuleInfo kInfo{.name = "v4l2", .driver = &kDriver};

}  // namespace
}  // namespace enc::v4l2

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::v4l2::kInfo;
}
