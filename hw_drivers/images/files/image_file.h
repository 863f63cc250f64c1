// PNG and JPEG files as Images: colour and grey, which becomes RGB; of 16 bits the upper 8; what is
// transparent lies on black. No more than kLargest on a side. Every mistake is an Error of one line with the
// file's name.
#pragma once

#include <string>
#include <string_view>

#include "core/base/image.h"

namespace enc::images {

inline constexpr int kLargest = 16384;                 // px, width or height
inline constexpr std::int64_t kMostPixels = 1L << 26;  // 200 MB of memory

[[nodiscard]] bool is_image_name(std::string_view name);  // *.png, *.jpg, *.jpeg, in any case

// What its header says; pixels are not read.
[[nodiscard]] ImageSize image_size(const std::string& path);
// The whole file. `into` keeps its memory where the size is the same.
void read_image(const std::string& path, Image& into);
// The same of bytes; `name` is for messages.
void decode_image(std::string_view bytes, const std::string& name, Image& into);

// The bytes of a PNG, made quickly rather than small. Throws Error.
[[nodiscard]] std::string png_of(const ImageView& image);

}  // namespace enc::images
