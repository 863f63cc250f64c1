#include "core/vision/ball/blob.h"

#include <cmath>
#include <numbers>

#include "core/vision/segmentation/kernels/hue.h"

namespace enc {
namespace {

using segmentation::kHues;
constexpr int kFullScale = 254;
constexpr std::uint8_t kOpen = 255, kCounted = 1;

int of_circle(double angle) {
  return static_cast<int>(std::lround(angle * kHues / (2.0 * std::numbers::pi)));
}

}  // namespace

BlobFinder::BlobFinder(const BallSpec& spec)
    : hue_(of_circle(spec.hue)),
      within_(of_circle(spec.hue_within)),
      saturation_(static_cast<int>(std::lround(256.0 * spec.least_saturation))) {}

void BlobFinder::colour(const ImageView& image) {
  if (mask_.width != image.width || mask_.height != image.height) mask_ = Mask(image.width, image.height);
  const segmentation::HueRule rule;
  const std::uint8_t* p = image.rgb;
  for (std::uint8_t& on : mask_.on) {
    const int r = p[0], g = p[1], b = p[2];
    p += 3;
    const int most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b));
    on = 0;
    // Most pixels of a room end here.
    if (256 * (most - least) < saturation_ * most || !segmentation::has_hue(most, least, rule)) continue;
    const int off = segmentation::hue_of_any(r, g, b, most, least) - hue_;
    const int round = ((off + kHues / 2) % kHues + kHues) % kHues - kHues / 2;
    if (std::abs(round) <= within_) on = kOpen;
  }
}

Blob BlobFinder::flood(const ImageView& image, int at) {
  Blob blob;
  const int width = mask_.width, height = mask_.height;
  Vec3 sum = Vec3::Zero();
  double columns = 0.0, rows = 0.0;
  int clipped = 0;
  blob.box = {width, height, 0, 0};
  const auto enter = [&](int i) {
    if (mask_.on[static_cast<std::size_t>(i)] != kOpen) return;
    mask_.on[static_cast<std::size_t>(i)] = kCounted;
    waiting_.push_back(i);
  };
  waiting_.clear();
  enter(at);
  while (!waiting_.empty()) {
    const int i = waiting_.back(), x = i % width, y = i / width;
    waiting_.pop_back();
    const std::uint8_t* p = image.at(x, y);
    sum += Vec3(p[0], p[1], p[2]);
    clipped += p[0] >= kFullScale || p[1] >= kFullScale || p[2] >= kFullScale ? 1 : 0;
    columns += x;
    rows += y;
    ++blob.pixels;
    blob.box = {std::min(blob.box.x0, x), std::min(blob.box.y0, y), std::max(blob.box.x1, x + 1),
                std::max(blob.box.y1, y + 1)};
    if (x > 0) enter(i - 1);
    if (x + 1 < width) enter(i + 1);
    if (y > 0) enter(i - width);
    if (y + 1 < height) enter(i + width);
  }
  blob.colour = sum / blob.pixels;
  blob.column = columns / blob.pixels;
  blob.row = rows / blob.pixels;
  blob.clipped = static_cast<double>(clipped) / blob.pixels;
  return blob;
}

Blobs BlobFinder::largest(const ImageView& image, int least) {
  colour(image);
  Blobs all;
  for (std::size_t i = 0; i < mask_.on.size(); ++i) {
    if (mask_.on[i] != kOpen) continue;
    const Blob blob = flood(image, static_cast<int>(i));
    if (blob.pixels < least) continue;
    std::size_t at = all.count < kMostBlobs ? all.count++ : kMostBlobs;
    for (; at > 0 && all.blob[at - 1].pixels < blob.pixels; --at)
      if (at < kMostBlobs) all.blob[at] = all.blob[at - 1];
    if (at < kMostBlobs) all.blob[at] = blob;
  }
  return all;
}

}  // namespace enc
