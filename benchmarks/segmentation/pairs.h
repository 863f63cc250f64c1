// Backgrounds with and without a hand, drawn at random, and how well each method tells its skin.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/peers/peers.h"
#include "benchmarks/staged/staged.h"
#include "core/vision/segmentation/roc.h"

namespace enc::bench::segmentation {

inline constexpr int kWidth = 640, kHeight = 480;
inline constexpr double kLeastHand = 0.15;  // of the frame's pixels are skin, else the hand is drawn anew

enum Method : std::uint8_t { published, ours, mog2, knn, nothing };
inline constexpr std::array<const char*, 5> kMethods{"the published method", "ours", "OpenCV MOG2 + inRange",
                                                     "OpenCV KNN + inRange", "all background"};

// A hand before the background of a place, in a light.
struct Take {
  std::string row;
  sim::Tone tone = sim::Tone::light;
  sim::Light light{};
};
struct Place {
  const sim::CameraModule* camera = nullptr;
  const OpenCv* opencv = nullptr;  // null: not there
  SkinModel skin;
  sim::Scenery scenery = sim::Scenery::office;
  std::uint64_t seed = 1;
  double exposure = 1.0;  // of all frames
  std::vector<Take> takes{};
  bool keeps = false;  // its images
};

struct Shown {
  Image background, image;
  Mask truth, published, ours;
};
struct Judged {
  Take take;
  double hand = 0.0;                                           // share of the frame
  std::array<std::optional<Confusion>, kMethods.size()> by{};  // none: not there
  Shown shown{};
};
[[nodiscard]] std::vector<Judged> judge(const Place& place);

// What a segmenter learns from and is asked, kept.
struct Material {
  std::vector<Image> background;
  Image image;
  Mask truth;
  [[nodiscard]] SegmentationPair pair() const;
};
[[nodiscard]] Material material(const Place& place, const Take& take);

// Several moments of one place, as a camera gives them: the hand moves on from one to the next.
struct Sequence {
  std::vector<Image> background;
  std::vector<Image> left{}, right{};
  std::vector<Mask> truth{};
};
[[nodiscard]] Sequence sequence(const Place& place, const Take& take, std::size_t frames);

[[nodiscard]] SegmentationSpec spec_of(const SkinModel& skin, SegmentationMethod method);
[[nodiscard]] HueRange range_of(const SkinModel& skin);  // as wide as SegmentationSpec's default

}  // namespace enc::bench::segmentation
