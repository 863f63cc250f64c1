#include "hw_drivers/arm/fake/client.h"

#include <algorithm>
#include <charconv>

#include <unistd.h>

#include "core/base/error.h"
#include "hw_drivers/net/clocks.h"

namespace enc::arm {

bool read_place(const std::string& text, Place& place) noexcept {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return false;
  std::uint16_t port = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data() + colon + 1, last, port);
  if (error != std::errc{} || end != last || port == 0) return false;
  place = {text.substr(0, colon), port};
  return true;
}

bool Client::open(const Place& place, Duration within) noexcept {
  constexpr Duration kAgain{50'000'000};  // a datagram may be lost
  try {
    socket_ = net::connect_udp(place.host, place.port);
  } catch (const Error&) {
    return false;
  }
  state_ = {};
  number_ = 0;
  session_ =
      static_cast<std::uint64_t>(net::steady_now().count()) ^ (static_cast<std::uint64_t>(getpid()) << 40U);
  session_ = std::max<std::uint64_t>(session_, 1);
  for (const Duration until = net::steady_now() + within; net::steady_now() < until;) {
    send(Message::hello, {}, false, 0);
    if (wait(kAgain)) return true;
  }
  close();
  return false;
}

void Client::close() noexcept {
  if (is_open()) send(Message::bye, {}, false, 0);
  session_ = 0;
}

bool Client::take() noexcept {
  std::array<std::byte, sizeof(State) + 1> bytes{};
  bool newer = false;
  for (std::size_t got = socket_.receive(bytes); got > 0; got = socket_.receive(bytes)) {
    State next;
    if (!read(std::span(bytes).first(got), next) || next.number <= state_.number) continue;
    state_ = next;
    newer = true;
  }
  return newer;
}

bool Client::wait(Duration most) noexcept {
  for (const Duration until = net::steady_now() + most;;) {
    if (take()) return true;
    const Duration left = until - net::steady_now();
    if (left <= Duration{}) return false;
    socket_.wait(left);
  }
}

void Client::send(const std::array<double, 3>& force, bool enabled) noexcept {
  send(Message::force, force, enabled, state_.number);
}

void Client::end_force() noexcept { send(Message::force, {}, false, 0); }

void Client::send(Message message, const std::array<double, 3>& force, bool enabled,
                  std::uint64_t state) noexcept {
  const std::lock_guard lock(sending_);
  if (message == Message::force) ++number_;
  const Command command{{kMagic, kVersion, message}, session_, number_, state, force,
                        enabled ? 1U : 0U,           watchdog_};
  static_cast<void>(socket_.send(bytes_of(command)));
}

bool Client::exchange(const std::array<double, 3>& force, bool enabled, Duration within) noexcept {
  send(force, enabled);
  for (const Duration until = net::steady_now() + within; state_.answers < number_;) {
    const Duration left = until - net::steady_now();
    if (left <= Duration{}) return false;
    wait(left);
  }
  return true;
}

}  // namespace enc::arm
