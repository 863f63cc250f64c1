#include "app/run/live_run.h"

#include <chrono>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "core/base/error.h"
#include "models/tables/number_text.h"

namespace enc::app {

LiveAddress live_address(const std::string& text) {
  LiveAddress at;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) at.address = text.substr(0, colon);
  const std::string_view port = std::string_view(text).substr(colon == std::string::npos ? 0 : colon + 1);
  const auto number = models::number_in<std::uint16_t>(port);
  // libwebsockets listens at all addresses if it is given one that it cannot use.
  in_addr ipv4{};
  if (!number || inet_pton(AF_INET, at.address.c_str(), &ipv4) != 1)
    throw Error("--live '" + text +
                "': expected a port from 0 to 65535, or ADDRESS:PORT with an IPv4 address; write, for "
                "example, 8765 or 0.0.0.0:8765");
  at.port = *number;
  return at;
}

LiveRun::LiveRun(const LiveAddress& at, const trial::Trial& trial, const RecordTexts& texts)
    : server_(live_module().open(at.address, at.port, "Encounter: " + trial.setup().scene.title)),
      mcap_(*server_, trial.setup(), trial.scene(), texts) {
  print_notes(
      {fmt::format("live at ws://{}:{}, for Foxglove and other viewers", at.address, server_->port())});
  // From here on the server belongs to this thread.
  thread_ = trial::beside_loop([this](const std::stop_token& stop) { work(stop); });
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
