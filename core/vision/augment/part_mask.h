// Where a part of the arm is in the rectified left image, as it is believed to stand.
#pragma once

#include "core/base/image.h"
#include "core/machine/arm_shape.h"
#include "core/vision/stereo/rectify.h"

namespace enc::augment {

// Turns on the pixels of the part and those nearer than `margin` px to it. Of what is not in front of the
// camera only the rest counts.
void cover(const RectifiedPair& pair, const Pose<'C', 'W'>& X_CW, const ArmPart& part, double margin,
           Mask& mask);

}  // namespace enc::augment
