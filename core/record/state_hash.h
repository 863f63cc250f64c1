// The hash of everything that a run computes: equal hashes mean equal bits. It goes field by field and never
// over padding (sources/choices 8).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "core/record/fields.h"

namespace enc {

// A leaf as eight bytes. Every NaN becomes one NaN; -0 and 0 stay different, because a bit-exact replay can
// distinguish them.
template <class T>
[[nodiscard]] std::uint64_t leaf_bits(const T& x) {
  if constexpr (std::is_same_v<T, double>)
    return std::isnan(x) ? 0x7ff8000000000000ULL : std::bit_cast<std::uint64_t>(x);
  else if constexpr (std::is_same_v<T, float>)
    return leaf_bits(static_cast<double>(x));
  else if constexpr (std::is_same_v<T, Time>)
    return static_cast<std::uint64_t>(x.time_since_epoch().count());
  else if constexpr (std::is_same_v<T, Duration>)
    return static_cast<std::uint64_t>(x.count());
  else
    return static_cast<std::uint64_t>(x);
}
template <class T>
void set_leaf(T& x, std::uint64_t bits) {
  if constexpr (std::is_same_v<T, double>)
    x = std::bit_cast<double>(bits);
  else if constexpr (std::is_same_v<T, float>)
    x = static_cast<float>(std::bit_cast<double>(bits));
  else if constexpr (std::is_same_v<T, Time>)
    x = Time(Duration(static_cast<std::int64_t>(bits)));
  else if constexpr (std::is_same_v<T, Duration>)
    x = Duration(static_cast<std::int64_t>(bits));
  else
    x = static_cast<T>(bits);
}

// 64-bit mixing hash over leaves, chained from tick to tick. It is not cryptographic: it finds differences,
// not forgeries.
struct StateHash {
  std::uint64_t value = 0x9e3779b97f4a7c15ULL;
  void add(std::uint64_t bits) {
    value = (value ^ bits) * 0xff51afd7ed558ccdULL;
    value ^= value >> 32;
  }
  template <class T>
  void operator()(std::string_view, T& x) {
    add(leaf_bits(x));
  }
};
inline void add_tick(StateHash& hash, State& state, Outputs& out) {
  fields(hash, state);
  fields(hash, out);
}

}  // namespace enc
