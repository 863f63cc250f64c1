#include "core/vision/segmentation/skin.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "core/base/error.h"

namespace enc {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

void SkinLearner::add(const ImageView& image, const Mask& hand) {
  if (image.width != hand.width || image.height != hand.height)
    throw Error("the image has " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                " pixels and its mask " + std::to_string(hand.width) + " x " + std::to_string(hand.height) +
                "; expected the same");
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!hand.at(x, y)) continue;
      const std::uint8_t* p = image.at(x, y);
      const int hue = segmentation::hue_of(p[0], p[1], p[2], rule_);
      if (hue == segmentation::kNoHue) continue;
      // A hue of 0 may also be the end of the last sextant.
      const double middle = segmentation::angle_of(hue);
      ++count_[static_cast<std::size_t>(hue)];
      sum_[static_cast<std::size_t>(hue)] +=
          middle + std::remainder(segmentation::exact_hue(p[0], p[1], p[2]) - middle, kTurn);
      ++pixels_;
    }
}

SkinModel SkinLearner::model() const {
  if (pixels_ < 2) throw Error("no skin to learn from: expected masks that have pixels with a hue");
  // Calls `take` for each hue bin with the mean of its exact hues.
  const auto each = [this](const auto& take) {
    for (std::size_t hue = 0; hue < count_.size(); ++hue)
      if (count_[hue] != 0)
        take(sum_[hue] / static_cast<double>(count_[hue]), static_cast<double>(count_[hue]));
  };
  double x = 0.0, y = 0.0;
  each([&](double hue, double n) {
    x += n * std::cos(hue);
    y += n * std::sin(hue);
  });
  const auto all = static_cast<double>(pixels_);
  if (std::hypot(x, y) < 1e-3 * all)
    throw Error("the masks' pixels have all hues alike; expected the hues of skin");
  SkinModel model;
  model.hue = std::atan2(y, x);
  // Mean and spread of the differences from that mean, each the short way around.
  double sum = 0.0, squares = 0.0;
  each([&](double hue, double n) {
    const double away = std::remainder(hue - model.hue, kTurn);
    sum += n * away;
    squares += n * away * away;
  });
  const double mean = sum / all;
  model.hue += mean;
  if (model.hue < 0.0) model.hue += kTurn;
  model.spread = std::sqrt(std::max(0.0, squares / all - mean * mean));
  return model;
}

SkinModel learn_skin(std::span<const ImageView> images, std::span<const Mask> hands,
                     const segmentation::HueRule& rule) {
  if (images.size() != hands.size())
    throw Error(std::to_string(images.size()) + " images with " + std::to_string(hands.size()) +
                " masks of hands; expected one for each");
  SkinLearner learner(rule);
  for (std::size_t i = 0; i < images.size(); ++i) learner.add(images[i], hands[i]);
  return learner.model();
}

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
