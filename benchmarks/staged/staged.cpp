#include "benchmarks/staged/staged.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "sim/camera/camera_scene.h"
#include "sim/picture/picture.h"

namespace enc::bench::staged {

std::uint64_t test_seed(const BenchContext& context) {
  constexpr std::uint64_t kEach = 1000, kMost = (kNeverSeen - kTest) / kEach - 1;
  if (context.seed > kMost)
    throw Error("the seed is " + std::to_string(context.seed) + "; here it is at most " +
                std::to_string(kMost) + ", because sceneries from " + std::to_string(kNeverSeen) +
                " on are kept for what nobody looked at");
  return kTest + context.seed * kEach;
}

const sim::CameraModule& camera(const BenchContext& context) {
  const ModuleInfo* module = context.module ? context.module("camera") : nullptr;
  if (module == nullptr || module->camera == nullptr)
    throw Error(
        "the benchmark draws what a camera sees, and the module 'camera' was not built; './encounter bench' "
        "builds it",
        {}, ErrorKind::device);
  return *static_cast<const sim::CameraModule*>(module->camera);
}

StereoRig head(int width) {
  StereoRig rig;
  const double size = static_cast<double>(width) / 640.0;
  rig.width = width;
  rig.height = width * 3 / 4;
  rig.left = rig.right = pinhole(rig.width, rig.height, 721.0 * size);
  return rig;
}

double finger_width(std::size_t person, std::size_t persons) {
  constexpr Draw kAll;
  return kAll.thin +
         (kAll.thick - kAll.thin) * (static_cast<double>(person) + 0.5) / static_cast<double>(persons);
}

Shot drawn(const StereoRig& rig, const Draw& draw, sim::Tone tone, sim::Stream& stream) {
  const auto between = [&](double low, double high) { return low + (high - low) * stream.uniform(); };
  const double z = between(draw.near, draw.far);
  const double focal = rig.left.focal_x;
  const double disparity = focal * rig.X_CD.p().x() / z;
  const double margin = focal * 0.03 / z;
  const double column = between(disparity + margin, static_cast<double>(rig.width) - margin);
  const double row = between(margin, static_cast<double>(rig.height) - margin);
  Shot shot;
  shot.pose.tip =
      Point<'C'>((column - rig.left.centre_x) * z / focal, (row - rig.left.centre_y) * z / focal, z);
  const double side = between(0.0, 2.0 * std::numbers::pi), tilt = between(-draw.tilt, draw.tilt);
  shot.pose.along =
      Vec<'C'>(std::cos(tilt) * std::cos(side), std::cos(tilt) * std::sin(side), std::sin(tilt));
  shot.pose.roll = between(0.0, 2.0 * std::numbers::pi);
  shot.look.finger_width = between(draw.thin, draw.thick);
  shot.look.skin = sim::skin_colour(tone);
  return shot;
}

SkinModel learned_skin(const sim::CameraModule& camera, int width, std::vector<SkinModel>* by_tone) {
  constexpr int kHands = 4;  // of each tone
  const StereoRig rig = head(width);
  SkinLearner learner;
  sim::Stream stream(kTraining, "training");
  Pair pair;
  for (const sim::SkinTone& tone : sim::kSkinTones) {
    sim::StageSpec spec;
    spec.camera = rig;
    spec.seed = kTraining + static_cast<std::uint64_t>(tone.tone);
    const auto stage = camera.stage(spec);
    SkinLearner alone;
    for (int i = 0; i < kHands; ++i) {
      const Shot shot = drawn(rig, {.near = 0.3, .far = 0.5}, tone.tone, stream);
      stage->draw(&shot.pose, shot.look, {}, static_cast<std::uint64_t>(i), pair.left, pair.right,
                  &pair.truth);
      learner.add(pair.left.view(), pair.truth.skin);
      alone.add(pair.left.view(), pair.truth.skin);
    }
    if (by_tone != nullptr) by_tone->push_back(alone.model());
  }
  return learner.model();
}

double within_cap(const sim::PixelTruth& truth) { return std::max(2.0, truth.radius); }

std::string png(const std::vector<Image>& images) {
  int width = 0, height = 0;
  for (const Image& image : images) {
    width += image.width;
    height = std::max(height, image.height);
  }
  Image picture(width, height);
  int from = 0;
  for (const Image& image : images) {
    for (int y = 0; y < image.height; ++y)
      std::copy_n(image.view().at(0, y), 3 * static_cast<std::size_t>(image.width), picture.at(from, y));
    from += image.width;
  }
  return sim::png(picture);
}

Image image_of(const Mask& mask) {
  Image image(mask.width, mask.height);
  for (std::size_t i = 0; i < mask.on.size(); ++i)
    std::fill_n(image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, mask.on[i]);
  return image;
}

void mark(Image& image, double column, double row, const std::array<std::uint8_t, 3>& ink, int size) {
  const auto x0 = static_cast<int>(std::lround(column)), y0 = static_cast<int>(std::lround(row));
  const Region whole{0, 0, image.width, image.height};
  for (int d = -size; d <= size; ++d)
    for (const auto& [x, y] : {std::pair{x0 + d, y0}, std::pair{x0, y0 + d}})
      if (whole.contains(x, y)) std::copy(ink.begin(), ink.end(), image.at(x, y));
}

}  // namespace enc::bench::staged
