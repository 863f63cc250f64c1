// Finds the fingertip in single frames: hands from all sides before many backgrounds. Each frame is searched
// whole, without the frame before it [VisHap 2.1.2, Fig 3]. Each background has its own person, with a finger
// of 10 to 25 mm whose K is known, as [VisHap] finds it for a configuration; then K is made wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/peers/peers.h"
#include "benchmarks/staged/staged.h"
#include "core/base/units.h"
#include "core/vision/finger/cap.h"
#include "core/vision/finger_tracker.h"
#include "core/vision/hand/hand_scene.h"
#include "core/vision/stereo/rectify.h"
#include "sim/camera/camera_scene.h"

namespace enc::bench::fingertip {
namespace {

using namespace staged;

// Size of the finger's cap as drawn: the outline of its sphere in the left image, an ellipse, measured in the
// true mask of skin.

struct Outline {
  // px, the ellipse's smaller half axis. It lies across the direction from the image's middle, and is f R /
  // sqrt(z2 - R2) wherever the cap is: the r = K / z of [VisHap]. Unset if the rim is hidden.
  double across = kUnset;
  double area =
      kUnset;  // px, radius of the circle of the ellipse's area: larger, the farther from the middle
};

// The part of the hand near a pixel at the rim. Only the finger comes within two diameters of the tip. So
// skin nearer or farther than cap and finger, however large they are drawn, is another part.
enum class RimPart : std::uint8_t { cap, behind, before };

RimPart seen(const Tangent& tangent, const staged::Shot& shot, const sim::PixelTruth& truth,
             const Pixel& at) {
  const auto x = static_cast<int>(std::lround(at.column)), y = static_cast<int>(std::lround(at.row));
  if (!truth.skin.whole().contains(x, y) || !truth.skin.at(x, y)) return RimPart::behind;
  const double z = static_cast<double>(
      truth.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.skin.width) +
                  static_cast<std::size_t>(x)]);
  const double radius = 0.5 * shot.look.finger_width;
  const double beyond =  // m, beyond the cap's middle
      z * tangent.ray({static_cast<double>(x), static_cast<double>(y)}).dot(tangent.view()) -
      shot.pose.tip.e().norm();
  if (beyond < -2.0 * radius) return RimPart::before;
  return beyond > 0.5 * radius ? RimPart::behind : RimPart::cap;
}

// Seen straight on, the outline is a circle within 60 degrees of the pointing direction: rays go from its
// middle to its edge. Rays on which another part of the hand covers the rim are left out.
Outline outline(const RectifiedPair& pair, const staged::Shot& shot, const sim::PixelTruth& truth) {
  constexpr double kStep = 0.05;  // px
  constexpr int kRays = 30;       // on either side, two degrees apart
  const Tangent tangent(pair, {truth.column, truth.row});
  const Vec3 along = shot.pose.along.e();
  const double ahead = std::atan2(along.dot(tangent.down()), along.dot(tangent.right()));
  const double radius = 0.5 * shot.look.finger_width, z = shot.pose.tip.xyz[2];
  const double share = radius / shot.pose.tip.e().norm();
  const double round = tangent.focal() * share / std::sqrt(1.0 - share * share);  // px, the expected radius
  double sum = 0.0;
  int rays = 0;
  for (int i = -kRays; i <= kRays; ++i) {
    const double angle = ahead + std::numbers::pi / 90.0 * i;
    double far = 0.5 * round;  // farther inside the image of a finger that points away is before its cap
    RimPart what = RimPart::cap;
    for (; what == RimPart::cap && far < 2.0 * round; far += kStep)
      what = seen(tangent, shot, truth, tangent.image({far * std::cos(angle), far * std::sin(angle)}));
    if (what == RimPart::before) continue;
    sum += far - 1.5 * kStep;  // between the last step on it and the first beyond
    ++rays;
  }
  if (rays < kRays) return {};
  const double size = sum / rays / round;
  return {size * pair.focal * radius / std::sqrt(z * z - radius * radius), size * truth.radius};
}

constexpr int kWidth = 640;           // px
constexpr double kPeriod = 1 / 20.0;  // s

// Null if the module was not built.
const OpenCv* opencv_of(const Bench& bench) {
  const ModuleInfo* module = bench.context.module("peers");
  const auto* peers = module != nullptr ? static_cast<const PeersModule*>(module->peers) : nullptr;
  return peers != nullptr ? peers->opencv : nullptr;
}

// A finger that moves to and fro before one background, as a camera's buffers hold it.
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

// Time for a stereo frame from pixels to the fingertip, beside OpenCV.

// A finger that moves at 300 mm/s. Without OpenCV there is no race.
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

// Factors on K; the first one is judged.
constexpr std::array<double, 3> kScales{1.0, 0.75, 1.25};
constexpr std::size_t kEnough = 1000;  // frames, for a share of 1 % and for the law of depth in six bins
constexpr std::array<double, 7> kDepths{0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};  // m, edges of the bins

struct TipMeasurement {
  double depth = 0.0, width = 0.0;  // m
  double across = kUnset;           // px, of the cap as drawn, its half width less K / z
  double area = kUnset;             // px, minus K / z: radius of the circle of its outline's area
  std::array<double, kScales.size()> off{kUnset, kUnset,
                                         kUnset};  // px, from the true middle; unset: not found
  double disparity = kUnset;                       // px, error
  double z = kUnset, place = kUnset;               // m, error in depth and in all
};
struct Cell {
  std::vector<TipMeasurement> shots;
  std::size_t empty = 0, mistaken = 0;  // frames of the background alone; background frames with a false tip
  StepCounts steps;
  std::vector<Image> picture;  // first shot: the frame and its skin mask
};

void add(StepCounts& sum, const StepCounts& more) {
  for (auto count :
       {&StepCounts::visited, &StepCounts::no_skin, &StepCounts::no_depth, &StepCounts::too_small,
        &StepCounts::circle, &StepCounts::square, &StepCounts::pairs, &StepCounts::candidates})
    sum.*count += more.*count;
}

FingerTracker tracker(const StereoRig& rig, const SkinModel& skin, double width, double scale) {
  SegmentationSpec segmentation;
  segmentation.model = skin;
  FingertipSpec tip;
  tip.radius = 0.5 * width;
  tip.scale = scale;
  return {rig, segmentation, tip, TrackSpec{}};
}

struct FingerSetup {
  const sim::CameraModule* camera;
  StereoRig rig;
  SkinModel skin;
  double width;  // m, of the finger
  std::size_t shots;
  std::uint64_t seed;
};

TipMeasurement look(std::vector<FingerTracker>& trackers, const FingerSetup& asked, const Shot& shot,
                    const Pair& pair, Time t) {
  TipMeasurement found{.depth = shot.pose.tip.xyz[2], .width = shot.look.finger_width};
  const double focal = asked.rig.left.focal_x;
  const Outline cap = outline(trackers.front().pair(), shot, pair.truth);
  const double radius = focal * 0.5 * found.width / found.depth;  // px, K / z
  found.across = cap.across - radius;
  found.area = cap.area - radius;
  for (std::size_t i = 0; i < trackers.size(); ++i) {
    trackers[i].forget();
    const Finger finger = trackers[i].see({pair.left.view(), pair.right.view()}, t);
    const Fingertip& tip = trackers[i].stats().tip;
    if (!tip.found) continue;
    const double off = std::hypot(tip.column - pair.truth.column, tip.row - pair.truth.row);
    if (off > within_cap(pair.truth)) continue;
    found.off[i] = off;
    if (i > 0 || finger.state != FingerState::seen) continue;
    found.disparity = finger.disparity - focal * asked.rig.X_CD.p().x() / found.depth;
    found.z = finger.tip.xyz[2] - found.depth;
    found.place = (finger.tip - shot.pose.tip).norm();
  }
  return found;
}

// One background, with many hands before it.
Cell look_at(const FingerSetup& asked) {
  sim::StageSpec spec;
  spec.camera = asked.rig;
  spec.seed = asked.seed;
  const auto stage = asked.camera->stage(spec);
  sim::Stream stream(asked.seed, "hands");
  std::vector<FingerTracker> trackers;
  trackers.reserve(kScales.size());
  for (const double scale : kScales) trackers.push_back(tracker(asked.rig, asked.skin, asked.width, scale));
  Cell cell;
  Pair pair;
  std::uint64_t frame = 0;
  const auto time = [&] { return Time(from_seconds(0.05 * static_cast<double>(frame))); };
  for (; frame < 10; ++frame) {
    stage->draw(nullptr, {}, {}, frame, pair.left, pair.right);
    for (FingerTracker& each : trackers) each.see({pair.left.view(), pair.right.view()}, time());
  }
  for (std::size_t i = 0; i < asked.shots; ++i, ++frame) {
    const auto tone =
        static_cast<sim::Tone>(stream.bits() % 4);  // dark skin: see the benchmark `segmentation`
    const Shot shot = drawn(asked.rig, {.thin = asked.width, .thick = asked.width}, tone, stream);
    stage->draw(&shot.pose, shot.look, {}, frame, pair.left, pair.right, &pair.truth);
    cell.shots.push_back(look(trackers, asked, shot, pair, time()));
    add(cell.steps, trackers.front().stats().steps);
    if (i > 0) continue;
    const Fingertip& tip = trackers.front().stats().tip;
    cell.picture = {pair.left, image_of(trackers.front().skin())};
    mark(cell.picture[0], tip.column, tip.row, {0, 255, 0});
    mark(cell.picture[1], tip.column, tip.row, {255, 0, 0});
  }
  for (; cell.empty < asked.shots / 10; ++cell.empty, ++frame) {
    stage->draw(nullptr, {}, {}, frame, pair.left, pair.right);
    trackers.front().forget();
    trackers.front().see({pair.left.view(), pair.right.view()}, time());
    cell.mistaken += trackers.front().stats().tip.found ? 1U : 0U;
  }
  return cell;
}

std::vector<TipMeasurement> all_of(const std::vector<Cell>& cells) {
  std::vector<TipMeasurement> all;
  for (const Cell& cell : cells) all.insert(all.end(), cell.shots.begin(), cell.shots.end());
  return all;
}
std::vector<double> offs(const std::vector<TipMeasurement>& shots, std::size_t scale) {
  std::vector<double> values;
  for (const TipMeasurement& f : shots)
    if (!std::isnan(f.off[scale])) values.push_back(f.off[scale]);
  return values;
}
double percent(std::size_t of, std::size_t all) {
  return 100.0 * static_cast<double>(of) / static_cast<double>(all);
}

void judge_tips(Bench& bench, const std::vector<TipMeasurement>& shots, const std::string& id,
                double most_median) {
  const std::vector<double> off = offs(shots, 0);
  bench.figure(id + ".found.percent", percent(off.size(), shots.size()), "%",
               shots.size() < kEnough ? Bounds{} : at_least(99.0),
               fmt::format("of {} frames; a tip beyond the cap, and 2 px off at least, counts as not found",
                           shots.size()));
  bench.figure(id + ".error.median", median(off), "px", at_most(most_median), "of the middle of the cap");
  const Tail tail = tail_of(off, 0.95);
  bench.figure(id + ".error." + tail.word, tail.value, "px", "of the middle of the cap");
}

void judge_empty(Bench& bench, const std::vector<Cell>& cells) {
  std::size_t empty = 0, mistaken = 0;
  for (const Cell& cell : cells) {
    empty += cell.empty;
    mistaken += cell.mistaken;
  }
  bench.figure("empty.mistaken.count", static_cast<double>(mistaken), "frames", exactly(0.0),
               fmt::format("of {} of the background alone: those in which there is a fingertip", empty));
}

double greatest(const std::vector<double>& values) {
  double most = values.empty() ? kUnset : 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

void judge_outline(Bench& bench, const std::vector<TipMeasurement>& shots) {
  const std::vector<double> across = known(shots, &TipMeasurement::across);
  bench.figure("outline.frames.percent", percent(across.size(), shots.size()), "%", at_least(90.0),
               "frames in which nothing hides the rim of the cap's far end, or half of it");
  bench.figure("outline.off.max", greatest(across), "px", at_most(0.5),
               "in these, half the cap's width as drawn against r = K / z: the outline's smaller half axis");
  bench.figure("outline.area_off.max", greatest(known(shots, &TipMeasurement::area)), "px",
               "likewise, radius of the circle of the outline's area: far from the image's middle a sphere's "
               "outline is longer than wide");
}

void judge_gross(Bench& bench, const std::vector<TipMeasurement>& shots, const std::string& id) {
  constexpr double kGross = 3.0;  // px
  const std::vector<double> errors = known(shots, &TipMeasurement::disparity);
  const auto gross =
      std::count_if(errors.begin(), errors.end(), [](double error) { return std::abs(error) > kGross; });
  bench.figure(id + ".gross.count", static_cast<double>(gross), "frames", exactly(0.0),
               fmt::format("of {} with an error in disparity beyond {:g} px", errors.size(), kGross));
}

// Z^2 sigma / (f B), with the measured sigma of the disparity.
void judge_depth(Bench& bench, const StereoRig& rig, const std::vector<TipMeasurement>& shots) {
  const double fb = rig.left.focal_x * rig.X_CD.p().x();
  const double sigma = rms(known(shots, &TipMeasurement::disparity));
  bench.figure("disparity.error.rms", sigma, "px", "of the cap's middle");
  judge_gross(bench, shots, "disparity");
  Series seen{.name = "twin", .mark = Mark::both}, law{.name = "Z2 sigma / (f B)"};
  double worst = 0.0, at_600 = kUnset;
  for (std::size_t i = 0; i + 1 < kDepths.size(); ++i) {
    std::vector<double> errors;
    for (const TipMeasurement& f : shots)
      if (f.depth >= kDepths[i] && f.depth < kDepths[i + 1] && !std::isnan(f.z)) errors.push_back(f.z);
    const double z = 0.5 * (kDepths[i] + kDepths[i + 1]), expected = z * z * sigma / fb;
    worst = std::max(worst, std::abs(rms(errors) / expected - 1.0));
    seen.add(z * kMmPerM, rms(errors) * kMmPerM);
    law.add(z * kMmPerM, expected * kMmPerM);
  }
  std::vector<double> near_600;
  for (const TipMeasurement& f : shots)
    if (std::abs(f.depth - 0.6) < 0.05 && !std::isnan(f.place)) near_600.push_back(f.place);
  at_600 = rms(near_600);
  bench.figure("depth.off_law.max", 100.0 * worst, "%", shots.size() < kEnough ? Bounds{} : at_most(30.0),
               "rms error in depth of 100 mm bins, against Z2 sigma / (f B)");
  bench.figure("place.at_600.rms", at_600 * kMmPerM, "mm", at_most(2.0),
               "in all three directions, 550 to 650 mm");
  bench.plot({.id = "depth",
              .title = "Depth of the fingertip",
              .x_label = "depth (mm)",
              .y_label = "rms error in depth (mm)",
              .series = {seen, law},
              .caption = "One frame, no filter."});
}

void tell_steps(Bench& bench, const std::vector<Cell>& cells) {
  StepCounts sum;
  for (const Cell& cell : cells) add(sum, cell.steps);
  Table table{"steps", "What each step of the pseudo-code dismissed", {"step", "pixels"}};
  table.add("1: no skin", sum.no_skin);
  table.add("2: no disparity", sum.no_depth);
  table.add("3: circle too small", sum.too_small);
  table.add("5: too little skin in the circle", sum.circle);
  table.add("7: too little or too much skin along the square", sum.square);
  table.add("9: pairs across the square", sum.pairs);
  table.add("10: candidates", sum.candidates);
  bench.table(std::move(table));
}

// A number of backgrounds, each with hands of its own finger width.
std::vector<FingerSetup> all_widths(const FingerSetup& like, std::size_t stages) {
  std::vector<FingerSetup> all(stages, like);
  for (std::size_t i = 0; i < stages; ++i) {
    all[i].width = finger_width(i, stages);
    all[i].seed += i;
  }
  return all;
}

// The factors that the printed pseudo-code lost, steps 5 and 7, and the size of the square of step 6: the
// detections for each value.
namespace factors {

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
  SkinModel skin;
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
  SegmentationSpec segmentation;
  segmentation.model = place.skin;
  FingertipSpec shipped;
  shipped.radius = 0.5 * place.width;
  HandScene scene(spec.camera, segmentation, shipped, {});
  const Region all = scene.frame();
  auto finders = finders_of(scene, shipped);
  Pair pair;
  std::uint64_t frame = 0;
  for (; frame < 10; ++frame) {
    stage->draw(nullptr, {}, {}, frame, pair.left, pair.right);
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

// Uses training seeds, so that a value chosen by them is not tuned on the judged seeds.
void tell(Bench& bench, const sim::CameraModule& camera, const SkinModel& skin) {
  const std::size_t places = bench.context.quick ? 2 : 16;
  std::vector<Place> asked;
  for (std::size_t i = 0; i < places; ++i)
    asked.push_back({&camera, skin, finger_width(i, places), kTraining + 500 + i});
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

}  // namespace factors

void run(Bench& bench) {
  const sim::CameraModule& module = camera(bench.context);
  const std::size_t stages = bench.context.count(20, 4), shots = bench.context.quick ? 10 : 100;
  for (const int width : {640, 320}) {
    const StereoRig rig = head(width);
    const SkinModel skin = learned_skin(module, width);
    FingerSetup like{&module, rig, skin, kUnset, shots, test_seed(bench.context)};
    const auto cells = bench.each(all_widths(like, stages), look_at);
    const std::vector<TipMeasurement> found = all_of(cells);
    judge_tips(bench, found, fmt::format("tip.{}", width), width == 640 ? 1.0 : 2.0);
    if (width != 640) continue;
    judge_empty(bench, cells);
    judge_outline(bench, found);
    for (const std::size_t scale : {1U, 2U}) {
      const std::vector<double> off = offs(found, scale);
      const std::string id = fmt::format("k.{:.0f}", 100.0 * kScales[scale]);
      bench.figure(id + ".found.percent", percent(off.size(), found.size()), "%", "K wrong by this share");
      bench.figure(id + ".error.median", median(off), "px", "K wrong by this share");
    }
    judge_depth(bench, rig, found);
    tell_steps(bench, cells);
    factors::tell(bench, module, skin);
    race(bench, module, skin);
    if (!bench.context.quick) {
      like.seed = kNeverSeen + 500;
      const std::vector<TipMeasurement> fresh = all_of(bench.each(all_widths(like, stages / 2), look_at));
      judge_tips(bench, fresh, "never_seen", 1.0);
      judge_gross(bench, fresh, "never_seen");
    }
    bench.picture({"fig3", "Fingertip", "A frame and its skin; the cross is the fingertip [VisHap Fig 3].",
                   png(cells.front().picture)});
  }
}

const Entry kEntry{"fingertip", "camera", "where the fingertip is in single frames, and how deep", run};

}  // namespace
}  // namespace enc::bench::fingertip
