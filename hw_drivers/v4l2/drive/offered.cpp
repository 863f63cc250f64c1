#include "hw_drivers/v4l2/drive/offered.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <linux/videodev2.h>

#include "hw_drivers/v4l2/wire/pixels.h"

namespace enc::v4l2 {
namespace {

constexpr std::uint32_t kMostListed = 64;  // of each list: a faulty device may never end one

std::string rates_of(System& system, int descriptor, const v4l2_frmsizeenum& size) {
  std::vector<double> rates;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_frmivalenum of{};
    of.index = i;
    of.pixel_format = size.pixel_format;
    of.width = size.discrete.width;
    of.height = size.discrete.height;
    if (system.control(descriptor, VIDIOC_ENUM_FRAMEINTERVALS, &of) != 0) break;
    if (of.type != V4L2_FRMIVAL_TYPE_DISCRETE || of.discrete.numerator == 0) break;
    rates.push_back(of.discrete.denominator / static_cast<double>(of.discrete.numerator));
  }
  std::sort(rates.begin(), rates.end());
  std::string text;
  for (const double rate : rates) text += fmt::format("{}{:.4g}", text.empty() ? " at " : ", ", rate);
  return text.empty() ? text : text + " Hz";
}

}  // namespace

std::string offered_by(System& system, int descriptor) {
  std::string text;
  int count = 0;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_fmtdesc format{};
    format.index = i;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (system.control(descriptor, VIDIOC_ENUM_FMT, &format) != 0) break;
    for (std::uint32_t j = 0; j < kMostListed; ++j) {
      v4l2_frmsizeenum size{};
      size.index = j;
      size.pixel_format = format.pixelformat;
      if (system.control(descriptor, VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
      if (++count > kMostOffered) return text + "; and more";
      if (!text.empty()) text += "; ";
      if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
        text += fmt::format("{} up to {} x {}", text_of(format.pixelformat), size.stepwise.max_width,
                            size.stepwise.max_height);
        break;
      }
      text += fmt::format("{} {} x {}{}", text_of(format.pixelformat), size.discrete.width,
                          size.discrete.height, rates_of(system, descriptor, size));
    }
  }
  return text;
}

}  // namespace enc::v4l2
