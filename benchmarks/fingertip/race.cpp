#include "benchmarks/fingertip/race.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/peers/peers.h"
#include "core/vision/finger_tracker.h"
#include "sim/camera/skin_tones.h"

namespace enc::bench::fingertip {
namespace {

using namespace staged;

constexpr int kWidth = 640;           // px
constexpr double kPeriod = 1 / 20.0;  // s

// Null where it was not built.
const OpenCv* opencv_of(const Bench& bench) {
  const ModuleInfo* module = bench.context.module("peers");
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  return peers != nullptr ? peers->opencv : nullptr;
}

// A finger that goes to and fro before one background, as a camera's buffers have it.
struct Ring {
  std::vector<Pair> background, frames;
  [[nodiscard]] const Pair& at(std::size_t i) const {
    const std::size_t turn = i % (2 * frames.size());
    return frames[std::min(turn, 2 * frames.size() - 1 - turn)];
  }
};
Ring ring_of(const Bench& bench, const sim::CameraModule& camera) {
  sim::StageSpec spec;
  spec.camera = head(kWidth);
  spec.seed = test_seed(bench.context) + 500;
  const auto stage = camera.stage(spec);
  Shot shot;
  shot.look.skin = sim::skin_colour(sim::Tone::light);
  shot.pose.along = Vec<'C'>(-0.3, -1.0, 0.2);
  Ring ring{std::vector<Pair>(10), std::vector<Pair>(16)};
  std::uint64_t frame = 0;
  for (Pair& pair : ring.background) stage->draw(nullptr, shot.look, {}, frame++, pair.left, pair.right);
  double x = -0.07;  // m
  for (Pair& pair : ring.frames) {
    shot.pose.tip = Point<'C'>(x, 0.0, 0.62);
    stage->draw(&shot.pose, shot.look, {}, frame++, pair.left, pair.right);
    x += 0.300 * kPeriod;
  }
  return ring;
}

}  // namespace

void race(Bench& bench, const sim::CameraModule& camera, const SkinModel& skin) {
  if (opencv_of(bench) == nullptr) return;
  const OpenCv& opencv = *opencv_of(bench);
  constexpr int kHues = 10;  // either way: wide enough for shaded skin
  const Ring ring = ring_of(bench, camera);
  SegmentationSpec segmentation;
  segmentation.model = skin;
  FingerTracker tracker(head(kWidth), segmentation, FingertipSpec{}, TrackSpec{}, MatchSpec{});
  const int hue = static_cast<int>(skin.hue / (2.0 * M_PI) * 256.0);
  const auto mog2 = opencv.mog2({(hue - kHues) & 255, (hue + kHues) & 255});
  const auto few = opencv.stereo(64, 15), all = opencv.stereo(224, 15);
  Mask mask(kWidth, kWidth * 3 / 4);
  std::array<std::size_t, 3> at{};
  std::size_t frame = 0, seen = 0;
  const auto see = [&](const Pair& pair) {
    const Time t(from_seconds(kPeriod * static_cast<double>(frame++)));
    return tracker.see({pair.left.view(), pair.right.view()}, t).state == FingerState::seen;
  };
  for (const Pair& pair : ring.background) {
    see(pair);
    mog2->learn(pair.left.view());
  }
  const auto theirs = [&](StereoPeer& stereo, const Pair& pair) {
    mog2->segment(pair.left.view(), mask);
    stereo.disparity(pair.left.view(), pair.right.view());
  };
  const Race raced(bench.context.quick ? 16 : 64,
                   {[&] { seen += see(ring.at(at[0]++)) ? 1U : 0U; }, [&] { theirs(*few, ring.at(at[1]++)); },
                    [&] { theirs(*all, ring.at(at[2]++)); }},
                   4);
  bench.cost("followed.time.median", raced.seconds(0) * 1e3, "ms", "a stereo frame with the search window");
  bench.cost("ratio_to_opencv.median", raced.ratio(1, 0), "x", at_least(9.0),
             fmt::format("MOG2 + inRange + medianBlur + StereoBM of 64 disparities, {:.1f} ms, over a stereo "
                         "frame of ours; same frames, interleaved",
                         raced.seconds(1) * 1e3));
  bench.cost("ratio_to_opencv_whole_range.median", raced.ratio(2, 0), "x",
             "the same with 224 disparities, which is what 0.25 to 1.5 m takes");
  bench.figure("race.seen.percent", 100.0 * static_cast<double>(seen) / static_cast<double>(at[0]), "%",
               at_least(90.0), "frames of the race in which ours saw the finger");
}

}  // namespace enc::bench::fingertip
