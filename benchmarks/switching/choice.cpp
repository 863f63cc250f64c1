// The choice of the nearest of many objects: right, without chatter, in time [VisHap 2.2].
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/switching/crowd.h"
#include "trial/finger_loop.h"
#include "trial/trial.h"

namespace enc::bench::switching {
namespace {

// s of this thread for step() alone, with the finger at p.
double time_of(trial::FingerLoop& loop, const Point<'W'>& p) {
  loop.put(p);
  const double start = thread_seconds();
  loop.go();
  return thread_seconds() - start;
}

constexpr double kNoise = 1e-3;        // m, of the finger along each axis [V35]
constexpr double kSeenNoise = 0.5e-3;  // m, of the rig [VisHap 2.1]

// The finger's pose is exact: only the choice is judged.
Scene bare_scene(const BenchContext& context) {
  return trial::prepare_setup(load_scene(context, "keypad", {}, {"rig.tracker.prediction=\"hold\""}));
}

Point<'W'> anywhere(std::mt19937_64& random) {
  std::uniform_real_distribution<double> even(-kCrowdRoom, kCrowdRoom);
  const double x = even(random), y = even(random), z = even(random);
  return {x, y, z};
}

double share_right(const BenchContext& context, int queries) {
  Scene scene = bare_scene(context);
  fill_with_crowd(scene, 50, context.seed);
  trial::FingerLoop loop(std::move(scene));
  std::mt19937_64 random(context.seed);
  const Vec<'W'> beside(context.mutated("beside") ? 0.03 : 0.0, 0.0, 0.0);
  int right = 0;
  for (int i = 0; i < queries; ++i) {
    loop.state = State{};
    const Point<'W'> p = anywhere(random);
    loop.tick(p);
    // Objects that are touched come first, so the nearest of all may not be one of them.
    right += loop.out.object == nearest_for_a_finger(loop.scene, p + beside, loop.scene.tools[0].tip.radius)
                 ? 1
                 : 0;
  }
  return static_cast<double>(right) / queries;
}

// Tracking of a finger at rest: exact, each tick; or by vision, 20 pictures a second that arrive 50 ms old,
// predicted by the scene's filter.
enum class FingerTracking : std::uint8_t { each_tick, pictures };
struct Chatter {
  const char* name;
  Point<'W'> middle;
  FingerTracking shown = FingerTracking::each_tick;
  std::vector<double> per_second = {};
};

// Two balls that face each other 40 mm apart: noise has its worst effect there.
Scene facing(Scene scene) {
  const Surface ball{Sphere{0.010}};
  scene.objects = {Object{ball, Pose<'W', 'O'>::shift(-0.03, 0, 0), {}},
                   Object{ball, Pose<'W', 'O'>::shift(0.03, 0, 0), {}}};
  return scene;
}

double switches_per_second(Scene scene, double hysteresis, const Chatter& finger, double seconds,
                           std::uint64_t seed) {
  constexpr int kPicture = 50;  // ticks
  constexpr Duration kOld = std::chrono::milliseconds(50);
  constexpr int kFrom = 1000;  // ticks until the filter has settled on the finger
  scene.follow.hysteresis = hysteresis;
  trial::FingerLoop loop(std::move(scene));
  std::mt19937_64 random(seed);
  const bool pictures = finger.shown == FingerTracking::pictures;
  std::normal_distribution<double> bell(0.0, pictures ? kSeenNoise : kNoise);
  int count = 0;
  std::int32_t before = -1;
  for (int i = 0; i < kFrom + static_cast<int>(seconds / loop.scene.dt); ++i) {
    if (pictures && i % kPicture != 0) {
      loop.tick();
    } else {
      const double x = bell(random), y = bell(random), z = bell(random);
      const Point<'W'> p = finger.middle + Vec<'W'>(x, y, z);
      pictures ? loop.see(p, kOld) : loop.tick(p);
    }
    count += i > kFrom && before >= 0 && loop.out.object != before ? 1 : 0;
    before = loop.out.object;
  }
  return count / seconds;
}

// Each case over the hysteresis, m.
std::vector<Chatter> all_chatter(const BenchContext& context, const std::vector<double>& hysteresis) {
  const double seconds = context.quick ? 5.0 : 60.0;
  const Scene keypad = bare_scene(context), whole = trial::prepare_setup(load_scene(context, "keypad"));
  // 12 mm over the gap between two keys: a finger that searches for the next one.
  const Point<'W'> gap(0.010, 0.010, 0.012);
  std::vector<Chatter> cases{
      {"two balls that face each other", {0, 0, 0}},
      {"two keys side by side", gap},
      {"the same, 20 pictures a second, and 60 ms ahead", gap, FingerTracking::pictures}};
  for (Chatter& one : cases) {
    one.per_second.resize(hysteresis.size());
    const bool balls = &one == &cases.front();
    in_parallel(hysteresis.size(), [&](std::size_t i) {
      const Scene& keys = one.shown == FingerTracking::pictures ? whole : keypad;
      one.per_second[i] =
          switches_per_second(balls ? facing(keypad) : keys, hysteresis[i], one, seconds, context.seed);
    });
  }
  return cases;
}

Plot chatter_plot(const std::vector<Chatter>& cases, const std::vector<double>& hysteresis) {
  Plot plot{"switching_chatter", "Changes of the nearest object on the mid-line", "hysteresis (mm)",
            "changes (1/s)"};
  for (const Chatter& one : cases) {
    Series series{.name = one.name, .mark = Mark::both};
    for (std::size_t i = 0; i < hysteresis.size(); ++i) series.add(1e3 * hysteresis[i], one.per_second[i]);
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "A finger that is seen with 1 mm noise (one sigma, each axis, every tick; or in pictures with 0.5 mm) "
      "stands where two objects are equally near. Between objects that face each other the noise counts "
      "twice; beside each other, less.";
  return plot;
}

void chatter(Bench& bench) {
  std::vector<double> hysteresis;
  for (int mm = 0; mm <= 14; ++mm) hysteresis.push_back(1e-3 * mm);
  const std::vector<Chatter> cases = all_chatter(bench.context, hysteresis);
  const auto at = [&](std::size_t mm) { return bench.context.mutated("exchange_room") ? 12 - mm : mm; };
  bench.figure("chatter.facing_none", cases[0].per_second[at(0)], "1/s", at_least(10.0),
               "without hysteresis, 1 mm noise");
  bench.figure("chatter.facing_12mm", cases[0].per_second[at(12)], "1/s", at_most(0.0),
               "with the 12 mm of room.toml, six sigma of the difference");
  bench.figure("chatter.keys_3mm", cases[1].per_second[at(12) == 12 ? 3 : 0], "1/s", at_most(0.0),
               "with the 3 mm of keypad.toml");
  bench.figure("chatter.keys_seen_3mm", cases[2].per_second[3], "1/s",
               "as vision sees it: 20 pictures a second with 0.5 mm, 50 ms old, carried on and looked ahead");
  bench.result.plots.push_back(chatter_plot(cases, hysteresis));
}

// Ticks among a number of objects.
struct Ticks {
  std::vector<double> step_s, all_s;  // s: of step(); of asking every object, in each tenth tick
  double farther = 0.0;               // m: of the chosen object beyond the nearest, at most
};
Ticks timed_ticks(const BenchContext& context, std::size_t count, Yardstick& yardstick) {
  Scene scene = bare_scene(context);
  fill_with_crowd(scene, count, context.seed);
  trial::FingerLoop loop(std::move(scene));
  Ticks timed;
  const Vec<'W'> beside(context.mutated("beside") ? 0.03 : 0.0, 0.0, 0.0);
  const int work = context.mutated("three_times") ? 3 : 1;
  const int ticks = context.quick ? 4000 : 20000;
  for (int i = 0; i < ticks; ++i) {
    const double t = 1e-3 * i;  // up to 300 mm/s
    const Point<'W'> p(0.25 * std::sin(0.9 * t), 0.25 * std::sin(1.3 * t + 1.0), 0.25 * std::sin(0.7 * t));
    double spent = 0.0;
    for (int k = 0; k < work; ++k) spent += time_of(loop, p);
    timed.step_s.push_back(spent);
    if (i % 10 != 0) continue;
    yardstick.measure();
    const double start = thread_seconds();
    const NearestObject all = brute_force(loop.scene, p);
    timed.all_s.push_back(thread_seconds() - start);
    const double chosen = distance_to(loop.scene, loop.out.object, p + beside);
    // An object in contact stays chosen until the finger has left it.
    if (loop.out.mode != Mode::contact) timed.farther = std::max(timed.farther, chosen - all.distance);
  }
  return timed;
}

// Times over the number of objects, us.
struct TickTimes {
  Series ours{"step(), median"}, worst{"step(), p99.9"}, brute{"asking every object, without bounds"};

  void add(std::size_t count, const Ticks& timed) {
    const auto n = static_cast<double>(count);
    for (Series* s : {&ours, &worst, &brute}) s->x.push_back(n);
    ours.y.push_back(1e6 * percentile(timed.step_s, 0.5));
    worst.y.push_back(1e6 * percentile(timed.step_s, 0.999));
    brute.y.push_back(1e6 * percentile(timed.all_s, 0.5));
  }
};

Plot time_plot(TickTimes times) {
  for (Series* s : {&times.ours, &times.worst, &times.brute}) s->mark = Mark::both;
  Plot plot{
      "switching_time", "Time of a tick over the number of objects", "objects", "time (us)", true, true};
  plot.series = {times.ours, times.worst, times.brute};
  plot.caption =
      "The answers are the same, so the run time alone is left of an error-against-run-time diagram. Objects "
      "whose ball is farther than the nearest so far are not asked.";
  return plot;
}

// Time of a tick, and of testing all objects for an equal answer, over the number of objects.
void timing(Bench& bench) {
  const BenchContext& context = bench.context;
  TickTimes times;
  double wrong = 0.0;
  Yardstick yardstick;
  for (const std::size_t count : {1U, 3U, 10U, 30U, 100U, 300U, 1000U}) {
    const Ticks timed = timed_ticks(context, count, yardstick);
    wrong = std::max(wrong, timed.farther);
    times.add(count, timed);
  }
  const double ours = times.ours.y.back();
  bench.cost("tick_1000.p50", ours, "us", "step() in a scene of 1,000 objects; CPU time of its thread");
  bench.cost("tick_1000.p99_9", times.worst.y.back(), "us", "the same");
  bench.cost("tick_1000.over_yardstick.median", 1e-6 * ours / yardstick.seconds(), "x", at_most(4.0),
             "the median over a fixed piece of work of the same run (kit/cost.h)");
  const double brute = times.brute.y[context.mutated("few_objects") ? 2 : 6];
  bench.cost("brute_over_tick_1000.median", brute / ours, "x", at_least(2.0),
             "asking every object over the whole of step()");
  bench.figure("farther_than_nearest.max", 1e3 * wrong, "mm",
               at_most(1e3 * (bare_scene(context).follow.hysteresis + 0.008)),
               "the chosen object beyond the nearest: the hysteresis, or what is touched comes first");
  bench.result.plots.push_back(time_plot(std::move(times)));
}

}  // namespace

void add_choice(Bench& bench) {
  const BenchContext& context = bench.context;
  bench.figure("right", 100.0 * share_right(context, context.quick ? 2000 : 10'000), "%", exactly(100.0),
               "queries over 50 objects of four kinds, against asking each by hand");
  chatter(bench);
  bench.progress(0.3);
  timing(bench);
}

}  // namespace enc::bench::switching
