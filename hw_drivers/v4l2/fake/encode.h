// Pictures as a camera sends them: the inverse of wire/pixels.h.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/image.h"
#include "hw_drivers/v4l2/wire/pixels.h"

namespace enc::v4l2 {

class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // The bytes of a frame, valid until the next call. `right`: beside it, of equal size; null: none. YUYV
  // needs even widths.
  [[nodiscard]] const std::vector<std::uint8_t>& encode(Pixels pixels, const ImageView& left,
                                                        const ImageView* right = nullptr);

 private:
  void jpeg(const ImageView& left, const ImageView* right);

  struct Jpeg;
  std::unique_ptr<Jpeg> jpeg_;  // made with the first JPEG
  std::vector<std::uint8_t> bytes_;
  Image both_;
};

}  // namespace enc::v4l2
