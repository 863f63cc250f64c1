// The export of encounter_vision.so.
#include "core/devices/module.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/vision/stereo/rectify.h"
#include "core/vision/vision_module.h"
#include "core/vision/vision_tracker.h"

namespace enc {
namespace {

// The painter of the vision module.
class RectifiedPainter final : public SeenPainter {
 public:
  explicit RectifiedPainter(const StereoRig& rig) : rectifier_(rig) {}
  [[nodiscard]] SeenPair draw(const StereoFrame& frame, const PoseTracker& tracker) const override;

 private:
  Rectifier rectifier_;
};

using Ink = std::array<std::uint8_t, 3>;
constexpr Ink kBelieved{220, 30, 40}, kDoubted{150, 150, 150}, kCandidate{250, 200, 40},
    kWindow{40, 110, 190};

void dot(Image& image, double x, double y, const Ink& ink) {
  const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
  if (column < 0 || row < 0 || column >= image.width || row >= image.height) return;
  std::copy(ink.begin(), ink.end(), image.at(column, row));
}

void circle(Image& image, double x, double y, double radius, const Ink& ink) {
  if (!(radius > 0.0) || !std::isfinite(x + y + radius)) return;
  for (const double r : {radius, radius + 1.0}) {
    const int steps = static_cast<int>(8.0 * r) + 8;
    for (int i = 0; i < steps; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / steps;
      dot(image, x + r * std::cos(angle), y + r * std::sin(angle), ink);
    }
  }
}

void frame(Image& image, const Region& part) {
  for (int x = part.x0; x < part.x1; ++x) {
    dot(image, x, part.y0, kWindow);
    dot(image, x, part.y1 - 1, kWindow);
  }
  for (int y = part.y0; y < part.y1; ++y) {
    dot(image, part.x0, y, kWindow);
    dot(image, part.x1 - 1, y, kWindow);
  }
}

void tint(Image& image, const Mask& skin, const Region& part) {
  if (skin.width != image.width || skin.height != image.height) return;
  for (int y = part.y0; y < part.y1; ++y)
    for (int x = part.x0; x < part.x1; ++x) {
      if (!skin.at(x, y)) continue;
      std::uint8_t* pixel = image.at(x, y);
      pixel[0] = static_cast<std::uint8_t>(pixel[0] / 2);
      pixel[1] = static_cast<std::uint8_t>(pixel[1] / 2 + 110);
      pixel[2] = static_cast<std::uint8_t>(pixel[2] / 2);
    }
}

SeenPair RectifiedPainter::draw(const StereoFrame& raw, const PoseTracker& by) const {
  SeenPair pair{{raw.left.width, raw.left.height}, {raw.right.width, raw.right.height}};
  const Region all{0, 0, pair.left.width, pair.left.height};
  if (rectifier_.none_needed()) {
    std::copy_n(raw.left.rgb, pair.left.rgb.size(), pair.left.rgb.begin());
    std::copy_n(raw.right.rgb, pair.right.rgb.size(), pair.right.rgb.begin());
  } else {
    rectifier_.part(Side::left, raw.left, all, pair.left);
    rectifier_.part(Side::right, raw.right, all, pair.right);
  }
  const auto* vision = dynamic_cast<const VisionTracker*>(&by);
  if (vision == nullptr) return pair;
  const FingerTracker& tracker = vision->tracker();
  const LookStats& stats = tracker.stats();
  if (stats.refused != FrameRefusal::no || !tracker.learned()) return pair;
  const Region window = stats.window.cut(all);
  tint(pair.left, tracker.skin(), window);
  frame(pair.left, window);
  for (const FingertipFinder::Candidate& one : tracker.candidates()) dot(pair.left, one.x, one.y, kCandidate);
  if (!stats.tip.found) return pair;
  const Ink& ink = stats.doubt == Doubt::no && !stats.beyond_gate ? kBelieved : kDoubted;
  const double radius = std::isfinite(stats.tip.outline) ? stats.tip.outline : stats.tip.radius;
  circle(pair.left, stats.tip.column, stats.tip.row, radius, ink);
  circle(pair.right, stats.found.column - stats.found.disparity, stats.found.row, radius, ink);
  return pair;
}

std::unique_ptr<PoseTracker> tracker(std::unique_ptr<StereoCamera> camera, const StereoRig& rig,
                                     const VisionRig& vision, Release release) {
  return std::make_unique<VisionTracker>(
      std::move(camera), rig,
      FingerTracker(rig, vision.segmentation, vision.fingertip, vision.track, vision.match, vision.search),
      release);
}
std::unique_ptr<AugmentedView> augmented(const AugmentedSpec& spec, std::span<const Object> objects) {
  return std::make_unique<AugmentedView>(spec, objects);
}
std::unique_ptr<BallFinder> ball(const StereoRig& rig, const BallSpec& spec) {
  return std::make_unique<BallFinder>(rig, spec);
}
std::unique_ptr<SeenPainter> painter(const StereoRig& rig) { return std::make_unique<RectifiedPainter>(rig); }
constexpr VisionModule kVision{.tracker = tracker, .augmented = augmented, .painter = painter, .ball = ball};

}  // namespace
}  // namespace enc

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "vision", .vision = &enc::kVision};
  return &kInfo;
}
