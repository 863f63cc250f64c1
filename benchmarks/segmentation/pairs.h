// Random backgrounds with and without a hand, the accuracy of each method's skin mask, and the statistics of
// a method over a set of pairs: means with their 95 % intervals.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/kit/kit.h"
#include "benchmarks/peers/peers.h"
#include "benchmarks/staged/staged.h"
#include "core/vision/segmentation/skin.h"
#include "models/identify/block_fit.h"

namespace enc::bench::segmentation {

inline constexpr int kWidth = 640, kHeight = 480;
inline constexpr double kLeastHand = 0.15;  // least share of skin pixels; a smaller hand is drawn anew

enum Method : std::uint8_t { published, ours, mog2, knn, nothing };
inline constexpr std::array<const char*, 5> kMethods{"the published method", "ours", "OpenCV MOG2 + inRange",
                                                     "OpenCV KNN + inRange", "all background"};

// px, sides of a tile beside the paper's 5.
inline constexpr std::array<int, 4> kSides{3, 5, 8, 12};

// A hand before the background of a place, in a light.
struct Take {
  std::string row;
  sim::Tone tone = sim::Tone::light;
  sim::Light light{};
};
struct Place {
  const sim::CameraModule* camera = nullptr;
  const OpenCv* opencv = nullptr;  // null: not there
  SegmentationSpec spec{};         // of the rig
  sim::Scenery scenery = sim::Scenery::office;
  std::uint64_t seed = 1;
  double exposure = 1.0;  // of all frames
  std::vector<Take> takes{};
  bool keeps = false;  // its images
};

struct PairImages {
  Image background, image;
  Mask truth, published, ours;
};
struct PairResult {
  Take take;
  double hand = 0.0;                                           // share of the frame
  std::array<std::optional<Confusion>, kMethods.size()> by{};  // none: not there
  std::array<Confusion, kSides.size()> by_side{};              // the published method with these tiles
  PairImages shown{};
};
[[nodiscard]] std::vector<PairResult> judge(const Place& place);

// The stored input of a segmenter: frames to learn from and frames to segment.
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

[[nodiscard]] SegmentationSpec with_method(SegmentationSpec spec, SegmentationMethod method);
[[nodiscard]] HueRange range_of(const SegmentationSpec& spec);

using Mean = models::Interval;  // 95 %, by Student's t over the pairs
// Value with the interval's ends, limited to 0 and 1, which Student's t may exceed with few pairs.
[[nodiscard]] Value ends(const Mean& share);
[[nodiscard]] inline Value in_percent(const Mean& share) { return ends(share) * 1e2; }
[[nodiscard]] std::string interval_text(const Mean& share, int digits = 2);  // in percent: "99.8..100.0"
// Score over the pairs that a method processed.
struct Score {
  std::size_t pairs = 0;
  Mean correct, false_positives, false_negatives, iou;  // shares
};
using Filter = std::function<bool(const PairResult&)>;
[[nodiscard]] Score score(std::span<const PairResult> pairs, Method method, const Filter& of = nullptr);

// Distance between the means of two sets, as a share of the 95 % interval of their difference.
[[nodiscard]] double apart(const Mean& a, const Mean& b);

// A line for each available method.
void add_rows(Table& table, const std::string& row, std::span<const PairResult> pairs,
              const Filter& of = nullptr);

}  // namespace enc::bench::segmentation
