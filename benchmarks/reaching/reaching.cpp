// The encounter of a bare finger: whether the prop is there before the finger, the distance between prop and
// touch, and the impact [VisHap 2.2].
#include <algorithm>
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

// Gains and costs of a faster finger tracker, another filter and finer steps of the physics.

constexpr int kEach = 10;  // reaches for each of two tilts: 20 have a p95

// Misses of a finger that comes obliquely with 200 mm/s, 20 and 40 degrees from the normal, p95, mm.
std::vector<double> misses_with(const BenchContext& context, const std::vector<Settings>& settings) {
  std::vector<ReachRun> runs;
  for (const Settings& set : settings)
    for (const double tilt : {20.0, 40.0})
      runs.push_back(steady_reaches(0.2, tilt, kEach, context.seed) + set);
  const std::vector<ReachResult> ran = run_all(context, runs);
  std::vector<double> p95;
  for (std::size_t i = 0; i < settings.size(); ++i)
    p95.push_back(1e3 * percentile(misses(joined({ran[2 * i], ran[2 * i + 1]})), 0.95));
  return p95;
}

void vision_part(const BenchContext& context, BenchResult& result) {
  const std::vector<double> latency{0, 10, 25, 50, 75, 100}, rate{20, 60, 120};
  Plot plot{"reaching_vision", "Miss over the age of what is seen", "latency of the vision (ms)",
            "miss, p95 (mm)"};
  for (const double hz : rate) {
    std::vector<Settings> settings;
    settings.reserve(latency.size());
    for (const double ms : latency)
      settings.push_back({fmt::format("truth.tracker.rate_hz={}", hz),
                          fmt::format("truth.tracker.latency_ms={}", ms),
                          fmt::format("rig.tracker.usual_age_ms={}", ms + 1e3 / hz + 10.0)});
    plot.series.push_back({.name = fmt::format("{:.0f} Hz", hz),
                           .x = latency,
                           .y = misses_with(context, settings),
                           .mark = Mark::both});
  }
  plot.caption =
      "Of a finger that comes with 200 mm/s, 20 and 40 degrees from the normal, with 0.5 mm noise.";
  result.plots.push_back(std::move(plot));
}

// The filter's one number: if it is too small, the filter lags when the hand changes its speed; if too large,
// it passes noise on.
void filter_part(const BenchContext& context, BenchResult& result) {
  const std::vector<double> noise{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
  std::vector<Settings> settings;
  std::vector<ReachRun> runs;
  for (const double q : noise) {
    settings.push_back({fmt::format("rig.tracker.acceleration_noise_m_s2_per_sqrt_hz={}", q)});
    for (const char* scene : {"wall", "reaching"})
      runs.push_back(random_reaches(scene, 25, context.seed) + settings.back());
  }
  const std::vector<ReachResult> ran = run_all(context, runs);
  Series random{"random reaches", noise};
  for (std::size_t i = 0; i < noise.size(); ++i)
    random.y.push_back(1e3 * percentile(misses(joined({ran[2 * i], ran[2 * i + 1]})), 0.95));
  random.mark = Mark::both;
  Plot plot{"reaching_filter",
            "Miss over the acceleration that the filter thinks possible",
            "acceleration noise (m/s^2/sqrt(Hz))",
            "miss, p95 (mm)",
            true,
            true};
  plot.series = {
      random, {.name = "even 200 mm/s", .x = noise, .y = misses_with(context, settings), .mark = Mark::both}};
  plot.caption =
      "An even approach wants a filter that averages long; a hand that slows down before the touch wants one "
      "that follows soon.";
  result.plots.push_back(std::move(plot));
}

struct Steps {
  std::string integrator;
  std::vector<double> timestep_us;
};

// Equal reaches with other steps of the physics: error of the impact against fine steps, over the run time.
void steps_part(const BenchContext& context, BenchResult& result) {
  const auto with = [&](const std::string& integrator, double us) {
    return steady_reaches(0.2, 20.0, kEach, context.seed) + seen(FingerTracking::live) +
           Settings{fmt::format("truth.arm.integrator=\"{}\"", integrator),
                    fmt::format("truth.arm.timestep_us={}", us)};
  };
  const std::vector<Steps> all{
      {"euler", {1000, 500, 250, 125}}, {"implicitfast", {1000, 500, 250, 125}}, {"rk4", {1000, 500, 250}}};
  std::vector<ReachRun> runs{with("rk4", 62.5)};
  for (const Steps& steps : all)
    for (const double us : steps.timestep_us) runs.push_back(with(steps.integrator, us));
  const std::vector<ReachResult> ran = run_all(context, runs);
  const std::vector<double> reference = impacts(ran[0].reaches);
  Plot plot{"reaching_steps",
            "Work and precision of the physics",
            "run time of a second (ms)",
            "error of the impact (%)",
            true,
            true};
  std::size_t next = 1;
  for (const Steps& steps : all) {
    Series series{steps.integrator};
    series.mark = Mark::both;
    for (std::size_t k = 0; k < steps.timestep_us.size(); ++k, ++next) {
      const std::vector<double> impact = impacts(ran[next].reaches);
      double sum = 0.0;
      const std::size_t n = std::min(impact.size(), reference.size());
      for (std::size_t i = 0; i < n; ++i) sum += std::abs(impact[i] / reference[i] - 1.0);
      series.add(1e3 * ran[next].seconds / ran[next].simulated, 100.0 * sum / static_cast<double>(n));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Mean error of the peak force of a touch at 200 mm/s against rk4 at 62.5 us; steps of 1000, 500, 250 "
      "(and 125) us from left to right. The haptic loop runs at 1 kHz in all.";
  result.plots.push_back(std::move(plot));
}

// The arm stays at rest while the finger is far away, for every friction and onset.

// Friction: zero; the equivalent of 0.04 N at the tip [PHANToM sheet]; the estimate of the published model;
// twice that. Its onset: as sharp as the time step allows, up to the constraint's own 20 ms.
struct Friction {
  double torque_Nm, time_ms, timestep_us;
};
std::vector<Friction> frictions(const BenchContext& context) {
  std::vector<Friction> all;
  for (const double torque : {0.0028, 0.0056, 0.01, 0.02}) {
    for (const double time : {2.0, 6.0, 20.0}) all.push_back({torque, time, 1000.0});
    if (context.full) all.push_back({torque, 0.1, 50.0});
  }
  if (context.quick) return {all[6]};
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

// Reaches for random places of both scenes in turn, by several people at once.
std::vector<ReachResult> random_runs(const BenchContext& context, FingerTracking how) {
  // A thousand reaches for the wall by a finger that vision tracks.
  const int people = context.quick ? 1 : !context.full ? 5 : how == FingerTracking::vision ? 100 : 25;
  const std::int64_t each = context.quick ? 8 : context.full ? 10 : 12;
  std::vector<ReachRun> runs;
  for (int i = 0; i < people; ++i)
    for (const std::string& scene : kScenes)
      runs.push_back(random_reaches(scene, each, context.seed + static_cast<std::uint64_t>(i)) + seen(how));
  return run_all(context, runs);
}

std::vector<ReachOutcome> of_scene(const std::vector<ReachResult>& ran, std::size_t scene) {
  std::vector<ReachResult> these;
  for (std::size_t i = scene; i < ran.size(); i += kScenes.size()) these.push_back(ran[i]);
  return joined(these);
}

void random_figures(Bench& bench, const std::vector<ReachResult>& ran, FingerTracking how, bool bounded) {
  const std::string key = key_of(how);
  const std::string text = name_of(how);
  const std::vector<ReachOutcome> all = joined(ran);
  bench.figure(key + "reaches", static_cast<double>(all.size()), "",
               "random reaches, 0.3 to 0.8 m/s at the peak and 50 to 200 mm/s wanted at the touch; " + text);
  bench.figure(key + "object_percent", percent(all, [](const ReachOutcome& r) { return r.chosen == r.aim; }),
               "%", "of the reaches in which the core has chosen the object that is met, when it is met");
  bench.figure(key + "felt_percent",
               percent(of_scene(ran, 1), [](const ReachOutcome& r) { return r.felt == r.aim; }), "%",
               at_least(bounded ? 99.0 : kUnset),
               "of the reaches at the keypad in which the key that is rendered, when the finger has met the "
               "prop, is the one that was meant");
  const std::vector<ReachOutcome> keys = of_scene(ran, 1);
  const Tail after = tail_of(felts(keys, &ReachOutcome::felt_after), 0.95);
  bench.figure(key + "felt_after_ms." + after.word, 1e3 * after.value, "ms",
               "from where the finger passes the place of the key until a key is felt; the same reaches");
  const Tail depth = tail_of(felts(keys, &ReachOutcome::felt_depth), 0.95);
  bench.figure(key + "felt_depth_mm." + depth.word, 1e3 * depth.value, "mm",
               "how far the finger has gone beyond that place by then");
  bench.figure(key + "contact_percent",
               percent(all, [](const ReachOutcome& r) { return r.contacts == 1 && r.touched; }), "%",
               "of the reaches that are one contact to the core");
  for (std::size_t i = 0; i < kScenes.size(); ++i) {
    const std::vector<ReachOutcome> these = of_scene(ran, i);
    bench.figure(
        key + "lead_percent." + kScenes[i], 100.0 * in_time(these), "%",
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
                                          const std::vector<ReachOutcome>& wall, std::size_t most) {
  constexpr double kSoon = 0.01;  // s: gives the best ideal predictor
  std::vector<ReachVerdict> all(most);
  in_parallel(most, [&](std::size_t i) {
    const ReachOutcome& r = wall[i];
    if (std::isnan(r.met)) return;
    const IdealPrediction at = ideal_place(spec, r.seen, r.met, r.met);
    const Eigen::Vector2d carried = ideal_carried(spec, r.seen, acceleration);
    const Eigen::Vector2d followed = ideal_followed(ideal_courses(spec, r.seen), r.met, acceleration, kSoon);
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
  const std::size_t most = context.quick ? std::min<std::size_t>(wall.size(), 4) : wall.size();
  const IdealCounts sum = counts_of(judged_by_ideal(spec, acceleration, wall, most), wall);
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
Plot lead_plot(const std::vector<ReachResult>& ran, FingerTracking how) {
  Plot plot{how == FingerTracking::live ? "reaching_lead_live" : "reaching_lead",
            std::string("From \"prepare\" until they meet; the finger is ") + name_of(how), "time (ms)",
            "reaches (%)"};
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
      "2 mm of where they meet, over the time since the core began to prepare. Where a curve of the prop "
      "ends below 100 %, it was farther in the others when they met. A prop at a wall goes along with a "
      "finger that comes obliquely, and arrives with it; at a key it waits.";
  return plot;
}

void random_part(Bench& bench) {
  const BenchContext& context = bench.context;
  double far = 0.0;
  for (const FingerTracking how : {FingerTracking::vision, FingerTracking::live}) {
    const std::vector<ReachResult> ran = random_runs(context, how);
    for (const ReachResult& one : ran) {
      far = std::max(far, one.far_speed);
      bench.result.simulated += one.simulated;
    }
    // The bound for vision is a quarter below the measured value, because 60 random reaches scatter.
    bench.figure(key_of(how) + "lead_percent", 100.0 * in_time(joined(ran)), "%",
                 at_least(context.quick                 ? kUnset
                          : how == FingerTracking::live ? 95.0
                                                        : 50.0),
                 how == FingerTracking::live
                     ? "of the reaches in which the machine is within 2 mm of where it is met before it is "
                       "met: the finger is seen live, so that the machine's travel alone counts"
                     : "the same of a finger that vision sees at 20 Hz, 50 ms late");
    random_figures(bench, ran, how, !context.quick);
    if (how == FingerTracking::vision) add_ideal(bench, of_scene(ran, 0));
    bench.result.plots.push_back(lead_plot(ran, how));
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
  if (!context.quick) speeds.each = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0};
  std::vector<ReachRun> runs;
  for (const double v : speeds.each)
    for (const double tilt : kTilts)
      runs.push_back(steady_reaches(v, tilt,
                                    context.quick  ? 1
                                    : context.full ? 12
                                                   : 7,  // reaches for each of three tilts: 21 have a p95
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

// The miss at 50 to 200 mm/s.
void add_miss_figures(Bench& bench, const Speeds& speeds, FingerTracking how) {
  for (std::size_t i = 0; i < speeds.each.size(); ++i) {
    const double v = speeds.each[i];
    if (v < 0.05 || v > 0.2) continue;
    const Tail tail = tail_of(misses(speeds.reaches[i]), 0.95);
    bench.figure(
        fmt::format("miss_mm.{}{:.0f}.{}", key_of(how), 1e3 * v, tail.word), 1e3 * tail.value, "mm",
        at_most(2.0),
        fmt::format("sideways, of a finger that comes with {:.0f} mm/s, 0 to 40 deg from the normal, {}",
                    1e3 * v, name_of(how)));
  }
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
    bench.figure("impact_N." + key_of(how) + "200.p50", impact.series.back().y[bench.context.quick ? 2 : 3],
                 "N", fmt::format("at 200 mm/s, {}", name_of(how)));
  }
  miss.caption =
      "Along the wall, from the middle of the prop to the finger's nearest point when they meet; 0, 20 and "
      "40 degrees from the normal. 2 mm is the bound for 200 mm/s and less.";
  impact.caption =
      "The prop weighs the finger's touch with its own inertia and the arm's; the arm itself pushes with 8.5 "
      "N at most.";
  bench.result.plots.push_back(std::move(miss));
  bench.result.plots.push_back(std::move(impact));
}

void slide_part(Bench& bench) {
  const BenchContext& context = bench.context;
  const std::vector<double> speeds = context.quick ? std::vector<double>{0.03, 0.1, 0.3}
                                                   : std::vector<double>{0.01, 0.03, 0.06, 0.1, 0.2, 0.3};
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

// Run by `--full`: costs and gains of the finger's rate and latency, the filter's noise and the physics'
// steps.
void add_reaching_full(const BenchContext& context, BenchResult& result) {
  vision_part(context, result);
  filter_part(context, result);
  steps_part(context, result);
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
  if (!bench.context.quick)
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
  if (context.full) add_reaching_full(context, bench.result);
  add_force_precision(bench, {"user.approach_mm_s=[50]", "user.approach_from_mm=40", "user.press_s=0.8",
                              "user.hold_s=0.2", "user.release_s=0.8"});
  bench.progress(1.0);
}

const Reads kReads{"reaching", {.scenes = {"*"}}};
const Entry kEntry{
    "reaching", "wall",
    "is the prop there before the finger, how far beside it and how hard do they meet (VisHap 2.2)", run};

}  // namespace
}  // namespace enc::bench::reaching
