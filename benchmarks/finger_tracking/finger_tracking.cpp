// A finger that moves before the stereo head is followed from frame to frame: is it lost, how well are its
// place and velocity known, and what does the search window save [VisHap 2.1.2]?
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/peers/peers.h"
#include "benchmarks/staged/staged.h"
#include "core/base/units.h"
#include "core/vision/finger_tracker.h"
#include "sim/camera/skin_tones.h"

namespace enc::bench::finger_tracking {
namespace {

using namespace staged;

constexpr double kSpeed = 0.300;         // m/s
constexpr double kRate = 20.0;           // Hz
constexpr std::size_t kHides = 50;       // frames
constexpr double kVelocityBound = 60.0;  // mm/s rms, a fifth of the speed: said before it was measured

// Round and round before the head, never the same way, at one speed.
class Path {
 public:
  explicit Path(std::uint64_t seed) {
    sim::Stream stream(seed, "path");
    for (double& phase : phase_) phase = 6.28 * stream.uniform();
  }
  // In small steps: where the path turns a whole one would leap.
  void advance(double dt) {
    constexpr int kSteps = 50;
    for (int i = 0; i < kSteps; ++i) u_ += kSpeed * dt / kSteps / slope().norm();
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

struct Asked {
  const sim::CameraModule* camera;
  SkinModel skin;
  int width = 640;
  int block = MatchSpec{}.columns;
  bool window = true;
  std::size_t frames = 1000;
  std::uint64_t seed = 1;
  bool hides = false;  // for 6 frames in every kHides
};

struct Walk {
  std::size_t lost = 0, shown = 0;
  std::vector<double> place, velocity;  // m, m/s: errors of the filter's
  std::vector<double> predicted, held;  // m: a frame ahead
  std::vector<double> reacquired;       // frames
  std::vector<double> seconds, pixels;  // of a frame
  std::vector<Triplet> found;           // in each frame, the filter not asked; NaN: nothing
  std::vector<Vec3> variance;           // of it
  std::vector<double> nees;             // squared error of the place in told sigmas; of three numbers
};

// The stage, and the hand that goes along the path before it.
class Play {
 public:
  explicit Play(const Asked& asked) : path(asked.seed) {
    sim::StageSpec spec;
    spec.camera = head(asked.width);
    spec.seed = asked.seed;
    stage_ = asked.camera->stage(spec);
    shot_.look.skin = sim::skin_colour(sim::Tone::light);
    shot_.pose.along = Vec<'C'>(-0.3, -1.0, 0.2);
  }
  // The next exposure.
  void draw(bool hand, Pair& pair) {
    shot_.pose.tip = Point<'C'>(path.at());
    stage_->draw(hand ? &shot_.pose : nullptr, shot_.look, {}, frame_++, pair.left, pair.right);
  }
  Path path;

 private:
  std::unique_ptr<sim::Stage> stage_;
  Shot shot_;
  std::uint64_t frame_ = 0;
};

FingerTracker tracker_of(const Asked& asked, const StereoRig& rig) {
  SegmentationSpec segmentation;
  segmentation.model = asked.skin;
  TrackSpec track;
  if (!asked.window) track.window_least = 1e4;
  MatchSpec match;
  match.columns = asked.block;
  return {rig, segmentation, FingertipSpec{}, track, match};
}

void note(Walk& walk, const Finger& finger, const Finger& before, const Path& path, double dt) {
  ++walk.shown;
  if (finger.state != FingerState::seen) {
    ++walk.lost;
    return;
  }
  walk.place.push_back((finger.tip.e() - path.at()).norm());
  const Vec3 off = finger.tip.e() - path.at();
  walk.nees.push_back(off.dot(finger.covariance.inverse() * off));
  walk.velocity.push_back((finger.velocity.e() - path.velocity()).norm());
  if (before.state != FingerState::seen) return;
  walk.predicted.push_back((before.tip.e() + dt * before.velocity.e() - path.at()).norm());
  walk.held.push_back((before.tip.e() - path.at()).norm());
}

Walk follow(const Asked& asked) {
  Play play(asked);
  FingerTracker tracker = tracker_of(asked, head(asked.width));
  Walk walk;
  Pair pair;
  Finger before;
  const double dt = 1.0 / kRate;
  int hidden = 0, since = -1;
  for (std::size_t frame = 0; frame < asked.frames + 10; ++frame) {
    const bool hand = frame >= 10 && !(asked.hides && (frame % kHides) >= kHides - 6);
    play.draw(hand, pair);
    const double start = thread_seconds();
    const Finger finger = tracker.see({pair.left.view(), pair.right.view()},
                                      Time(from_seconds(dt * static_cast<double>(frame))));
    if (hand) {
      walk.seconds.push_back(thread_seconds() - start);
      walk.pixels.push_back(static_cast<double>(tracker.stats().pixels));
      if (hidden > 0) since = 0;
      hidden = 0;
      if (since >= 0) {
        ++since;
        if (finger.state == FingerState::seen) {
          walk.reacquired.push_back(since);
          since = -1;
        }
      } else if (frame > 10) {
        note(walk, finger, before, play.path, dt);
      }
      walk.found.push_back(tracker.stats().found);
      walk.variance.push_back(tracker.stats().variance);
    } else if (frame >= 10) {
      ++hidden;
    }
    before = finger;
    if (frame >= 10) play.path.advance(dt);
  }
  return walk;
}

void judge_window(Bench& bench, const Walk& windowed, const Walk& whole) {
  std::size_t same = 0;
  const std::size_t all = std::min(windowed.found.size(), whole.found.size());
  const auto none = [](const Triplet& found) { return std::isnan(found.column); };
  for (std::size_t i = 0; i < all; ++i) {
    const Triplet &a = windowed.found[i], &b = whole.found[i];
    const bool equal = a.e() == b.e() && windowed.variance[i] == whole.variance[i];
    same += equal || (none(a) && none(b)) ? 1U : 0U;
  }
  bench.figure(
      "window.same.percent", 100.0 * static_cast<double>(same) / static_cast<double>(all), "%",
      at_least(100.0),
      "frames in which window and whole frame give the same column, row, disparity and variance, to the "
      "bit");
  bench.figure("window.pixels.mean", 100.0 * mean(windowed.pixels) / mean(whole.pixels), "%", at_most(25.0),
               "pixels of the left image that are segmented, of the whole frame's");
  bench.cost("window.speed_up.median", median(whole.seconds) / median(windowed.seconds), "x",
             "CPU time of a frame without the window over that with it");
  bench.cost("window.time.median", median(windowed.seconds) * 1e3, "ms", "a stereo frame, with the window");
}

void judge_walk(Bench& bench, const Walk& walk) {
  bench.figure("lost.count", static_cast<double>(walk.lost), "frames", exactly(0.0),
               fmt::format("of {} with a finger at 300 mm/s", walk.shown));
  bench.figure("place.error.rms", rms(walk.place) * kMmPerM, "mm", at_most(2.0),
               "the filter's, at the exposure, 520 to 720 mm away");
  bench.figure("covariance.nees.mean", mean(walk.nees), "",
               "squared error of the place in sigmas of the covariance that is told; 3 where that is right");
  bench.figure("velocity.error.rms", rms(walk.velocity) * kMmPerM, "mm/s", at_most(kVelocityBound),
               "the filter's, at the exposure; the bound was stated before");
  bench.figure("prediction.gain", 100.0 * (1.0 - rms(walk.predicted) / rms(walk.held)), "%", at_least(60.0),
               fmt::format("a frame ahead: {:.2f} mm rms by the filter, {:.2f} mm by the last place",
                           rms(walk.predicted) * kMmPerM, rms(walk.held) * kMmPerM));
}

// Error against run time.
void weigh(Bench& bench, const Asked& like) {
  std::vector<CostCurve> curves;
  for (const int width : {640, 320}) {
    Asked asked = like;
    asked.width = width;
    if (width != like.width) asked.skin = learned_skin(*like.camera, width);
    for (const bool window : {true, false}) {
      CostCurve curve{fmt::format("{} px, {}", width, window ? "window" : "whole frame")};
      for (const int block : {8, 12, 16}) {
        asked.window = window;
        asked.block = block;
        const Walk walk = follow(asked);
        curve.cost.push_back(median(walk.seconds) * 1e3);
        curve.error.push_back(rms(walk.place) * kMmPerM);
      }
      curves.push_back(std::move(curve));
    }
  }
  bench.plot(cost_beside_error({.id = "cost",
                                .title = "Error of the fingertip against run time",
                                .x_label = "CPU time of a stereo frame (ms)",
                                .y_label = "rms error of the place (mm)",
                                .caption = "Along a line the matched block has 8, 12 and 16 columns."},
                               curves));
}

// A finger that goes to and fro before one background, as a camera's buffers have it.
struct Ring {
  std::vector<Pair> background, frames;
  [[nodiscard]] const Pair& at(std::size_t i) const {
    const std::size_t turn = i % (2 * frames.size());
    return frames[std::min(turn, 2 * frames.size() - 1 - turn)];
  }
};
Ring ring_of(const Asked& asked) {
  Play play(asked);
  Ring ring{std::vector<Pair>(10), std::vector<Pair>(16)};
  for (Pair& pair : ring.background) play.draw(false, pair);
  for (Pair& pair : ring.frames) {
    play.draw(true, pair);
    play.path.advance(1.0 / kRate);
  }
  return ring;
}

void race(Bench& bench, const Asked& asked, const OpenCv& opencv) {
  constexpr int kHues = 10;  // either way: wide enough for shaded skin
  const StereoRig rig = head(asked.width);
  const Ring ring = ring_of(asked);
  FingerTracker tracker = tracker_of(asked, rig);
  const int hue = static_cast<int>(asked.skin.hue / (2.0 * M_PI) * 256.0);
  const auto mog2 = opencv.mog2({(hue - kHues) & 255, (hue + kHues) & 255});
  const auto few = opencv.stereo(64, 15), all = opencv.stereo(224, 15);
  Mask skin(rig.width, rig.height);
  std::array<std::size_t, 3> at{};
  std::size_t frame = 0, seen = 0;
  const auto see = [&](const Pair& pair) {
    const Time t(from_seconds(static_cast<double>(frame++) / kRate));
    return tracker.see({pair.left.view(), pair.right.view()}, t).state == FingerState::seen;
  };
  for (const Pair& pair : ring.background) {
    see(pair);
    mog2->learn(pair.left.view());
  }
  const auto theirs = [&](StereoPeer& stereo, const Pair& pair) {
    mog2->segment(pair.left.view(), skin);
    stereo.disparity(pair.left.view(), pair.right.view());
  };
  const Race raced(bench.context.quick ? 16 : 64,
                   {[&] { seen += see(ring.at(at[0]++)) ? 1U : 0U; }, [&] { theirs(*few, ring.at(at[1]++)); },
                    [&] { theirs(*all, ring.at(at[2]++)); }},
                   4);
  bench.cost("ratio_to_opencv.median", raced.ratio(1, 0), "x", at_least(9.0),
             fmt::format("MOG2 + inRange + medianBlur + StereoBM of 64 disparities, {:.1f} ms, over a stereo "
                         "frame of ours, {:.2f} ms; same frames, interleaved",
                         raced.seconds(1) * 1e3, raced.seconds(0) * 1e3));
  bench.cost("ratio_to_opencv_whole_range.median", raced.ratio(2, 0), "x",
             "the same with 224 disparities, which is what 0.25 to 1.5 m takes");
  bench.figure("race.seen.percent", 100.0 * static_cast<double>(seen) / static_cast<double>(at[0]), "%",
               at_least(90.0), "frames of the race in which ours saw the finger");
}

void run(Bench& bench) {
  Asked asked;
  asked.camera = &camera(bench.context);
  asked.skin = learned_skin(*asked.camera, asked.width);
  asked.frames = bench.context.count(1000, 50);
  asked.seed = test_seed(bench.context) + 500;
  Asked whole = asked, hiding = asked;
  whole.window = false;
  hiding.hides = true;
  hiding.frames = bench.context.quick ? 100 : 500;
  std::vector<Asked> all{asked, whole, hiding};
  if (!bench.context.quick) {
    all.push_back(asked);
    all.back().seed = kNeverSeen + 700;
  }
  const auto walks = bench.each(all, follow);
  judge_walk(bench, walks[0]);
  if (all.size() > 3) {
    bench.figure("never_seen.lost.count", static_cast<double>(walks[3].lost), "frames", exactly(0.0),
                 fmt::format("of {}, on a seed never looked at", walks[3].shown));
    bench.figure("never_seen.place.error.rms", rms(walks[3].place) * kMmPerM, "mm", at_most(2.0),
                 "on a seed never looked at");
  }
  judge_window(bench, walks[0], walks[1]);
  const std::vector<double>& back = walks[2].reacquired;
  const std::size_t hidden = hiding.frames / kHides;
  bench.figure("hidden.back.count", static_cast<double>(back.size()), "times",
               exactly(static_cast<double>(hidden)), "a finger that was hidden is seen again");
  bench.figure("hidden.back_after.max", back.empty() ? kUnset : *std::max_element(back.begin(), back.end()),
               "frames", at_most(2.0),
               "after six frames without a finger: until it is seen again, counted from 1");
  const ModuleInfo* module = bench.context.module("peers");
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  if (peers != nullptr && peers->opencv != nullptr) race(bench, asked, *peers->opencv);
  Asked shorter = asked;
  shorter.frames = 200;
  if (!bench.context.quick) weigh(bench, shorter);
}

const Entry kEntry{"finger_tracking", "camera", "a finger at 300 mm/s is followed by its search window", run};

}  // namespace
}  // namespace enc::bench::finger_tracking
