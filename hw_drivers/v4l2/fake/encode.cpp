#include "hw_drivers/v4l2/fake/encode.h"

#include <algorithm>
#include <cstring>

#include <turbojpeg.h>

#include "core/base/error.h"

namespace enc::v4l2 {
namespace {

// BT.601 of limited range, 16 bits behind the point.
int luma(const std::uint8_t* rgb) {
  return 16 + ((16829 * rgb[0] + 33039 * rgb[1] + 6416 * rgb[2] + 32768) >> 16);
}

// Two pixels share the colour of their mean.
void put_two(const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* into) {
  const int red = a[0] + b[0], green = a[1] + b[1], blue = a[2] + b[2];
  into[0] = static_cast<std::uint8_t>(luma(a));
  into[1] = static_cast<std::uint8_t>(128 + ((-9714 * red - 19070 * green + 28784 * blue + 65536) >> 17));
  into[2] = static_cast<std::uint8_t>(luma(b));
  into[3] = static_cast<std::uint8_t>(128 + ((28784 * red - 24103 * green - 4681 * blue + 65536) >> 17));
}

void put_yuyv(const ImageView& view, int from, std::size_t stride, std::vector<std::uint8_t>& bytes) {
  for (int y = 0; y < view.height; ++y) {
    std::uint8_t* row = bytes.data() + static_cast<std::size_t>(y) * stride + 2 * from;
    for (int x = 0; x + 1 < view.width; x += 2) put_two(view.at(x, y), view.at(x + 1, y), row + 2 * x);
  }
}

// Full range, as cameras send grey.
void put_grey(const ImageView& view, int from, std::size_t stride, std::vector<std::uint8_t>& bytes) {
  for (int y = 0; y < view.height; ++y) {
    std::uint8_t* row = bytes.data() + static_cast<std::size_t>(y) * stride + from;
    for (int x = 0; x < view.width; ++x) {
      const std::uint8_t* rgb = view.at(x, y);
      row[x] = static_cast<std::uint8_t>((19595 * rgb[0] + 38470 * rgb[1] + 7471 * rgb[2] + 32768) >> 16);
    }
  }
}

void put_rgb(const ImageView& view, int from, std::size_t stride, std::vector<std::uint8_t>& bytes) {
  const std::size_t row = row_bytes(Pixels::rgb, static_cast<std::size_t>(view.width));
  for (int y = 0; y < view.height; ++y)
    std::memcpy(bytes.data() + static_cast<std::size_t>(y) * stride + 3 * from, view.at(0, y), row);
}

}  // namespace

struct Encoder::Jpeg {
  tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  Jpeg() = default;
  ~Jpeg() {
    tjFree(bytes);
    tjDestroy(handle);
  }
  Jpeg(const Jpeg&) = delete;
  Jpeg& operator=(const Jpeg&) = delete;
};

Encoder::Encoder() = default;
Encoder::~Encoder() = default;

void Encoder::jpeg(const ImageView& left, const ImageView* right) {
  constexpr int kQuality = 90;
  if (!jpeg_) jpeg_ = std::make_unique<Jpeg>();
  ImageView view = left;
  if (right != nullptr) {
    both_ = Image(2 * left.width, left.height);
    for (int y = 0; y < left.height; ++y) {
      std::memcpy(both_.at(0, y), left.at(0, y), 3 * static_cast<std::size_t>(left.width));
      std::memcpy(both_.at(left.width, y), right->at(0, y), 3 * static_cast<std::size_t>(left.width));
    }
    view = both_.view();
  }
  if (tjCompress2(jpeg_->handle, view.rgb, view.width, 0, view.height, TJPF_RGB, &jpeg_->bytes, &jpeg_->size,
                  TJSAMP_422, kQuality, 0) != 0)
    throw Error(std::string("a fake camera makes no JPEG: ") + tjGetErrorStr2(jpeg_->handle));
  bytes_.assign(jpeg_->bytes, jpeg_->bytes + jpeg_->size);
}

const std::vector<std::uint8_t>& Encoder::encode(Pixels pixels, const ImageView& left,
                                                 const ImageView* right) {
  if (pixels == Pixels::mjpeg) {
    jpeg(left, right);
    return bytes_;
  }
  const std::size_t stride =
      row_bytes(pixels, static_cast<std::size_t>(left.width)) * (right != nullptr ? 2 : 1);
  bytes_.resize(stride * static_cast<std::size_t>(left.height));
  const auto put = pixels == Pixels::yuyv ? &put_yuyv : pixels == Pixels::grey ? &put_grey : &put_rgb;
  put(left, 0, stride, bytes_);
  if (right != nullptr) put(*right, left.width, stride, bytes_);
  return bytes_;
}

}  // namespace enc::v4l2
