// Runs step() again over a record: equal inputs must give equal outputs, to the bit [sources/choices 1 5].
#pragma once

#include <cstdint>
#include <string>

#include "core/control/scene/scene.h"
#include "core/record/record.h"

namespace enc {

struct ReplayResult {
  std::int64_t ticks = 0;              // ticks run again
  std::int64_t first_difference = -1;  // index of the tick; -1: no difference
  std::string what;                    // "gap: recorded 0.0123, computed 0.0124"; empty: no difference
  std::uint64_t hash = 0;              // computed StateHash after the last tick
};

// Replays the whole record, even after a difference, so that the hash covers the whole run.
[[nodiscard]] ReplayResult replay(const Scene& scene, RecordReader& record);

}  // namespace enc
