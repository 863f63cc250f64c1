// Heap of this program through operator new, counted; of a build with a sanitizer nothing is counted, because
// that one watches itself.
#pragma once

#include <cstddef>

namespace enc::fuzz {

[[nodiscard]] std::size_t live_bytes();  // now
[[nodiscard]] std::size_t peak_bytes();  // most since forget_peak()
void forget_peak();

}  // namespace enc::fuzz
