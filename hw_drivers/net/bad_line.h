// The way from a fake to whoever listens, on which messages fare as on a bad network. Without trouble each
// leaves as it came.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "core/devices/fake.h"

namespace enc::net {

class BadLine {
 public:
  enum class Wire : bool { datagrams, stream };
  BadLine(Wire wire, std::uint64_t seed) : wire_(wire), random_(seed) {}

  [[nodiscard]] bool knows(Trouble::Kind kind) const noexcept;
  void suffer(const Trouble& trouble) noexcept { of(trouble.kind) = trouble.value; }
  void heal(Trouble::Kind kind) noexcept { of(kind).reset(); }
  [[nodiscard]] bool suffers(Trouble::Kind kind) const noexcept {
    return shares_[static_cast<std::size_t>(kind)].has_value();
  }
  // The device stands, or nobody is let in.
  [[nodiscard]] bool dead() const noexcept {
    return suffers(Trouble::Kind::stall) || suffers(Trouble::Kind::disconnect);
  }
  // Somebody came: what was on its way is gone.
  void begin(Time now);

  void put(Time now, std::span<const std::byte> message);
  // The next that is to leave by now.
  [[nodiscard]] std::optional<std::vector<std::byte>> take(Time now);
  // All of them, each to send(bytes).
  template <class Send>
  void leave(Time now, Send send) {
    for (auto next = take(now); next; next = take(now)) send(std::span<const std::byte>(*next));
  }

 private:
  struct Message {
    Time due;
    std::vector<std::byte> bytes;
    bool waits = false;  // until another one has left
  };
  [[nodiscard]] std::optional<double>& of(Trouble::Kind kind) noexcept {
    return shares_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] bool happens(Trouble::Kind kind);  // to this message
  [[nodiscard]] double uniform() { return std::generate_canonical<double, 53>(random_); }
  void spoil(std::vector<std::byte>& bytes);

  Wire wire_;
  std::mt19937_64 random_;
  std::array<std::optional<double>, 11> shares_{};  // by kind
  std::deque<Message> on_the_way_;                  // in the order in which they leave
  Time begun_{}, last_{}, now_{};                   // last_: when the one before leaves, of a stream
};

}  // namespace enc::net
