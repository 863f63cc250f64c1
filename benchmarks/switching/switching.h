// Parts of the benchmark `switching`: what is measured in the twin.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"

namespace enc::bench::switching {

using Adder = std::function<void(const std::string& id, double value, const char* unit,
                                 const std::string& note, double low, double high)>;

// A tracker that sees the finger where it is, each tick: what is left is the display's.
inline const std::vector<std::string> kLiveFinger{
    "truth.tracker.rate_hz=1000",      "truth.tracker.latency_ms=0",      "truth.tracker.noise_mm=[0,0,0]",
    "truth.tracker.marker_noise_mm=0", "rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};

// A finger slides over the keys, row by row, pressed: is the key that is felt the one that is meant?
void slide_over_keys(const BenchContext& context, BenchResult& result, const Adder& add);
// Ball, tiles and drum in the twin.
void move_things(const BenchContext& context, BenchResult& result, const Adder& add);

}  // namespace enc::bench::switching
