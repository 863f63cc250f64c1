// Parts of the benchmark `fingertip`.
#pragma once

#include <cstdint>

#include "benchmarks/kit/kit.h"
#include "benchmarks/staged/staged.h"
#include "core/spec/vision_rig.h"

namespace enc::bench::fingertip {

// A frame of the background alone: drawn once, exposed anew for each further frame.
inline void expose(sim::Stage& stage, std::uint64_t frame, staged::Pair& pair) {
  if (frame == 0)
    stage.draw(nullptr, {}, {}, frame, pair.left, pair.right);
  else
    stage.again(frame, pair.left, pair.right);
}

// Detections for several values of each factor of steps 5 to 7. Uses training seeds, so that a value chosen
// by them is not tuned on the judged seeds.
namespace factors {
void tell(Bench& bench, const sim::CameraModule& camera, const VisionRig& vision);
}

}  // namespace enc::bench::fingertip
