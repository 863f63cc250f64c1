#include "benchmarks/segmentation/speed.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "core/vision/segmentation/kernels/arc.h"
#include "core/vision/segmentation/kernels/majority.h"
#include "core/vision/segmentation/tiles.h"

namespace enc::bench::segmentation {
namespace {

namespace s = enc::segmentation;

constexpr std::size_t kRing = 16;  // frames of a camera's buffers: 15 MB, more than a core's caches keep

// Work on one frame after the other of the ring.
template <class Work>
std::function<void()> on_ring(const Sequence& frames, Work work) {
  return [&frames, work, i = std::size_t{0}]() mutable { work(i++ % frames.left.size()); };
}

// Everything that a frame may go through.
struct Course {
  const Place& place;
  std::size_t rounds;
  Sequence frames = sequence(place, {.row = "", .tone = sim::Tone::light}, kRing);
  SegmentationSpec spec = spec_of(place.skin, SegmentationMethod::published);
  Segmenter published{spec, kWidth, kHeight};
  Mask found{kWidth, kHeight};

  Course(const Place& where, std::size_t times) : place(where), rounds(times) {
    for (const Image& image : frames.background) published.learn(image.view());
  }
  [[nodiscard]] ImageView view(std::size_t i) const { return frames.left[i].view(); }
};

void beside_copy(Bench& bench, Course& course) {
  Image copy(kWidth, kHeight);
  const auto copy_of = [&](std::size_t i) {
    std::memcpy(copy.rgb.data(), course.view(i).rgb, copy.rgb.size());
  };
  const auto segment = [&](std::size_t i) {
    course.published.segment(course.view(i), course.found.whole(), course.found);
  };
  const Race raced(course.rounds, {on_ring(course.frames, segment), on_ring(course.frames, copy_of),
                                   [&] { segment(0); }, [&] { copy_of(0); }});
  bench.cost("time.median", raced.seconds(0) * 1e3, "ms",
             "the published method, a 640x480 frame of a ring of 16");
  bench.cost("copies.median", raced.ratio(0, 1), "x",
             fmt::format("the time of a frame over that of copying it, {:.3f} ms; both of a ring of 16, as a "
                         "camera gives them",
                         raced.seconds(1) * 1e3));
  bench.cost("copies_in_cache.median", raced.ratio(2, 3), "x",
             "the same with one frame again and again, which no camera gives: its copy stays in the caches");
}

// The same frames, the peer's mask judged by the same truth.
void beside_pipeline(Bench& bench, Course& course) {
  const auto peer = course.place.opencv->mog2(range_of(course.place.skin));
  for (const Image& image : course.frames.background) peer->learn(image.view());
  Mask theirs(kWidth, kHeight);
  Confusion own, other;
  for (std::size_t i = 0; i < kRing; ++i) {
    course.published.segment(course.view(i), theirs.whole(), theirs);
    own += compare(theirs, course.frames.truth[i]);
    peer->segment(course.view(i), theirs);
    other += compare(theirs, course.frames.truth[i]);
  }
  const Race raced(course.rounds,
                   {on_ring(course.frames,
                            [&](std::size_t i) {
                              course.published.segment(course.view(i), course.found.whole(), course.found);
                            }),
                    on_ring(course.frames, [&](std::size_t i) { peer->segment(course.view(i), theirs); })});
  bench.cost("ratio_to_mog2.median", raced.ratio(1, 0), "x", at_least(8.0),
             fmt::format("MOG2 + inRange + medianBlur, {:.2f} ms, over the published method; same frames, "
                         "interleaved",
                         raced.seconds(1) * 1e3));
  bench.figure("race.wrong.mean", 100.0 * (1.0 - own.correct()), "%", at_most(0.2),
               fmt::format("of the pixels of the race's frames; MOG2 + inRange + medianBlur {:.3f} %",
                           100.0 * (1.0 - other.correct())));
}

// Ours keeps the pixels of foreground tiles that have a hue, were every hue skin. Theirs tells the tiles.
double unlike_tiles(Course& course, s::Tiles& tiles, TilePeer& peer) {
  const int side = course.spec.tile;
  const s::Grid grid{kWidth, kHeight, side};
  const s::Cut any = s::cut_of({0, s::kHues}, course.spec.hue);
  std::vector<std::uint8_t> theirs;
  std::size_t unlike = 0, all = 0;
  for (std::size_t i = 0; i < kRing; ++i) {
    const ImageView image = course.view(i);
    tiles.candidates(image, grid.whole(), course.spec.match, any, course.found);
    peer.match(image, course.spec.match, theirs);
    std::size_t tile = 0;
    for (int y = 0; y + side <= kHeight; y += side)
      for (int x = 0; x + side <= kWidth; x += side, ++tile) {
        bool hued = true, found = false;
        for (int j = 0; j < side * side; ++j) {
          const std::uint8_t* p = image.at(x + j % side, y + j / side);
          hued = hued && s::hue_of(p[0], p[1], p[2], course.spec.hue) != s::kNoHue;
          found = found || course.found.at(x + j % side, y + j / side);
        }
        if (!hued) continue;
        ++all;
        unlike += found == (theirs[tile] != 0) ? 0U : 1U;
      }
  }
  return static_cast<double>(unlike) / static_cast<double>(all);
}

void beside_parts(Bench& bench, Course& course) {
  const OpenCv& opencv = *course.place.opencv;
  const SegmentationSpec& spec = course.spec;
  const s::Grid grid{kWidth, kHeight, spec.tile};
  const s::Cut cut = s::cut_of(s::skin_arc(spec.model, spec.skin), spec.hue);
  Image mean(kWidth, kHeight);
  mean.rgb = course.frames.background.front().rgb;
  s::Tiles tiles(s::kernels(), grid, spec.bins);
  tiles.learn(mean, cut);
  const auto histograms = opencv.tiles(spec.tile, spec.bins);
  histograms->learn(mean.view());
  std::vector<std::uint8_t> changed;
  bench.figure(
      "tiles.unlike.mean", 100.0 * unlike_tiles(course, tiles, *histograms), "%", at_most(1.0),
      "of the tiles whose pixels all have a hue: those that calcHist and compareHist call otherwise");
  const Race tiled(course.rounds,
                   {on_ring(course.frames,
                            [&](std::size_t i) {
                              tiles.candidates(course.view(i), grid.whole(), spec.match, cut, course.found);
                            }),
                    on_ring(course.frames,
                            [&](std::size_t i) { histograms->match(course.view(i), spec.match, changed); })});
  bench.cost("tiles.ratio_to_calc_hist.median", tiled.ratio(1, 0), "x", at_least(40.0),
             fmt::format("calcHist and compareHist of each tile, {:.1f} ms, over ours, {:.3f} ms, in which "
                         "skin is judged, too; from RGB both",
                         tiled.seconds(1) * 1e3, tiled.seconds(0) * 1e3));

  std::vector<Mask> rough;  // what the filter is for: skin before it
  for (std::size_t i = 0; i < kRing; ++i) {
    tiles.candidates(course.view(i), grid.whole(), spec.match, cut, course.found);
    rough.push_back(course.found);
  }
  s::Majority majority(s::kernels(), spec.median, kWidth);
  Mask own(kWidth, kHeight), theirs(kWidth, kHeight);
  std::size_t unlike = 0;
  for (const Mask& mask : rough) {
    majority.filter(mask, mask.whole(), own);
    opencv.median(mask, spec.median, theirs);
    unlike += own.on == theirs.on ? 0U : 1U;
  }
  const Race filtered(
      course.rounds,
      {on_ring(course.frames, [&](std::size_t i) { majority.filter(rough[i], rough[i].whole(), own); }),
       on_ring(course.frames, [&](std::size_t i) { opencv.median(rough[i], spec.median, theirs); })});
  bench.cost("median.ratio_to_median_blur.median", filtered.ratio(1, 0), "x", at_least(8.0),
             fmt::format("medianBlur, {:.2f} ms, over ours, {:.3f} ms; of masks, side {}",
                         filtered.seconds(1) * 1e3, filtered.seconds(0) * 1e3, spec.median));
  bench.figure("median.unlike.count", static_cast<double>(unlike), "masks", exactly(0.0),
               fmt::format("of {} that medianBlur filters to other bits", kRing));
}

}  // namespace

void race(Bench& bench, const Place& place) {
  Course course(place, bench.context.quick ? 16 : 64);
  beside_copy(bench, course);
  if (place.opencv == nullptr) return;
  beside_pipeline(bench, course);
  beside_parts(bench, course);
}

}  // namespace enc::bench::segmentation
