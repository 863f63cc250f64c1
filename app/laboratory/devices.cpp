// What is there of a rig: whether each device answers, how often it says something, how regularly and how
// late.
#include <cmath>

#include <fmt/format.h>

#include "app/laboratory/laboratory.h"
#include "app/laboratory/probe.h"
#include "app/modules/modules.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/scene_file.h"
#include "trial/operator/signals.h"

namespace enc::app {
namespace {

std::string line_of(const Probed& device) {
  if (!device.there) return fmt::format("{:12} NOT THERE: {}\n", device.role, device.words);
  std::string text = fmt::format("{:12} {}\n", device.role, device.words);
  if (device.samples > 0 && !device.last.empty()) text += fmt::format("{:12} {}\n", "", device.last);
  for (std::string remark : device.remarks) {
    if (remark.starts_with(device.words + ": ")) remark.erase(0, device.words.size() + 2);
    text += fmt::format("{:12} {}\n", "", remark);
  }
  if (device.samples == 1) text += fmt::format("{:12} 1 sample\n", "");
  if (device.samples > 1)
    text += fmt::format("{:12} {:.1f} samples a second; apart {} ms; old when they come {} ms\n", "",
                        device.rate, text_of(device.interval, 1e3, 2, 2), text_of(device.age, 1e3, 2, 2));
  if (!device.unusable.empty()) text += fmt::format("{:12} NOT USABLE: {}\n", "", device.unusable);
  return text;
}

}  // namespace

int devices(const LaboratoryOptions& options) {
  trial::Signals signals;
  signals.begin();
  if (!(options.seconds > 0.0 && options.seconds <= 1e4))
    throw Error("--for-s: expected a number above 0, up to 10000");
  const models::Setup setup = load_setup(with_scene(options));
  const auto found =
      probe_devices(setup, load_module, options.seconds, [] { return trial::Signals::caught() != 0; });
  if (found.empty()) fmt::print("every device that the scene names is simulated\n");
  bool all = true;
  for (const Probed& device : found) {
    fmt::print("{}", line_of(device));
    all = all && device.there && device.unusable.empty();
  }
  if (trial::Signals::caught() != 0) return 128 + trial::Signals::caught();
  return all ? 0 : 3;
}

}  // namespace enc::app
