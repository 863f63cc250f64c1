// What begins deep inside, or arrives as fast as no hand does.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "core/base/units.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::extremes {
namespace {

constexpr double kDeep = 20e-3, kTop = 25e-3;  // m: of the finger; of the wall over the waiting prop

// Vision sees the finger for the first time when it is 20 mm inside of the wall.
Found deep_finger(const BenchContext& context) {
  const models::Setup setup =
      load_scene(context, "wall",
                 {"object.wall.position_mm=[0,0,25]", "user.push_N=2", "user.press_s=0.5", "user.hold_s=2",
                  "user.release_s=0.5", "user.rest_s=1", "user.approach_mm_s=[100]"});
  Found found{"wall.toml, finger first seen 20 mm inside", "pushed out at <= 50 mm/s, within the force", {}};
  bool seen = false;
  double fastest = 0.0, deepest = 0.0;
  trial::TrialOptions options;
  options.seed = context.seed;
  options.disturb = [&](Inputs& in) {
    if (!seen) in.tool.health = Health::absent;
  };
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    const double depth = kTop - g.truth.tool_tip.xyz[2] + g.truth.tool_radius;
    seen = seen || depth > kDeep;
    deepest = std::max(deepest, depth);
    if (seen && g.truth.phase != sim::Phase::release)
      fastest = std::max(fastest, g.truth.tool_velocity.xyz[2]);
  });
  found.numbers = {
      {"exit_speed.max", fastest * kMmPerM, "mm/s", {}, "of the finger, outwards", 50.0},
      {"over.max", static_cast<double>(run.judge.over), "", at_most(1.0), "cycles in a row"},
      {"force.max", run.judge.force, "N", at_most(setup.rig.arm.peak * (1.0 + 1e-9)), "commanded"},
      {"depth.max", deepest * kMmPerM, "mm", {}, "of the finger"}};
  found.words = "the law is a spring wherever the finger is first seen, and gives what nobody has put in";
  add_soundness(run, found);
  return found;
}

// The machine's tip is 20 mm inside of the ball when the loop begins.
Found deep_tip(const BenchContext& context) {
  const models::Setup setup = load_scene(context, "tennis_ball",
                                         {"object.ball.position_mm=[0,0,-13]", "user.approach_mm_s=[20]",
                                          "user.press_s=1", "user.release_s=1", "user.approach_from_mm=50"});
  Found found{
      "tennis_ball.toml, tip starts 20 mm inside", "out at <= 50 mm/s, never deeper, not outside", {}};
  double least = kInfinite, back = 0.0, outside = -kInfinite, first = kUnset;
  trial::TrialOptions options;
  options.seed = context.seed;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    const Object& ball = g.scene.objects.front();
    const double depth = -ball.surface.nearest(ball.X_WO.inverse() * g.truth.tip).distance;
    if (std::isnan(first)) first = depth;
    if (g.out.contacts == 0) {
      back = std::max(back, depth - least);
      least = std::min(least, depth);
    }
    outside = std::max(outside, g.truth.tip_radius - depth);
  });
  constexpr double kStep = 3e-6;  // m: what the machine's own step may take it back
  found.numbers = {
      {"start.value", first * kMmPerM, "mm", between(19.9, 20.1), "depth of the tip's centre"},
      {"back.max", back * 1e6, "um", at_most(2e6 * kStep), "deeper than it has been before"},
      {"outside.max", outside * 1e6, "um", at_most(0.0), "of the tip outside the ball"},
      {"speed.max", run.judge.fastest * kMmPerM, "mm/s", at_most(50.0 * (1.0 + 1e-9)), "commanded"}};
  add_soundness(run, found);
  return found;
}

struct Hit {
  double deepest = -kInfinite;  // m: tool into tip
  double through = 0.0;  // times that the tool's centre went through the middle of the tip, or the front
  bool over = false;
  double arrives = 0.0;  // m/s, of the tool before it touches
};

// Along z, which is the normal in both scenes. Who passes beside it goes through nothing.
void see_hit(const trial::Glance& g, bool arm, Hit& hit) {
  const Vec3 apart = (g.truth.tool_tip - g.truth.tip).e();
  const double aside = std::hypot(apart.x(), apart.y()), radii = g.truth.tool_radius + g.truth.tip_radius;
  constexpr double kPlate = 15e-3;  // m: half of the plate, whose front faces up
  const bool over = aside < (arm ? kPlate : radii) && apart.z() >= 0.0;
  const bool under = aside < (arm ? kPlate : radii) && apart.z() < 0.0;
  if (over) hit.deepest = std::max(hit.deepest, arm ? g.truth.tool_radius - apart.z() : radii - apart.norm());
  hit.through += hit.over && under ? 1.0 : 0.0;
  hit.over = over;
}

// The hand needs its way to be that fast: it has 50 N.
Found impact(const BenchContext& context, bool arm, double speed) {
  const models::Setup setup = load_scene(context, arm ? "wall" : "tennis_ball",
                                         {fmt::format("user.approach_mm_s=[{:g}]", speed * kMmPerM),
                                          fmt::format("user.approach_from_mm={:g}", 300.0 * speed),
                                          "user.approach_tilt_deg=0", "user.press_s=1", "user.release_s=1"});
  Found found{fmt::format("{}.toml, touched at {:g} m/s", arm ? "wall" : "tennis_ball", speed),
              "stopped, not gone through; at 1 m/s at most 1.5 mm into each other",
              {}};
  trial::TrialOptions options;
  options.seed = context.seed;
  Hit hit;
  double before = 0.0;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    see_hit(g, arm, hit);
    if (g.truth.touching && hit.arrives == 0.0) hit.arrives = before;
    before = g.truth.tool_velocity.norm();
  });
  found.numbers = {
      {"through.value", hit.through, "", exactly(0.0), "times that the tool went through what it touched"},
      {"into.max", hit.deepest * kMmPerM, "mm", {}, "tool into tip", speed < 2.0 ? 1.5 : kUnset},
      {"arrives.value", hit.arrives, "m/s", at_least(0.85 * speed), "of the tool, before the first touch"},
      {"touch.max", run.judge.touch, "N", {}, "true force"}};
  if (arm)
    found.numbers.push_back({"over.max", static_cast<double>(run.judge.over), "", at_most(1.0), "cycles"});
  if (!arm && speed < 2.0)
    found.words =
        "the stop between tool and tip has 5 ms, so that a tip that goes in steps is not felt to rattle";
  add_soundness(run, found);
  return found;
}

// Hard objects beside a soft one, with two tools [VHMR 5: training].
Found training(const BenchContext& context) {
  const models::Setup setup =
      load_scene(context, "training", {fmt::format("user.session.duration_s={}", context.quick ? 20 : 60)});
  Found found{"training.toml, 50 to 200 N/mm beside 0.5",
              "each press one contact; never outside; no deeper than the limit and two steps of the machine",
              {}};
  trial::PressMeasure presses(setup);
  double limit = kUnset;
  trial::TrialOptions options;
  options.seed = context.seed;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    presses.see(g);
    limit = g.scene.objects.front().limit;
  });
  double torn = 0.0, deepest = 0.0, felt = 0.0;
  for (const trial::PressFigures& press : presses.presses()) {
    if (std::isnan(press.miss)) continue;
    ++felt;
    torn += press.contacts == 1 ? 0.0 : 1.0;
    deepest = std::max(deepest, press.peak_deflection);
  }
  constexpr double kStep = 3e-6;  // m, of the machine
  found.numbers = {{"presses.value", felt, "", at_least(3.0), "that touched"},
                   {"torn.value", torn, "", exactly(0.0), "of them, with none or several contacts"},
                   {"deeper.max", (deepest - limit) * 1e6, "um", at_most(2e6 * kStep),
                    "than the limit of the tooth, true"},
                   {"outside.max", presses.greatest_outside() * 1e6, "um", at_most(0.0),
                    "of the tip outside of an object"},
                   {"touch.max", run.judge.touch, "N", {}, "true force"}};
  add_soundness(run, found);
  return found;
}

}  // namespace

void add_touches(Cases& cases, bool quick) {
  cases.push_back({"arm.deep", deep_finger});
  cases.push_back({"hexapod.deep", deep_tip});
  cases.push_back({"hexapod.training", training});
  for (const bool arm : {true, false})
    for (const double speed : quick ? std::vector<double>{1.0} : std::vector<double>{1.0, 5.0})
      cases.push_back({fmt::format("{}.impact.{:g}", arm ? "arm" : "hexapod", speed),
                       [=](const BenchContext& context) { return impact(context, arm, speed); }});
}

}  // namespace enc::bench::extremes
