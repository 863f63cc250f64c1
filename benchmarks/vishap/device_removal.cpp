// Removal of the haptic device from the user's view: whether the device is gone, the hand still there, and
// virtual objects in place. Also the effect on the tracker of an arm that crosses the picture.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/vishap/vishap.h"
#include "core/base/units.h"
#include "core/vision/augment/view_parts.h"
#include "core/vision/finger_tracker.h"
#include "core/vision/stereo/rectify.h"
#include "trial/assemble/assemble.h"
#include "trial/assemble/vision.h"

namespace enc::bench::vishap {
namespace {

using namespace staged;

constexpr std::size_t kLearning = 10;  // frames, of the background
constexpr double kHidden = 0.1;        // share of the cap: a larger share counts as hidden

struct BeliefEntry {
  const char* id;
  const char* words;
  Belief belief;
};
// m, along each axis: a typical registration error (docs/guide/registration.md), and the shift of a head that
// was hit.
constexpr double kRegistration = 0.3e-3, kHit = 5e-3;
const std::array<BeliefEntry, 3> kBeliefs{
    {{"shipped", "as shipped: the rig believes what is true", {}},
     {"registration",
      "registration off by 0.3 mm along each axis",
      {Vec<'C'>(kRegistration, kRegistration, kRegistration)}},
     {"moved", "camera moved sideways by 5 mm after it was registered", {Vec<'C'>(kHit, 0, 0)}}}};

struct Removal {
  std::vector<double> device, hand, background;  // shares of a frame
  std::vector<double> known, filled;             // grey levels, of a frame
  std::vector<double> overlay;                   // px, of an edge
  std::vector<double> seconds;
  std::size_t unknown = 0, taken = 0;  // pixels replaced from their surroundings; all replaced pixels
};
struct DetectionCounts {
  std::size_t frames = 0, found = 0, elsewhere = 0, nobody = 0, mistaken = 0;
  std::vector<double> pixels, place;  // px, m
};
struct Cell {
  std::array<Removal, kBeliefs.size()> removal;
  std::array<DetectionCounts, 2> seen;          // results with the arm, without it
  std::array<DetectionCounts, 2> meets;         // the prop under the fingertip
  std::array<DetectionCounts, 2> open, hidden;  // results by the share of the cap that the arm hides
  std::vector<Image> picture;
};

// `shown`: the picture without the device.
void judge(const AugmentedView& view, const Image& shown, const sim::PixelTruth& truth, const Image& empty,
           Removal& removal) {
  std::size_t device = 0, gone = 0, skin = 0, lost = 0, room = 0, wrong = 0;
  std::array<double, 2> off{};
  std::array<std::size_t, 2> counted{};
  for (std::size_t i = 0; i < truth.skin.on.size(); ++i) {
    const bool replaced = view.replaced().on[i] != 0;
    if (truth.things.on[i] != 0) {
      ++device;
      if (!replaced) continue;
      ++gone;
      const std::size_t filled = view.known().on[i] == 0 ? 1 : 0;
      ++counted[filled];
      for (std::size_t c = 0; c < 3; ++c)
        off[filled] += std::abs(shown.rgb[3 * i + c] - empty.rgb[3 * i + c]) / 3.0;
    } else if (truth.skin.on[i] != 0) {
      ++skin;
      lost += replaced ? 1 : 0;
    } else {
      ++room;
      wrong += replaced ? 1 : 0;
    }
  }
  const auto share = [](std::size_t of, std::size_t all) {
    return 100.0 * static_cast<double>(of) / static_cast<double>(all);
  };
  if (device > 0) removal.device.push_back(share(gone, device));
  if (skin > 0) removal.hand.push_back(share(skin - lost, skin));
  removal.background.push_back(share(wrong, room));
  removal.unknown += counted[1];
  removal.taken += counted[0] + counted[1];
  if (counted[0] > 0) removal.known.push_back(off[0] / static_cast<double>(counted[0]));
  if (counted[1] > 0) removal.filled.push_back(off[1] / static_cast<double>(counted[1]));
}

// Distance in the picture between each edge of the drawn square of the wall and its true place, px, mean
// along the edge. Pixels that only the picture or only the truth has count for the nearest edge.
void judge_overlay(const ArmPlay& play, const models::Setup& setup, const AugmentedSpec& spec,
                   const Object& object, const AugmentedView& view, Removal& removal) {
  const Rectifier rectifier(spec.camera);
  const StereoRig truth = trial::stage_of(setup.twin.camera, 0).camera;
  std::array<Vec3, 4> corner;  // column, row, 0
  constexpr double kHalf = 0.5 * augment::kPatch;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point<'O'> at(i == 0 || i == 3 ? -kHalf : kHalf, i < 2 ? -kHalf : kHalf, 0.0);
    const Vec3 is = play.in_camera(object.X_WO * at).e();
    const Pixel there =
        rectifier.rectified(Side::left, project(truth.left, {is.x() / is.z(), is.y() / is.z()}));
    corner[i] = {there.column, there.row, 0.0};
  }
  const double turn = (corner[1] - corner[0]).cross(corner[2] - corner[0]).z() > 0.0 ? 1.0 : -1.0;
  std::array<double, 8> pixels{};  // two halves of each edge: a turned edge is off to both sides
  const Image &with = view.augmented(), &without = view.removed();
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x) {
      double inside = HUGE_VAL;  // px to the nearest edge; negative outside
      std::size_t nearest = 0, half = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 edge = corner[(i + 1) % 4] - corner[i], way = Vec3(x, y, 0.0) - corner[i];
        const double distance = turn * edge.normalized().cross(way).z();
        if (!(distance < inside)) continue;
        inside = distance;
        nearest = i;
        half = edge.dot(way) > 0.5 * edge.squaredNorm() ? 1 : 0;
      }
      const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(with.width) +
                                  static_cast<std::size_t>(x));
      const bool drawn = !std::equal(&with.rgb[at], &with.rgb[at] + 3, &without.rgb[at]);
      if (drawn != (inside >= 0.0)) pixels[2 * nearest + half] += drawn ? 1.0 : -1.0;
    }
  for (std::size_t i = 0; i < 4; ++i) {
    const double half = 0.5 * (corner[(i + 1) % 4] - corner[i]).norm();
    removal.overlay.push_back(0.5 * (std::abs(pixels[2 * i]) + std::abs(pixels[2 * i + 1])) / half);
  }
}

// Share of the unobstructed cap's skin that the arm hides.
double hidden_share(const sim::PixelTruth& with, const sim::PixelTruth& without) {
  const double r = without.radius;
  const auto span = [&](double middle) {
    return std::pair(static_cast<int>(std::floor(middle - r)), static_cast<int>(std::ceil(middle + r)) + 1);
  };
  const auto [x0, x1] = span(without.column);
  const auto [y0, y1] = span(without.row);
  const Region cap = Region{x0, y0, x1, y1}.cut(without.skin.whole());
  std::size_t all = 0, left = 0;
  for (int y = cap.y0; y < cap.y1; ++y)
    for (int x = cap.x0; x < cap.x1; ++x) {
      if (!without.skin.at(x, y) || std::hypot(x - without.column, y - without.row) > r) continue;
      ++all;
      left += with.skin.at(x, y) ? 1 : 0;
    }
  return all == 0 ? 0.0 : 1.0 - static_cast<double>(left) / static_cast<double>(all);
}

void note(const FingerTracker& tracker, const sim::CameraScene& shown, const sim::PixelTruth& truth,
          DetectionCounts& seen) {
  const LookStats& stats = tracker.stats();
  const bool found = stats.found.disparity > 0.0;
  if (!shown.hand) {
    ++seen.nobody;
    seen.mistaken += found ? 1 : 0;
    return;
  }
  ++seen.frames;
  if (!found) return;
  const double off = std::hypot(stats.found.column - truth.column, stats.found.row - truth.row);
  if (off > within_cap(truth)) {
    ++seen.elsewhere;
    return;
  }
  ++seen.found;
  seen.pixels.push_back(off);
  seen.place.push_back((triangulate(tracker.pair(), stats.found).e() - shown.pose.tip.e()).norm());
}

struct RemovalSetup {
  const sim::CameraModule* camera;
  const models::Setup* setup;
  std::uint64_t seed;
  std::size_t frames;
  // Mutants: a margin of 12 px around the arm, and the camera's picture for the one without the device.
  bool wide_margin, device_stays;
};

// One for each belief.
struct Views {
  std::vector<AugmentedSpec> specs;
  std::vector<std::unique_ptr<AugmentedView>> all;
};
Views views_of(const ArmPlay& play, const Scene& scene, bool wide_margin) {
  Views views;
  views.all.reserve(kBeliefs.size());
  for (std::size_t b = 0; b < kBeliefs.size(); ++b) {
    views.specs.push_back(play.believed(kBeliefs[b].belief));
    if (wide_margin) views.specs.back().margin = 12.0;
    views.all.push_back(std::make_unique<AugmentedView>(views.specs.back(), scene.objects));
  }
  return views;
}

// Two: for the pictures with the arm, and for those without it.
std::vector<FingerTracker> trackers_of(const models::Setup& setup) {
  const VisionRig& vision = setup.rig.vision;
  std::vector<FingerTracker> trackers;
  trackers.reserve(2);
  for (int i = 0; i < 2; ++i)
    trackers.emplace_back(setup.rig.camera, vision.segmentation, vision.fingertip, vision.track,
                          vision.match);
  return trackers;
}

// Searches a frame with the arm and without it (`bare`). Frames from which the trackers learn do not count.
void see_fingertips(std::vector<FingerTracker>& trackers, const ArmPlay::Frame& frame, const Pair& bare,
                    Time t, bool learning, Cell& cell) {
  for (std::size_t a = 0; a < 2; ++a) {
    const Pair& pair = a == 0 ? frame.pair : bare;
    trackers[a].forget();  // each frame alone: earlier frames do not help
    static_cast<void>(trackers[a].see({pair.left.view(), pair.right.view()}, t));
    if (learning) continue;
    note(trackers[a], frame.shown, pair.truth, cell.seen[a]);
    if (!frame.shown.hand) continue;
    if (frame.meets) note(trackers[a], frame.shown, pair.truth, cell.meets[a]);
    const bool hidden = hidden_share(frame.pair.truth, bare.truth) > kHidden;
    note(trackers[a], frame.shown, pair.truth, (hidden ? cell.hidden : cell.open)[a]);
  }
}

Cell measure(const RemovalSetup& asked) {
  const models::Setup& setup = *asked.setup;
  ArmPlay play(setup, *asked.camera, asked.seed);
  const Scene scene = trial::prepare_setup(setup);
  Cell cell;
  const Views views = views_of(play, scene, asked.wide_margin);
  std::vector<FingerTracker> trackers = trackers_of(setup);
  const Image empty = play.empty();
  std::vector<ArmPlay::Frame> rest(kLearning);
  std::vector<Pair> without(kLearning);
  play.rest(rest, without);
  ArmPlay::Frame frame;
  Pair bare;
  for (std::size_t i = 0; i < kLearning + asked.frames; ++i) {
    const bool learning = i < kLearning;
    if (learning) {
      frame = rest[i];
      bare = without[i];
    } else {
      play.next(frame);
      play.without_arm(frame, bare);
    }
    for (std::size_t b = 0; b < views.all.size(); ++b) {
      const double start = thread_seconds();
      views.all[b]->see(frame.pair.left.view(), frame.moment);
      if (i + 1 == kLearning)  // no person is there yet to cover a part of the background
        judge_overlay(play, setup, views.specs[b], scene.objects.front(), *views.all[b], cell.removal[b]);
      if (learning) continue;
      cell.removal[b].seconds.push_back(thread_seconds() - start);
      const Image& shown = asked.device_stays ? frame.pair.left : views.all[b]->removed();
      judge(*views.all[b], shown, frame.pair.truth, empty, cell.removal[b]);
    }
    const Time t(from_seconds(0.05 * static_cast<double>(i)));
    see_fingertips(trackers, frame, bare, t, learning, cell);
    if (frame.meets && i > kLearning + asked.frames / 2)
      cell.picture = {frame.pair.left, views.all[0]->removed(), views.all[0]->augmented()};
  }
  return cell;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

Removal all_of(const std::vector<Cell>& cells, std::size_t belief) {
  Removal all;
  for (const Cell& cell : cells) {
    const Removal& one = cell.removal[belief];
    for (const auto member : {&Removal::device, &Removal::hand, &Removal::background, &Removal::known,
                              &Removal::filled, &Removal::overlay, &Removal::seconds})
      append(all.*member, one.*member);
    all.unknown += one.unknown;
    all.taken += one.taken;
  }
  return all;
}

DetectionCounts all_of(const std::vector<Cell>& cells, const std::array<DetectionCounts, 2> Cell::*which,
                       std::size_t arm) {
  DetectionCounts all;
  for (const Cell& cell : cells) {
    const DetectionCounts& one = (cell.*which)[arm];
    for (const auto member : {&DetectionCounts::frames, &DetectionCounts::found, &DetectionCounts::elsewhere,
                              &DetectionCounts::nobody, &DetectionCounts::mistaken})
      all.*member += one.*member;
    append(all.pixels, one.pixels);
    append(all.place, one.place);
  }
  return all;
}

double least(const std::vector<double>& values) {
  return values.empty() ? kUnset : *std::min_element(values.begin(), values.end());
}
double most(const std::vector<double>& values) {
  return values.empty() ? kUnset : *std::max_element(values.begin(), values.end());
}

void tell_removal(Bench& bench, const Removal& shipped) {
  bench.figure(
      "removal.device_percent.mean", mean(shipped.device), "%", at_least(99.0),
      fmt::format("true pixels of arm and prop that are replaced, of {} frames", shipped.device.size()));
  bench.figure("removal.device_percent.worst", least(shipped.device), "%", at_least(95.0), "of a frame");
  // 99.98 % over six seeds of two rooms, 99.8 % over six rooms.
  bench.figure("removal.hand_kept_percent.mean", mean(shipped.hand), "%",
               at_least(bench.context.full ? 99.5 : 99.8), "true pixels of skin that stay");
  bench.figure("removal.hand_kept_percent.worst", least(shipped.hand), "%", "of a frame");
  bench.figure(
      "removal.background_percent.mean", mean(shipped.background), "%", at_most(5.0),
      "pixels of room and sleeve that are replaced: the margin round the arm, and a sleeve before it");
  bench.figure(
      "removal.residual.mean", mean(shipped.known), "levels", at_most(3.0),
      "from the true empty room, of 255, where the background is known; the sensor's noise is 1.5 rms");
  bench.figure("removal.residual_filled.mean", mean(shipped.filled), "levels",
               "the same where the device never moved away: smoothly from what lies around");
  bench.figure("removal.filled_percent",
               100.0 * static_cast<double>(shipped.unknown) / static_cast<double>(shipped.taken), "%",
               "of the replaced device pixels, such as its base");
  bench.cost("removal.time.median", median(shipped.seconds) * 1e3, "ms", "CPU time of a frame");
}

void tell_beliefs(Bench& bench, const std::vector<Cell>& cells) {
  Table table{.id = "removal",
              .title = "The device removed, an object overlaid: what a wrong registration does",
              .columns = {"what is believed", "device removed (%)", "worst frame (%)", "overlay, mean (px)",
                          "overlay, most (px)"}};
  for (std::size_t b = 0; b < kBeliefs.size(); ++b) {
    const Removal all = all_of(cells, b);
    bench.figure(fmt::format("overlay.error_px.{}", kBeliefs[b].id), mean(all.overlay), "px",
                 b == 0 ? at_most(0.3) : Bounds{},
                 fmt::format("edges of the wall in the picture from where they are; {}", kBeliefs[b].words));
    if (b > 0)
      bench.figure(fmt::format("removal.device_percent.{}", kBeliefs[b].id), mean(all.device), "%",
                   kBeliefs[b].words);
    table.add(kBeliefs[b].words, fixed(mean(all.device), 3), fixed(least(all.device), 2),
              fixed(mean(all.overlay), 2), fixed(most(all.overlay), 2));
  }
  bench.table(std::move(table));
}

void tell_tracker(Bench& bench, const std::vector<Cell>& cells) {
  struct Row {
    const char* id;
    const char* words;
    const std::array<DetectionCounts, 2> Cell::*which;
  };
  const std::array<Row, 4> rows{{{"all", "all", &Cell::seen},
                                 {"meets", "prop under the fingertip", &Cell::meets},
                                 {"open", "the arm hides less than a tenth of the cap", &Cell::open},
                                 {"hidden", "the arm hides more of it", &Cell::hidden}}};
  Table table{.id = "arm_in_view",
              .title = "What an arm in view is to the tracker: each frame searched whole",
              .columns = {"hands", "arm", "frames", "found (%)", "elsewhere (%)", "error (px)", "error (mm)",
                          "tips where nobody is"}};
  const auto percent = [](std::size_t of, std::size_t all) {
    return 100.0 * static_cast<double>(of) / static_cast<double>(std::max<std::size_t>(1, all));
  };
  for (const Row& row : rows)
    for (std::size_t arm = 0; arm < 2; ++arm) {
      const DetectionCounts seen = all_of(cells, row.which, arm);
      const char* drawn = arm == 0 ? "with" : "without";
      table.add(row.words, drawn, seen.frames, fixed(percent(seen.found, seen.frames), 1),
                fixed(percent(seen.elsewhere, seen.frames), 1), fixed(mean(seen.pixels), 2),
                fixed(mean(seen.place) * kMmPerM, 2), fmt::format("{} of {}", seen.mistaken, seen.nobody));
      const std::string id = fmt::format("arm_in_view.{}.{}", drawn, row.id);
      const bool judged = arm == 0 && row.which == &Cell::open;
      if (seen.frames == 0 && !judged) continue;
      bench.figure(id + ".found_percent", percent(seen.found, seen.frames), "%",
                   judged ? at_least(95.0) : Bounds{},
                   fmt::format("fingertips found within the cap, of {}: {}", seen.frames, row.words));
      bench.figure(id + ".place.mean", mean(seen.place) * kMmPerM, "mm", "from the true middle of the cap");
    }
  const DetectionCounts nobody = all_of(cells, &Cell::seen, 0);
  bench.figure(
      "arm_in_view.mistaken.count", static_cast<double>(nobody.mistaken), "frames", exactly(0.0),
      fmt::format("of {} without a hand: a fingertip is seen in the arm or what it uncovers", nobody.nobody));
  bench.table(std::move(table));
}

}  // namespace

void add_device_removal(Bench& bench) {
  const models::Setup setup = bench.setup();
  const bool full = bench.context.full;
  const std::size_t rooms = full ? 6 : 2, frames = full ? 60 : 16;
  std::vector<RemovalSetup> asked;
  for (std::size_t i = 0; i < rooms; ++i)
    asked.push_back({&camera(bench.context), &setup, test_seed(bench.context) + 800 + i, frames,
                     bench.context.mutated("wide_margin"), bench.context.mutated("device_stays")});
  const std::vector<Cell> cells = bench.each(asked, measure);
  tell_removal(bench, all_of(cells, 0));
  tell_beliefs(bench, cells);
  tell_tracker(bench, cells);
  bench.picture(
      {.id = "removal",
       .title = "The device removed, an object overlaid",
       .caption = "The left camera's image; without the device; with the virtual wall in its place.",
       .png = png(cells.front().picture)});
}

}  // namespace enc::bench::vishap
