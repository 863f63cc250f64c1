// PNG and JPEG files as Images: colour, and grey converted to RGB; 16-bit values keep their upper 8 bits;
// transparent pixels are blended with black. No side may exceed kLargest. Every fault is an Error in one line
// with the file's name.
#pragma once

#include <string>
#include <string_view>

#include "core/base/image.h"

namespace enc::images {

inline constexpr int kLargest = 16384;                 // px, width or height
inline constexpr std::int64_t kMostPixels = 1L << 26;  // 200 MB of memory

[[nodiscard]] bool is_image_name(std::string_view name);  // *.png, *.jpg, *.jpeg, in any case

// The size from the file's header; pixels are not read.
[[nodiscard]] ImageSize image_size(const std::string& path);
// Reads the whole file. `into` keeps its memory if the size is unchanged.
void read_image(const std::string& path, Image& into);
// Reads an image from bytes; `name` is for messages.
void decode_image(std::string_view bytes, const std::string& name, Image& into);

// The bytes of a PNG, optimised for speed rather than size. Throws Error.
[[nodiscard]] std::string png_of(const ImageView& image);

}  // namespace enc::images
