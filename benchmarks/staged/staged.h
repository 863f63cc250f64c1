// Input of the vision benchmarks: random hands before the twin's stereo head, and their images for the
// report.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/kit/kit.h"
#include "core/vision/segmentation/skin.h"
#include "sim/camera/stage.h"
#include "sim/truth/random.h"

namespace enc::bench::staged {

// Seeds of sceneries and hands. Skin is learned from the first and judged by the others; the last were not
// used while vision was built.
inline constexpr std::uint64_t kTraining = 1000, kTest = 2000, kNeverSeen = 1'000'000'000;

// Start of the benchmark's sceneries, from the user's --seed. Throws Error for a seed that reaches those not
// used while vision was built.
[[nodiscard]] std::uint64_t test_seed(const BenchContext& context);
// The module that draws. Throws Error if it was not built.
[[nodiscard]] const sim::CameraModule& camera(const BenchContext& context);

// A rectified head of this width, with the field of view of the default head.
[[nodiscard]] StereoRig head(int width);

struct Draw {
  double near = 0.300, far = 0.900;    // m, depth of the tip
  double thin = 0.010, thick = 0.025;  // m, width of the finger
  double tilt = 0.6;                   // rad, largest tilt of the finger out of the image's plane, either way
};
// m, finger width of one of `persons`: evenly from thin to thick, as in Draw.
[[nodiscard]] double finger_width(std::size_t person, std::size_t persons);
struct Shot {
  sim::HandPose pose;
  sim::HandLook look;
};
// A hand from any side; both cameras see its tip, half a finger's length from the edges.
[[nodiscard]] Shot drawn(const StereoRig& rig, const Draw& draw, sim::Tone tone, sim::Stream& stream);

// Skin of all tones in the office, from training seeds; and of each tone alone, if requested.
[[nodiscard]] SkinModel learned_skin(const sim::CameraModule& camera, int width,
                                     std::vector<SkinModel>* by_tone = nullptr);

// One exposure.
struct Pair {
  Image left, right;
  sim::PixelTruth truth;
};

// px: a detected tip farther from the true one counts as another object, not as an inaccurate tip.
[[nodiscard]] double within_cap(const sim::PixelTruth& truth);

// Images side by side, as the bytes of a PNG.
[[nodiscard]] std::string png(const std::vector<Image>& images);
[[nodiscard]] Image image_of(const Mask& mask);
// A cross, for the eye.
void mark(Image& image, double column, double row, const std::array<std::uint8_t, 3>& ink, int size = 6);

}  // namespace enc::bench::staged
