// A tally that a process of its own has made: of a filter nobody gets out again.
#pragma once

#include <functional>
#include <string>

#include "tests/hygiene/tally.h"

namespace enc::test {

struct Told {
  Tally tally;
  double extra = 0.0;  // as the child said
  std::string error;   // empty: it came to its end
};
// What `work` tells, in a child of this process. Of one thread: the others are not in the child.
[[nodiscard]] Told in_child(const std::function<void(Told&)>& work);

// "2 heap, 1 lock in 60000 ticks", and who made the first: a line for each.
[[nodiscard]] std::string words(const Tally& tally);

}  // namespace enc::test
