// What the augmented view (core/vision/augment) is told of a run: all of it as the core believes it.
#pragma once

#include "core/vision/augment/augmented_view.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::app {

[[nodiscard]] AugmentedSpec believed_spec(const models::Setup& setup, const Scene& scene);

// After the tick in which the image came.
class BelievedMoment {
 public:
  [[nodiscard]] AugmentedMoment of(trial::Trial& trial);

 private:
  Quat q_WN_ = Quat::Identity();  // of the last surface that was near
};

}  // namespace enc::app
