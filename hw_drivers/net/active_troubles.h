// The faults that a fake has now, and the chance that decides which message they hit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include "core/devices/fake.h"

namespace enc::net {

class ActiveTroubles {
 public:
  explicit ActiveTroubles(std::uint64_t seed) : random_(seed) {}

  void suffer(const Trouble& trouble) noexcept { values_[index(trouble.kind)] = trouble.value; }
  void heal(Trouble::Kind kind) noexcept { values_[index(kind)].reset(); }
  // The fault's value; empty: the fake does not have it.
  [[nodiscard]] const std::optional<double>& of(Trouble::Kind kind) const noexcept {
    return values_[index(kind)];
  }
  // True if the fault, whose value is a share, hits this message.
  [[nodiscard]] bool happens(Trouble::Kind kind) {
    const std::optional<double>& share = of(kind);
    return share && uniform() < *share;
  }
  // The chance begins again, as for a new client.
  void restart(std::uint64_t seed) { random_.seed(seed); }
  [[nodiscard]] double uniform() { return std::generate_canonical<double, 53>(random_); }
  [[nodiscard]] std::uint8_t noise() { return static_cast<std::uint8_t>(random_()); }

 private:
  [[nodiscard]] static constexpr std::size_t index(Trouble::Kind kind) noexcept {
    return static_cast<std::size_t>(kind);
  }
  // The last kind is slow_start.
  static constexpr std::size_t kKinds = static_cast<std::size_t>(Trouble::Kind::slow_start) + 1;

  std::array<std::optional<double>, kKinds> values_{};
  std::mt19937_64 random_;
};

}  // namespace enc::net
