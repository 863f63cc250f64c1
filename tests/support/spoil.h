// Puts nonsense in one number of the inputs.
#pragma once

#include <array>
#include <limits>
#include <random>
#include <string_view>
#include <type_traits>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "core/base/time.h"

namespace enc::test {

// A visitor of fields(): spoils the `wanted`-th, -1: none, and counts them. What is withheld or resumed is no
// sample of a device.
struct SpoilOne {
  std::mt19937_64& random;
  int wanted;
  int seen = 0;
  template <class T>
  void operator()(std::string_view name, T& x) {
    if (name == "withheld" || name == "resumed" || seen++ != wanted) return;
    if constexpr (std::is_same_v<T, double>) {
      constexpr double kInf = std::numeric_limits<double>::infinity();
      const double share = std::uniform_real_distribution<double>(-0.1, 0.1)(random);
      const std::array<double, 12> bad{kUnset, kInf, -kInf, 1e12,   -1e12,  1e308,
                                       0.0,    1.0,  -1.0,  1e-300, 5e-324, x * (1.0 + share)};
      x = bad[random() % bad.size()];
    } else if constexpr (std::is_same_v<T, Time>) {
      x = Time(Duration(static_cast<std::int64_t>(random() % 2'000'000'000'000) - 1'000'000'000'000));
    } else if constexpr (std::is_same_v<T, Health>) {
      x = static_cast<Health>(random() % 6);
    } else {
      x = static_cast<T>(static_cast<std::int64_t>(random() % 2001) - 1000);
    }
  }
};

}  // namespace enc::test
