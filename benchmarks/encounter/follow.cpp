#include "benchmarks/encounter/follow.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/units.h"
#include "trial/trial.h"

namespace enc::bench::encounter {
namespace {

constexpr std::array kToolSpeeds{0.010, 0.020, 0.040, 0.050, 0.060, 0.080, 0.100};  // m/s
constexpr double kFastest = 50.0;                                                   // mm/s [VHMR 2]
constexpr double kAcceleration = 0.41;  // m/s^2 [sources/hexapod 4]

// A tool 60 mm above a wall, seen to move 80 mm along it, or for 2 s, at one speed.
struct Slide {
  double speed;                         // m/s
  static constexpr double kFrom = 1.5;  // s: by then the tip waits at the start
  [[nodiscard]] double half() const { return std::min(0.040, speed); }      // m
  [[nodiscard]] double to() const { return kFrom + 2.0 * half() / speed; }  // s
  [[nodiscard]] double at(double t) const {                                 // m
    return std::clamp(speed * (t - kFrom), 0.0, 2.0 * half()) - half();
  }
};

struct FollowRun {
  double lag = 0.0, top = 0.0;  // m, at the end of the way; m/s, of the tip
  double way = 0.0;             // m, of the tip
  double simulated = 0.0;       // s
};

FollowRun follow(const BenchContext& context, double speed, double above = 60.0, double pause = 100.0) {
  const models::Setup setup = load_scene(
      context, "plane",
      {"user.approach_mm_s=[1]", fmt::format("user.approach_from_mm={:g}", above), "user.approach_tilt_deg=0",
       fmt::format("follow.pause_mm={:g}", pause), fmt::format("follow.resume_mm={:g}", 0.9 * pause)});
  const Vec3 along(pose_of<'W', 'C'>(setup.twin.frames.W_C).inverse().q() * Vec3::UnitX());
  const Slide slide{speed};
  FollowRun found;
  trial::TrialOptions options{.seed = context.seed, .seconds = slide.to()};
  Time stamp{};
  options.disturb = [&](Inputs& in) {
    if (in.tool.t == stamp) return;  // a sample stays until the next one
    stamp = in.tool.t;
    const Vec3 moved = slide.at(seconds(stamp.time_since_epoch())) * along;
    for (std::size_t i = 0; i < 3; ++i) in.tool.value.X_CT.xyz[i] += moved(static_cast<Eigen::Index>(i));
  };
  const double faster = context.mutated("tip_twice_as_fast") ? 2.0 : 1.0;
  options.watch = [&](const trial::Glance& g) {
    const double t = seconds(g.tick.t.time_since_epoch());
    if (t > Slide::kFrom) found.top = std::max(found.top, faster * std::abs(g.truth.tip_velocity.xyz[0]));
    found.way += g.scene.dt * std::abs(g.truth.tip_velocity.xyz[0]);
    found.lag = g.truth.tool_tip.xyz[0] + slide.at(t) - g.truth.tip.xyz[0];
  };
  found.simulated = trial::Trial(setup, options).run().simulated;
  return found;
}

// A tool that moves 150 mm above the wall, with the pause beyond 100 mm and without it.
void add_pause(Bench& bench) {
  const auto ways = bench.each(std::vector<int>{1, 0}, [&](int pauses) {
    const bool never = pauses == 0 || bench.context.mutated("never_pauses");
    return follow(bench.context, 0.040, 150.0, never ? 2000.0 : 100.0);
  });
  bench.figure(
      "follow.pause_saves.percent", 100.0 * (1.0 - ways[0].way / ways[1].way), "%", between(95.0, 100.0),
      fmt::format("of the tip's way, {:.0f} mm behind a tool that moves 150 mm above the wall, by the "
                  "pause beyond 100 mm",
                  ways[1].way * kMmPerM));
}

}  // namespace

void add_follow(Bench& bench) {
  const std::vector<double> speeds(kToolSpeeds.begin(), kToolSpeeds.end());
  const auto runs = bench.each(speeds, [&](double speed) { return follow(bench.context, speed); });
  Series lag{.name = "tip behind the tool", .mark = Mark::both};
  Series limit{.name = "the machine's fastest", .x = {kFastest, kFastest}, .y = {0.0, 40.0}, .paper = true};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const double speed = 1e3 * speeds[i];
    lag.add(speed, runs[i].lag * kMmPerM);
    // The machine could brake for a tool that stops: that alone is half of v^2/a, the rest is dead time.
    const double brakes = speed * speed / (1e3 * kAcceleration);  // mm
    if (speed < kFastest)
      bench.figure(fmt::format("follow.behind.{:.0f}", speed), runs[i].lag * kMmPerM, "mm",
                   between(0.5 * brakes, brakes + 0.025 * speed),
                   "the tip behind a tool that moves along a wall at that speed; v^2/a and 25 ms at most");
    if (speed > kFastest)
      bench.figure(fmt::format("follow.top_speed.{:.0f}", speed), 1e3 * runs[i].top, "mm/s",
                   calibrated(kFastest), between(49.0, 51.0), "of the tip behind a tool that is faster");
  }
  bench.plot({.id = "follow",
              .title = "How far the haptic-tip is behind a tool that moves along a wall",
              .x_label = "tool speed (mm/s)",
              .y_label = "behind at the end of 80 mm (mm)",
              .series = {lag, limit},
              .caption = "Up to 50 mm/s it is behind by what it needs to brake, and its dead time. A faster "
                         "tool leaves it."});
  add_pause(bench);
}

}  // namespace enc::bench::encounter
