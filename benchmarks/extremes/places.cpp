// Where no tool should be: out of reach, at a singular pose, on two objects at once; and more force than
// there is.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/extremes/faults.h"
#include "core/base/units.h"

namespace enc::bench::extremes {
namespace {

// The tool is seen to go 0.2 m aside and back, twice, and then to tremble about the pause distance.
Found leaves(const BenchContext& context, bool arm) {
  constexpr double kFar = 0.2, kTurn = 3.0, kFrom = 1.0;  // m, s
  const models::Setup setup =
      load_scene(context, arm ? "wall" : "plane",
                 {"user.approach_mm_s=[10]", "user.approach_from_mm=60", "user.approach_tilt_deg=0"});
  Found found{fmt::format("{}.toml, 200 mm aside and back, twice", arm ? "wall" : "plane"),
              "within reach, never near a singular pose; back in place 1.2 s later",
              {}};
  double now = 0.0, back = 0.0, unreachable = 0.0, farthest = 0.0;
  trial::TrialOptions options;
  options.seconds = kFrom + 2.0 * kTurn + 1.6;
  options.fit_out = keep_clean;
  options.disturb = [&](Inputs& in) {
    const double since = now - kFrom;
    now += 1e-3;
    if (since < 0.0 || since > 2.0 * kTurn) return;
    const double aside = 0.5 * kFar * (1.0 - std::cos(2.0 * std::numbers::pi * since / kTurn));
    in.tool.value.X_CT.xyz[0] += aside;
  };
  const auto look = [&](const trial::Glance& g) {
    unreachable += (g.out.why & kUnreachable) != 0 ? 1.0 : 0.0;
    const Vec3 off = (g.truth.tool_tip - g.truth.tip).e();
    farthest = std::max(farthest, std::hypot(g.truth.tip.xyz[0], g.truth.tip.xyz[1]));
    if (time_of(g) > kFrom + 2.0 * kTurn + 1.2) back = std::max(back, std::hypot(off.x(), off.y()));
  };
  // Where a tool meets a tip that comes from the side is chance: one hand shows little.
  constexpr std::uint64_t kHands = 4;
  double condition = 0.0, dexterity = 1.0;
  Run worst;
  for (std::uint64_t hand = 0; hand < kHands; ++hand) {
    options.seed = context.seed + hand;
    now = 0.0;
    Run run = judged(setup, options, look);
    condition = std::max(condition, run.judge.condition);
    dexterity = std::min(dexterity, run.judge.dexterity);
    const bool worse = run.judge.broken() > worst.judge.broken() || run.result.diverged_at >= 0;
    if (hand == 0 || worse) worst = std::move(run);
  }
  found.numbers = {{"clamped.value", unreachable, "", {}, "ticks with a target out of reach"},
                   {"back.max", back * kMmPerM, "mm", at_most(arm ? 3.0 : 1.0),
                    "from under the tool, 1.2 s later, worst of 4 hands: 50 mm take 1.1 s"},
                   {"farthest.max", farthest * kMmPerM, "mm", {}, "of the tip, aside"}};
  if (arm)
    found.numbers.push_back({"dexterity.min", dexterity, "", at_least(0.9 * setup.rig.arm.least_dexterity),
                             "a tenth for what the arm overshoots"});
  else
    found.numbers.push_back({"condition.max", condition, "", at_most(20.0), "of the commanded poses"});
  add_soundness(worst, found);
  return found;
}

// Up and down about the pause distance, by 3 mm at 1 Hz with 50 um of noise: within the hysteresis.
Found trembles(const BenchContext& context, bool arm) {
  const models::Setup setup =
      load_scene(context, arm ? "wall" : "plane",
                 {"user.approach_mm_s=[1]", "user.approach_from_mm=60", "user.approach_tilt_deg=0"});
  Found found{fmt::format("{}.toml, trembles where following ends", arm ? "wall" : "plane"),
              "followed or not: no more than one change of mode",
              {}};
  const double pause = setup.scene.follow.pause;
  double now = 0.0;
  Mode before = Mode::away;
  double changes = 0.0;
  std::mt19937_64 random(context.seed);
  std::normal_distribution<double> noise(0.0, 50e-6);
  double shift = 0.0;
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = 6.0;
  options.fit_out = keep_clean;
  options.disturb = [&](Inputs& in) {
    if (std::fmod(now, 0.008) < 1e-3)
      shift = pause - 0.060 + 3e-3 * std::sin(2.0 * std::numbers::pi * now) + noise(random);
    now += 1e-3;
    const Vec3 up = shift * Vec3(pose_of<'W', 'C'>(setup.twin.frames.W_C).inverse().q() * Vec3::UnitZ());
    for (std::size_t i = 0; i < 3; ++i) in.tool.value.X_CT.xyz[i] += up(static_cast<Eigen::Index>(i));
  };
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    if (time_of(g) > 1.0) changes += g.out.mode != before ? 1.0 : 0.0;
    before = g.out.mode;
  });
  found.numbers = {{"changes.value", changes, "", at_most(1.0), "of mode, in 5 s"}};
  add_soundness(run, found);
  return found;
}

// A sensor that ends at 12 N, of which 9 N are its load.
Found saturated(const BenchContext& context) {
  const models::Setup setup =
      load_scene(context, "tennis_ball",
                 {"truth.force.range_N=12", "truth.force.zero_N=0", "user.approach_mm_s=[50]",
                  "user.approach_from_mm=30", "user.press_s=1.5", "user.depth_mm=4"});
  Found found{"tennis_ball.toml, force sensor at its range",
              "a hold on each such tick and on no other; at rest in it",
              {}};
  double wrong = 0.0, ticks = 0.0, moved = 0.0, held_for = 0.0;
  Vec3 before = Vec3::Zero();
  trial::TrialOptions options;
  options.seed = context.seed;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    const bool full = g.in.wrench.health == Health::saturated, held = g.out.mode == Mode::hold;
    ticks += full ? 1.0 : 0.0;
    wrong += full != held ? 1.0 : 0.0;
    held_for = held ? held_for + g.scene.dt : 0.0;
    constexpr double kBrakes = 0.125;  // s: from 50 mm/s at 0.41 m/s2
    if (held_for > kBrakes) moved = std::max(moved, (g.out.tip.p() - before).norm());
    before = g.out.tip.p();
  });
  found.numbers = {{"wrong.value", wrong, "", exactly(0.0), "ticks with the one and not the other"},
                   {"full.value", ticks, "", at_least(500.0), "ticks at the range"},
                   {"moved.max", moved * 1e6, "um", exactly(0.0), "commanded in a hold, once at rest"}};
  add_soundness(run, found);
  return found;
}

// Pressed with 40 N by a tool, where the machine carries 30 N and 9 N of them are its load.
Found overloaded(const BenchContext& context) {
  constexpr double kStiffness = 10e3;  // N/m
  const models::Setup setup =
      load_scene(context, "plane",
                 {"behaviour.wall.stiffness_N_per_mm=10", "rig.manipulator.payload_N=30", "user.push_N=40"});
  Found found{"plane.toml, 40 N on a machine that carries 30 N",
              "said; the tip goes no deeper than 30 N have it",
              {}};
  double said = 0.0, deepest = 0.0;
  trial::TrialOptions options;
  options.seed = context.seed;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    said += (g.out.why & kOverload) != 0 ? 1.0 : 0.0;
    deepest = std::max(deepest, g.out.deflection);
  });
  found.numbers = {
      {"said.value", said, "", at_least(1.0), "ticks with the notice"},
      {"given.max", deepest * kStiffness, "N", at_most(30.0), "of the wall, where the tip is sent"},
      {"touch.max", run.judge.touch, "N", {}, "true force"}};
  add_soundness(run, found);
  return found;
}

Found coincident(const BenchContext& context, bool arm) {
  models::Setup setup = load_scene(context, arm ? "keypad" : "tennis_ball",
                                   arm ? std::vector<std::string>{}
                                       : std::vector<std::string>{"user.approach_mm_s=[50]", "user.press_s=1",
                                                                  "user.release_s=1", "user.depth_mm=4"});
  std::vector<ObjectSpec>& objects = setup.scene.objects;
  ObjectSpec again = objects[arm ? 4 : 0];  // the one that is pressed
  again.name += "_again";
  objects.push_back(again);
  Found found{fmt::format("{}.toml, its object there twice", arm ? "keypad" : "tennis_ball"),
              "one of them, the same each time: no change in 100 cycles",
              {}};
  std::uint64_t hash = 0;
  double most = 0.0;
  for (int i = 0; i < 2; ++i) {
    std::int64_t last = -1000, switches = 0;
    std::int32_t before = -1;
    const auto twin = [&](std::int32_t index) { return arm ? index == 4 || index == 12 : true; };
    trial::TrialOptions options;
    options.seed = context.seed;
    const Run run = judged(setup, options, [&](const trial::Glance& g) {
      if (g.out.object != before && before >= 0 && twin(before) && twin(g.out.object)) {
        switches += g.tick.index - last < 100 ? 1 : 0;
        last = g.tick.index;
      }
      before = g.out.object;
    });
    most = std::max(most, static_cast<double>(switches));
    if (i == 0) hash = run.result.hash;
    if (i == 0) continue;
    found.numbers = {
        {"switches.value", most, "", exactly(0.0), "less than 100 cycles after another"},
        {"other.value", hash == run.result.hash ? 0.0 : 1.0, "", exactly(0.0), "1: not the same twice"}};
    add_soundness(run, found);
  }
  return found;
}

}  // namespace

void add_places(Cases& cases, bool quick) {
  for (const bool arm : {true, false}) {
    const std::string machine = arm ? "arm" : "hexapod";
    cases.push_back({machine + ".leaves", [=](const BenchContext& context) { return leaves(context, arm); }});
    if (quick) continue;
    cases.push_back(
        {machine + ".trembles", [=](const BenchContext& context) { return trembles(context, arm); }});
    cases.push_back(
        {machine + ".coincident", [=](const BenchContext& context) { return coincident(context, arm); }});
  }
  cases.push_back({"hexapod.saturated", saturated});
  cases.push_back({"hexapod.overloaded", overloaded});
}

}  // namespace enc::bench::extremes
