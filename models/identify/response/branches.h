// Splits the readings of a press into pressing and releasing, at any ratio of their speeds and with any hold
// between them.
#pragma once

#include <vector>

#include "models/identify/response/response_fit.h"

namespace enc::models {

// Splits a press at its deepest reading: sets `pressing` and `held` of each reading, and returns those of
// either branch, in order of time. It leaves out readings within the noise of the deepest one. It also leaves
// out readings at standstill (a motion of less than a quarter of the branch's usual speed), and readings over
// a range that the branch has covered before (a minor loop).
[[nodiscard]] std::vector<LoopPoint> split_branches(std::vector<LoopPoint>& press);

}  // namespace enc::models
