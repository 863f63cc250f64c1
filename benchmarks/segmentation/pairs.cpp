#include "benchmarks/segmentation/pairs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/error.h"
#include "sim/camera/camera_scene.h"

namespace enc::bench::segmentation {
namespace {

using namespace staged;

constexpr std::uint64_t kBackgrounds = 10;  // [VisHap 3]
constexpr int kMostTries = 200;
constexpr double kPalm = 0.11;  // m, from the tip to the palm's middle

// The background's frames, then hands.
class Scene {
 public:
  explicit Scene(const Place& place)
      : rig_(head(kWidth)), stage_(place.camera->stage(spec(rig_, place))), stream_(place.seed, "pairs") {
    stage_->draw(nullptr, {}, {}, frame_, pair_.left, pair_.right);
    for (; frame_ < kBackgrounds; ++frame_) {
      if (frame_ > 0) stage_->again(frame_, pair_.left, pair_.right);
      background_.push_back(pair_.left);
    }
  }
  [[nodiscard]] const std::vector<Image>& background() const { return background_; }
  // A hand that is large enough.
  const Pair& take(const Take& take) {
    for (int i = 0; i < kMostTries; ++i) {
      do {
        shot_ = drawn(rig_, {.near = 0.28, .far = 0.42}, take.tone, stream_);
      } while (!palm_in_view());
      if (share(draw(take.light)) >= kLeastHand) return pair_;
    }
    throw Error("no hand came as large as the pairs are to have");
  }
  const Pair& move_on(const sim::Light& light, const Vec<'C'>& by) {
    shot_.pose.tip = shot_.pose.tip + by;
    return draw(light);
  }
  [[nodiscard]] static double share(const Pair& pair) {
    const auto on = std::count_if(pair.truth.skin.on.begin(), pair.truth.skin.on.end(),
                                  [](std::uint8_t x) { return x != 0; });
    return static_cast<double>(on) / static_cast<double>(pair.truth.skin.on.size());
  }

 private:
  // Skips drawing a hand that is certain to be too small.
  [[nodiscard]] bool palm_in_view() const {
    const Point<'C'> palm = shot_.pose.tip + Vec<'C'>(-kPalm * shot_.pose.along.e().normalized());
    const Lens& lens = rig_.left;
    const double z = palm.xyz[2];
    const double column = lens.centre_x + lens.focal_x * palm.xyz[0] / z;
    const double row = lens.centre_y + lens.focal_y * palm.xyz[1] / z;
    return z > 0.0 && column > 0.0 && row > 0.0 && column < kWidth && row < kHeight;
  }
  static sim::StageSpec spec(const StereoRig& rig, const Place& place) {
    sim::StageSpec spec;
    spec.camera = rig;
    spec.scenery = place.scenery;
    spec.seed = place.seed;
    spec.sensor.exposure = place.exposure;
    return spec;
  }
  const Pair& draw(const sim::Light& light) {
    stage_->draw(&shot_.pose, shot_.look, light, frame_++, pair_.left, pair_.right, &pair_.truth);
    return pair_;
  }

  StereoRig rig_;
  std::unique_ptr<sim::Stage> stage_;
  sim::Stream stream_;
  std::uint64_t frame_ = 0;
  std::vector<Image> background_;
  Shot shot_;
  Pair pair_;
};

// All methods, after each has learned a background.
class Judges {
 public:
  Judges(const Place& place, const std::vector<Image>& background) {
    for (const SegmentationMethod method : {SegmentationMethod::published, SegmentationMethod::ours})
      own_.emplace_back(with_method(place.spec, method), kWidth, kHeight);
    for (const int side : kSides) {
      SegmentationSpec spec = with_method(place.spec, SegmentationMethod::published);
      spec.tile = side;
      tiled_.emplace_back(spec, kWidth, kHeight);
    }
    if (place.opencv != nullptr)
      for (const auto make : {place.opencv->mog2, place.opencv->knn})
        peers_.push_back(make(range_of(place.spec)));
    for (const Image& image : background) {
      for (Segmenter& each : own_) each.learn(image.view());
      for (Segmenter& each : tiled_) each.learn(image.view());
      for (const auto& each : peers_) each->learn(image.view());
    }
  }
  void judge(const Pair& pair, PairResult& judged, bool keeps) {
    Mask found(kWidth, kHeight);
    const Mask& truth = pair.truth.skin;
    judged.by[nothing] = compare(found, truth);
    for (const std::size_t i : {published, ours}) {
      own_[i].segment(pair.left.view(), found.whole(), found);
      judged.by[i] = compare(found, truth);
      if (keeps) (i == published ? judged.shown.published : judged.shown.ours) = found;
    }
    for (std::size_t i = 0; i < tiled_.size(); ++i) {
      tiled_[i].segment(pair.left.view(), found.whole(), found);
      judged.by_side[i] = compare(found, truth);
    }
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      peers_[i]->segment(pair.left.view(), found);
      judged.by[mog2 + i] = compare(found, truth);
    }
  }

 private:
  std::vector<Segmenter> own_, tiled_;
  std::vector<std::unique_ptr<SegmentationPeer>> peers_;
};

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  if (values.empty()) return {};
  Mean mean{.value = 0.0, .half = kUnset};
  for (const double x : values) mean.value += x / n;
  if (values.size() < 2) return mean;
  double square = 0.0;
  for (const double x : values) square += (x - mean.value) * (x - mean.value);
  mean.half = models::student(n - 1.0) * std::sqrt(square / (n - 1.0) / n);
  return mean;
}

std::string words(const Mean& mean) {
  if (std::isnan(mean.half)) return fixed(1e2 * mean.value, 2);
  return fmt::format("{:.2f} ({})", 1e2 * mean.value, interval_text(mean));
}

}  // namespace

SegmentationSpec with_method(SegmentationSpec spec, SegmentationMethod method) {
  spec.method = method;
  return spec;
}

HueRange range_of(const SegmentationSpec& spec) {
  const double width = spec.skin * spec.model.spread;
  const auto at = [](double angle) {
    return static_cast<int>(std::lround(angle / (2.0 * std::numbers::pi) * 256.0)) & 255;
  };
  return {at(spec.model.hue - width), at(spec.model.hue + width)};
}

SegmentationPair Material::pair() const {
  SegmentationPair pair{{}, image.view(), &truth};
  for (const Image& each : background) pair.background.push_back(each.view());
  return pair;
}

std::vector<PairResult> judge(const Place& place) {
  Scene scene(place);
  Judges judges(place, scene.background());
  std::vector<PairResult> all;
  for (const Take& take : place.takes) {
    const Pair& pair = scene.take(take);
    PairResult judged{.take = take, .hand = Scene::share(pair)};
    judges.judge(pair, judged, place.keeps);
    if (place.keeps) {
      judged.shown.background = scene.background().back();
      judged.shown.image = pair.left;
      judged.shown.truth = pair.truth.skin;
    }
    all.push_back(std::move(judged));
  }
  return all;
}

Material material(const Place& place, const Take& take) {
  Scene scene(place);
  const Pair& pair = scene.take(take);
  return {scene.background(), pair.left, pair.truth.skin};
}

Sequence sequence(const Place& place, const Take& take, std::size_t frames) {
  Scene scene(place);
  Sequence all{.background = scene.background()};
  const Pair* pair = &scene.take(take);
  for (std::size_t i = 0; i < frames; ++i) {
    all.left.push_back(pair->left);
    all.right.push_back(pair->right);
    all.truth.push_back(pair->truth.skin);
    pair = &scene.move_on(take.light, Vec<'C'>(i % 2 == 0 ? 0.003 : -0.002, 0.001, 0.0));
  }
  return all;
}

Value ends(const Mean& share) {
  if (std::isnan(share.half)) return {share.value};
  return {share.value, std::max(0.0, share.value - share.half), std::min(1.0, share.value + share.half)};
}

std::string interval_text(const Mean& share, int digits) {
  if (std::isnan(share.half)) return "not known";
  const Value percent = in_percent(share);
  return fmt::format("{:.{}f}..{:.{}f}", percent.least, digits, percent.most, digits);
}

Score score(std::span<const PairResult> pairs, Method method, const Filter& of) {
  std::vector<double> correct, positives, negatives, iou;
  for (const PairResult& pair : pairs) {
    const auto& found = pair.by[method];
    if (!found || (of && !of(pair))) continue;
    correct.push_back(found->correct());
    positives.push_back(found->false_positives());
    negatives.push_back(found->false_negatives());
    iou.push_back(found->iou());
  }
  return {correct.size(), mean_of(correct), mean_of(positives), mean_of(negatives), mean_of(iou)};
}

double apart(const Mean& a, const Mean& b) {
  return std::abs(a.value - b.value) / std::sqrt(a.half * a.half + b.half * b.half);
}

void add_rows(Table& table, const std::string& row, std::span<const PairResult> pairs, const Filter& of) {
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    const Score s = score(pairs, static_cast<Method>(i), of);
    if (s.pairs > 0)
      table.add(row, kMethods[i], s.pairs, words(s.correct), words(s.false_positives),
                words(s.false_negatives), words(s.iou));
  }
}

}  // namespace enc::bench::segmentation
