// What the benchmarks of vision look at: hands before the twin's stereo head, drawn at random, and their
// images for the report.
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

// Seeds of sceneries and hands. Skin is learned from the first, judged by the others; the last were looked at
// by nobody while vision was built.
inline constexpr std::uint64_t kTraining = 1000, kTest = 2000, kNeverSeen = 1'000'000'000;

// Of the user's --seed: where the benchmark's sceneries begin. Throws Error for one that reaches those that
// nobody looked at.
[[nodiscard]] std::uint64_t test_seed(const BenchContext& context);
// The module that draws. Throws Error where it is not built.
[[nodiscard]] const sim::CameraModule& camera(const BenchContext& context);

// A rectified head of a size, with the field of view of the default one.
[[nodiscard]] StereoRig head(int width);

struct Draw {
  double near = 0.300, far = 0.900;    // m, depth of the tip
  double thin = 0.010, thick = 0.025;  // m, width of the finger
  double tilt = 0.6;                   // rad, the finger out of the image's plane, either way
};
// m, of the finger of one of so many persons: evenly from thin to thick, as Draw has them.
[[nodiscard]] double finger_width(std::size_t person, std::size_t persons);
struct Shot {
  sim::HandPose pose;
  sim::HandLook look;
};
// From all sides; the tip where both cameras see it, half a finger's length from the edges.
[[nodiscard]] Shot drawn(const StereoRig& rig, const Draw& draw, sim::Tone tone, sim::Stream& stream);

// Skin of all tones in the office, from training seeds; and of each alone, where asked for.
[[nodiscard]] SkinModel learned_skin(const sim::CameraModule& camera, int width,
                                     std::vector<SkinModel>* by_tone = nullptr);

// One exposure.
struct Pair {
  Image left, right;
  sim::PixelTruth truth;
};

// px: a tip that is found farther from the true one is another thing, not a tip found badly.
[[nodiscard]] double within_cap(const sim::PixelTruth& truth);

// Images side by side, as the bytes of a PNG.
[[nodiscard]] std::string png(const std::vector<Image>& images);
[[nodiscard]] Image image_of(const Mask& mask);
// A cross, for the eye.
void mark(Image& image, double column, double row, const std::array<std::uint8_t, 3>& ink, int size = 6);

}  // namespace enc::bench::staged
