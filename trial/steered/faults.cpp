#include "trial/steered/faults.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {

void Faults::apply(Inputs& in) {
  if (in.tool.health != Health::absent && in.tool.t != tool_.t) {  // else it is what the core was told last
    if (in.tool.t != read_) ++samples_;
    read_ = in.tool.t;
    const bool told = tool_.health != Health::absent;
    const bool lost = (bits_ & kFrozenTracker) != 0 || ((bits_ & kDroppedPackets) != 0 && samples_ % 4 != 0);
    if (lost && told)
      in.tool = tool_;
    else if ((bits_ & kLateClock) != 0)
      in.tool.t -= from_seconds(kLate);
    tool_ = in.tool;
  }
  if ((bits_ & kSaturated) == 0 || in.wrench.health != Health::ok) return;
  for (double& one : in.wrench.value.force.xyz) {
    if (std::abs(one) <= kRange) continue;
    one = std::clamp(one, -kRange, kRange);
    in.wrench.health = Health::saturated;
  }
}

}  // namespace enc::trial
