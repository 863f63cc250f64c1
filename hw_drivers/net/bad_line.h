// The connection from a fake to its client, with the faults of a bad network. Without a fault each message
// leaves unchanged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/net/active_troubles.h"

namespace enc::net {

class BadLine {
 public:
  enum class Wire : bool { datagrams, stream };
  BadLine(Wire wire, std::uint64_t seed) : wire_(wire), troubles_(seed) {}

  [[nodiscard]] bool knows(Trouble::Kind kind) const noexcept;
  void suffer(const Trouble& trouble) noexcept { troubles_.suffer(trouble); }
  void heal(Trouble::Kind kind) noexcept { troubles_.heal(kind); }
  [[nodiscard]] bool suffers(Trouble::Kind kind) const noexcept { return troubles_.of(kind).has_value(); }
  // The device is stalled, or new connections are refused.
  [[nodiscard]] bool dead() const noexcept {
    return suffers(Trouble::Kind::stall) || suffers(Trouble::Kind::disconnect);
  }
  // A new client: drops all messages under way.
  void begin(Time now);

  void put(Time now, std::span<const std::byte> message);
  // The next message that is due by now.
  [[nodiscard]] std::optional<std::vector<std::byte>> take(Time now);
  // Passes all due messages to send(bytes).
  template <class Send>
  void leave(Time now, Send send) {
    for (auto next = take(now); next; next = take(now)) send(std::span<const std::byte>(*next));
  }

 private:
  struct Message {
    Time due;
    std::vector<std::byte> bytes;
    bool waits = false;  // holds this message until another one has left
  };
  void spoil(std::vector<std::byte>& bytes);

  Wire wire_;
  ActiveTroubles troubles_;
  std::deque<Message> on_the_way_;  // ordered by departure
  Time begun_{}, last_{}, now_{};   // last_: departure of the last message, stream only
};

}  // namespace enc::net
