// A stereo pair of a pointing hand by ray casting, without a renderer: a finger that ends in a half sphere, a
// fist, a wall behind. Surfaces have marks, so that they can be matched. The truth is exact.
#pragma once

#include <cstdint>

#include "core/devices/device.h"
#include "core/spec/optics_rig.h"
#include "core/vision/segmentation/segmenter.h"
#include "core/vision/stereo/rectify.h"

namespace enc::drawn {

struct HandAt {
  Vec3 tip{0, 0, 0.6};    // centre of the cap in C, m
  Vec3 along{0, -1, 0};   // direction from the knuckle to the tip
  double radius = 0.008;  // m
  double length = 0.07;   // m, to the fist
  bool fist = true;
  double palm = 0.035;  // m, radius of the fist
  double marks = 0.15;  // contrast of the skin
};

inline Time at_frame(int i) { return Time(Duration(50'000'000) * i); }  // 20 Hz

// Half the size, so that drawing takes a fifth of a second.
inline StereoRig small() {
  StereoRig rig;
  rig.width = 320;
  rig.height = 240;
  rig.left = rig.right = {360.5, 360.5, 159.5, 119.5, {}};
  return rig;
}

// 0 to 1, from three numbers.
double hashed(std::int64_t x, std::int64_t y, std::int64_t z);
// Smooth noise in space, 0 to 1.
double noise(const Vec3& p);

// One raw image; `skin` of the left one on request (more than half of the pixel).
void draw(const StereoRig& rig, Side side, const HandAt* hand, std::uint64_t seed, double sensor,
          Image& image, Mask* skin = nullptr);

struct Pair {
  Image left, right;
  [[nodiscard]] StereoFrame frame() const { return {left.view(), right.view()}; }
};
inline Pair pair_of(const StereoRig& rig, const HandAt* hand, std::uint64_t seed = 1, double sensor = 1.5) {
  Pair pair;
  draw(rig, Side::left, hand, seed, sensor, pair.left);
  draw(rig, Side::right, hand, seed, sensor, pair.right);
  return pair;
}

// Skin of the drawn hand; the wall is of another hue.
inline SegmentationSpec segmentation() {
  SegmentationSpec spec;
  spec.background_frames = 2;
  spec.model = {0.385, 0.06};  // rad, hue of (205, 150, 118)
  return spec;
}

}  // namespace enc::drawn
