// Which pixels are a bare hand? The published method beside the paper's figures, on pairs of its kind; where
// it fails, and what ours and OpenCV's do there [VisHap 2.1.1, 3, Fig 2].
#include <algorithm>

#include <fmt/format.h>

#include "benchmarks/segmentation/score.h"
#include "benchmarks/segmentation/speed.h"
#include "benchmarks/segmentation/thresholds.h"
#include "core/base/units.h"
#include "sim/camera/skin_tones.h"

namespace enc::bench::segmentation {
namespace {

using namespace staged;

// Light of an office: a lamp more or less, a cloud, a blind; gain of all light and how far it comes from a
// side.
constexpr std::array<sim::Light, 6> kOffice{{{.gain = 0.8, .side = 0.0},
                                             {.gain = 1.25, .side = 0.0},
                                             {.gain = 0.9, .side = 0.2},
                                             {.gain = 1.1, .side = -0.2},
                                             {.gain = 1.0, .side = 0.3},
                                             {.gain = 1.0, .side = -0.3}}};
constexpr std::size_t kChanged = kOffice.size();
constexpr int kTones = 4;  // fair to brown

// What the paper does not have, one thing at a time.
struct Row {
  const char *id, *title;
  sim::Scenery scenery = sim::Scenery::office;
  sim::Light light{};
  std::optional<sim::Tone> tone{};  // none: fair to brown in turn
  double exposure = 1.0;
  // Clips fair skin: judged by the mean over all tones, which a quick run has not, and not by its outline.
  bool clips = false;
};
const std::array<Row, 11> kRows{{
    {.id = "clutter", .title = "clutter", .scenery = sim::Scenery::clutter},
    {.id = "gain_half", .title = "half the light", .light = {.gain = 0.5}},
    {.id = "gain_double",
     .title = "twice the light, which clips fair skin",
     .light = {.gain = 2.0},
     .clips = true},
    {.id = "side", .title = "a lamp from the left, 0.8", .light = {.side = 0.8}},
    {.id = "colour", .title = "a lamp of RGB 1.25, 1, 0.75", .light = {.colour = {1.25F, 1.0F, 0.75F}}},
    {.id = "skin_hued", .title = "wood and cardboard", .scenery = sim::Scenery::skin_hued},
    {.id = "skin_hued_dimmed",
     .title = "wood and cardboard, 0.7 of the light",
     .scenery = sim::Scenery::skin_hued,
     .light = {.gain = 0.7}},
    {.id = "dark", .title = "dark skin", .tone = sim::Tone::dark},
    {.id = "dark_exposed",
     .title = "dark skin, exposed twice as long",
     .tone = sim::Tone::dark,
     .exposure = 2.0},
    {.id = "deep", .title = "deep skin", .tone = sim::Tone::deep},
    {.id = "deep_exposed",
     .title = "deep skin, exposed 3 times as long",
     .tone = sim::Tone::deep,
     .exposure = 3.0},
}};

sim::Tone tone_of(std::size_t i) { return static_cast<sim::Tone>(i % kTones); }

// So many pairs of the paper's kind, each of a scenery of its own; the last 6 (quick: 1) in changed light.
std::vector<Place> of_the_paper(const Place& like, std::uint64_t seed, std::size_t pairs) {
  std::vector<Place> places;
  const std::size_t changed = pairs < 4 * kChanged ? pairs / 4 : kChanged;
  for (std::size_t i = 0; i < pairs; ++i) {
    const bool changes = i + changed >= pairs;
    places.push_back(like);
    places.back().seed = seed + i;
    places.back().keeps = i == 0;
    places.back().takes = {{.row = changes ? "changed" : "steady",
                            .tone = tone_of(i),
                            .light = changes ? kOffice[pairs - 1 - i] : sim::Light{}}};
  }
  return places;
}

// All rows, each of so many places; what differs in light and skin alone shares them.
std::vector<Place> of_rows(const Place& like, std::uint64_t seed, std::size_t count) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < count; ++i)
    for (const Row& row : kRows) {
      const Take take{.row = row.id, .tone = row.tone.value_or(tone_of(i)), .light = row.light};
      const auto same = std::find_if(places.begin(), places.end(), [&](const Place& p) {
        return p.seed == seed + i && p.scenery == row.scenery && p.exposure == row.exposure;
      });
      if (same != places.end()) {
        same->takes.push_back(take);
        continue;
      }
      places.push_back(like);
      places.back().scenery = row.scenery;
      places.back().exposure = row.exposure;
      places.back().seed = seed + i;
      places.back().keeps = i == 0;
      places.back().takes = {take};
    }
  return places;
}

std::vector<Judged> judged(Bench& bench, const std::vector<Place>& places) {
  std::vector<Judged> all;
  for (auto& cell : bench.each(places, judge))
    for (Judged& each : cell) all.push_back(std::move(each));
  return all;
}

void tell(Bench& bench, const std::string& id, const Score& s, const std::string& what, bool paper) {
  struct Line {
    const char* id;
    const Mean& mean;
    double paper;
    Bounds bounds;
  };
  const std::array<Line, 3> lines{{{"correct", s.correct, 98.16, at_least(98.16)},
                                   {"false_positives", s.false_positives, 1.55, at_most(1.55)},
                                   {"false_negatives", s.false_negatives, 0.29, at_most(0.29)}}};
  for (const Line& line : lines) {
    const std::string note = fmt::format("of all pixels, {}; 95 % interval over {} pairs: {}", what, s.pairs,
                                         interval_text(line.mean, 3));
    if (paper)
      bench.figure(id + "." + line.id + ".mean", in_percent(line.mean), "%", predicted(line.paper),
                   line.bounds, note);
    else
      bench.figure(id + "." + line.id + ".mean", in_percent(line.mean), "%", line.bounds, note);
  }
  bench.figure(id + ".iou.mean", ends(s.iou), "", at_least(0.9),
               what + ": skin and what was found, intersection over union");
}

void judge_paper(Bench& bench, Table& table, const std::vector<Judged>& pairs) {
  tell(bench, "published", score(pairs, published), "the published method on pairs of the paper's kind",
       true);
  tell(bench, "ours", score(pairs, ours), "our method on the same pairs", false);
  double least = 1.0;
  for (const Judged& pair : pairs) least = std::min(least, pair.hand);
  bench.figure("hand.min", 1e2 * least, "%", at_least(1e2 * kLeastHand),
               "share of the frame that is skin, by truth");
  add_rows(table, "office", pairs);
  for (const sim::SkinTone& tone : sim::kSkinTones)
    add_rows(table, fmt::format("office, {}", word_of(tone.tone)), pairs,
             [&](const Judged& pair) { return pair.take.tone == tone.tone; });
  for (const char* light : {"steady", "changed"})
    add_rows(table, fmt::format("office, {} light", light), pairs,
             [&](const Judged& pair) { return pair.take.row == light; });
}

void judge_rows(Bench& bench, Table& table, const std::vector<Judged>& pairs) {
  for (const Row& row : kRows) {
    const auto of = [&](const Judged& pair) { return pair.take.row == row.id; };
    const Score theirs = score(pairs, published, of), own = score(pairs, ours, of);
    bench.figure(fmt::format("{}.published.correct.mean", row.id), in_percent(theirs.correct), "%",
                 fmt::format("{}: the published method", row.title));
    bench.figure(fmt::format("{}.ours.correct.mean", row.id), in_percent(own.correct), "%",
                 row.clips && bench.context.quick ? Bounds{} : at_least(98.16),
                 fmt::format("{}: ours", row.title));
    bench.figure(fmt::format("{}.ours.iou.mean", row.id), own.iou.value, "",
                 row.clips ? Bounds{} : at_least(0.9), fmt::format("{}: ours", row.title));
    add_rows(table, row.title, pairs, of);
  }
}

// Seeds that nobody looked at while this was built: the same but for chance.
void judge_never_seen(Bench& bench, Table& table, const std::vector<Judged>& seen,
                      const std::vector<Judged>& fresh) {
  add_rows(table, "office, seeds never looked at", fresh);
  struct Line {
    const char* id;
    Mean Score::*mean;
  };
  for (const Method method : {published, ours}) {
    const char* id = method == published ? "published" : "ours";
    tell(bench, fmt::format("never_seen.{}", id), score(fresh, method),
         fmt::format("{}, on seeds never looked at", kMethods[method]), false);
    for (const Line& line :
         {Line{"correct", &Score::correct}, Line{"false_positives", &Score::false_positives},
          Line{"false_negatives", &Score::false_negatives}}) {
      const Mean a = score(seen, method).*line.mean, b = score(fresh, method).*line.mean;
      bench.figure(
          fmt::format("never_seen.{}.{}.apart", id, line.id), apart(a, b), "", at_most(1.0),
          fmt::format("{:.3f} ({}) % on seeds never looked at, {:.3f} ({}) % on the others: the difference "
                      "over its 95 % interval",
                      1e2 * b.value, interval_text(b, 3), 1e2 * a.value, interval_text(a, 3)));
    }
  }
}

// Half as wide and high.
Image smaller(const Image& image) {
  Image half(image.width / 2, image.height / 2);
  const ImageView from = image.view();
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      for (int c = 0; c < 3; ++c)
        half.at(x, y)[c] =
            static_cast<std::uint8_t>((from.at(2 * x, 2 * y)[c] + from.at(2 * x + 1, 2 * y)[c] +
                                       from.at(2 * x, 2 * y + 1)[c] + from.at(2 * x + 1, 2 * y + 1)[c] + 2) /
                                      4);
  return half;
}

void show(Bench& bench, const std::vector<Judged>& paper, const std::vector<Judged>& rows) {
  const Shown& first = paper.front().shown;
  bench.picture({"fig2", "Segmentation",
                 "Background, image, and its skin by the published method [VisHap Fig 2].",
                 png({smaller(first.background), smaller(first.image), smaller(image_of(first.published))})});
  for (const Row& row : kRows) {
    const auto at =
        std::find_if(rows.begin(), rows.end(), [&](const Judged& pair) { return pair.take.row == row.id; });
    bench.picture({fmt::format("row_{}", row.id), fmt::format("Segmentation: {}", row.title),
                   "Image, its skin by the published method, and by ours.",
                   png({smaller(at->shown.image), smaller(image_of(at->shown.published)),
                        smaller(image_of(at->shown.ours))})});
  }
}

void tell_skin(Bench& bench, const SkinModel& all, const std::vector<SkinModel>& by_tone) {
  Table table{"skin", "Hue of skin, learned from training seeds", {"skin", "mean (deg)", "spread (deg)"}};
  for (std::size_t i = 0; i < by_tone.size(); ++i)
    table.add(word_of(sim::kSkinTones[i].tone), fmt::format("{:.2f}", by_tone[i].hue * kDegPerRad),
              fmt::format("{:.2f}", by_tone[i].spread * kDegPerRad));
  table.add("all", fmt::format("{:.2f}", all.hue * kDegPerRad),
            fmt::format("{:.2f}", all.spread * kDegPerRad));
  bench.table(std::move(table));
}

void run(Bench& bench) {
  Place like;
  like.camera = &camera(bench.context);
  const ModuleInfo* module = bench.context.module("peers");
  if (module != nullptr) like.opencv = static_cast<const PeersModule*>(module->peers)->opencv;
  if (like.opencv == nullptr)
    bench.result.note = "no race: OpenCV was not there when this was built (./encounter bench installs it)";
  std::vector<SkinModel> by_tone;
  like.skin = learned_skin(*like.camera, kWidth, &by_tone);
  tell_skin(bench, like.skin, by_tone);

  const std::size_t pairs = bench.context.count(24, 4);
  const std::uint64_t seed = test_seed(bench.context);
  const auto paper = judged(bench, of_the_paper(like, seed + 100, pairs));
  const auto rows = judged(bench, of_rows(like, seed + 200, bench.context.quick ? 1 : 8));
  Table table{"pairs",
              "Segmentation: percent of all pixels, means over pairs with their 95 % intervals",
              {"pairs of", "method", "pairs", "correct", "false positives", "false negatives", "IoU"}};
  judge_paper(bench, table, paper);
  judge_rows(bench, table, rows);
  if (!bench.context.quick)
    judge_never_seen(bench, table, paper, judged(bench, of_the_paper(like, kNeverSeen + 100, pairs)));
  bench.table(std::move(table));
  show(bench, paper, rows);
  if (!bench.context.quick) judge_thresholds(bench, like);
  like.seed = seed + 300;
  race(bench, like);
}

const Entry kEntry{"segmentation", "camera", "which pixels are a bare hand: published, ours, OpenCV's", run};

}  // namespace
}  // namespace enc::bench::segmentation
