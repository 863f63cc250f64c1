#include "app/run/live_run.h"

#include <charconv>
#include <chrono>

#include <fmt/format.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "core/base/error.h"

namespace enc::app {

LiveAddress live_address(const std::string& text) {
  LiveAddress at;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) at.address = text.substr(0, colon);
  const std::string_view port = std::string_view(text).substr(colon == std::string::npos ? 0 : colon + 1);
  const auto [end, bad] = std::from_chars(port.data(), port.data() + port.size(), at.port);
  if (bad != std::errc() || end != port.data() + port.size() || at.address.empty())
    throw Error("--live '" + text + "': expected a port from 0 to 65535, or ADDRESS:PORT, such as 8765");
  return at;
}

LiveRun::LiveRun(const std::string& where, const trial::Trial& trial, const RecordTexts& texts)
    : server_([&] {
        const LiveAddress at = live_address(where);
        return live_module().open(at.address, at.port, "Encounter: " + trial.setup().scene.title);
      }()),
      mcap_(*server_, trial.setup(), trial.scene(), texts),
      thread_(trial::beside_loop([this](const std::stop_token& stop) { work(stop); })) {
  print_notes({fmt::format("live at ws://{}:{}, for Foxglove and other viewers", live_address(where).address,
                           server_->port())});
}

void LiveRun::add(const trial::Glance& glance) noexcept { ticks_.push({glance.tick, glance.in, glance.out}); }

void LiveRun::work(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kTurn{2};
  for (bool last = false; !last;) {
    last = stop.stop_requested();
    for (RecordedTick tick; ticks_.pop(tick);) mcap_.add(tick);
    server_->serve();
    if (!last) std::this_thread::sleep_for(kTurn);
  }
}

void LiveRun::end() {
  thread_.request_stop();
  thread_.join();
  mcap_.end({}, "whole");
  if (const std::size_t ticks = ticks_.take_dropped(); ticks > 0)
    print_notes({fmt::format("live: {} ticks were not sent, because this computer was too slow", ticks)});
  if (const std::uint64_t messages = server_->dropped(); messages > 0)
    print_notes({fmt::format("live: a viewer was too slow for {} messages; they were left out", messages)});
}

}  // namespace enc::app
