// Export of the images module besides playback: writing an image to a file.
#pragma once

#include <string>

#include "core/base/image.h"

namespace enc {

struct FrameFiles {
  // The bytes of a PNG without loss of pixels. Throws Error.
  std::string (*png)(const ImageView& image) = nullptr;
};

}  // namespace enc
