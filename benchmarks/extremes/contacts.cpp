// Cases of contact: walls of any stiffness, touches at too high a speed, and contacts at unusual places.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/extremes/faults.h"
#include "core/base/units.h"
#include "trial/certificates.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::extremes {
namespace {

// Walls from 10^2 to 10^6 N/m on both machines.

constexpr double kPush = 4.0;   // N, of the finger
constexpr double kStill = 1.0;  // mm, peak to peak: a larger swing counts as not rendered
// N/m: from here on the arm's law rings at the length of the finger's way; from there on it parts from the
// finger before it has swung so far.
constexpr double kSwings = 1e4, kParts = 2e5;

// m, peak to peak along z: the tip's swing while it is watched.
class Swing {
 public:
  void see(const trial::Glance& glance) {
    low_ = std::min(low_, glance.truth.tip.xyz[2]);
    high_ = std::max(high_, glance.truth.tip.xyz[2]);
  }
  [[nodiscard]] double size() const { return high_ > low_ ? high_ - low_ : 0.0; }

 private:
  double low_ = kInfinite, high_ = -kInfinite;
};

std::string name_of(const char* machine, double stiffness) {
  return fmt::format("{}.wall.{:.0f}", machine, stiffness);
}

// The finger presses as in the scene; the last half of its hold is watched.
CaseResult arm_wall(const BenchContext& context, double stiffness) {
  const models::Setup setup =
      load_scene(context, "wall",
                 {fmt::format("behaviour.phantom_wall.stiffness_N_per_mm={:g}", stiffness / 1e3),
                  fmt::format("user.push_N={:g}", kPush)});
  CaseResult found{fmt::format("wall.toml at {:g} N/m, pressed with 4 N", stiffness),
                   "the sheet's peak for at most a cycle more; named where beyond the law",
                   {}};
  trial::TrialOptions options{.seed = context.seed};
  Swing swing;
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    if (g.truth.phase == sim::Phase::hold) swing.see(g);
  });
  const trial::ObjectCertificate wall = trial::certificates_of(setup, trial::prepare_setup(setup)).back();
  const std::string beyond = context.mutated("quiet") ? "" : trial::refusal_text(setup, wall);
  const bool holds = stiffness < kSwings;
  found.numbers = {{"force.max", run.judge.force, "N", {}, "commanded"},
                   {"touch.max", run.judge.touch, "N", {}, "true force on the finger"},
                   {"swing.max", swing.size() * kMmPerM, "mm",
                    at_most(holds                ? kStill
                            : stiffness < kParts ? 50.0
                                                 : 6.0),
                    "of the tip, while the finger holds", kStill}};
  if (stiffness > certificate::row_of(wall.certificate, "exact_with_hand").bound)
    found.numbers.push_back(
        {"named.value", beyond.empty() ? 0.0 : 1.0, "", exactly(1.0), "by check and run"});
  add_soundness(run, found);
  if (!beyond.empty()) found.words = "said before the run: " + beyond.substr(0, beyond.find(';'));
  return found;
}

// Pushed from outside with up to 30 N.
CaseResult machine_wall(const BenchContext& context, double stiffness) {
  const models::Setup setup = load_scene(
      context, "stiffness", {fmt::format("behaviour.spring.stiffness_N_per_mm={:g}", stiffness / 1e3)});
  CaseResult found{
      fmt::format("stiffness.toml at {:g} N/m, pushed with 30 N", stiffness),
      "commands within speed, acceleration and reach; a tenth more than the push; tip within 0.05 mm",
      {}};
  trial::TrialOptions options{.seed = context.seed};
  Swing swing;
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    const double t = time_of(g);
    if (t > 5.0 && t < 8.5) swing.see(g);  // held from 3 s to 9 s
  });
  found.numbers = {{"speed.max", run.judge.fastest * kMmPerM, "mm/s", {}, "commanded"},
                   {"touch.max", run.judge.touch, "N", at_most(1.1 * std::min(30.0, 15e-3 * stiffness)),
                    "true force on the tip, pushed with 30 N or 15 mm deep"},
                   {"swing.max", swing.size() * kMmPerM, "mm", stiffness < 5e4 ? at_most(0.05) : Bounds{},
                    "of the tip, while it is held down"}};
  add_soundness(run, found);
  return found;
}

// Starts deep inside the object, and approaches faster than any hand.

constexpr double kDeep = 20e-3, kTop = 25e-3;  // m: of the finger; of the wall over the waiting prop

// Vision detects the finger for the first time when it is 20 mm inside the wall.
CaseResult deep_finger(const BenchContext& context) {
  const models::Setup setup =
      load_scene(context, "wall",
                 {"object.wall.position_mm=[0,0,25]", "user.push_N=2", "user.press_s=0.5", "user.hold_s=2",
                  "user.release_s=0.5", "user.rest_s=1", "user.approach_mm_s=[100]"});
  CaseResult found{
      "wall.toml, finger first seen 20 mm inside", "pushed out at <= 50 mm/s, within the force", {}};
  bool seen = false;
  double fastest = 0.0, deepest = 0.0;
  trial::TrialOptions options{.seed = context.seed};
  options.disturb = [&](Inputs& in) {
    if (!seen) in.tool.health = Health::absent;
  };
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    const double depth = kTop - g.truth.tool_tip.xyz[2] + g.truth.tool_radius;
    seen = seen || depth > kDeep;
    deepest = std::max(deepest, depth);
    if (seen && g.truth.phase != sim::Phase::release)
      fastest = std::max(fastest, g.truth.tool_velocity.xyz[2]);
  });
  found.numbers = {
      {"exit_speed.max", fastest * kMmPerM, "mm/s", at_most(365.0), "of the finger, outwards", 50.0},
      {"force.max", run.judge.force, "N", {}, "commanded"},
      {"depth.max", deepest * kMmPerM, "mm", {}, "of the finger"}};
  found.words = "the law is a spring wherever the finger is first seen, and gives what nobody has put in";
  add_soundness(run, found);
  return found;
}

// The machine's tip is 20 mm inside of the ball when the loop begins.
CaseResult deep_tip(const BenchContext& context) {
  const models::Setup setup = load_scene(context, "tennis_ball",
                                         {"object.ball.position_mm=[0,0,-13]", "user.approach_mm_s=[20]",
                                          "user.press_s=1", "user.release_s=1", "user.approach_from_mm=50"});
  CaseResult found{
      "tennis_ball.toml, tip starts 20 mm inside", "out at <= 50 mm/s, never deeper, not outside", {}};
  double least = kInfinite, back = 0.0, outside = -kInfinite, first = kUnset;
  trial::TrialOptions options{.seed = context.seed};
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    const Object& ball = g.scene.objects.front();
    const double depth = -ball.surface.nearest(ball.X_WO.inverse() * g.truth.tip).distance;
    if (std::isnan(first)) first = depth;
    if (g.out.contacts == 0) {
      back = std::max(back, depth - least);
      least = std::min(least, depth);
    }
    outside = std::max(outside, g.truth.tip_radius - depth);
  });
  constexpr double kStep = 3e-6;  // m: retreat that the machine's own step may cause
  found.numbers = {{"start.value", first * kMmPerM, "mm", between(19.9, 20.1), "depth of the tip's centre"},
                   {"back.max", back * 1e6, "um", at_most(2e6 * kStep), "deeper than it has been before"},
                   {"outside.max", outside * 1e6, "um", at_most(0.0), "of the tip outside the ball"},
                   {"speed.max", run.judge.fastest * kMmPerM, "mm/s", {}, "commanded"}};
  add_soundness(run, found);
  return found;
}

struct Hit {
  double deepest = -kInfinite;  // m: tool inside the tip
  double through = 0.0;  // crossings of the tool's centre through the middle of the tip, or through the front
  bool over = false;
  double arrives = 0.0;  // m/s, of the tool before it touches
};

// Measured along z, which is the normal in both scenes, `front` above the tip. A tool that passes beside the
// tip does not count as through.
void see_hit(const trial::Glance& g, bool arm, double front, Hit& hit) {
  const Vec3 apart = (g.truth.tool_tip - g.truth.tip).e() - Vec3(0, 0, front);
  const double aside = std::hypot(apart.x(), apart.y()), radii = g.truth.tool_radius + g.truth.tip_radius;
  constexpr double kPlate = 15e-3;  // m: half of the plate, whose front faces up
  const bool over = aside < (arm ? kPlate : radii) && apart.z() >= 0.0;
  const bool under = aside < (arm ? kPlate : radii) && apart.z() < 0.0;
  if (over) hit.deepest = std::max(hit.deepest, arm ? g.truth.tool_radius - apart.z() : radii - apart.norm());
  hit.through += hit.over && under ? 1.0 : 0.0;
  hit.over = over;
}

// The hand can reach that speed because it has 50 N.
CaseResult impact(const BenchContext& context, bool arm, double speed) {
  const models::Setup setup = load_scene(context, arm ? "wall" : "tennis_ball",
                                         {fmt::format("user.approach_mm_s=[{:g}]", speed * kMmPerM),
                                          fmt::format("user.approach_from_mm={:g}", 300.0 * speed),
                                          "user.approach_tilt_deg=0", "user.press_s=1", "user.release_s=1"});
  CaseResult found{fmt::format("{}.toml, touched at {:g} m/s", arm ? "wall" : "tennis_ball", speed),
                   "stopped, not gone through; at 1 m/s at most 1.5 mm into each other",
                   {}};
  trial::TrialOptions options{.seed = context.seed};
  Hit hit;
  double before = 0.0;
  const double deepest = arm ? (speed < 2.0 ? 1.6 : 4.5) : speed < 2.0 ? 1.7 : 1.9;  // mm
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    see_hit(g, arm, context.mutated("front_20mm_higher") ? 0.02 : 0.0, hit);
    if (g.truth.touching && hit.arrives == 0.0)
      hit.arrives = (context.mutated("half_speed") ? 0.5 : 1.0) * before;
    before = g.truth.tool_velocity.norm();
  });
  found.numbers = {
      {"through.value", hit.through, "", exactly(0.0), "times that the tool went through what it touched"},
      {"into.max", hit.deepest * kMmPerM, "mm", at_most(deepest), "tool into tip",
       speed < 2.0 ? 1.5 : kUnset},
      {"arrives.value", hit.arrives, "m/s", between(0.85 * speed, 1.1 * speed),
       "of the tool, before the first touch"},
      {"touch.max", run.judge.touch, "N", {}, "true force"}};
  if (!arm && speed < 2.0)
    found.words =
        "the stop between tool and tip has 5 ms, so that a tip that goes in steps is not felt to rattle";
  add_soundness(run, found);
  return found;
}

// Hard objects beside a soft one, with two tools [VHMR 5: training].
CaseResult training(const BenchContext& context) {
  const models::Setup setup =
      load_scene(context, "training", {fmt::format("user.session.duration_s={}", context.full ? 60 : 20)});
  CaseResult found{
      "training.toml, 50 to 200 N/mm beside 0.5",
      "each press one contact; never outside; no deeper than the limit and two steps of the machine",
      {}};
  trial::PressMeasure presses(setup);
  double limit = kUnset;
  trial::TrialOptions options{.seed = context.seed};
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    presses.see(g);
    limit = g.scene.objects.front().limit - (context.mutated("limit_1mm_less") ? 1e-3 : 0.0);
  });
  double torn = 0.0, deepest = 0.0, felt = 0.0;
  for (const trial::PressFigures& press : presses.presses()) {
    if (std::isnan(press.miss)) continue;
    ++felt;
    torn += press.contacts == (context.mutated("two_contacts") ? 2 : 1) ? 0.0 : 1.0;
    deepest = std::max(deepest, press.peak_deflection);
  }
  constexpr double kStep = 3e-6;  // m, of the machine
  found.numbers = {{"presses.value", felt, "", {}, "that touched"},
                   {"torn.value", torn, "", exactly(0.0), "of them, with none or several contacts"},
                   {"deeper.max", (deepest - limit) * 1e6, "um", at_most(2e6 * kStep),
                    "than the limit of the tooth, true"},
                   {"outside.max", presses.greatest_outside() * 1e6, "um", at_most(0.0),
                    "of the tip outside of an object"},
                   {"touch.max", run.judge.touch, "N", {}, "true force"}};
  add_soundness(run, found);
  return found;
}

// Tools in unusual places: out of reach, at a singular pose, on two objects at once; and more force than the
// device has.

// Vision sees the tool move 0.2 m aside and back, twice: the movement, and what is seen of the tip.
struct ToolExcursion {
  static constexpr double kFar = 0.2, kTurn = 3.0, kFrom = 1.0;  // m, s
  double now = 0.0;                                              // s
  double unreachable = 0.0;                                      // ticks with a target out of reach
  double back = 0.0, farthest = 0.0;                             // m
  double back_after = 1.2;                                       // s

  void disturb(Inputs& in) {
    const double since = now - kFrom;
    now += 1e-3;
    if (since < 0.0 || since > 2.0 * kTurn) return;
    const double aside = 0.5 * kFar * (1.0 - std::cos(2.0 * std::numbers::pi * since / kTurn));
    in.tool.value.X_CT.xyz[0] += aside;
  }
  void see(const trial::Glance& g) {
    unreachable += (g.out.why & kUnreachable) != 0 ? 1.0 : 0.0;
    const Vec3 off = (g.truth.tool_tip - g.truth.tip).e();
    farthest = std::max(farthest, std::hypot(g.truth.tip.xyz[0], g.truth.tip.xyz[1]));
    if (time_of(g) > kFrom + 2.0 * kTurn + back_after) back = std::max(back, std::hypot(off.x(), off.y()));
  }
};

struct WorstHand {
  double condition = 0.0, dexterity = 1.0;  // the worst of any hand
  Run run;                                  // the one with most ticks that the judge objects to
};

// The place where a tool meets a tip that comes from the side is chance: one hand is not enough.
WorstHand worst_of_hands(const BenchContext& context, const models::Setup& setup, ToolExcursion& leaving) {
  trial::TrialOptions options{.seconds = ToolExcursion::kFrom + 2.0 * ToolExcursion::kTurn + 1.6,
                              .fit_out = keep_clean};
  options.disturb = [&](Inputs& in) { leaving.disturb(in); };
  constexpr std::uint64_t kHands = 4;
  WorstHand worst;
  for (std::uint64_t hand = 0; hand < kHands; ++hand) {
    options.seed = context.seed + hand;
    leaving.now = 0.0;
    Run run = judged(context, setup, options, [&](const trial::Glance& g) { leaving.see(g); });
    worst.condition = std::max(worst.condition, run.judge.condition);
    worst.dexterity = std::min(worst.dexterity, run.judge.dexterity);
    const bool worse = run.judge.broken() > worst.run.judge.broken() || run.result.diverged_at >= 0;
    if (hand == 0 || worse) worst.run = std::move(run);
  }
  return worst;
}

CaseResult leaves(const BenchContext& context, bool arm) {
  const models::Setup setup =
      load_scene(context, arm ? "wall" : "plane",
                 {"user.approach_mm_s=[10]", "user.approach_from_mm=60", "user.approach_tilt_deg=0"});
  CaseResult found{fmt::format("{}.toml, 200 mm aside and back, twice", arm ? "wall" : "plane"),
                   "within reach; back in place 1.2 s later",
                   {}};
  ToolExcursion leaving;
  if (context.mutated("too_early")) leaving.back_after = 0.3;
  const WorstHand worst = worst_of_hands(context, setup, leaving);
  found.numbers = {{"clamped.value", leaving.unreachable, "", {}, "ticks with a target out of reach"},
                   {"back.max", leaving.back * kMmPerM, "mm", at_most(arm ? 1.5 : 0.4),
                    "from under the tool, 1.2 s later, worst of 4 hands: 50 mm take 1.1 s"},
                   {"farthest.max", leaving.farthest * kMmPerM, "mm", {}, "of the tip, aside"}};
  if (arm)
    found.numbers.push_back({"dexterity.min", worst.dexterity, "", {}, "0.15 is where a pose is refused"});
  else
    found.numbers.push_back({"condition.max", worst.condition, "", {}, "of the commanded poses"});
  add_soundness(worst.run, found);
  return found;
}

// Up and down about the pause distance, by 3 mm at 1 Hz with 50 um of noise: within the hysteresis.
CaseResult trembles(const BenchContext& context, bool arm) {
  const models::Setup setup =
      load_scene(context, arm ? "wall" : "plane",
                 {"user.approach_mm_s=[1]", "user.approach_from_mm=60", "user.approach_tilt_deg=0"},
                 context.mutated("no_hysteresis")
                     ? std::vector<std::string>{"follow.resume_mm=99.99", "follow.pause_mm=100"}
                     : std::vector<std::string>{});
  CaseResult found{fmt::format("{}.toml, trembles where following ends", arm ? "wall" : "plane"),
                   "followed or not: no more than one change of mode",
                   {}};
  const double pause = setup.scene.follow.pause;
  double now = 0.0;
  Mode before = Mode::away;
  double changes = 0.0;
  std::mt19937_64 random(context.seed);
  std::normal_distribution<double> noise(0.0, 50e-6);
  double shift = 0.0;
  trial::TrialOptions options{.seed = context.seed, .seconds = 6.0, .fit_out = keep_clean};
  options.disturb = [&](Inputs& in) {
    if (std::fmod(now, 0.008) < 1e-3)
      shift = pause - 0.060 + 3e-3 * std::sin(2.0 * std::numbers::pi * now) + noise(random);
    now += 1e-3;
    const Vec3 up = shift * Vec3(pose_of<'W', 'C'>(setup.twin.frames.W_C).inverse().q() * Vec3::UnitZ());
    for (std::size_t i = 0; i < 3; ++i) in.tool.value.X_CT.xyz[i] += up(static_cast<Eigen::Index>(i));
  };
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    if (time_of(g) > 1.0) changes += g.out.mode != before ? 1.0 : 0.0;
    before = g.out.mode;
  });
  found.numbers = {{"changes.value", changes, "", at_most(1.0), "of mode, in 5 s"}};
  add_soundness(run, found);
  return found;
}

// A sensor with a range of 12 N, of which its load takes 9 N.
CaseResult saturated(const BenchContext& context) {
  const models::Setup setup =
      load_scene(context, "tennis_ball",
                 {"truth.force.range_N=12", "truth.force.zero_N=0", "user.approach_mm_s=[50]",
                  "user.approach_from_mm=30", "user.press_s=1.5", "user.depth_mm=4"});
  CaseResult found{"tennis_ball.toml, force sensor at its range",
                   "a hold on each such tick and on no other; at rest in it",
                   {}};
  double wrong = 0.0, ticks = 0.0, moved = 0.0, held_for = 0.0;
  bool held_before = false;
  Vec3 before = Vec3::Zero();
  trial::TrialOptions options{.seed = context.seed};
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    const bool full = g.in.wrench.health == Health::saturated, held = g.out.mode == Mode::hold;
    ticks += full ? 1.0 : 0.0;
    wrong += full != (context.mutated("a_tick_late") ? held_before : held) ? 1.0 : 0.0;
    held_before = held;
    held_for = held ? held_for + g.scene.dt : 0.0;
    const double brakes = context.mutated("too_early") ? 0.0 : 0.125;  // s: from 50 mm/s at 0.41 m/s2
    if (held_for > brakes) moved = std::max(moved, (g.out.manipulator.tip.p() - before).norm());
    before = g.out.manipulator.tip.p();
  });
  found.numbers = {{"wrong.value", wrong, "", exactly(0.0), "ticks with the one and not the other"},
                   {"full.value", ticks, "", {}, "ticks at the range"},
                   {"moved.max", moved * 1e6, "um", exactly(0.0), "commanded in a hold, once at rest"}};
  add_soundness(run, found);
  return found;
}

// A tool presses with 40 N on a machine that carries 30 N, of which its load takes 9 N.
CaseResult overloaded(const BenchContext& context) {
  constexpr double kStiffness = 10e3;  // N/m
  const models::Setup setup =
      load_scene(context, "plane",
                 {"behaviour.wall.stiffness_N_per_mm=10", "rig.manipulator.payload_N=30", "user.push_N=40"});
  CaseResult found{"plane.toml, 40 N on a machine that carries 30 N",
                   "said; the tip goes no deeper than 30 N have it",
                   {}};
  double said = 0.0, deepest = 0.0;
  trial::TrialOptions options{.seed = context.seed};
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    said += (g.out.why & kOverload) != 0 ? 1.0 : 0.0;
    deepest = std::max(deepest, g.out.deflection);
  });
  found.numbers = {{"said.value", said, "", at_least(1.0), "ticks with the notice"},
                   {"given.max", deepest * kStiffness, "N", between(18.0, 24.0),
                    "of the wall, where the tip is sent: 30 N less the load"},
                   {"touch.max", run.judge.touch, "N", {}, "true force"}};
  add_soundness(run, found);
  return found;
}

CaseResult coincident(const BenchContext& context, bool arm) {
  models::Setup setup = load_scene(context, arm ? "keypad" : "tennis_ball",
                                   arm ? std::vector<std::string>{}
                                       : std::vector<std::string>{"user.approach_mm_s=[50]", "user.press_s=1",
                                                                  "user.release_s=1", "user.depth_mm=4"});
  std::vector<ObjectSpec>& objects = setup.scene.objects;
  ObjectSpec again = objects[arm ? 4 : 0];  // the object that is pressed
  again.name += "_again";
  objects.push_back(again);
  CaseResult found{fmt::format("{}.toml, its object there twice", arm ? "keypad" : "tennis_ball"),
                   "one of them, the same each time: no change in 100 cycles",
                   {}};
  std::uint64_t hash = 0;
  double most = 0.0;
  for (int i = 0; i < 2; ++i) {
    std::int64_t last = -1000, switches = 0;
    std::int32_t before = -1;
    const auto twin = [&](std::int32_t index) { return arm ? index == 4 || index == 12 : true; };
    const bool other = i == 1 && context.mutated("other_seed");
    trial::TrialOptions options{.seed = context.seed + (other ? 1 : 0)};
    const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
      const bool any = context.mutated("any_change");
      if (g.out.object != before && (any || (before >= 0 && twin(before) && twin(g.out.object)))) {
        switches += any || g.tick.index - last < 100 ? 1 : 0;
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

void add_walls(Cases& cases) {
  const std::vector<double> soft{1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6}, stiff{1e3, 1e4, 1e5, 1e6};
  for (const double stiffness : soft)
    cases.push_back({name_of("arm", stiffness),
                     [=](const BenchContext& context) { return arm_wall(context, stiffness); }});
  for (const double stiffness : stiff)
    cases.push_back({name_of("hexapod", stiffness),
                     [=](const BenchContext& context) { return machine_wall(context, stiffness); }});
}

void add_wall_plot(Bench& bench, const Cases& cases, const std::vector<CaseResult>& found) {
  Series told{.name = "commanded", .mark = Mark::both},
      touch{.name = "true, on the finger", .mark = Mark::both};
  Series limit{.name = "what the device has"}, push{.name = "what the finger pushes with"};
  Series lost{.name = "does not hold the finger still", .mark = Mark::crosses};
  const std::string wall = "arm.wall.";
  const double most = load_scene(bench.context, "wall").rig.arm.peak;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].id.starts_with(wall)) continue;
    const double stiffness = std::stod(cases[i].id.substr(wall.size()));
    for (const Number& n : found[i].numbers) {
      if (n.what == "force.max") {
        told.add(stiffness, n.value);
        limit.add(stiffness, most);
        push.add(stiffness, kPush);
      }
      if (n.what == "touch.max") touch.add(stiffness, n.value);
      if (n.what == "swing.max" && n.value > n.wanted) lost.add(stiffness, kUnset);
    }
  }
  bench.plot({.id = "walls",
              .title = "A finger presses a wall with 4 N",
              .x_label = "stiffness of the wall (N/m)",
              .y_label = "largest force (N)",
              .log_x = true,
              .series = {told, touch, limit, push, lost},
              .caption = "However stiff a wall is, no more is commanded than the device has. From 10^4 N/m "
                         "on the law rings, which is said before the run: the tip swings by centimetres."});
}

void add_touches(Cases& cases) {
  cases.push_back({"arm.deep", deep_finger});
  cases.push_back({"hexapod.deep", deep_tip});
  cases.push_back({"hexapod.training", training});
  for (const bool arm : {true, false})
    for (const double speed : {1.0, 5.0})
      cases.push_back({fmt::format("{}.impact.{:g}", arm ? "arm" : "hexapod", speed),
                       [=](const BenchContext& context) { return impact(context, arm, speed); }});
}

void add_places(Cases& cases) {
  for (const bool arm : {true, false}) {
    const std::string machine = arm ? "arm" : "hexapod";
    cases.push_back({machine + ".leaves", [=](const BenchContext& context) { return leaves(context, arm); }});
    cases.push_back(
        {machine + ".trembles", [=](const BenchContext& context) { return trembles(context, arm); }});
    cases.push_back(
        {machine + ".coincident", [=](const BenchContext& context) { return coincident(context, arm); }});
  }
  cases.push_back({"hexapod.saturated", saturated});
  cases.push_back({"hexapod.overloaded", overloaded});
}

}  // namespace enc::bench::extremes
