// Pixel formats of a camera, and their conversion to RGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/image.h"
#include "core/base/words.h"

namespace enc::v4l2 {

// YUV 4:2:2 in bytes Y U Y V; JPEG for each frame; one grey byte a pixel; bytes R G B.
enum class Pixels : std::uint8_t { yuyv, mjpeg, grey, rgb };
constexpr auto words(Pixels) { return enum_words("YUYV", "MJPG", "GREY", "RGB3"); }
// Bytes of a row without padding; of MJPG the most that a row needs on average.
[[nodiscard]] constexpr std::size_t row_bytes(Pixels pixels, std::size_t width) {
  return (pixels == Pixels::grey ? 1 : pixels == Pixels::rgb ? 3 : 2) * width;
}

inline constexpr int kMostSide = 16384;  // px

// Four letters as the kernel's number, and back. A letter that is not printable becomes '?'.
[[nodiscard]] std::uint32_t code_of(Pixels pixels);
[[nodiscard]] std::string text_of(std::uint32_t code);

// The picture in a buffer.
struct Raster {
  Pixels pixels = Pixels::yuyv;
  int width = 0, height = 0;  // px
  std::size_t stride = 0;     // bytes of a row; MJPG: unused
};

// Converts frames. It keeps its memory from frame to frame.
class Decoder {
 public:
  Decoder();
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  // Returns false if the bytes are too few or damaged, or if a JPEG has another size. `into` is then
  // undefined.
  [[nodiscard]] bool whole(std::span<const std::uint8_t> bytes, const Raster& raster, Image& into);
  // The left image is in the left half. The width is even.
  [[nodiscard]] bool halves(std::span<const std::uint8_t> bytes, const Raster& raster, Image& left,
                            Image& right);

 private:
  [[nodiscard]] bool jpeg(std::span<const std::uint8_t> bytes, const Raster& raster, Image& into);

  struct Jpeg;
  std::unique_ptr<Jpeg> jpeg_;  // made with the first JPEG
  Image both_;
};

}  // namespace enc::v4l2
