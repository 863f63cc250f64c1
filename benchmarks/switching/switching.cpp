// Which of many objects is nearest, and what becomes of those that move [VisHap 2.2, 2.3.3].
#include "benchmarks/switching/switching.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "benchmarks/kit/force_precision.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/yardstick.h"
#include "benchmarks/switching/crowd.h"
#include "trial/finger_loop.h"
#include "trial/trial.h"

namespace enc::bench::switching {

namespace {

// Of step() alone, with the finger at p, s of this thread.
double time_of(trial::FingerLoop& loop, const Point<'W'>& p) {
  loop.put(p);
  const double start = thread_seconds();
  loop.go();
  return thread_seconds() - start;
}

constexpr double kNoise = 1e-3;        // m, of the finger along each axis [V35]
constexpr double kSeenNoise = 0.5e-3;  // m, of the rig [VisHap 2.1]

// A finger that is seen as it is: the choice itself is judged.
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
  int right = 0;
  for (int i = 0; i < queries; ++i) {
    loop.state = State{};
    const Point<'W'> p = anywhere(random);
    loop.tick(p);
    // Objects that are touched come first: then the nearest of all may not be one of them.
    right += loop.out.object == nearest_for_a_finger(loop.scene, p, loop.scene.tools[0].tip.radius) ? 1 : 0;
  }
  return static_cast<double>(right) / queries;
}

// How a finger at rest is seen: as it is, each tick; or as vision sees it, 20 pictures a second that are 50
// ms old when they come, and carried on by the filter of the scene.
enum class Shown : std::uint8_t { each_tick, pictures };
struct Chatter {
  const char* name;
  Point<'W'> middle;
  Shown shown = Shown::each_tick;
  std::vector<double> per_second = {};
};

// Two balls that face each other 40 mm apart: what noise does there is the worst.
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
  constexpr int kFrom = 1000;  // ticks until the filter knows the finger
  scene.follow.hysteresis = hysteresis;
  trial::FingerLoop loop(std::move(scene));
  std::mt19937_64 random(seed);
  const bool pictures = finger.shown == Shown::pictures;
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

void chatter(const BenchContext& context, BenchResult& result, const Adder& add) {
  const double seconds = context.quick ? 5.0 : 60.0;
  std::vector<double> hysteresis;
  for (int mm = 0; mm <= 14; ++mm) hysteresis.push_back(1e-3 * mm);
  const Scene keypad = bare_scene(context), whole = trial::prepare_setup(load_scene(context, "keypad"));
  // 12 mm over the gap between two keys: a finger that looks for the next one.
  const Point<'W'> gap(0.010, 0.010, 0.012);
  std::vector<Chatter> cases{{"two balls that face each other", {0, 0, 0}},
                             {"two keys side by side", gap},
                             {"the same, 20 pictures a second, and 60 ms ahead", gap, Shown::pictures}};
  for (Chatter& one : cases) {
    one.per_second.resize(hysteresis.size());
    const bool balls = &one == &cases.front();
    in_parallel(hysteresis.size(), [&](std::size_t i) {
      const Scene& keys = one.shown == Shown::pictures ? whole : keypad;
      one.per_second[i] =
          switches_per_second(balls ? facing(keypad) : keys, hysteresis[i], one, seconds, context.seed);
    });
  }
  add("chatter.facing_none", cases[0].per_second[0], "1/s", "without hysteresis, 1 mm noise", 10.0, kUnset);
  add("chatter.facing_12mm", cases[0].per_second[12], "1/s",
      "with the 12 mm of room.toml, six sigma of the difference", kUnset, 0.0);
  add("chatter.keys_3mm", cases[1].per_second[3], "1/s", "with the 3 mm of keypad.toml", kUnset, 0.0);
  add("chatter.keys_seen_3mm", cases[2].per_second[3], "1/s",
      "as vision sees it: 20 pictures a second with 0.5 mm, 50 ms old, carried on and looked ahead", kUnset,
      kUnset);
  Plot plot{"switching_chatter",
            "Changes of the nearest object on the mid-line",
            "hysteresis (mm)",
            "changes (1/s)",
            false,
            false,
            {}};
  for (const Chatter& one : cases) {
    Series series{one.name, {}, {}};
    for (std::size_t i = 0; i < hysteresis.size(); ++i) {
      series.x.push_back(1e3 * hysteresis[i]);
      series.y.push_back(one.per_second[i]);
    }
    series.mark = Mark::both;
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "A finger that is seen with 1 mm noise (one sigma, each axis, every tick; or in pictures with 0.5 mm) "
      "stands where two objects are "
      "equally near. Between objects that face each other the noise counts twice; beside each other, less.";
  result.plots.push_back(std::move(plot));
}

// Time of a tick and of the same answer by asking all, over the number of objects.
void timing(const BenchContext& context, BenchResult& result, const Adder& add, const Adder& add_cost) {
  const std::vector<std::size_t> counts{1, 3, 10, 30, 100, 300, 1000};
  const int ticks = context.quick ? 4000 : 20000;
  Series ours{"step(), median", {}, {}}, worst{"step(), p99.9", {}, {}},
      brute{"asking every object, without bounds", {}, {}};
  double wrong = 0.0, ratio = kUnset;
  Yardstick yardstick;
  for (const std::size_t count : counts) {
    Scene scene = bare_scene(context);
    fill_with_crowd(scene, count, context.seed);
    trial::FingerLoop loop(std::move(scene));
    std::vector<double> step_s, all_s;
    for (int i = 0; i < ticks; ++i) {
      const double t = 1e-3 * i;  // up to 300 mm/s
      const Point<'W'> p(0.25 * std::sin(0.9 * t), 0.25 * std::sin(1.3 * t + 1.0), 0.25 * std::sin(0.7 * t));
      step_s.push_back(time_of(loop, p));
      if (i % 10 != 0) continue;
      yardstick.measure();
      const double start = thread_seconds();
      const Nearby all = brute_force(loop.scene, p);
      all_s.push_back(thread_seconds() - start);
      const double chosen = distance_to(loop.scene, loop.out.object, p);
      // What is in contact stays so until the finger has left it.
      if (loop.out.mode != Mode::contact) wrong = std::max(wrong, chosen - all.distance);  // m
    }
    const auto n = static_cast<double>(count);
    for (Series* s : {&ours, &worst, &brute}) s->x.push_back(n);
    ours.y.push_back(1e6 * percentile(step_s, 0.5));
    worst.y.push_back(1e6 * percentile(step_s, 0.999));
    brute.y.push_back(1e6 * percentile(all_s, 0.5));
    ratio = brute.y.back() / ours.y.back();
  }
  add_cost("tick_1000.p50", ours.y.back(), "us", "step() in a scene of 1,000 objects; CPU time of its thread",
           kUnset, kUnset);
  add_cost("tick_1000.p99_9", worst.y.back(), "us", "the same", kUnset, kUnset);
  add_cost("tick_1000.over_yardstick.median", 1e-6 * ours.y.back() / yardstick.seconds(), "x",
           "the median over a fixed piece of work of the same run (kit/yardstick.h)", kUnset, 4.0);
  add_cost("brute_over_tick_1000.median", ratio, "x", "asking every object over the whole of step()", 2.0,
           kUnset);
  add("farther_than_nearest.max", 1e3 * wrong, "mm",
      "the chosen object beyond the nearest: the hysteresis, or what is "
      "touched comes first",
      kUnset, 1e3 * (bare_scene(context).follow.hysteresis + 0.008));
  for (Series* s : {&ours, &worst, &brute}) s->mark = Mark::both;
  Plot plot{
      "switching_time", "Time of a tick over the number of objects", "objects", "time (us)", true, true, {}};
  plot.series = {ours, worst, brute};
  plot.caption =
      "The answers are the same, so the run time alone is left of an error-against-run-time diagram. Objects "
      "whose ball is farther than the nearest so far are not asked.";
  result.plots.push_back(std::move(plot));
}

}  // namespace

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const Adder add = [&](const std::string& id, double value, const char* unit, const std::string& note,
                        double low, double high) {
    result.figures.push_back({"switching." + id, kUnset, value, unit, Role::ours, low, high, note});
  };
  const Adder add_cost = [&](const std::string& id, double value, const char* unit, const std::string& note,
                             double low, double high) {
    add(id, value, unit, note, low, high);
    result.figures.back().cost = true;
  };
  const auto progress = [&](double share) {
    if (context.progress) context.progress(share);
  };
  add("right", 100.0 * share_right(context, context.quick ? 2000 : 10'000), "%",
      "queries over 50 objects of four kinds, against asking each by hand", 100.0, 100.0);
  chatter(context, result, add);
  progress(0.3);
  timing(context, result, add, add_cost);
  progress(0.5);
  slide_over_keys(context, result, add);
  progress(0.8);
  move_things(context, result, add);
  add_force_precision(bench);
}

const Entry kEntry{
    "switching", "keypad",
    "the nearest of many objects: right, without chatter, in time; keys, a hit ball, tiles and a drum", run};

}  // namespace enc::bench::switching
