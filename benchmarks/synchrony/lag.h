// How much later one signal is than another, by cross-correlation.
#pragma once

#include <span>

namespace enc::bench::synchrony {

// The delay of `later` behind `earlier`, s, at which their correlation (each with its own mean taken out) is
// highest; negative where `later` comes first. Both are sampled every `period` s. Searched to `most` s either
// way; between samples by a parabola through the three highest. NaN where there is too little signal, or
// where the highest is at the end of the search.
[[nodiscard]] double lag_of(std::span<const double> earlier, std::span<const double> later, double period,
                            double most);

}  // namespace enc::bench::synchrony
