// The tracker follows a finger that moves at 300 mm/s before the stereo head from frame to frame. It does not
// lose the finger, estimates its place and velocity, and gives equal results with and without the search
// window [VisHap 2.1.2].
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/staged/staged.h"
#include "core/vision/finger_tracker.h"
#include "sim/camera/camera_scene.h"

namespace enc::bench::staged {
namespace {

constexpr double kSpeed = 0.300;       // m/s
constexpr double kPeriod = 1.0 / 20;   // s
constexpr std::uint64_t kSeed = 3500;  // of `encounter bench --seed 1`

std::unique_ptr<sim::Stage> stage_of(const sim::StageSpec& spec) {
  return std::make_unique<sim::Stage>(spec);
}

const SkinModel& skin() {
  static const SkinModel kSkin = learned_skin({stage_of, nullptr, nullptr, nullptr}, 640);
  return kSkin;
}

// A path before the head that never repeats, at one speed.
class Path {
 public:
  explicit Path(std::uint64_t seed) {
    sim::Stream stream(seed, "path");
    for (double& phase : phase_) phase = 6.28 * stream.uniform();
  }
  // Advances in small steps: one whole step would leap where the path turns.
  void advance() {
    constexpr int kSteps = 50;
    for (int i = 0; i < kSteps; ++i) u_ += kSpeed * kPeriod / kSteps / slope().norm();
  }
  [[nodiscard]] Vec3 at() const {
    return kMiddle + Vec3(kSize.x() * std::sin(u_ + phase_[0]), kSize.y() * std::sin(1.31 * u_ + phase_[1]),
                          kSize.z() * std::sin(0.77 * u_ + phase_[2]));
  }
  [[nodiscard]] Vec3 velocity() const { return kSpeed * slope().normalized(); }

 private:
  [[nodiscard]] Vec3 slope() const {
    return {kSize.x() * std::cos(u_ + phase_[0]), 1.31 * kSize.y() * std::cos(1.31 * u_ + phase_[1]),
            0.77 * kSize.z() * std::cos(0.77 * u_ + phase_[2])};
  }
  inline static const Vec3 kMiddle{0.04, 0.0, 0.62}, kSize{0.11, 0.08, 0.10};  // m, in C
  std::array<double, 3> phase_{};
  double u_ = 0.0;
};

// The stage and the hand that follows the path; the first ten frames show the background only.
class Play {
 public:
  explicit Play(std::uint64_t seed) : path(seed) {
    sim::StageSpec spec;
    spec.camera = head(640);
    spec.seed = seed;
    stage_ = stage_of(spec);
    shot_.look.skin = sim::skin_colour(sim::Tone::light);
    shot_.pose.along = Vec<'C'>(-0.3, -1.0, 0.2);
  }
  StereoFrame draw(bool hand) {
    shot_.pose.tip = Point<'C'>(path.at());
    stage_->draw(hand ? &shot_.pose : nullptr, shot_.look, {}, frame_++, pair_.left, pair_.right);
    return {pair_.left.view(), pair_.right.view()};
  }
  [[nodiscard]] Time exposed() const { return Time(from_seconds(kPeriod * static_cast<double>(frame_))); }
  Path path;

 private:
  std::unique_ptr<sim::Stage> stage_;
  Shot shot_;
  Pair pair_;
  std::uint64_t frame_ = 0;
};

FingerTracker tracker(bool window = true) {
  SegmentationSpec segmentation;
  segmentation.model = skin();
  TrackSpec track;
  if (!window) track.window_least = 1e4;
  return {head(640), segmentation, FingertipSpec{}, track, MatchSpec{}};
}

// Compares the tracker with its search window to a tracker that searches whole frames.
void follow(std::uint64_t seed, int frames) {
  Play play(seed);
  FingerTracker windowed = tracker(), whole = tracker(false);
  std::vector<double> place, velocity, foreseen, held, pixels, all_pixels;  // m, m/s, m, m, px
  Finger before;
  int lost = 0;
  for (int frame = -10; frame < frames; ++frame) {
    const Time t = play.exposed();
    const StereoFrame pair = play.draw(frame >= 0);
    const Finger finger = windowed.see(pair, t);
    (void)whole.see(pair, t);
    if (frame < 0) continue;
    const Triplet &a = windowed.stats().found, &b = whole.stats().found;
    EXPECT_TRUE((a.e() == b.e() && windowed.stats().variance == whole.stats().variance) ||
                (std::isnan(a.column) && std::isnan(b.column)))
        << "the window changes what is found in frame " << frame;
    pixels.push_back(static_cast<double>(windowed.stats().pixels));
    all_pixels.push_back(static_cast<double>(whole.stats().pixels));
    const bool seen = finger.state == FingerState::seen;
    if (frame > 0 && !seen) ++lost;
    if (frame > 0 && seen) {
      place.push_back((finger.tip.e() - play.path.at()).norm());
      velocity.push_back((finger.velocity.e() - play.path.velocity()).norm());
      if (before.state == FingerState::seen) {
        foreseen.push_back((before.tip.e() + kPeriod * before.velocity.e() - play.path.at()).norm());
        held.push_back((before.tip.e() - play.path.at()).norm());
      }
    }
    before = finger;
    play.path.advance();
  }
  EXPECT_EQ(lost, 0);
  EXPECT_LE(rms(place), 2e-3) << "520 to 720 mm away";
  EXPECT_LE(rms(velocity), 0.060) << "a fifth of the speed";
  EXPECT_LE(rms(foreseen), 0.4 * rms(held)) << "a frame ahead, by the filter and by the last place";
  EXPECT_LE(mean(pixels), 0.25 * mean(all_pixels));
}

TEST(FingerTracking, FollowsAFingerInAWindow) { follow(kSeed, 100); }
TEST(FingerTrackingLong, FollowsAFingerInAWindow) { follow(kSeed, 1000); }
TEST(FingerTrackingLong, FollowsAFingerOnASeedNeverLookedAt) { follow(kNeverSeen + 700, 1000); }

// Hides the finger in six of every fifty frames.
void hide(int times) {
  Play play(kSeed);
  FingerTracker eyes = tracker();
  int missed = 0;  // frames with a finger since it came back
  bool hidden = false;
  for (int frame = -10; frame < 50 * times + 10; ++frame) {
    const bool hand = frame >= 0 && (frame + 10) % 50 < 44;
    const Time t = play.exposed();
    const Finger finger = eyes.see(play.draw(hand), t);
    if (frame < 0) continue;
    if (hand && hidden) {
      ++missed;
      hidden = finger.state != FingerState::seen;
      EXPECT_LE(missed, hidden ? 1 : 2) << "it is seen again in the second frame at the latest";
    }
    if (!hand) {
      hidden = true;
      missed = 0;
    }
    play.path.advance();
  }
  EXPECT_FALSE(hidden);
}

TEST(FingerTracking, FindsAHiddenFingerAgain) { hide(2); }
TEST(FingerTrackingLong, FindsAHiddenFingerAgain) { hide(10); }

}  // namespace
}  // namespace enc::bench::staged
