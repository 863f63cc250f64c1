// The encounter of a bare finger: whether the prop is there before the finger, the distance between prop and
// touch, and the impact [VisHap 2.2].
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/precision.h"
#include "benchmarks/reaching/ideal.h"
#include "benchmarks/reaching/reach_runs.h"

namespace enc::bench::reaching {
namespace {

// Bounds, chosen below what many seeds give (docs/reference/reaching.md).
// N in a ms, above what a hard finger gets where vision sees it late, and where nothing is late.
constexpr double kSeenForceStep = 4.3, kSeenForceStepMost = 5.5, kLiveForceStep = 1.3;
constexpr double kFeltForce = 0.1;                       // N, threshold of a person [sources/hand 6]
constexpr double kContacts = 2.2, kLiveContacts = 1.25;  // of a reach
constexpr double kLiveInTime = 95.0;                     // %
constexpr std::array<double, 2> kInTime{30.0, 80.0};     // %, wall and keypad

// The arm stays at rest while the finger is far away, for every friction and onset.

// Friction: zero; the equivalent of 0.04 N at the tip [PHANToM sheet]; the estimate of the published model;
// twice that. Its onset: as sharp as the time step allows, up to the constraint's own 20 ms.
struct Friction {
  double torque_Nm, time_ms, timestep_us;
};
std::vector<Friction> frictions(const BenchContext& context) {
  std::vector<Friction> all;
  if (context.quick) return {{0.01, 2.0, 1000.0}};
  if (!context.full) return {{0.0028, 20.0, 1000.0}, {0.02, 2.0, 1000.0}};
  for (const double torque : {0.0028, 0.0056, 0.01, 0.02}) {
    for (const double time : {2.0, 6.0, 20.0}) all.push_back({torque, time, 1000.0});
    all.push_back({torque, 0.1, 50.0});
  }
  all.push_back({0.0, 20.0, 1000.0});
  return all;
}

Settings set_of(const Friction& f) {
  return {fmt::format("truth.arm.friction_Nm=[{0}, {0}, {0}]", f.torque_Nm),
          fmt::format("truth.arm.friction_time_ms={}", f.time_ms),
          fmt::format("truth.arm.timestep_us={}", f.timestep_us)};
}

// Cumulative distribution, %, of milliseconds.
Series distribution(const std::string& name, std::vector<double> seconds) {
  const double count = static_cast<double>(seconds.size());
  std::erase_if(seconds, [](double s) { return std::isnan(s); });
  std::sort(seconds.begin(), seconds.end());
  Series series{name};
  for (std::size_t i = 0; i < seconds.size(); ++i)
    series.add(1e3 * seconds[i], 100.0 * static_cast<double>(i + 1) / count);
  return series;
}

const char* name_of(FingerTracking how) {
  return how == FingerTracking::vision ? "seen at 20 Hz, 50 ms late" : "seen live";
}
std::string key_of(FingerTracking how) { return how == FingerTracking::vision ? "vision." : "live."; }

double percent(const std::vector<ReachOutcome>& reaches, const std::function<bool(const ReachOutcome&)>& is) {
  return 100.0 * static_cast<double>(std::count_if(reaches.begin(), reaches.end(), is)) /
         static_cast<double>(reaches.size());
}

const std::array<std::string, 2> kScenes{"wall", "keypad"};

// Random reaches, by scene.
struct RandomReaches {
  std::array<std::vector<ReachOutcome>, 2> of;
  double far_speed = 0.0, simulated = 0.0;  // m/s, s

  [[nodiscard]] std::vector<ReachOutcome> all() const {
    std::vector<ReachOutcome> both = of[0];
    both.insert(both.end(), of[1].begin(), of[1].end());
    return both;
  }
};

// Number of people who reach in a scene. Most reaches judge the share at the wall, which scatters most.
std::size_t people_of(const BenchContext& context, FingerTracking how, std::size_t scene) {
  if (context.full) return how == FingerTracking::vision ? context.count(100, 100) : context.count(25, 25);
  if (context.quick || how == FingerTracking::live) return 1;
  return scene == 0 ? context.count(8, 1) : 2;
}

RandomReaches random_reaches_of(const BenchContext& context, FingerTracking how) {
  const std::int64_t each = context.quick ? 8 : context.full ? 10 : 12;
  std::vector<ReachRun> runs;
  std::vector<std::size_t> scenes;
  for (std::size_t scene = 0; scene < kScenes.size(); ++scene)
    for (std::size_t i = 0; i < people_of(context, how, scene); ++i) {
      runs.push_back(random_reaches(kScenes[scene], each, context.seed + i) + seen(how));
      scenes.push_back(scene);
    }
  const std::vector<ReachResult> ran = run_all(context, runs);
  RandomReaches random;
  for (std::size_t i = 0; i < ran.size(); ++i) {
    std::vector<ReachOutcome>& of = random.of[scenes[i]];
    of.insert(of.end(), ran[i].reaches.begin(), ran[i].reaches.end());
    random.far_speed = std::max(random.far_speed, ran[i].far_speed);
    random.simulated += ran[i].simulated;
  }
  return random;
}

// Largest change of the force on the finger in a tick of each reach.
void force_figures(Bench& bench, const std::vector<ReachOutcome>& all, FingerTracking how) {
  const std::string key = key_of(how);
  const bool live = how == FingerTracking::live;
  const std::vector<double> steps = force_steps(all);
  const double most = percentile(steps, 1.0);
  if (models::has_percentile(steps.size(), 0.95)) {
    const double p95 = percentile(steps, 0.95);
    bench.figure(key + "force_step_N.p95", p95, "N", at_most(live ? kLiveForceStep : kSeenForceStep),
                 fmt::format("largest change of the force on the finger in a ms. A person feels {:g} N "
                             "[sources/hand 6]: misses by {:.2f} N",
                             kFeltForce, std::max(0.0, p95 - kFeltForce)));
  }
  bench.figure(key + "force_step_N.max", most, "N",
               at_most(live || bench.context.full ? kUnset : kSeenForceStepMost), "that of all reaches");
}

void random_figures(Bench& bench, const RandomReaches& random, FingerTracking how) {
  const BenchContext& context = bench.context;
  const auto if_judged = [&](double bound) { return context.quick ? kUnset : bound; };
  const std::string key = key_of(how);
  const std::string text = name_of(how);
  const std::vector<ReachOutcome> all = random.all();
  const std::vector<ReachOutcome>& keys = random.of[1];
  bench.figure(key + "reaches", static_cast<double>(all.size()), "",
               "random reaches, 0.3 to 0.8 m/s at the peak and 50 to 200 mm/s wanted at the touch; " + text);
  bench.figure(key + "object_percent", percent(all, [](const ReachOutcome& r) { return r.chosen == r.aim; }),
               "%", "of the reaches in which the core has chosen the object that is met, when it is met");
  bench.figure(key + "felt_percent", percent(keys, [](const ReachOutcome& r) { return r.felt == r.aim; }),
               "%", at_least(if_judged(context.full ? 99.0 : 95.0)),
               "of the reaches at the keypad in which the key that is rendered, when the finger has met the "
               "prop, is the one that was meant");
  const Tail after = tail_of(felts(keys, &ReachOutcome::felt_after), 0.95);
  bench.figure(key + "felt_after_ms." + after.word, 1e3 * after.value, "ms",
               "from where the finger passes the place of the key until a key is felt; the same reaches");
  const Tail depth = tail_of(felts(keys, &ReachOutcome::felt_depth), 0.95);
  bench.figure(key + "felt_depth_mm." + depth.word, 1e3 * depth.value, "mm",
               "how far the finger has gone beyond that place by then");
  bench.figure(key + "contacts_per_reach", contacts_per_reach(all), "",
               at_most(if_judged(how == FingerTracking::live ? kLiveContacts : kContacts)),
               "contacts that the core counts, over the reaches that met the surface");
  force_figures(bench, all, how);
  for (std::size_t i = 0; i < kScenes.size(); ++i) {
    const std::vector<ReachOutcome>& these = random.of[i];
    const double least = how == FingerTracking::live ? kLiveInTime : kInTime[i];
    bench.figure(
        key + "lead_percent." + kScenes[i], 100.0 * in_time(these), "%", at_least(if_judged(least)),
        "of the reaches in which the prop is within 2 mm of where it is met before it is met; " + text);
    const Tail miss = tail_of(misses(these), 0.95);
    bench.figure(key + "random_miss_mm." + kScenes[i] + "." + miss.word, 1e3 * miss.value, "mm",
                 "sideways, when they meet; " + text);
  }
}

// Whether the prop of an ideal predictor is there when a reach meets, by its kind of prop.
struct ReachVerdict {
  bool counts = false, reached = false, carried = false, followed = false;
  double within = 0.0;
};

// The first `most` reaches, judged on all cores.
std::vector<ReachVerdict> judged_by_ideal(const IdealSpec& spec, double acceleration,
                                          const std::vector<ReachOutcome>& wall, std::size_t most,
                                          bool followed_too) {
  constexpr double kSoon = 0.01;  // s: gives the best ideal predictor
  std::vector<ReachVerdict> all(most);
  in_parallel(most, [&](std::size_t i) {
    const ReachOutcome& r = wall[i];
    if (std::isnan(r.met)) return;
    const IdealPrediction at = ideal_place(spec, r.seen, r.met, r.met);
    const Eigen::Vector2d carried = ideal_carried(spec, r.seen, acceleration);
    const Eigen::Vector2d followed =
        followed_too ? ideal_followed(ideal_courses(spec, r.seen), r.met, acceleration, kSoon)
                     : Eigen::Vector2d(kUnset, kUnset);
    const auto there = [&](const Eigen::Vector2d& place) { return (place - r.seen.where).norm() < kThere; };
    all[i] = {true, there(at.place), there(carried), there(followed), at.within};
  });
  return all;
}

// Numbers of reaches; `within` is the number that the predictor expects.
struct IdealCounts {
  double counts = 0.0, reached = 0.0, carried = 0.0, followed = 0.0, within = 0.0, ours = 0.0;
};
IdealCounts counts_of(const std::vector<ReachVerdict>& all, const std::vector<ReachOutcome>& wall) {
  IdealCounts sum;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].counts) continue;
    ++sum.counts;
    sum.reached += all[i].reached ? 1.0 : 0.0;
    sum.carried += all[i].carried ? 1.0 : 0.0;
    sum.followed += all[i].followed ? 1.0 : 0.0;
    sum.within += all[i].within;
    sum.ours += wall[i].lead() >= wall[i].travel() ? 1.0 : 0.0;
  }
  return sum;
}

// Share of the reaches with the prop in time, beside that of an ideal predictor with the same pictures and
// this arm (ideal.h).
void add_ideal(Bench& bench, const std::vector<ReachOutcome>& wall) {
  const BenchContext& context = bench.context;
  const models::Setup setup = load_scene(context, "wall");
  const bool reach = setup.rig.tracker.foresight == TouchPrediction::reach;  // the scene's motion prediction
  const double acceleration = reach ? setup.rig.arm.reach_acceleration : setup.rig.arm.acceleration;
  IdealSpec spec;
  spec.hand = setup.twin.hand;
  spec.noise = setup.twin.tracker.noise.maxCoeff();
  constexpr std::size_t kFew = 24;  // reaches without --full, for which no bound needs more
  const std::size_t most = std::min<std::size_t>(wall.size(), context.quick  ? 4
                                                              : context.full ? wall.size()
                                                                             : kFew);
  const IdealCounts sum = counts_of(judged_by_ideal(spec, acceleration, wall, most, context.full), wall);
  bench.figure("ideal.place_percent.wall", 100.0 * sum.reached / sum.counts, "%",
               fmt::format("of {:.0f} of these reaches: within 2 mm of where they meet is the best place "
                           "that an ideal predictor knows of by the same pictures, told when the finger "
                           "touches, with a prop that is anywhere at once: no machine can do more",
                           sum.counts));
  bench.figure("ideal.expected_percent.wall", 100.0 * sum.within / sum.counts, "%",
               "what that predictor expects of itself: the same, if it is ideal");
  bench.figure("ideal.carried_percent.wall", 100.0 * sum.carried / sum.counts, "%",
               fmt::format("the same if an arm carries the prop from picture to picture with {:.0f} m/s^2, "
                           "without any other delay",
                           acceleration));
  if (context.full)
    bench.figure("ideal.followed_percent.wall", 100.0 * sum.followed / sum.counts, "%",
                 "the same of a predictor that is not told when it touches: the arm goes after the mean of "
                 "what is still to come; how soon was chosen on other reaches");
  bench.figure("vision.of_ideal_percent.wall", sum.reached > 0.0 ? 100.0 * sum.ours / sum.reached : kUnset,
               "%",
               fmt::format("in time, of what that ideal is: {:.1f} % of the same reaches",
                           100.0 * sum.ours / sum.counts));
  // The bound applies only to a thousand reaches.
  bench.figure("vision.of_carried_percent.wall", sum.carried > 0.0 ? 100.0 * sum.ours / sum.carried : kUnset,
               "%", at_least(context.full ? 90.0 : kUnset), "the same, of that ideal with an arm");
}

// Distribution of the time in which finger and prop come to where they meet.
Plot lead_plot(const RandomReaches& random, FingerTracking how) {
  Plot plot{how == FingerTracking::live ? "reaching_lead_live" : "reaching_lead",
            std::string("From \"prepare\" until they meet; the finger is ") + name_of(how), "time (ms)",
            "reaches (%)"};
  for (std::size_t i = 0; i < kScenes.size(); ++i) {
    std::vector<double> lead, travel;
    for (const ReachOutcome& r : random.of[i]) {
      lead.push_back(r.lead());
      travel.push_back(r.travel());
    }
    plot.series.push_back(distribution(kScenes[i] + ": finger", lead));
    plot.series.push_back(distribution(kScenes[i] + ": prop", travel));
  }
  plot.caption =
      "Share of the reaches in which the finger has met the surface, and in which the prop has come within "
      "2 mm of where they meet, over the time since the core began to prepare. Where a curve of the prop "
      "ends below 100 %, it was farther in the others when they met. A prop at a wall goes along with a "
      "finger that comes obliquely, and arrives with it; at a key it waits.";
  return plot;
}

void random_part(Bench& bench) {
  double far = 0.0;
  for (const FingerTracking how : {FingerTracking::vision, FingerTracking::live}) {
    const RandomReaches random = random_reaches_of(bench.context, how);
    far = std::max(far, random.far_speed);
    bench.result.simulated += random.simulated;
    random_figures(bench, random, how);
    if (how == FingerTracking::vision) add_ideal(bench, random.of[0]);
    bench.result.plots.push_back(lead_plot(random, how));
  }
  bench.figure("far_speed_mm_s", 1e3 * far, "mm/s", at_most(0.1),
               "of the tip, at most, while the finger is far, from a second after it went away");
}

struct Speeds {
  std::vector<double> each;  // m/s
  std::vector<std::vector<ReachOutcome>> reaches;
};

constexpr std::array<double, 3> kTilts{0.0, 20.0, 40.0};  // deg

Speeds steady(const BenchContext& context, BenchResult& result, FingerTracking how) {
  Speeds speeds{{0.05, 0.1, 0.2}, {}};
  if (context.full) speeds.each = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0};
  std::vector<ReachRun> runs;
  for (const double v : speeds.each)
    for (const double tilt : kTilts)
      runs.push_back(steady_reaches(v, tilt,
                                    context.full                                   ? 12
                                    : context.quick || how == FingerTracking::live ? 1
                                                                                   : 3,
                                    context.seed) +
                     seen(how));
  const std::vector<ReachResult> ran = run_all(context, runs);
  for (std::size_t i = 0; i < speeds.each.size(); ++i) {
    const auto from = ran.begin() + static_cast<std::ptrdiff_t>(i * kTilts.size());
    speeds.reaches.push_back(joined({from, from + kTilts.size()}));
  }
  for (const ReachResult& one : ran) result.simulated += one.simulated;
  return speeds;
}

Series over_speed(const std::string& name, const Speeds& speeds, double share, double unit,
                  std::vector<double> (*of)(const std::vector<ReachOutcome>&)) {
  Series series{name};
  series.mark = Mark::both;
  for (std::size_t i = 0; i < speeds.each.size(); ++i)
    series.add(1e3 * speeds.each[i], unit * percentile(of(speeds.reaches[i]), share));
  return series;
}

// The miss at 50 to 200 mm/s of each speed, and the share of all that are near. A tail of a few reaches is a
// lottery with vision's noise: judged is the share, 95 % of them, less three standard errors of that many
// reaches, and that none is far.
void add_miss_figures(Bench& bench, const Speeds& speeds, FingerTracking how) {
  std::vector<double> all;
  for (std::size_t i = 0; i < speeds.each.size(); ++i) {
    const double v = speeds.each[i];
    if (v < 0.05 || v > 0.2) continue;
    const std::vector<double> these = misses(speeds.reaches[i]);
    all.insert(all.end(), these.begin(), these.end());
    const Tail tail = tail_of(these, 0.95);
    bench.figure(
        fmt::format("miss_mm.{}{:.0f}.{}", key_of(how), 1e3 * v, tail.word), 1e3 * tail.value, "mm",
        at_most(how == FingerTracking::live ? 2.0 : 5.0),
        fmt::format("sideways, of a finger that comes with {:.0f} mm/s, 0 to 40 deg from the normal, {}",
                    1e3 * v, name_of(how)));
  }
  const double count = static_cast<double>(all.size());
  const auto near = std::count_if(all.begin(), all.end(), [](double miss) { return miss <= 2e-3; });
  bench.figure("near_percent." + key_of(how) + "steady", 100.0 * static_cast<double>(near) / count, "%",
               at_least(100.0 * (0.95 - 3.0 * std::sqrt(0.95 * 0.05 / count))),
               fmt::format("share within 2 mm sideways, of {} reaches of 50 to 200 mm/s, {}", all.size(),
                           name_of(how)));
}

void speed_part(Bench& bench) {
  Plot miss{"reaching_miss",
            "Miss of a finger that comes with an even speed",
            "approach speed (mm/s)",
            "miss (mm)",
            true,
            true};
  Plot impact{"reaching_impact",
              "Peak of the force in the first 50 ms of a touch",
              "approach speed (mm/s)",
              "force (N)",
              true,
              true};
  for (const FingerTracking how : {FingerTracking::vision, FingerTracking::live}) {
    const Speeds speeds = steady(bench.context, bench.result, how);
    add_miss_figures(bench, speeds, how);
    const bool enough = models::has_percentile(misses(speeds.reaches.front()).size(), 0.95);
    for (const auto& [share, text] :
         {std::pair{0.5, "median"}, {enough ? 0.95 : 1.0, enough ? "p95" : "most"}})
      miss.series.push_back(
          over_speed(fmt::format("{}, {}", name_of(how), text), speeds, share, 1e3, misses));
    impact.series.push_back(over_speed(fmt::format("{}, median", name_of(how)), speeds, 0.5, 1.0, impacts));
    bench.figure("impact_N." + key_of(how) + "200.p50", impact.series.back().y[bench.context.full ? 3 : 2],
                 "N", fmt::format("at 200 mm/s, {}", name_of(how)));
  }
  miss.caption =
      "Along the wall, from the middle of the prop to the finger's nearest point when they meet; 0, 20 and "
      "40 degrees from the normal. Of 50 to 200 mm/s, 95 % shall be within 2 mm.";
  impact.caption =
      "The prop weighs the finger's touch with its own inertia and the arm's; the arm itself pushes with 8.5 "
      "N at most.";
  bench.result.plots.push_back(std::move(miss));
  bench.result.plots.push_back(std::move(impact));
}

void slide_part(Bench& bench) {
  const BenchContext& context = bench.context;
  const std::vector<double> speeds =
      context.full ? std::vector<double>{0.01, 0.03, 0.06, 0.1, 0.2, 0.3} : std::vector<double>{0.1};
  Plot plot{"reaching_slide",
            "Error while the finger slides along the wall",
            "sliding speed (mm/s)",
            "error (mm)",
            true,
            true};
  for (const FingerTracking how : {FingerTracking::vision, FingerTracking::live}) {
    std::vector<ReachRun> runs;
    runs.reserve(speeds.size());
    for (const double v : speeds) runs.push_back(slide(v, context.full ? 5 : 1, context.seed) + seen(how));
    const std::vector<ReachResult> ran = run_all(context, runs);
    Series series{name_of(how)};
    series.mark = Mark::both;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      std::vector<double> errors;
      for (const ReachOutcome& r : ran[i].reaches) errors.push_back(r.slide_error);
      series.add(1e3 * speeds[i], 1e3 * median(errors));
      bench.result.simulated += ran[i].simulated;
      if (speeds[i] == 0.1)
        bench.figure("slide_mm." + key_of(how) + "100.p50", series.y.back(), "mm",
                     fmt::format("most of the distance along the wall, sliding 50 mm there and back with 100 "
                                 "mm/s at its fastest, {}",
                                 name_of(how)));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Greatest distance along the wall from the prop's middle to the finger's nearest point while it slides "
      "50 mm there and back, 4 mm deep. The speed is that at its fastest.";
  bench.result.plots.push_back(std::move(plot));
}

// Reaches for the wall with each friction, by `people` each.
std::vector<ReachRun> rest_runs(const BenchContext& context, const std::vector<Friction>& all, int people) {
  std::vector<ReachRun> runs;
  for (const Friction& f : all)
    for (int i = 0; i < people; ++i)
      runs.push_back(
          random_reaches("wall", context.full ? 8 : 4, context.seed + static_cast<std::uint64_t>(i)) +
          seen(FingerTracking::vision) + set_of(f));
  return runs;
}

struct FarTip {
  double most = 0.0, none = kUnset;  // m/s: with friction, and without any
  std::size_t reaches = 0;           // with friction
};

void add_far_figures(Bench& bench, const FarTip& tip) {
  bench.figure("rest.reaches", static_cast<double>(tip.reaches), "",
               "random reaches with other frictions than the rig's");
  bench.figure("rest.far_speed_mm_s", 1e3 * tip.most, "mm/s", at_most(0.1),
               "of the tip, at most, while the finger is far: joints with 0.0028 to 0.02 N m of friction, "
               "which sets in within 2 to 20 ms (--full: from 0.1 ms on)");
  if (bench.context.full)
    bench.figure("rest.without_friction_mm_s", 1e3 * tip.none, "mm/s",
                 "the same of joints without any: nothing holds what the law lets go");
}

// Motion of the tip while the finger is far away, over the friction of the joints.
void add_rest(Bench& bench) {
  const BenchContext& context = bench.context;
  const std::vector<Friction> all = frictions(context);
  const int people = context.full ? 8 : 1;
  const std::vector<ReachResult> ran = run_all(context, rest_runs(context, all, people));
  Table table{"reaching_rest",
              "Speed of the far tip, over the friction of the joints and how it sets in",
              {"friction (N m)", "sets in (ms)", "time step (us)", "reaches", "at most (mm/s)"}};
  FarTip tip;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto from = ran.begin() + static_cast<std::ptrdiff_t>(i) * people;
    double here = 0.0;
    for (auto one = from; one != from + people; ++one) {
      here = std::max(here, one->far_speed);
      bench.result.simulated += one->simulated;
    }
    const std::size_t met = joined({from, from + people}).size();
    if (all[i].torque_Nm > 0.0) {
      tip.reaches += met;
      tip.most = std::max(tip.most, here);
    } else {
      tip.none = here;
    }
    table.rows.push_back({fmt::format("{:g}", all[i].torque_Nm), fmt::format("{:g}", all[i].time_ms),
                          fmt::format("{:g}", all[i].timestep_us), fmt::format("{}", met),
                          fmt::format("{:.2g}", 1e3 * here)});
  }
  table.note =
      "From a second after the finger went away. Friction that sets in within 2 ms holds from 1 mm/s on.";
  bench.result.tables.push_back(std::move(table));
  add_far_figures(bench, tip);
}

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  random_part(bench);
  bench.progress(context.full ? 0.3 : 0.6);
  speed_part(bench);
  bench.progress(context.full ? 0.5 : 0.9);
  slide_part(bench);
  add_rest(bench);
  if (context.full) {
    add_sweeps(context, bench.result);
    add_force_precision(bench, {"user.approach_mm_s=[50]", "user.approach_from_mm=40", "user.press_s=0.8",
                                "user.hold_s=0.2", "user.release_s=0.8"});
  }
  bench.progress(1.0);
}

const Reads kReads{"reaching", {.scenes = {"*"}}};
const Entry kEntry{
    "reaching", "wall",
    "is the prop there before the finger, how far beside it and how hard do they meet (VisHap 2.2)", run};

}  // namespace
}  // namespace enc::bench::reaching
