// Where is the fingertip in a single frame? Hands from all sides before many backgrounds, each frame searched
// whole, without what came before it [VisHap 2.1.2, Fig 3]. Each background has a person of its own, with a
// finger of 10 to 25 mm whose K is known, as [VisHap] finds it for a configuration; then K is made wrong.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/fingertip/factors.h"
#include "benchmarks/fingertip/outline.h"
#include "benchmarks/fingertip/race.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/staged/staged.h"
#include "core/base/units.h"
#include "core/vision/finger_tracker.h"
#include "sim/camera/skin_tones.h"

namespace enc::bench::fingertip {
namespace {

using namespace staged;

// K is wrong by this factor; the first is what is judged.
constexpr std::array<double, 3> kScales{1.0, 0.75, 1.25};
constexpr std::size_t kEnough = 1000;  // frames, for a share of 1 % and for the law of depth in six bins
constexpr std::array<double, 7> kDepths{0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};  // m, edges of the bins

struct Found {
  double depth = 0.0, width = 0.0;  // m
  double across = kUnset;           // px, of the cap as drawn, its half width less K / z
  double area = kUnset;             // px, likewise of the circle of its outline's area
  std::array<double, kScales.size()> off{kUnset, kUnset,
                                         kUnset};  // px, from the true middle; none: not found
  double disparity = kUnset;                       // px, error
  double z = kUnset, place = kUnset;               // m, error in depth and in all
};
struct Cell {
  std::vector<Found> shots;
  std::size_t empty = 0, mistaken = 0;  // frames of the background alone; those with a tip in them
  StepCounts steps;
  std::vector<Image> picture;  // of the first shot: the frame and its skin
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

struct Asked {
  const sim::CameraModule* camera;
  StereoRig rig;
  SkinModel skin;
  double width;  // m, of the finger
  std::size_t shots;
  std::uint64_t seed;
};

Found look(std::vector<FingerTracker>& trackers, const Asked& asked, const Shot& shot, const Pair& pair,
           Time t) {
  Found found{.depth = shot.pose.tip.xyz[2], .width = shot.look.finger_width};
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

// One background, and hands before it.
Cell look_at(const Asked& asked) {
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

std::vector<Found> all_of(const std::vector<Cell>& cells) {
  std::vector<Found> all;
  for (const Cell& cell : cells) all.insert(all.end(), cell.shots.begin(), cell.shots.end());
  return all;
}
std::vector<double> offs(const std::vector<Found>& shots, std::size_t scale) {
  std::vector<double> values;
  for (const Found& f : shots)
    if (!std::isnan(f.off[scale])) values.push_back(f.off[scale]);
  return values;
}
double percent(std::size_t of, std::size_t all) {
  return 100.0 * static_cast<double>(of) / static_cast<double>(all);
}

void judge_tips(Bench& bench, const std::vector<Found>& shots, const std::string& id, double most_median) {
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

void judge_outline(Bench& bench, const std::vector<Found>& shots) {
  const std::vector<double> across = known(shots, &Found::across);
  bench.figure("outline.frames.percent", percent(across.size(), shots.size()), "%", at_least(90.0),
               "frames in which nothing hides the rim of the cap's far end, or half of it");
  bench.figure("outline.off.max", greatest(across), "px", at_most(0.5),
               "in these, half the cap's width as drawn against r = K / z: the outline's smaller half axis");
  bench.figure("outline.area_off.max", greatest(known(shots, &Found::area)), "px",
               "likewise, radius of the circle of the outline's area: far from the image's middle a sphere's "
               "outline is longer than wide");
}

void judge_gross(Bench& bench, const std::vector<Found>& shots, const std::string& id) {
  constexpr double kGross = 3.0;  // px
  const std::vector<double> errors = known(shots, &Found::disparity);
  const auto gross =
      std::count_if(errors.begin(), errors.end(), [](double error) { return std::abs(error) > kGross; });
  bench.figure(id + ".gross.count", static_cast<double>(gross), "frames", exactly(0.0),
               fmt::format("of {} with an error in disparity beyond {:g} px", errors.size(), kGross));
}

// Z^2 sigma / (f B), with the sigma that the disparity turned out to have.
void judge_depth(Bench& bench, const StereoRig& rig, const std::vector<Found>& shots) {
  const double fb = rig.left.focal_x * rig.X_CD.p().x();
  const double sigma = rms(known(shots, &Found::disparity));
  bench.figure("disparity.error.rms", sigma, "px", "of the cap's middle");
  judge_gross(bench, shots, "disparity");
  Series seen{.name = "twin", .mark = Mark::both}, law{.name = "Z2 sigma / (f B)"};
  double worst = 0.0, at_600 = kUnset;
  for (std::size_t i = 0; i + 1 < kDepths.size(); ++i) {
    std::vector<double> errors;
    for (const Found& f : shots)
      if (f.depth >= kDepths[i] && f.depth < kDepths[i + 1] && !std::isnan(f.z)) errors.push_back(f.z);
    const double z = 0.5 * (kDepths[i] + kDepths[i + 1]), expected = z * z * sigma / fb;
    worst = std::max(worst, std::abs(rms(errors) / expected - 1.0));
    seen.add(z * kMmPerM, rms(errors) * kMmPerM);
    law.add(z * kMmPerM, expected * kMmPerM);
  }
  std::vector<double> near_600;
  for (const Found& f : shots)
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

// So many backgrounds, each with hands of a width of its own.
std::vector<Asked> all_widths(const Asked& like, std::size_t stages) {
  std::vector<Asked> all(stages, like);
  for (std::size_t i = 0; i < stages; ++i) {
    all[i].width = finger_width(i, stages);
    all[i].seed += i;
  }
  return all;
}

void run(Bench& bench) {
  const sim::CameraModule& module = camera(bench.context);
  const std::size_t stages = bench.context.count(20, 4), shots = bench.context.quick ? 10 : 100;
  for (const int width : {640, 320}) {
    const StereoRig rig = head(width);
    const SkinModel skin = learned_skin(module, width);
    Asked like{&module, rig, skin, kUnset, shots, test_seed(bench.context)};
    const auto cells = bench.each(all_widths(like, stages), look_at);
    const std::vector<Found> found = all_of(cells);
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
      const std::vector<Found> fresh = all_of(bench.each(all_widths(like, stages / 2), look_at));
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
