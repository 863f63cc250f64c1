// Which readings of a press were pressing and which releasing, at any ratio of their speeds and with any hold
// between them.
#pragma once

#include <vector>

#include "models/identify/response/response_fit.h"

namespace enc::models {

// Splits a press at its deepest reading: sets `pressing` and `held` of each reading and returns those of
// either branch, in the order of time. Left out are readings that lie within the noise of the deepest one,
// that were taken at standstill (a motion of less than a quarter of the branch's usual speed), or that run
// over ground the branch has covered before (a minor loop).
[[nodiscard]] std::vector<LoopPoint> split_branches(std::vector<LoopPoint>& press);

}  // namespace enc::models
