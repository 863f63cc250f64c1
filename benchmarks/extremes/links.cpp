// Drop-outs of the tracker, packets that are lost, overtake and come twice, and a clock that stalls.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/extremes/faults.h"
#include "core/base/units.h"

namespace enc::bench::extremes {
namespace {

constexpr double kSpeed = 40.0;  // mm/s, of the tool

// m: where the tool is believed to be, against where it is.
double belief_error(const trial::Glance& g) {
  return g.out.view.tip.finite() ? (g.out.view.tip - g.truth.tool_tip).norm() : 0.0;
}

models::Setup approach(const BenchContext& context, bool arm, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{fmt::format("user.approach_mm_s=[{:g}]", kSpeed), "user.approach_from_mm=80",
                               "user.press_s=1", "user.release_s=1", "user.hold_s=0.5"};
  set.insert(set.end(), more.begin(), more.end());
  return load_scene(context, arm ? "wall" : "tennis_ball", set);
}

// While the tool comes: it is seen for the last time at 1.5 s.
Found dropout(const BenchContext& context, bool arm, double length) {
  constexpr double kAt = 1.5, kExtrapolated = 0.1, kStops = 0.2;  // s
  const models::Setup setup = approach(context, arm,
                                       {fmt::format("truth.tracker.blackout_at_s={:g}", kAt),
                                        fmt::format("truth.tracker.blackout_for_s={:g}", length)});
  Found found{
      fmt::format("{}.toml, tool unseen for {:g} ms at 40 mm/s", arm ? "wall" : "tennis_ball", 1e3 * length),
      "within 1.5 mm for 100 ms, then at rest within 200 ms; back at once",
      {}};
  const double lost = setup.rig.tracker.lost_age;
  const double again =
      kAt + length + 1.0 / setup.twin.tracker.rate + 0.06;  // a frame, and its way: 55 ms of the arm's
  double error = 0.0, speed = 0.0, held_after = 0.0;
  Vec3 before = Vec3::Zero();
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = 4.0;
  const Run run = judged(setup, options, [&](const trial::Glance& g) {
    const double t = time_of(g);
    const Vec3 command = arm ? Vec3(g.out.wanted.e()) : Vec3(g.out.tip.p());
    if (t >= kAt && t <= kAt + std::min(length, kExtrapolated)) error = std::max(error, belief_error(g));
    if (t > kAt + lost + kStops && t < kAt + length)
      speed = std::max(speed, (command - before).norm() / g.scene.dt);
    held_after += t > again && g.out.mode == Mode::hold ? 1.0 : 0.0;
    before = command;
  });
  found.numbers = {{"error.max", error * kMmPerM, "mm", at_most(1.5), "of the believed place, 100 ms long"},
                   {"late.value", held_after, "", exactly(0.0), "ticks of hold once it is seen again"}};
  if (length > lost + kStops)
    found.numbers.push_back(
        {"speed.max", speed * kMmPerM, "mm/s", at_most(1e-3), "commanded, 200 ms after it is lost"});
  add_soundness(run, found);
  return found;
}

struct Link {
  double rms = kUnset;  // m, of the believed place, along the worst axis
  std::uint64_t hash = 0;
  Run run;
};
// A way of 16 mm: the hand goes back at 40 mm/s, too.
Link link_of(const BenchContext& context, const Network::Faults& faults) {
  Link link;
  Network network(faults, context.seed);
  Vec3 sum = Vec3::Zero();
  std::int64_t number = 0;
  Time now{};
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = 6.0;
  options.fit_out = keep_clean;
  options.disturb = [&](Inputs& in) {
    network(now, in);
    now += Duration(1'000'000);
  };
  link.run = judged(approach(context, false, {"truth.tracker.bias_mm=[0,0,0]", "user.approach_from_mm=16"}),
                    options, [&](const trial::Glance& g) {
                      if (time_of(g) < 1.0 || !g.out.view.tip.finite()) return;
                      const Vec3 error = (g.out.view.tip - g.truth.tool_tip).e();
                      sum += error.cwiseAbs2();
                      ++number;
                    });
  link.rms = std::sqrt(sum.maxCoeff() / static_cast<double>(number));
  link.hash = link.run.result.hash;
  return link;
}

Found network(const BenchContext& context, const char* what, const Network::Faults& faults) {
  const Link clean = link_of(context, {}), bad = link_of(context, faults);
  const bool twice = faults.twice > 0.0;
  Found found{fmt::format("tennis_ball.toml, {}", what),
              twice ? "the same bits as without" : "rms of the believed place at most 0.13 mm",
              {}};
  found.numbers = {
      {"rms.value", bad.rms * kMmPerM, "mm", at_most(0.13),
       "of the believed place along its worst axis, registered without error"},
      {"clean_rms.value", clean.rms * kMmPerM, "mm", {}, "the same, nothing lost"},
      {"held.value", static_cast<double>(bad.run.judge.held), "", exactly(0.0), "ticks of hold"}};
  if (twice)
    found.numbers.push_back(
        {"other.value", clean.hash == bad.hash ? 0.0 : 1.0, "", exactly(0.0), "1: another hash"});
  add_soundness(bad.run, found);
  found.simulated += clean.run.result.simulated;
  return found;
}

// Ticks that pass without the loop, every 0.7 s: the world goes on.
class Stalling final : public Clock {
 public:
  Stalling(std::unique_ptr<Clock> clock, std::int64_t cycles) : clock_(std::move(clock)), cycles_(cycles) {}
  Tick next() override {
    constexpr std::int64_t kBetween = 700;
    missed_ = ++calls_ % kBetween == 0 ? cycles_ : 0;
    for (std::int64_t i = 0; i < missed_; ++i) clock_->next();
    return clock_->next();
  }
  [[nodiscard]] std::int64_t missed() const noexcept override { return missed_; }

 private:
  std::unique_ptr<Clock> clock_;
  std::int64_t cycles_, calls_ = 0, missed_ = 0;
};

Found stall(const BenchContext& context, bool arm, std::int64_t cycles) {
  Found found{fmt::format("{}.toml, {} cycles missed, again and again", arm ? "wall" : "tennis_ball", cycles),
              "a hold on each, none a tick later, no wind-up",
              {}};
  std::int64_t stalls = 0, held = 0, late = 0;
  bool before = false;
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = 8.0;
  options.fit_out = [&](Rig& rig) { rig.clock = std::make_unique<Stalling>(std::move(rig.clock), cycles); };
  const Run run = judged(approach(context, arm), options, [&](const trial::Glance& g) {
    const bool now = g.in.missed > 0, holds = g.out.mode == Mode::hold;
    stalls += now ? 1 : 0;
    held += now && holds && (g.out.why & kClockLate) != 0 ? 1 : 0;
    late += before && !now && holds ? 1 : 0;
    before = now;
  });
  found.numbers = {{"held.percent", 100.0 * static_cast<double>(held) / static_cast<double>(stalls), "%",
                    exactly(100.0), "of the stalls, at once"},
                   {"late.value", static_cast<double>(late), "", exactly(0.0), "holds on the tick after"},
                   {"stalls.value", static_cast<double>(stalls), "", at_least(5.0)}};
  add_soundness(run, found);
  return found;
}

}  // namespace

void add_links(Cases& cases, bool quick) {
  for (const bool arm : {true, false}) {
    const std::string machine = arm ? "arm" : "hexapod";
    for (const double length :
         quick ? std::vector<double>{0.1, 0.5} : std::vector<double>{0.05, 0.1, 0.2, 0.5})
      cases.push_back({fmt::format("{}.dropout.{:.0f}", machine, 1e3 * length),
                       [=](const BenchContext& context) { return dropout(context, arm, length); }});
    for (const std::int64_t cycles :
         quick ? std::vector<std::int64_t>{5} : std::vector<std::int64_t>{5, 50, 500})
      cases.push_back({fmt::format("{}.stall.{}", machine, cycles),
                       [=](const BenchContext& context) { return stall(context, arm, cycles); }});
  }
  const auto add = [&](const char* id, const char* what, const Network::Faults& faults) {
    cases.push_back({id, [=](const BenchContext& context) { return network(context, what, faults); }});
  };
  add("hexapod.lost", "20 % of the packets lost", {.loss = 0.2});
  add("hexapod.reordered", "30 % of the packets up to 30 ms late", {.late = 0.3});
  add("hexapod.twice", "each second packet comes twice", {.twice = 0.5});
}

}  // namespace enc::bench::extremes
