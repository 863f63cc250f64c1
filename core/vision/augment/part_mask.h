// Pixels of an arm's part in the rectified left image, by the part's modelled position.
#pragma once

#include "core/base/image.h"
#include "core/machine/arm_shape.h"
#include "core/vision/stereo/rectify.h"

namespace enc::augment {

// Sets the pixels of the part, and those within `margin` px of it. Only the portion of the part in front of
// the camera counts.
void cover(const RectifiedPair& pair, const Pose<'C', 'W'>& X_CW, const ArmPart& part, double margin,
           Mask& mask);

}  // namespace enc::augment
