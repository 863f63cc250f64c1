#include "hw_drivers/v4l2/wire/pixels.h"

#include <algorithm>
#include <cstring>

#include <turbojpeg.h>

namespace enc::v4l2 {

// ---- names of formats

std::uint32_t code_of(Pixels pixels) {
  const std::string_view word = word_of(pixels);
  std::uint32_t code = 0;
  for (std::size_t i = 4; i-- > 0;) code = code << 8U | static_cast<unsigned char>(word[i]);
  return code;
}

std::string text_of(std::uint32_t code) {
  std::string text;
  for (int i = 0; i < 4; ++i, code >>= 8U) {
    const auto letter = static_cast<char>(code & 0x7fU);
    text += letter >= ' ' && letter < 0x7f ? letter : '?';
  }
  while (text.ends_with(' ')) text.pop_back();  // "Y16 "
  return text;
}

// ---- pictures

namespace {

void make_room(int width, int height, Image& into) {
  if (into.width != width || into.height != height) into = Image(width, height);
}

std::uint8_t byte_of(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

// BT.601 of limited range, 16 bits behind the point, as UVC cameras send it.
void put_rgb(int y, int u, int v, std::uint8_t* rgb) {
  const int grey = 76309 * (y - 16) + 32768;
  rgb[0] = byte_of((grey + 104597 * (v - 128)) >> 16);
  rgb[1] = byte_of((grey - 25675 * (u - 128) - 53279 * (v - 128)) >> 16);
  rgb[2] = byte_of((grey + 132201 * (u - 128)) >> 16);
}

// Columns from `from` on, which is even.
void cut_yuyv(const std::uint8_t* bytes, std::size_t stride, int from, Image& into) {
  for (int y = 0; y < into.height; ++y) {
    const std::uint8_t* row = bytes + static_cast<std::size_t>(y) * stride + 2 * from;
    for (int x = 0; x < into.width; ++x) {
      const std::uint8_t* two = row + 4 * (x / 2);
      put_rgb(two[2 * (x % 2)], two[1], two[3], into.at(x, y));
    }
  }
}

void cut_grey(const std::uint8_t* bytes, std::size_t stride, int from, Image& into) {
  for (int y = 0; y < into.height; ++y) {
    const std::uint8_t* row = bytes + static_cast<std::size_t>(y) * stride + from;
    for (int x = 0; x < into.width; ++x) std::fill_n(into.at(x, y), 3, row[x]);
  }
}

void cut_rgb(const std::uint8_t* bytes, std::size_t stride, int from, Image& into) {
  const std::size_t row = row_bytes(Pixels::rgb, static_cast<std::size_t>(into.width));
  for (int y = 0; y < into.height; ++y)
    std::memcpy(into.at(0, y), bytes + static_cast<std::size_t>(y) * stride + 3 * from, row);
}

// True if the bytes hold the whole raster.
bool fits(std::span<const std::uint8_t> bytes, const Raster& raster) {
  const auto width = static_cast<std::size_t>(raster.width), height = static_cast<std::size_t>(raster.height);
  if (raster.width < 1 || raster.height < 1 || raster.width > kMostSide || raster.height > kMostSide)
    return false;
  if (raster.pixels == Pixels::mjpeg) return true;
  const std::size_t row = row_bytes(raster.pixels, width);
  if (raster.pixels == Pixels::yuyv && width % 2 != 0) return false;
  return raster.stride >= row && bytes.size() >= row && (bytes.size() - row) / raster.stride >= height - 1;
}

void cut(const std::uint8_t* bytes, const Raster& raster, int from, Image& into) {
  const auto cut_as = raster.pixels == Pixels::yuyv   ? &cut_yuyv
                      : raster.pixels == Pixels::grey ? &cut_grey
                                                      : &cut_rgb;
  cut_as(bytes, raster.stride, from, into);
}

}  // namespace

struct Decoder::Jpeg {
  tjhandle handle = tjInitDecompress();
  Jpeg() = default;
  ~Jpeg() { tjDestroy(handle); }
  Jpeg(const Jpeg&) = delete;
  Jpeg& operator=(const Jpeg&) = delete;
};

Decoder::Decoder() = default;
Decoder::~Decoder() = default;

// The size is checked before a pixel is decoded. A warning, such as an early end, counts as damage, because a
// JPEG has no checksum.
bool Decoder::jpeg(std::span<const std::uint8_t> bytes, const Raster& raster, Image& into) {
  if (!jpeg_) jpeg_ = std::make_unique<Jpeg>();
  int width = 0, height = 0, sampling = 0, colours = 0;
  if (bytes.empty() || tjDecompressHeader3(jpeg_->handle, bytes.data(), bytes.size(), &width, &height,
                                           &sampling, &colours) != 0)
    return false;
  if (width != raster.width || height != raster.height) return false;
  make_room(width, height, into);
  return tjDecompress2(jpeg_->handle, bytes.data(), bytes.size(), into.rgb.data(), width, 0, height, TJPF_RGB,
                       TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS) == 0;
}

bool Decoder::whole(std::span<const std::uint8_t> bytes, const Raster& raster, Image& into) {
  if (!fits(bytes, raster)) return false;
  if (raster.pixels == Pixels::mjpeg) return jpeg(bytes, raster, into);
  make_room(raster.width, raster.height, into);
  cut(bytes.data(), raster, 0, into);
  return true;
}

bool Decoder::halves(std::span<const std::uint8_t> bytes, const Raster& raster, Image& left, Image& right) {
  const int half = raster.width / 2;
  if (!fits(bytes, raster) || raster.width % 2 != 0 || half < 1) return false;
  if (raster.pixels == Pixels::yuyv && half % 2 != 0) return false;
  if (raster.pixels == Pixels::mjpeg && !jpeg(bytes, raster, both_)) return false;
  int from = 0;
  for (Image* into : {&left, &right}) {
    make_room(half, raster.height, *into);
    if (raster.pixels == Pixels::mjpeg)
      cut_rgb(both_.rgb.data(), 6 * static_cast<std::size_t>(half), from, *into);
    else
      cut(bytes.data(), raster, from, *into);
    from += half;
  }
  return true;
}

}  // namespace enc::v4l2
