// The encounter of a bare finger: whether the prop is there before the finger, how far beside it they meet,
// and how hard [VisHap 2.2].
#include "benchmarks/reaching/reaching.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "benchmarks/kit/force_precision.h"
#include "benchmarks/kit/kit.h"

namespace enc::bench::reaching {
namespace {

const char* name_of(Seen how) { return how == Seen::vision ? "seen at 20 Hz, 50 ms late" : "seen live"; }
std::string key_of(Seen how) { return how == Seen::vision ? "vision." : "live."; }

double percent(const std::vector<ReachOutcome>& reaches, const std::function<bool(const ReachOutcome&)>& is) {
  return 100.0 * static_cast<double>(std::count_if(reaches.begin(), reaches.end(), is)) /
         static_cast<double>(reaches.size());
}

const std::array<std::string, 2> kScenes{"wall", "keypad"};

// Reaches for random places of both scenes in turn, by several people at once.
std::vector<ReachRan> random_runs(const BenchContext& context, Seen how) {
  // A thousand reaches at the wall, of a finger that vision sees.
  const int people = context.quick ? 1 : !context.full ? 5 : how == Seen::vision ? 100 : 25;
  const std::int64_t each = context.quick ? 8 : context.full ? 10 : 12;
  std::vector<ReachRun> runs;
  for (int i = 0; i < people; ++i)
    for (const std::string& scene : kScenes)
      runs.push_back(random_reaches(scene, each, context.seed + static_cast<std::uint64_t>(i)) + seen(how));
  return run_all(context, runs);
}

std::vector<ReachOutcome> of_scene(const std::vector<ReachRan>& ran, std::size_t scene) {
  std::vector<ReachRan> these;
  for (std::size_t i = scene; i < ran.size(); i += kScenes.size()) these.push_back(ran[i]);
  return joined(these);
}

void random_figures(const std::vector<ReachRan>& ran, Seen how, bool bounded, const Adder& add) {
  const std::string key = key_of(how);
  const std::string text = name_of(how);
  const std::vector<ReachOutcome> all = joined(ran);
  add(key + "reaches", static_cast<double>(all.size()), "", kUnset, kUnset,
      "random reaches, 0.3 to 0.8 m/s at the peak and 50 to 200 mm/s wanted at the touch; " + text);
  add(key + "object_percent", percent(all, [](const ReachOutcome& r) { return r.chosen == r.aim; }), "%",
      kUnset, kUnset, "of the reaches in which the core has chosen the object that is met, when it is met");
  add(key + "felt_percent", percent(of_scene(ran, 1), [](const ReachOutcome& r) { return r.felt == r.aim; }),
      "%", bounded ? 99.0 : kUnset, kUnset,
      "of the reaches at the keypad in which the key that is rendered, when the finger has met the prop, is "
      "the one that was meant");
  const std::vector<ReachOutcome> keys = of_scene(ran, 1);
  const Tail after = tail_of(felts(keys, &ReachOutcome::felt_after), 0.95);
  add(key + "felt_after_ms." + after.word, 1e3 * after.value, "ms", kUnset, kUnset,
      "from where the finger passes the place of the key until a key is felt; the same reaches");
  const Tail depth = tail_of(felts(keys, &ReachOutcome::felt_depth), 0.95);
  add(key + "felt_depth_mm." + depth.word, 1e3 * depth.value, "mm", kUnset, kUnset,
      "how far the finger has gone beyond that place by then");
  add(key + "contact_percent",
      percent(all, [](const ReachOutcome& r) { return r.contacts == 1 && r.touched; }), "%", kUnset, kUnset,
      "of the reaches that are one contact to the core");
  for (std::size_t i = 0; i < kScenes.size(); ++i) {
    const std::vector<ReachOutcome> these = of_scene(ran, i);
    add(key + "lead_percent." + kScenes[i], 100.0 * in_time(these), "%", kUnset, kUnset,
        "of the reaches in which the prop is within 2 mm of where it is met before it is met; " + text);
    const Tail miss = tail_of(misses(these), 0.95);
    add(key + "random_miss_mm." + kScenes[i] + "." + miss.word, 1e3 * miss.value, "mm", kUnset, kUnset,
        "sideways, when they meet; " + text);
  }
}

void random_part(const BenchContext& context, BenchResult& result, const Adder& add) {
  double far = 0.0;
  for (const Seen how : {Seen::vision, Seen::live}) {
    const std::vector<ReachRan> ran = random_runs(context, how);
    for (const ReachRan& one : ran) {
      far = std::max(far, one.far_speed);
      result.simulated += one.simulated;
    }
    // By a quarter less than is measured: of 60 reaches, which are drawn.
    add(key_of(how) + "lead_percent", 100.0 * in_time(joined(ran)), "%",
        context.quick       ? kUnset
        : how == Seen::live ? 95.0
                            : 50.0,
        kUnset,
        how == Seen::live
            ? "of the reaches in which the machine is within 2 mm of where it is met before it is "
              "met: the finger is seen live, so that the machine's travel alone counts"
            : "the same of a finger that vision sees at 20 Hz, 50 ms late");
    random_figures(ran, how, !context.quick, add);
    if (how == Seen::vision) add_ideal(context, of_scene(ran, 0), add);
    Plot plot{how == Seen::live ? "reaching_lead_live" : "reaching_lead",
              std::string("From \"prepare\" until they meet; the finger is ") + name_of(how),
              "time (ms)",
              "reaches (%)",
              false,
              false,
              {}};
    for (std::size_t i = 0; i < kScenes.size(); ++i) {
      std::vector<double> lead, travel;
      for (const ReachOutcome& r : of_scene(ran, i)) {
        lead.push_back(r.lead());
        travel.push_back(r.travel());
      }
      plot.series.push_back(distribution(kScenes[i] + ": finger", lead));
      plot.series.push_back(distribution(kScenes[i] + ": prop", travel));
    }
    plot.caption =
        "Share of the reaches in which the finger has met the surface, and in which the prop has come within "
        "2 mm of "
        "where they meet, over the time since the core began to prepare. Where a curve of the prop ends "
        "below 100 %, "
        "it was farther in the others when they met. A prop at a wall goes along with a finger that comes "
        "obliquely, "
        "and arrives with it; at a key it waits.";
    result.plots.push_back(std::move(plot));
  }
  add("far_speed_mm_s", 1e3 * far, "mm/s", kUnset, 0.1,
      "of the tip, at most, while the finger is far, from a second after it went away");
}

struct Speeds {
  std::vector<double> each;  // m/s
  std::vector<std::vector<ReachOutcome>> reaches;
};

constexpr std::array<double, 3> kTilts{0.0, 20.0, 40.0};  // deg

Speeds steady(const BenchContext& context, BenchResult& result, Seen how) {
  Speeds speeds{{0.05, 0.1, 0.2}, {}};
  if (!context.quick) speeds.each = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0};
  std::vector<ReachRun> runs;
  for (const double v : speeds.each)
    for (const double tilt : kTilts)
      runs.push_back(steady_reaches(v, tilt,
                                    context.quick  ? 1
                                    : context.full ? 12
                                                   : 7,  // of three tilts: 21 have a p95
                                    context.seed) +
                     seen(how));
  const std::vector<ReachRan> ran = run_all(context, runs);
  for (std::size_t i = 0; i < speeds.each.size(); ++i) {
    const auto from = ran.begin() + static_cast<std::ptrdiff_t>(i * kTilts.size());
    speeds.reaches.push_back(joined({from, from + kTilts.size()}));
  }
  for (const ReachRan& one : ran) result.simulated += one.simulated;
  return speeds;
}

Series over_speed(const std::string& name, const Speeds& speeds, double share, double unit,
                  std::vector<double> (*of)(const std::vector<ReachOutcome>&)) {
  Series series{name, {}, {}};
  series.mark = Mark::both;
  for (std::size_t i = 0; i < speeds.each.size(); ++i) {
    series.x.push_back(1e3 * speeds.each[i]);
    series.y.push_back(unit * percentile(of(speeds.reaches[i]), share));
  }
  return series;
}

void speed_part(const BenchContext& context, BenchResult& result, const Adder& add) {
  Plot miss{"reaching_miss",
            "Miss of a finger that comes with an even speed",
            "approach speed (mm/s)",
            "miss (mm)",
            true,
            true,
            {}};
  Plot impact{"reaching_impact",
              "Peak of the force in the first 50 ms of a touch",
              "approach speed (mm/s)",
              "force (N)",
              true,
              true,
              {}};
  for (const Seen how : {Seen::vision, Seen::live}) {
    const Speeds speeds = steady(context, result, how);
    for (std::size_t i = 0; i < speeds.each.size(); ++i) {
      const double v = speeds.each[i];
      if (v < 0.05 || v > 0.2) continue;
      const Tail tail = tail_of(misses(speeds.reaches[i]), 0.95);
      add(fmt::format("miss_mm.{}{:.0f}.{}", key_of(how), 1e3 * v, tail.word), 1e3 * tail.value, "mm", kUnset,
          2.0,
          fmt::format("sideways, of a finger that comes with {:.0f} mm/s, 0 to 40 deg from the normal, {}",
                      1e3 * v, name_of(how)));
    }
    const bool enough = models::has_percentile(misses(speeds.reaches.front()).size(), 0.95);
    for (const auto& [share, text] :
         {std::pair{0.5, "median"}, {enough ? 0.95 : 1.0, enough ? "p95" : "most"}})
      miss.series.push_back(
          over_speed(fmt::format("{}, {}", name_of(how), text), speeds, share, 1e3, misses));
    impact.series.push_back(over_speed(fmt::format("{}, median", name_of(how)), speeds, 0.5, 1.0, impacts));
    add("impact_N." + key_of(how) + "200.p50", impact.series.back().y[context.quick ? 2 : 3], "N", kUnset,
        kUnset, fmt::format("at 200 mm/s, {}", name_of(how)));
  }
  miss.caption =
      "Along the wall, from the middle of the prop to the finger's nearest point when they meet; 0, 20 and "
      "40 degrees "
      "from the normal. 2 mm is the bound for 200 mm/s and less.";
  impact.caption =
      "The prop weighs the finger's touch with its own inertia and the arm's; the arm itself pushes with 8.5 "
      "N at most.";
  result.plots.push_back(std::move(miss));
  result.plots.push_back(std::move(impact));
}

void slide_part(const BenchContext& context, BenchResult& result, const Adder& add) {
  const std::vector<double> speeds = context.quick ? std::vector<double>{0.03, 0.1, 0.3}
                                                   : std::vector<double>{0.01, 0.03, 0.06, 0.1, 0.2, 0.3};
  Plot plot{"reaching_slide",
            "Error while the finger slides along the wall",
            "sliding speed (mm/s)",
            "error (mm)",
            true,
            true,
            {}};
  for (const Seen how : {Seen::vision, Seen::live}) {
    std::vector<ReachRun> runs;
    runs.reserve(speeds.size());
    for (const double v : speeds) runs.push_back(slide(v, context.full ? 5 : 1, context.seed) + seen(how));
    const std::vector<ReachRan> ran = run_all(context, runs);
    Series series{name_of(how), {}, {}};
    series.mark = Mark::both;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      std::vector<double> errors;
      for (const ReachOutcome& r : ran[i].reaches) errors.push_back(r.slide_error);
      series.x.push_back(1e3 * speeds[i]);
      series.y.push_back(1e3 * median(errors));
      result.simulated += ran[i].simulated;
      if (speeds[i] == 0.1)
        add("slide_mm." + key_of(how) + "100.p50", series.y.back(), "mm", kUnset, kUnset,
            fmt::format("most of the distance along the wall, sliding 50 mm there and back with 100 mm/s at "
                        "its fastest, {}",
                        name_of(how)));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Greatest distance along the wall from the prop's middle to the finger's nearest point while it slides "
      "50 mm "
      "there and back, 4 mm deep. The speed is that at its fastest.";
  result.plots.push_back(std::move(plot));
}

}  // namespace

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const Adder add = [&](const std::string& id, double value, const char* unit, double low, double high,
                        const std::string& note) {
    result.figures.push_back({"reaching." + id, kUnset, value, unit, Role::ours, low, high, note});
  };
  const auto progress = [&](double share) {
    if (context.progress) context.progress(share);
  };
  random_part(context, result, add);
  progress(context.full ? 0.3 : 0.6);
  speed_part(context, result, add);
  progress(context.full ? 0.5 : 0.9);
  slide_part(context, result, add);
  add_rest(context, result, add);
  if (context.full) add_reaching_full(context, result);
  add_force_precision(bench, {"user.approach_mm_s=[50]", "user.approach_from_mm=40", "user.press_s=0.8",
                              "user.hold_s=0.2", "user.release_s=0.8"});
  progress(1.0);
}

const Entry kEntry{
    "reaching", "wall",
    "is the prop there before the finger, how far beside it and how hard do they meet (VisHap 2.2)", run};

}  // namespace enc::bench::reaching
