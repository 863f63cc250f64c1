// Runs step() again over a record: the same inputs must give the same outputs, to the bit [sources/choices 1
// 5].
#pragma once

#include <cstdint>
#include <string>

#include "core/control/scene/scene.h"
#include "core/record/record.h"

namespace enc {

struct ReplayResult {
  std::int64_t ticks = 0;              // run again
  std::int64_t first_difference = -1;  // index of the tick, -1: none
  std::string what;                    // "gap: recorded 0.0123, computed 0.0124"; empty: no difference
  std::uint64_t hash = 0;              // StateHash after the last tick, as computed
};

// All of the record from its beginning, also after a difference, so that the hash is that of the whole run.
[[nodiscard]] ReplayResult replay(const Scene& scene, RecordReader& record);

}  // namespace enc
