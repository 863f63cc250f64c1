// Injects faults between devices and core, one at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/control/step.h"
#include "core/devices/rig.h"
#include "core/record/fields.h"

namespace enc::bench::extremes {

// The value that replaces a number.
enum class Junk : std::uint8_t { nan, infinite, negative_infinite, huge };
inline constexpr auto kJunk = {Junk::nan, Junk::infinite, Junk::negative_infinite, Junk::huge};
[[nodiscard]] const char* name_of(Junk junk);

// A visitor of fields(): counts the numbers and puts junk in the `wanted`-th (-1: in no number). Hold and
// resume signals are no device samples.
struct InputSpoiler {
  int wanted = -1;
  Junk junk = Junk::nan;
  int seen = 0;
  std::string_view name{};
  template <class T>
  void operator()(std::string_view called, T& x) {
    if (called == "withheld" || called == "resumed" || seen++ != wanted) return;
    name = called;
    const auto kind = static_cast<int>(junk);
    if constexpr (std::is_same_v<T, double>) {
      constexpr double kInf = std::numeric_limits<double>::infinity();
      x = kind == 0 ? kUnset : kind == 1 ? kInf : kind == 2 ? -kInf : 1e12;
    } else if constexpr (std::is_same_v<T, Time>) {  // 1000 s ahead or ago, and the largest number
      using Limit = std::numeric_limits<std::int64_t>;
      constexpr std::int64_t kFar = 1'000'000'000'000;
      x = Time(Duration(kind == 0 ? -kFar : kind == 1 ? Limit::max() : kind == 2 ? Limit::min() : kFar));
    } else if constexpr (std::is_same_v<T, Health>) {
      x = kind == 0   ? Health::absent
          : kind == 1 ? Health::fault
          : kind == 2 ? Health::stale
                      : Health::out_of_range;
    } else if constexpr (std::is_same_v<T, bool>) {
      x = !x;
    } else if constexpr (std::is_enum_v<T>) {
      x = static_cast<T>(kind);
    } else {
      x = static_cast<T>(kind == 0 ? -2 : kind == 1 ? 1'000'000 : kind == 2 ? -1'000'000 : 1000);
    }
  }
};

// Restores samples that persist until there is news on every tick: a spoiled sample is gone on the next tick.
void keep_clean(Rig& rig);

// Packets between device and core: some are lost, some overtake others, some come twice.
class Network {
 public:
  struct Faults {
    double loss = 0.0, late = 0.0, twice = 0.0;  // shares
    double least = 0.0, most = 0.030;            // s, delay of late packets
  };
  Network(const Faults& faults, std::uint64_t seed) : faults_(faults), random_(seed) {}
  void operator()(Time now, Inputs& in);

 private:
  struct Packet {
    Time due{};
    Measurement<TrackedTool> sample;
  };
  [[nodiscard]] double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  Faults faults_;
  std::mt19937_64 random_;
  Time newest_{-Duration(1)};
  std::deque<Packet> under_way_;
  Measurement<TrackedTool> shown_;  // that came last
};

// All faults at random, one a second, until `quiet_from`.
class Storm {
 public:
  Storm(std::uint64_t seed, double rate, double quiet_from)
      : random_(seed), rate_(rate), quiet_from_(quiet_from) {}
  void operator()(Time now, Inputs& in);
  [[nodiscard]] std::int64_t faults() const { return faults_; }

 private:
  void begin();
  void spoil(Inputs& in);
  [[nodiscard]] double in(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  std::mt19937_64 random_;
  double rate_, quiet_from_;                       // Hz, s
  std::int64_t next_ = 0, faults_ = 0, left_ = 0;  // ticks
  int kind_ = 0, field_ = 0;
  Junk junk_ = Junk::nan;
  Vec3 shift_{0, 0, 0};
  Measurement<TrackedTool> frozen_;
  bool freezes_ = false;
};

}  // namespace enc::bench::extremes
