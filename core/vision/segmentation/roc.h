// Accuracy of a segmenter over its two thresholds, by images with ground truth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/vision/segmentation/segmenter.h"

namespace enc {

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

struct RocPoint {
  double foreground = 0.0, skin = 0.0;  // the thresholds
  Confusion found;                      // all pairs together
};

// One point for each foreground threshold (`match`, or `change`) and each skin threshold, in this order.
[[nodiscard]] std::vector<RocPoint> roc(const SegmentationSpec& spec, std::span<const SegmentationPair> pairs,
                                        std::span<const double> foreground, std::span<const double> skin);

}  // namespace enc
