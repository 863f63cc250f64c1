#include "core/vision/segmentation/roc.h"

#include <cstddef>

#include "core/base/error.h"

namespace enc {

Confusion& Confusion::operator+=(const Confusion& other) {
  true_positive += other.true_positive;
  false_positive += other.false_positive;
  false_negative += other.false_negative;
  true_negative += other.true_negative;
  return *this;
}

Confusion compare(const Mask& found, const Mask& truth) {
  if (found.width != truth.width || found.height != truth.height)
    throw Error("the mask and its truth differ in size");
  Confusion all;
  for (std::size_t i = 0; i < found.on.size(); ++i) {
    const bool is = truth.on[i] != 0, seen = found.on[i] != 0;
    ++(is ? (seen ? all.true_positive : all.false_negative)
          : (seen ? all.false_positive : all.true_negative));
  }
  return all;
}

std::vector<RocPoint> roc(const SegmentationSpec& spec, std::span<const SegmentationPair> pairs,
                          std::span<const double> foreground, std::span<const double> skin) {
  std::vector<RocPoint> points;
  for (const double first : foreground)
    for (const double second : skin) points.push_back({first, second, {}});
  for (const SegmentationPair& pair : pairs) {
    if (pair.background.empty() || pair.truth == nullptr)
      throw Error("a pair without a background or without its truth");
    Segmenter segmenter(spec, pair.image.width, pair.image.height);
    for (std::size_t i = 0; !segmenter.learned(); ++i)
      segmenter.learn(pair.background[std::min(i, pair.background.size() - 1)]);
    Mask found(pair.image.width, pair.image.height);
    for (RocPoint& point : points) {
      segmenter.thresholds(point.foreground, point.skin);
      segmenter.segment(pair.image, found.whole(), found);
      point.found += compare(found, *pair.truth);
    }
  }
  return points;
}

}  // namespace enc
