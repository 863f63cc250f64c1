#include "hw_drivers/leap/drive/settings.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/base/error.h"

namespace enc::leap {
namespace {

// In the order of their numbers.
constexpr std::array<std::string_view, 3> kModes{"desktop", "headset", "screen_top"};

}  // namespace

void LeapSettings::declare(Settings& table) {
  static constexpr std::array<std::string_view, 2> kSides{"right", "left"};
  table.value({.name = "library",
               .meaning = "file of the vendor's library; \"fake\": the stand-in; empty: the installed one"},
              library);
  table.value(
      {.name = "server",
       .meaning = "namespace of the tracking service; of the fake: its HOST:PORT; empty: the usual one"},
      server);
  table.value({.name = "mode", .meaning = "where the device is mounted", .words = kModes}, mode);
  table.value({.name = "side", .meaning = "which hand", .words = kSides}, side);
  table.value({.name = "timeout_ms", .meaning = "longest wait for the first frame", .low = 1, .high = 1e5},
              timeout);
  table.value({.name = "silent_ms",
               .meaning = "longest time without a frame; then the link is lost",
               .low = 1,
               .high = 1e5},
              silent);
}

std::uint32_t LeapSettings::mode_number() const noexcept {
  return static_cast<std::uint32_t>(std::find(kModes.begin(), kModes.end(), mode) - kModes.begin());
}

arm::Place LeapSettings::fake_place() const {
  arm::Place place;
  if (!arm::read_place(server.empty() ? kUsualPlace : server, place))
    throw Error("[driver.leap] names the server '" + server +
                    "'; expected HOST:PORT, where a fake sends; see models/rigs/fakes_vishap.toml",
                {}, ErrorKind::device);
  return place;
}

}  // namespace enc::leap
