// Named random streams, one for each device, so that an added part does not change the numbers of the others
// (sources/choices 7).
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/base/frames.h"

namespace enc::sim {

// splitmix64 in counter form: its whole state is one number, so that save and restore are trivial.
class Stream {
 public:
  Stream() = default;
  Stream(std::uint64_t seed, std::string_view name)
      : state_(seed * 0x9e3779b97f4a7c15ULL + 0xd1b54a32d192ed03ULL) {
    for (const char c : name) state_ = mix(state_ ^ static_cast<unsigned char>(c));
  }
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return mix(state_);
  }
  // A number in (0, 1): never 0, so that its logarithm exists.
  double uniform() { return (static_cast<double>(bits() >> 11U) + 0.5) * 0x1p-53; }
  double normal() {  // Marsaglia's polar method; the second value is dropped to avoid memory
    while (true) {
      const double x = 2.0 * uniform() - 1.0;
      const double y = 2.0 * uniform() - 1.0;
      const double r = x * x + y * y;
      if (r > 0.0 && r < 1.0) return x * std::sqrt(-2.0 * std::log(r) / r);
    }
  }
  Vec3 normal3() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }
  double exponential(double mean) { return -mean * std::log(uniform()); }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  std::uint64_t state_ = 0;
};

}  // namespace enc::sim
