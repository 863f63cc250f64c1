// Lettering of a picture: a title, and labels in both margins with lines to their objects.
#pragma once

#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/view.h"

namespace enc::sim {

// `finer`: number of pixels of `picture` for one pixel of the final picture.
void letter(Image& picture, const mjvScene& scene, const mjrContext& context, const ViewRequest& request,
            int finer);

}  // namespace enc::sim
