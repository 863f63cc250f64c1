// The fault injectors, and the cases of inputs and links that use them.
#include "benchmarks/extremes/faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "core/base/units.h"

namespace enc::bench::extremes {
namespace {

// Repeats at each poll the last sample of the device, whatever happened to it.
template <class Role, class Sample>
class CleanDevice : public Role {
 public:
  explicit CleanDevice(std::unique_ptr<Role> device) : device_(std::move(device)) {}
  bool poll(Time now, Measurement<Sample>& newest) noexcept override {
    device_->poll(now, newest_);
    newest = newest_;
    return true;
  }

 protected:
  std::unique_ptr<Role> device_;

 private:
  Measurement<Sample> newest_;
};
using CleanTracker = CleanDevice<PoseTracker, TrackedTool>;
class CleanDisplay final : public CleanDevice<Display, DentSample> {
 public:
  using CleanDevice::CleanDevice;
  void show(const View& view) noexcept override { device_->show(view); }
};

// Invalid values in one number of the devices' samples, each number and each kind once.

constexpr std::int64_t kEvery = 30;  // ticks between two

// Checks that each invalid number was followed by a tick that is not held.
class Recovery {
 public:
  explicit Recovery(bool a_tick_late) : a_tick_late_(a_tick_late) {}
  void see(const trial::Glance& g, bool spoiled) {
    const bool held = a_tick_late_ ? was_held_ : g.out.mode == Mode::hold;
    was_held_ = g.out.mode == Mode::hold;
    caught_ += spoiled && held ? 1 : 0;
    spoiled_ += spoiled ? 1 : 0;
    late_ += was_spoiled_ && !spoiled && held ? 1 : 0;
    was_spoiled_ = spoiled;
  }
  [[nodiscard]] double late() const { return static_cast<double>(late_); }
  [[nodiscard]] double caught() const { return static_cast<double>(caught_); }
  [[nodiscard]] double spoiled() const { return static_cast<double>(spoiled_); }

 private:
  std::int64_t late_ = 0, caught_ = 0, spoiled_ = 0;
  bool a_tick_late_, was_spoiled_ = false, was_held_ = false;
};

CaseResult spoiled(const BenchContext& context, bool arm, bool full) {
  const models::Setup setup =
      load_scene(context, arm ? "wall" : "tennis_ball",
                 {"user.press_s=2", "user.hold_s=4", "user.depth_mm=4", "user.approach_mm_s=[50]",
                  "user.approach_from_mm=40", "user.repeats=9"});
  CaseResult found{fmt::format("{}.toml, NaN, Inf, -Inf, 1e12 in each input", arm ? "wall" : "tennis_ball"),
                   "command as the judge wants it; no hold on the next good tick",
                   {}};
  Inputs none;
  InputSpoiler count;
  fields(count, none);
  constexpr std::int64_t kFrom = 1500;  // ticks: it follows, or is in contact
  const std::int64_t number = 4 * count.seen / (full ? 1 : 4);
  Recovery recovery(context.mutated("a_tick_late"));
  bool now = false;
  std::int64_t tick = 0, done = 0, next = kFrom;
  Time packet{};
  trial::TrialOptions options{.seed = context.seed,
                              .seconds = 1e-3 * static_cast<double>(kFrom + 2 * kEvery * (number + 2)),
                              .fit_out = keep_clean};
  // Spoils only a new packet of the tool: a repeated packet has no effect, and neither would its junk.
  options.disturb = [&](Inputs& in) {
    const bool fresh = in.tool.t > packet;
    packet = in.tool.t;
    now = tick++ >= next && fresh && done < number;
    if (!now) return;
    next = tick + kEvery;
    InputSpoiler one{static_cast<int>(full ? done / 4 : done), static_cast<Junk>(done % 4)};
    fields(one, in);
    ++done;
  };
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) { recovery.see(g, now); });
  found.numbers = {
      {"late.value", recovery.late(), "", exactly(0.0), "holds on the tick after, all good again"},
      {"spoiled.value", recovery.spoiled(), "", {}, "inputs"},
      {"held.value", recovery.caught(), "", at_least(10.0), "of them with a hold at once"}};
  add_soundness(run, found);
  return found;
}

// Drop-outs of the tracker; packets that are lost, overtake or come twice; and a clock that stalls.

constexpr double kSpeed = 40.0;  // mm/s, of the tool

// m: distance of the estimated from the true place of the tool.
double belief_error(const trial::Glance& g) {
  return g.out.view.tip.finite() ? (g.out.view.tip - g.truth.tool_tip).norm() : 0.0;
}

models::Setup approach(const BenchContext& context, bool arm, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{fmt::format("user.approach_mm_s=[{:g}]", kSpeed), "user.approach_from_mm=80",
                               "user.press_s=1", "user.release_s=1", "user.hold_s=0.5"};
  set.insert(set.end(), more.begin(), more.end());
  return load_scene(context, arm ? "wall" : "tennis_ball", set);
}

// The tool is approaching: it is seen for the last time at 1.5 s.
CaseResult dropout(const BenchContext& context, bool arm, double length) {
  constexpr double kAt = 1.5, kExtrapolated = 0.1, kStops = 0.2;                      // s
  const double unseen = length + (context.mutated("unseen_for_longer") ? 0.5 : 0.0);  // s
  const double stops = context.mutated("too_early") ? 0.0 : kStops;
  const models::Setup setup = approach(context, arm,
                                       {fmt::format("truth.tracker.blackout_at_s={:g}", kAt),
                                        fmt::format("truth.tracker.blackout_for_s={:g}", unseen)});
  CaseResult found{
      fmt::format("{}.toml, tool unseen for {:g} ms at 40 mm/s", arm ? "wall" : "tennis_ball", 1e3 * length),
      arm ? "within 1.5 mm for 100 ms, then at rest within 200 ms; back at once"
          : "within 0.4 mm for 100 ms, then at rest within 200 ms; back at once",
      {}};
  const double lost = setup.rig.tracker.lost_age;
  const double again =
      kAt + length + 1.0 / setup.twin.tracker.rate + 0.06;  // a frame, and its latency: 55 ms of the arm's
  double error = 0.0, speed = 0.0, held_after = 0.0;
  Vec3 before = Vec3::Zero();
  trial::TrialOptions options{.seed = context.seed, .seconds = 4.0};
  const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
    const double t = time_of(g);
    const Vec3 command = arm ? Vec3(g.out.arm.target.e()) : Vec3(g.out.manipulator.tip.p());
    if (t >= kAt && t <= kAt + std::min(length, kExtrapolated)) error = std::max(error, belief_error(g));
    if (t > kAt + lost + stops && t < kAt + length)
      speed = std::max(speed, (command - before).norm() / g.scene.dt);
    held_after += t > again && g.out.mode == Mode::hold ? 1.0 : 0.0;
    before = command;
  });
  found.numbers = {
      {"error.max", error * kMmPerM, "mm", at_most(arm ? 1.5 : 0.4), "of the believed place, 100 ms long"},
      {"late.value", held_after, "", exactly(0.0), "ticks of hold once it is seen again"}};
  if (length > lost + kStops)
    found.numbers.push_back({"speed.max", speed * kMmPerM, "mm/s", {}, "commanded, 200 ms after it is lost"});
  add_soundness(run, found);
  return found;
}

struct Link {
  double rms = kUnset;  // m, of the estimated place, along the worst axis
  std::uint64_t hash = 0;
  Run run;
};
// A path of 16 mm, because the hand returns at 40 mm/s, too.
Link link_of(const BenchContext& context, const Network::Faults& faults, std::vector<std::string> more = {}) {
  Link link;
  Network network(faults, context.seed);
  Vec3 sum = Vec3::Zero();
  std::int64_t number = 0;
  Time now{};
  trial::TrialOptions options{.seed = context.seed, .seconds = 6.0, .fit_out = keep_clean};
  options.disturb = [&](Inputs& in) {
    network(now, in);
    now += Duration(1'000'000);
  };
  more.insert(more.end(), {"truth.tracker.bias_mm=[0,0,0]", "user.approach_from_mm=16"});
  link.run = judged(context, approach(context, false, more), options, [&](const trial::Glance& g) {
    if (time_of(g) < 1.0 || !g.out.view.tip.finite()) return;
    const Vec3 error = (g.out.view.tip - g.truth.tool_tip).e();
    sum += error.cwiseAbs2();
    ++number;
  });
  link.rms = std::sqrt(sum.maxCoeff() / static_cast<double>(number));
  link.hash = link.run.result.hash;
  return link;
}

CaseResult network(const BenchContext& context, const char* what, const Network::Faults& faults) {
  std::vector<std::string> unseen;
  if (context.mutated("unseen_for_longer"))
    unseen = {"truth.tracker.blackout_at_s=2", "truth.tracker.blackout_for_s=0.5"};
  const Link clean = link_of(context, {}), bad = link_of(context, faults, unseen);
  const bool twice = faults.twice > 0.0;
  CaseResult found{fmt::format("tennis_ball.toml, {}", what),
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

// Ticks that pass without the loop, every 0.7 s: the simulated world continues.
class StallClock final : public Clock {
 public:
  StallClock(std::unique_ptr<Clock> clock, std::int64_t cycles) : clock_(std::move(clock)), cycles_(cycles) {}
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

CaseResult stall(const BenchContext& context, bool arm, std::int64_t cycles) {
  CaseResult found{
      fmt::format("{}.toml, {} cycles missed, again and again", arm ? "wall" : "tennis_ball", cycles),
      "a hold on each, none a tick later, no wind-up",
      {}};
  std::int64_t stalls = 0, held = 0, late = 0;
  bool before = false, held_before = false;
  trial::TrialOptions options{.seed = context.seed, .seconds = 8.0};
  options.fit_out = [&](Rig& rig) { rig.clock = std::make_unique<StallClock>(std::move(rig.clock), cycles); };
  const Run run = judged(context, approach(context, arm), options, [&](const trial::Glance& g) {
    const bool now = g.in.missed > 0;
    const bool holds = context.mutated("a_tick_late") ? held_before : g.out.mode == Mode::hold;
    held_before = g.out.mode == Mode::hold;
    stalls += now ? 1 : 0;
    held += now && holds && (g.out.why & kClockLate) != 0 ? 1 : 0;
    late += before && !now && holds ? 1 : 0;
    before = now;
  });
  found.numbers = {{"held.percent", 100.0 * static_cast<double>(held) / static_cast<double>(stalls), "%",
                    exactly(100.0), "of the stalls, at once"},
                   {"late.value", static_cast<double>(late), "", exactly(0.0), "holds on the tick after"},
                   {"stalls.value", static_cast<double>(stalls), ""}};
  add_soundness(run, found);
  return found;
}

}  // namespace

const char* name_of(Junk junk) {
  return std::array{"NaN", "Inf", "-Inf", "1e12"}[static_cast<std::size_t>(junk)];
}

void keep_clean(Rig& rig) {
  if (rig.tracker) rig.tracker = std::make_unique<CleanTracker>(std::move(rig.tracker));
  if (rig.display) rig.display = std::make_unique<CleanDisplay>(std::move(rig.display));
}

void Network::operator()(Time now, Inputs& in) {
  if (in.tool.health != Health::absent && in.tool.t > newest_) {
    newest_ = in.tool.t;
    if (share() >= faults_.loss) {
      const auto delay = [&] {
        return share() < faults_.late ? from_seconds(faults_.least + (faults_.most - faults_.least) * share())
                                      : Duration(0);
      };
      under_way_.push_back({now + delay(), in.tool});
      if (share() < faults_.twice) under_way_.push_back({now + from_seconds(0.005), in.tool});
    }
  }
  for (std::size_t i = 0; i < under_way_.size();) {
    if (under_way_[i].due > now) {
      ++i;
      continue;
    }
    shown_ = under_way_[i].sample;
    under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  in.tool = shown_;
}

// Draws the fault and its number of ticks.
void Storm::begin() {
  constexpr int kKinds = 10;
  kind_ = static_cast<int>(random_() % kKinds);
  Inputs none;
  InputSpoiler count;
  fields(count, none);
  field_ = static_cast<int>(random_() % static_cast<std::uint64_t>(count.seen));
  junk_ = static_cast<Junk>(random_() % 4);
  const double longest = kind_ == 1 ? 0.5 : kind_ == 3 ? 0.1 : kind_ == 4 ? 0.001 : 0.02;
  left_ = 1 + static_cast<std::int64_t>(1e3 * in(0.0, longest));
  shift_ = Vec3(in(-1, 1), in(-1, 1), in(-1, 1));
  freezes_ = false;
  ++faults_;
}

void Storm::spoil(Inputs& in) {
  InputSpoiler one{field_, junk_};
  switch (kind_) {
    case 1:  // the tool has no news
      if (!std::exchange(freezes_, true)) frozen_ = in.tool;
      in.tool = frozen_;
      return;
    case 2:  // the tracker reports a fault
      in.tool.health = Health::fault;
      return;
    case 3:  // the tool's pose has leapt, and is taken as valid
      in.tool.value.X_CT.xyz[0] += shift_.x();
      in.tool.value.X_CT.xyz[2] += shift_.z();
      return;
    case 4:  // cycles were missed
      in.missed = 1 + static_cast<std::int64_t>(100.0 * std::abs(shift_.x()));
      return;
    case 5:  // the machine sends nothing
      in.tip.health = in.arm.health = Health::absent;
      return;
    case 6:  // force at the sensor's range
      if (in.wrench.health == Health::ok) in.wrench.health = Health::saturated;
      return;
    case 7:  // a spike of force
      if (in.wrench.health == Health::ok) in.wrench.value.force.xyz[2] += 60.0 * shift_.z();
      return;
    case 8:  // old packets
      in.tool.t -= from_seconds(std::abs(shift_.y()));
      return;
    default:  // an invalid value in one number
      fields(one, in);
  }
}

void Storm::operator()(Time now, Inputs& in) {
  const std::int64_t tick = now.time_since_epoch() / Duration(1'000'000);
  if (seconds(now.time_since_epoch()) >= quiet_from_) return;
  if (tick >= next_) {
    begin();
    next_ = tick + static_cast<std::int64_t>(1e3 / rate_);
  }
  if (left_-- > 0) spoil(in);
}

void add_inputs(Cases& cases, bool full) {
  for (const bool arm : {true, false})
    cases.push_back({arm ? "arm.inputs" : "hexapod.inputs",
                     [=](const BenchContext& context) { return spoiled(context, arm, full); }});
}

void add_links(Cases& cases) {
  for (const bool arm : {true, false}) {
    const std::string machine = arm ? "arm" : "hexapod";
    for (const double length : {0.05, 0.1, 0.2, 0.5})
      cases.push_back({fmt::format("{}.dropout.{:.0f}", machine, 1e3 * length),
                       [=](const BenchContext& context) { return dropout(context, arm, length); }});
    for (const std::int64_t cycles : {std::int64_t{5}, std::int64_t{50}, std::int64_t{500}})
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
