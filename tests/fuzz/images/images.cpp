// Pictures of cameras: PNG and JPEG. An accepted picture has the size from its header.

#include <turbojpeg.h>
#include <zlib.h>

#include "hw_drivers/images/files/image_file.h"
#include "tests/fuzz/machine/fuzzing.h"
#include "tests/fuzz/targets/seeds.h"

namespace enc::fuzz {
namespace {

Image picture() {
  Image image(12, 9);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint8_t>(7 * i);
  return image;
}

std::string jpeg_of(const Image& image, int samples, int flags) {
  const tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  tjCompress2(handle, image.rgb.data(), image.width, 0, image.height, TJPF_RGB, &bytes, &size, samples, 90,
              flags);
  std::string text(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(handle);
  return text;
}

bool read(const std::string& input) {
  static const Folder kFolder;
  const ImageSize said = images::image_size(kFolder.write("fuzz.image", input));
  Image image;
  images::decode_image(input, "fuzz.image", image);
  expect(image.width == said.width && image.height == said.height, "its header said another size");
  expect(
      image.rgb.size() == 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
      "it lacks pixels");
  return true;
}

// Corrects the checksum of each chunk.
void mend_png(std::string& bytes) {
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes[i]);
    return value;
  };
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t size = number(at);
    if (size > bytes.size() || at + 12 + size > bytes.size()) return;
    const unsigned long sum =
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + at + 4), static_cast<uInt>(size + 4));
    for (std::size_t i = 0; i < 4; ++i) bytes[at + 8 + size + i] = static_cast<char>(sum >> (24 - 8 * i));
    at += 12 + size;
  }
}

// A header may claim as many pixels as an image may have.
constexpr Bound kBound{256, 3 * static_cast<std::size_t>(images::kMostPixels) + (4U << 20U)};

Target png() {
  Target target;
  target.seeds = {images::png_of(picture().view())};
  target.tokens = {"IHDR", "IDAT", "IEND", "PLTE", "tRNS", "gAMA", "iCCP", std::string(4, '\0')};
  target.run = &read;
  target.mend = &mend_png;
  target.bound = kBound;
  return target;
}

Target jpeg() {
  Target target;
  target.seeds = {jpeg_of(picture(), TJSAMP_444, 0), jpeg_of(picture(), TJSAMP_420, TJFLAG_PROGRESSIVE),
                  jpeg_of(picture(), TJSAMP_GRAY, 0)};
  target.tokens = jpeg_tokens();
  target.run = &read;
  target.bound = kBound;
  return target;
}

const Offer kPng("png", &png), kJpeg("jpeg", &jpeg);

}  // namespace
}  // namespace enc::fuzz
