#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/fingertip/fingertip.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/hand/hand_scene.h"
#include "sim/camera/camera_scene.h"

namespace enc::bench::fingertip::factors {
namespace {

using namespace staged;

// The factors that the printed pseudo-code lost, steps 5 and 7, and the size of the square of step 6.

// A factor and its values; the others stay as shipped.
struct Factor {
  const char *key, *title;
  double FingertipSpec::*member;
  std::array<double, 7> values;
};
constexpr std::array<Factor, 4> kFactors{{
    {"circle_share",
     "step 5, least share of skin in the circle",
     &FingertipSpec::circle_share,
     {0.30, 0.50, 0.60, 0.70, 0.80, 0.90, 0.97}},
    {"square_radii",
     "step 6, half a side of the square, in r",
     &FingertipSpec::square_radii,
     {1.2, 1.4, 1.55, 1.7, 1.85, 2.0, 2.5}},
    {"square_least_radii",
     "step 7, least skin along the square, in r",
     &FingertipSpec::square_least,
     {0.0, 0.7, 1.1, 1.4, 1.7, 2.0, 2.4}},
    {"square_most_radii",
     "step 7, most skin along the square, in r",
     &FingertipSpec::square_most,
     {2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 9.0}},
}};
// The content of a frame.
enum Kind : std::uint8_t { finger, hidden, nothing, kKinds };

struct Counts {
  int frames = 0, right = 0, wrong = 0;
};
using Cell = std::array<std::array<std::array<Counts, 7>, kFactors.size()>, kKinds>;

struct Place {
  const sim::CameraModule* camera;
  const VisionRig* vision;
  double width;  // m, of the finger
  std::uint64_t seed;
};

// The straight finger points away and the fist covers it: folded fingers and a thumb stay visible.
Shot fist(const StereoRig& rig, const Draw& draw, sim::Tone tone, sim::Stream& stream) {
  Draw farther = draw;
  farther.near = 0.35;  // the fist is a finger's length nearer
  Shot shot = drawn(rig, farther, tone, stream);
  const Vec3 ray = shot.pose.tip.e().normalized();
  const double aslant = 0.15 * stream.uniform(), side = 2.0 * std::numbers::pi * stream.uniform();
  shot.pose.along = Vec<'C'>(Vec3(ray + aslant * Vec3(std::cos(side), std::sin(side), 0.0)));
  return shot;
}

// Finders for the same images, one for each value of each factor.
std::vector<std::vector<FingertipFinder>> finders_of(const HandScene& scene, const FingertipSpec& shipped) {
  std::vector<std::vector<FingertipFinder>> finders(kFactors.size());
  for (std::size_t f = 0; f < kFactors.size(); ++f)
    for (const double value : kFactors[f].values) {
      FingertipSpec tip = shipped;
      tip.*kFactors[f].member = value;
      finders[f].push_back(scene.finder_with(tip));
    }
  return finders;
}

void count(const Fingertip& tip, const sim::PixelTruth& truth, Kind kind, Counts& counts) {
  const double off = std::hypot(tip.column - truth.column, tip.row - truth.row);
  const bool right = kind == finger && tip.found && off <= within_cap(truth);
  ++counts.frames;
  counts.right += right ? 1 : 0;
  counts.wrong += tip.found && !right ? 1 : 0;
}

Cell look_at(const Place& place) {
  constexpr int kFrames = 24;  // of each kind
  sim::StageSpec spec;
  spec.camera = head(640);
  spec.seed = place.seed;
  const auto stage = place.camera->stage(spec);
  FingertipSpec shipped = place.vision->fingertip;
  shipped.radius = 0.5 * place.width;
  HandScene scene(spec.camera, place.vision->segmentation, shipped, place.vision->match);
  const Region all = scene.frame();
  auto finders = finders_of(scene, shipped);
  Pair pair;
  std::uint64_t frame = 0;
  for (const int frames = place.vision->segmentation.background_frames;
       frame < static_cast<std::uint64_t>(frames); ++frame) {
    expose(*stage, frame, pair);
    scene.learn({pair.left.view(), pair.right.view()});
  }
  Cell cell{};
  sim::Stream stream(place.seed, "hands");
  const Draw draw{.thin = place.width, .thick = place.width};
  for (int i = 0; i < kKinds * kFrames; ++i, ++frame) {
    const auto kind = static_cast<Kind>(i % kKinds);
    const auto tone = static_cast<sim::Tone>(stream.bits() % 4);
    const Shot shot =
        kind == hidden ? fist(spec.camera, draw, tone, stream) : drawn(spec.camera, draw, tone, stream);
    stage->draw(kind == nothing ? nullptr : &shot.pose, shot.look, {}, frame, pair.left, pair.right,
                &pair.truth);
    scene.look({pair.left.view(), pair.right.view()}, all, {});
    for (std::size_t f = 0; f < finders.size(); ++f)
      for (std::size_t v = 0; v < finders[f].size(); ++v)
        count(finders[f][v].find(scene.skin(), scene.disparity(), all), pair.truth, kind, cell[kind][f][v]);
  }
  return cell;
}

double percent(int of, int all) { return 100.0 * of / all; }

}  // namespace

void tell(Bench& bench, const sim::CameraModule& camera, const VisionRig& vision) {
  const std::size_t places = 16;
  std::vector<Place> asked;
  for (std::size_t i = 0; i < places; ++i)
    asked.push_back({&camera, &vision, finger_width(i, places), kTraining + 500 + i});
  Cell sum{};
  for (const Cell& cell : bench.each(asked, look_at))
    for (std::size_t k = 0; k < kKinds; ++k)
      for (std::size_t f = 0; f < kFactors.size(); ++f)
        for (std::size_t v = 0; v < kFactors[f].values.size(); ++v) {
          sum[k][f][v].frames += cell[k][f][v].frames;
          sum[k][f][v].right += cell[k][f][v].right;
          sum[k][f][v].wrong += cell[k][f][v].wrong;
        }
  Table table{
      "factors",
      "Factors of steps 5 to 7, training seeds (% of frames)",
      {"factor", "value", "fingertip found", "found beside it", "found in a fist", "found in nothing"}};
  std::vector<Series> lines;
  for (std::size_t f = 0; f < kFactors.size(); ++f) {
    Series line{.name = kFactors[f].title, .mark = Mark::both};
    for (std::size_t v = 0; v < kFactors[f].values.size(); ++v) {
      const Counts &with = sum[finger][f][v], &fists = sum[hidden][f][v], &none = sum[nothing][f][v];
      const double found = percent(with.right, with.frames), wrong = percent(fists.wrong, fists.frames);
      table.add(kFactors[f].key, fmt::format("{:g}", kFactors[f].values[v]), fixed(found, 1),
                fixed(percent(with.wrong, with.frames), 1), fixed(wrong, 1),
                fixed(percent(none.wrong, none.frames), 1));
      line.add(wrong, found);
    }
    lines.push_back(std::move(line));
  }
  bench.table(std::move(table));
  bench.plot({.id = "factors",
              .title = "Factors of steps 5 to 7",
              .x_label = "fists in which a fingertip is found (%)",
              .y_label = "fingertips found (%)",
              .series = std::move(lines),
              .caption = "Along a line one factor changes, the others stay as shipped; the lines cross at "
                         "the shipped ones. The end of a folded finger is a fingertip by all ten steps."});
}

}  // namespace enc::bench::fingertip::factors
