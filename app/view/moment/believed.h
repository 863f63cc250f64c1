// Inputs of the augmented view (core/vision/augment) for a run, all as the core has them.
#pragma once

#include "core/vision/augment/augmented_view.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::app {

[[nodiscard]] AugmentedSpec believed_spec(const models::Setup& setup, const Scene& scene);

// The moment after the tick in which the image came.
class BelievedMoment {
 public:
  [[nodiscard]] AugmentedMoment of(trial::Trial& trial);

 private:
  Quat q_WN_ = Quat::Identity();  // orientation of the last near surface
};

}  // namespace enc::app
