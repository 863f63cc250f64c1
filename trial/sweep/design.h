// The points of a sweep's design and the seeds of its runs. Both depend on the sweep's hash and on the number
// of the point or run alone, so every shard computes its own without the others (Random123, Philox 4x32-10).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "trial/sweep/spec.h"

namespace enc::trial {

// Parameters of a Sobol design: as many as the table of direction numbers has.
inline constexpr std::size_t kMostSobolAxes = 21;

class Design {
 public:
  explicit Design(const SweepSpec& spec);

  // The value of each axis at a point.
  [[nodiscard]] std::vector<std::string> values(std::int64_t point) const;
  // Seed of a run, below 2^53, so that every JSON reader keeps it.
  [[nodiscard]] std::uint64_t seed(std::int64_t run) const;
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  [[nodiscard]] double share(std::size_t axis, std::int64_t point) const;

  const SweepSpec& spec_;
  std::uint64_t hash_;
};

// 64 random bits for (key, number, axis) [Salmon et al., SC11]. Separate streams draw separate numbers.
enum class CounterStream : std::uint32_t { seeds, points, shifts };
[[nodiscard]] std::uint64_t counter_bits(std::uint64_t key, std::uint64_t number, std::uint32_t axis,
                                         CounterStream stream);

// A point of the Sobol sequence as a fraction of 2^32; axis: 0 to kMostSobolAxes - 1.
[[nodiscard]] std::uint32_t sobol(std::size_t axis, std::uint32_t point);

}  // namespace enc::trial
