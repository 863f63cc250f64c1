// Valid ranges of a record's numbers. The reader checks each number of a frame, because a file may come from
// anywhere.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/record/fields.h"

namespace enc {

// Every other number that is not a double has the range of its type. `index` rises from tick to tick, and at
// most one contact begins in a tick.
inline constexpr std::int64_t kMostTicks = 1'000'000'000'000;  // `index` and `missed`: 30 years at 1 kHz
inline constexpr std::int64_t kMostTime = 1'000'000'000'000'000'000;  // ns, time of a tick, from 0: 30 years
inline constexpr std::int64_t kMostPeriod = 1'000'000'000;            // ns, length of a tick, from 0
// ns, a device's stamp, positive or negative
inline constexpr std::int64_t kMostStamp = std::int64_t{1} << 62;

// The values that a leaf of a type can have, both ends included; a double can have all.
struct LeafRange {
  std::int64_t low, high;
};
template <class T>
constexpr LeafRange range_of_type() {
  if constexpr (std::is_same_v<T, Time>)
    return {-kMostStamp, kMostStamp};
  else if constexpr (std::is_same_v<T, Duration>)
    return {0, kMostPeriod};
  else if constexpr (std::is_same_v<T, Mode>)
    return {0, kModes - 1};
  else if constexpr (std::is_enum_v<T>)
    return {0, static_cast<std::int64_t>(kWords<T>.size()) - 1};
  else if constexpr (std::is_integral_v<T> && sizeof(T) < sizeof(std::uint64_t))
    return {std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
  else
    return {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()};
}

// A visitor of a frame that finds the first leaf out of its range.
struct CheckLeaves {
  const std::uint64_t* from;
  std::int64_t index;    // index of the last tick, then of this one
  std::size_t leaf = 0;  // the next leaf, or the first wrong one
  std::string wrong{};   // empty: no wrong leaf so far

  template <class T>
  void operator()(std::string_view name, T&) {
    if (!wrong.empty()) return;
    const auto value = static_cast<std::int64_t>(from[leaf]);
    const LeafRange range = range_of<T>(name);
    if (value < range.low || value > range.high) {
      wrong = "'" + std::string(name) + "' of a tick is " + std::to_string(value) + "; expected " +
              std::to_string(range.low) + " to " + std::to_string(range.high) + "; record the run again";
      return;
    }
    if (std::is_same_v<T, std::int64_t> && name == "index") index = value;
    ++leaf;
  }

 private:
  // Ranges of the numbers that count ticks or time since the start, which are narrower than their types.
  template <class T>
  [[nodiscard]] LeafRange range_of(std::string_view name) const {
    if constexpr (std::is_same_v<T, std::int64_t>) {
      if (name == "index") return {index + 1, kMostTicks};
      if (name == "missed") return {0, kMostTicks};
    }
    if constexpr (std::is_same_v<T, std::int32_t>)
      if (name == "contacts") return {0, std::min<std::int64_t>(index + 1, range_of_type<T>().high)};
    if constexpr (std::is_same_v<T, Time>)
      if (name == "t" || name == "view_t") return {0, kMostTime};
    return range_of_type<T>();
  }
};

// The first leaf out of its range in consecutive frames of `each` leaves. `index`: of the tick before them;
// afterwards, of the last.
struct WrongLeaf {
  std::size_t leaf = 0;
  std::string why{};  // empty: no such leaf
};
template <class Frame>
[[nodiscard]] WrongLeaf wrong_leaf_of(const std::vector<std::uint64_t>& leaves, std::size_t each,
                                      std::int64_t& index) {
  Frame frame;
  for (std::size_t first = 0; first < leaves.size(); first += each) {
    CheckLeaves check{leaves.data() + first, index};
    all_fields(check, frame);
    if (!check.wrong.empty()) return {first + check.leaf, check.wrong};
    index = check.index;
  }
  return {};
}

}  // namespace enc
