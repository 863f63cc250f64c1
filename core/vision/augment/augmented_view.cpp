#include "core/vision/augment/augmented_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/machine/arm_shape.h"
#include "core/vision/augment/view_parts.h"
#include "core/vision/segmentation/segmenter.h"
#include "core/vision/stereo/rectify.h"

namespace enc {
namespace {

constexpr float kTint[3] = {70.0F, 160.0F, 215.0F};  // colour of virtual objects, out of 255
constexpr int kEdge = 6;                             // px around skin: an edge that was not detected as skin
constexpr double kBehind = 0.020;                    // m: half of a hand, plus the error of a depth

// Sets the mask's pixels and all within `by` px in column and row.
void grow(const Mask& mask, int by, Mask& grown) {
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (!mask.at(x, y)) continue;
      const int x0 = std::max(0, x - by), x1 = std::min(mask.width, x + by + 1);
      const bool inside = x > 0 && mask.at(x - 1, y) && y > 0 && mask.at(x, y - 1) && x + 1 < mask.width &&
                          mask.at(x + 1, y) && y + 1 < mask.height && mask.at(x, y + 1);
      if (inside) {
        grown.row(y)[x] = 255;
        continue;
      }
      for (int v = std::max(0, y - by); v < std::min(mask.height, y + by + 1); ++v)
        std::fill(grown.row(v) + x0, grown.row(v) + x1, std::uint8_t{255});
    }
}

}  // namespace

struct AugmentedView::Parts {
  Parts(const AugmentedSpec& given, std::span<const Object> objects);

  void find_device(const AugmentedMoment& moment);
  void remove();
  void overlay(const AugmentedMoment& moment);

  AugmentedSpec spec;
  Rectifier rectifier;
  Segmenter segmenter;
  augment::CleanBackground background;
  std::vector<augment::Facets> facets;
  std::vector<Pose<'W', 'O'>> X_WO;
  Pose<'C', 'W'> X_CW;
  Image left, removed, augmented;
  Mask device, skin, covered, replaced;
  augment::DepthPicture seen;
};

AugmentedView::Parts::Parts(const AugmentedSpec& given, std::span<const Object> objects)
    : spec(given),
      rectifier(given.camera),
      segmenter(given.segmentation, rectifier.width(), rectifier.height()),
      background(rectifier.width(), rectifier.height(), given.segmentation.background_frames),
      X_CW(given.X_WC.inverse()),
      left(rectifier.width(), rectifier.height()),
      removed(left),
      augmented(left),
      device(left.width, left.height),
      skin(device),
      covered(device),
      replaced(device),
      seen(left.width, left.height) {
  for (const Object& object : objects) {
    facets.push_back(augment::facets_of(object.surface));
    X_WO.push_back(object.X_WO);
  }
}

void AugmentedView::Parts::find_device(const AugmentedMoment& moment) {
  std::fill(device.on.begin(), device.on.end(), std::uint8_t{0});
  if (!spec.arm) return;
  const auto take = [&](const ArmPart& part) {
    augment::cover(rectifier.pair(), X_CW, part, spec.margin, device);
  };
  for (const ArmPart& part : arm_shape(*spec.arm, moment.joints, spec.X_WR)) take(part);
  if (spec.prop) take(prop_shape(*spec.prop, spec.X_WR * Arm(*spec.arm).tip(moment.joints), moment.q_WN));
}

void AugmentedView::Parts::remove() {
  removed.rgb = left.rgb;
  replaced.on.assign(replaced.on.size(), 0);
  if (!background.any()) return;  // no background is known that could replace the arm
  const Image& behind = background.image();
  for (std::size_t i = 0; i < device.on.size(); ++i) {
    replaced.on[i] = device.on[i] != 0 && skin.on[i] == 0 ? 255 : 0;
    if (replaced.on[i] != 0) std::copy_n(behind.rgb.data() + 3 * i, 3, removed.rgb.data() + 3 * i);
  }
}

void AugmentedView::Parts::overlay(const AugmentedMoment& moment) {
  seen.clear();
  for (std::size_t i = 0; i < facets.size(); ++i) {
    Pose<'W', 'O'> at = X_WO[i];
    if (i < moment.moved.size()) at = {Quat(at.q()), at.origin() + moment.moved[i]};
    augment::draw(facets[i], rectifier.pair(), X_CW * at, seen);
  }
  const double hand = (rectifier.pair().turn.transpose() * moment.finger.e()).z();
  const float before_hand = std::isfinite(hand) ? static_cast<float>(hand - kBehind) : 0.0F;
  const auto opacity = static_cast<float>(spec.opacity);
  augmented.rgb = removed.rgb;
  for (std::size_t i = 0; i < skin.on.size(); ++i) {
    if (!std::isfinite(seen.depth[i]) || (skin.on[i] != 0 && seen.depth[i] >= before_hand)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& to = augmented.rgb[3 * i + c];
      const float mixed = (1.0F - opacity) * static_cast<float>(to) + opacity * seen.shade[i] * kTint[c];
      to = static_cast<std::uint8_t>(mixed + 0.5F);
    }
  }
}

AugmentedView::AugmentedView(const AugmentedSpec& spec, std::span<const Object> objects)
    : parts_(std::make_unique<Parts>(spec, objects)) {}
AugmentedView::~AugmentedView() = default;

const Image& AugmentedView::removed() const { return parts_->removed; }
const Image& AugmentedView::augmented() const { return parts_->augmented; }
const Mask& AugmentedView::replaced() const { return parts_->replaced; }
const Mask& AugmentedView::known() const { return parts_->background.known(); }

void AugmentedView::see(const ImageView& raw, const AugmentedMoment& moment) {
  Parts& p = *parts_;
  if (raw.width != p.left.width || raw.height != p.left.height)
    throw Error("an image has another size than the rig says");
  if (p.rectifier.none_needed())
    std::copy_n(raw.rgb, p.left.rgb.size(), p.left.rgb.begin());
  else
    p.rectifier.part(Side::left, raw, p.skin.whole(), p.left);
  if (p.segmenter.learned())
    p.segmenter.segment(p.left.view(), p.skin.whole(), p.skin);
  else
    p.segmenter.learn(p.left.view());
  p.find_device(moment);
  p.covered.on = p.device.on;
  grow(p.skin, kEdge, p.covered);
  p.background.add(p.left.view(), p.covered);
  p.remove();
  p.overlay(moment);
}

}  // namespace enc
