// Lettering of a picture: labels in both margins with lines to what they name, and a title.
#pragma once

#include "sim/bodies/mujoco.h"
#include "sim/picture/picture.h"
#include "sim/view/view.h"

namespace enc::sim {

// `finer`: how many pixels of `picture` one pixel of the final picture has.
void letter(Image& picture, const mjvScene& scene, const mjrContext& context, const ViewRequest& request,
            int finer);

}  // namespace enc::sim
