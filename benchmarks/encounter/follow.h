// Following a tool that moves along a wall: how far behind the tip is, and the travel that the pause saves.
#pragma once

#include "benchmarks/kit/kit.h"

namespace enc::bench::encounter {

// Figures encounter.follow.* and a plot [VHMR 3.3].
void add_follow(Bench& bench);

}  // namespace enc::bench::encounter
