// What the module of images does besides playing them: how an image becomes a file.
#pragma once

#include <string>

#include "core/base/image.h"

namespace enc {

struct FrameFiles {
  // The bytes of a PNG, from which the same pixels come back. Throws Error.
  std::string (*png)(const ImageView& image) = nullptr;
};

}  // namespace enc
