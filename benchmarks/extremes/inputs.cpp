// Nonsense in one number of what the devices say, each number and each kind once.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/extremes/faults.h"

namespace enc::bench::extremes {
namespace {

constexpr std::int64_t kEvery = 30;  // ticks between two

// Whether each number was followed by a tick on which nothing is held.
class Recovery {
 public:
  void see(const trial::Glance& g, bool spoiled) {
    const bool held = g.out.mode == Mode::hold;
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
  bool was_spoiled_ = false;
};

Found spoiled(const BenchContext& context, bool arm, bool quick) {
  const models::Setup setup =
      load_scene(context, arm ? "wall" : "tennis_ball",
                 {"user.press_s=2", "user.hold_s=4", "user.depth_mm=4", "user.approach_mm_s=[50]",
                  "user.approach_from_mm=40", "user.repeats=9"});
  Found found{fmt::format("{}.toml, NaN, Inf, -Inf, 1e12 in each input", arm ? "wall" : "tennis_ball"),
              "command as the judge wants it; no hold on the next good tick",
              {}};
  Inputs none;
  Spoil count;
  fields(count, none);
  constexpr std::int64_t kFrom = 1500;  // ticks: it follows, or is in contact
  const std::int64_t number = 4 * count.seen / (quick ? 4 : 1);
  Recovery recovery;
  bool now = false;
  std::int64_t tick = 0, done = 0, next = kFrom;
  Time packet{};
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = 1e-3 * static_cast<double>(kFrom + 2 * kEvery * (number + 2));
  options.fit_out = keep_clean;
  // With a new packet of the tool: a repeated one says nothing, and its junk would not, either.
  options.disturb = [&](Inputs& in) {
    const bool fresh = in.tool.t > packet;
    packet = in.tool.t;
    now = tick++ >= next && fresh && done < number;
    if (!now) return;
    next = tick + kEvery;
    Spoil one{static_cast<int>(quick ? done : done / 4), static_cast<Junk>(done % 4)};
    fields(one, in);
    ++done;
  };
  const Run run = judged(setup, options, [&](const trial::Glance& g) { recovery.see(g, now); });
  found.numbers = {
      {"late.value", recovery.late(), "", exactly(0.0), "holds on the tick after, all good again"},
      {"spoiled.value", recovery.spoiled(), "", at_least(static_cast<double>(number)), "inputs"},
      {"held.value", recovery.caught(), "", at_least(1.0), "of them with a hold at once"}};
  add_soundness(run, found);
  return found;
}

}  // namespace

void add_inputs(Cases& cases, bool quick) {
  for (const bool arm : {true, false})
    cases.push_back({arm ? "arm.inputs" : "hexapod.inputs",
                     [=](const BenchContext& context) { return spoiled(context, arm, quick); }});
}

}  // namespace enc::bench::extremes
