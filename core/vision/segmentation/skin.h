// The colour of skin, learned offline from images with segmented hands, and the accuracy of a segmenter.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/spec/vision_rig.h"
#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/segmenter.h"

namespace enc {

// The colour of skin: one Gaussian of hue, learned offline from images with segmented hands [VisHap 2.1.1].
// Takes any number of images, one by one.
class SkinLearner {
 public:
  explicit SkinLearner(const segmentation::HueRule& rule = {}) : rule_(rule) {}
  // Adds the pixels of the mask `hand`. Throws Error if the sizes differ.
  void add(const ImageView& image, const Mask& hand);
  [[nodiscard]] std::int64_t pixels() const { return pixels_; }  // pixels with a hue
  // Mean on the circle; the spread takes each difference the short way around. Throws Error with fewer than
  // two pixels of a hue, or if the hues are uniform around the circle.
  [[nodiscard]] SkinModel model() const;

 private:
  segmentation::HueRule rule_;
  std::array<std::int64_t, segmentation::kHues> count_{};
  std::array<double, segmentation::kHues> sum_{};  // sums of the exact hues in each bin, rad
  std::int64_t pixels_ = 0;
};

// Learns from all images at once, one mask each.
[[nodiscard]] SkinModel learn_skin(std::span<const ImageView> images, std::span<const Mask> hands,
                                   const segmentation::HueRule& rule = {});

// Counts of pixels, for one image or many.
struct Confusion {
  std::int64_t true_positive = 0, false_positive = 0, false_negative = 0, true_negative = 0;

  [[nodiscard]] std::int64_t pixels() const {
    return true_positive + false_positive + false_negative + true_negative;
  }
  // Shares of all pixels, as in [VisHap 3].
  [[nodiscard]] double correct() const { return share(true_positive + true_negative, pixels()); }
  [[nodiscard]] double false_positives() const { return share(false_positive, pixels()); }
  [[nodiscard]] double false_negatives() const { return share(false_negative, pixels()); }
  // The axes of an ROC: found share of non-skin, found share of skin.
  [[nodiscard]] double false_positive_rate() const {
    return share(false_positive, false_positive + true_negative);
  }
  [[nodiscard]] double true_positive_rate() const {
    return share(true_positive, true_positive + false_negative);
  }
  // Intersection over union; 1 if there is no skin and none was found.
  [[nodiscard]] double iou() const {
    const std::int64_t any = true_positive + false_positive + false_negative;
    return any == 0 ? 1.0 : share(true_positive, any);
  }
  Confusion& operator+=(const Confusion& other);

 private:
  [[nodiscard]] static double share(std::int64_t of, std::int64_t all) {
    return all == 0 ? 0.0 : static_cast<double>(of) / static_cast<double>(all);
  }
};

// Throws Error if the sizes differ.
[[nodiscard]] Confusion compare(const Mask& found, const Mask& truth);

// Frames of a background, an image with a hand in front of it, and the true mask of skin.
struct SegmentationPair {
  std::vector<ImageView> background;  // the last frame repeats if a segmenter needs more
  ImageView image;
  const Mask* truth = nullptr;
};

// Accuracy of a segmenter over its two thresholds, by images with ground truth.
struct RocPoint {
  double foreground = 0.0, skin = 0.0;  // the thresholds
  Confusion found;                      // all pairs together
};

// One point for each foreground threshold (`match`, or `change`) and each skin threshold, in this order.
[[nodiscard]] std::vector<RocPoint> roc(const SegmentationSpec& spec, std::span<const SegmentationPair> pairs,
                                        std::span<const double> foreground, std::span<const double> skin);

}  // namespace enc
