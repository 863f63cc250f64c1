// Whole runs, as `run` and the benchmarks make them: the same to the bit whatever the wall clock does, right
// when the twin's devices are not, and within all limits on every tick.
#include "trial/trial.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/record/fields.h"
#include "models/setup/scene_file.h"
#include "trial/measure/press_measure.h"

namespace enc::bench {
namespace {

using Set = std::vector<std::string>;

models::Setup scene(const std::string& name, const Set& set = {}) {
  return models::load(
      std::string(ENCOUNTER_SOURCE_DIR).append("/models/scenes/").append(name).append(".toml"), "sim", set);
}
// One press of 4 mm, met 0.6 + 0.75 s after the start: 30 mm at 50 mm/s, the first 0.3 s of it speeding up.
Set quick(const Set& more = {}) {
  Set set{"user.approach_mm_s=[50]", "user.approach_from_mm=30", "user.press_s=1.5",
          "user.hold_s=0.2",         "user.release_s=1.5",       "user.depth_mm=4"};
  set.insert(set.end(), more.begin(), more.end());
  return set;
}

trial::TrialResult run(const models::Setup& setup, trial::TrialOptions options = {}) {
  trial::Trial trial(setup, std::move(options));
  return trial.run();
}

// ---- the wall clock is nobody's business
// ---------------------------------------------------------------------

// Sleeps now and then, at random: a loaded machine.
class Stalled : public Clock {
 public:
  Stalled(std::unique_ptr<Clock> clock, int& stalls) : clock_(std::move(clock)), stalls_(stalls) {}
  Tick next() override {
    if (random_() % 40 == 0) {
      ++stalls_;
      std::this_thread::sleep_for(std::chrono::microseconds(random_() % 2000));
    }
    return clock_->next();
  }
  [[nodiscard]] std::int64_t missed() const noexcept override { return clock_->missed(); }

 private:
  std::unique_ptr<Clock> clock_;
  int& stalls_;
  std::mt19937 random_{std::random_device{}()};
};

// 2 s: approach, touch at 1.35 s and the first part of a press.
trial::TrialOptions two_seconds(std::uint64_t seed = 1) {
  trial::TrialOptions options;
  options.seed = seed;
  options.seconds = 2.0;
  return options;
}

TEST(TrialHash, IsTheSameAtAnyPaceAndUnderStalls) {
  const models::Setup setup = scene("tennis_ball", quick());
  const trial::TrialResult free = run(setup, two_seconds());
  EXPECT_EQ(free.ticks, 2001);
  EXPECT_EQ(free.contacts, 1);
  EXPECT_GT(free.mode_time[static_cast<std::size_t>(Mode::contact)], 0.3);
  EXPECT_EQ(run(setup, two_seconds()).hash, free.hash);

  trial::TrialOptions paced = two_seconds();
  paced.pace = 200.0;
  EXPECT_EQ(run(setup, paced).hash, free.hash);
  paced.pace = 20.0;  // slower than the machine could: it does wait
  const trial::TrialResult slow = run(setup, paced);
  EXPECT_EQ(slow.hash, free.hash);
  EXPECT_GT(slow.wall, 0.095);  // 2 s / 20

  int stalls = 0;
  trial::TrialOptions stalled = two_seconds();
  stalled.fit_out = [&](Rig& rig) { rig.clock = std::make_unique<Stalled>(std::move(rig.clock), stalls); };
  const trial::TrialResult result = run(setup, stalled);
  EXPECT_GT(stalls, 10);
  EXPECT_EQ(result.hash, free.hash);
  EXPECT_TRUE(result.holds.empty());  // a lockstep clock is never late
}

TEST(TrialHash, AnotherSeedIsAnotherRun) {
  const models::Setup setup = scene("tennis_ball", quick());
  EXPECT_NE(run(setup, two_seconds(2)).hash, run(setup, two_seconds(1)).hash);
}

TEST(TrialHash, LookingOnChangesNothing) {
  const models::Setup setup = scene("tennis_ball", quick());
  int seen = 0;
  trial::TrialOptions watched = two_seconds();
  watched.watch = [&](const trial::Glance&) { ++seen; };
  watched.progress = [](double) {};
  EXPECT_EQ(run(setup, watched).hash, run(setup, two_seconds()).hash);
  EXPECT_EQ(seen, 2001);
}

// ---- saved and restored
// --------------------------------------------------------------------------------------

// The devices whose samples stay in Inputs between packets, tapped for where that is: Trial gives no way to
// it.
class TappedTracker : public PoseTracker {
 public:
  TappedTracker(std::unique_ptr<PoseTracker> tracker, Stamped<TrackedTool>*& at)
      : tracker_(std::move(tracker)), at_(at) {}
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    at_ = &newest;
    return tracker_->poll(now, newest);
  }

 private:
  std::unique_ptr<PoseTracker> tracker_;
  Stamped<TrackedTool>*& at_;
};
class TappedDisplay : public Display {
 public:
  TappedDisplay(std::unique_ptr<Display> display, Stamped<DentSample>*& at)
      : display_(std::move(display)), at_(at) {}
  void show(const View& view) noexcept override { display_->show(view); }
  bool poll(Time now, Stamped<DentSample>& newest) noexcept override {
    at_ = &newest;
    return display_->poll(now, newest);
  }

 private:
  std::unique_ptr<Display> display_;
  Stamped<DentSample>*& at_;
};

// Hash over truth, state and outputs of each of the next ticks.
std::vector<std::uint64_t> trace(trial::Trial& trial, int ticks) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(trial.tick());
    StateHash hash;
    Outputs out = trial.outputs();
    add_tick(hash, trial.state(), out);
    const sim::Truth& truth = trial.world().truth();
    hash.add(leaf_bits(truth.t));
    for (const auto* triple : {&truth.tool_tip.xyz, &truth.tool_velocity.xyz, &truth.tip.xyz,
                               &truth.tip_velocity.xyz, &truth.contact_force.xyz, &truth.hand_force.xyz})
      for (const double x : *triple) hash.add(leaf_bits(x));
    all.push_back(hash.value);
  }
  return all;
}

void goes_on_from(int saved_at) {
  Stamped<TrackedTool>* tool = nullptr;
  Stamped<DentSample>* dent = nullptr;
  trial::TrialOptions options;
  options.seconds = 10.0;
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<TappedTracker>(std::move(rig.tracker), tool);
    rig.display = std::make_unique<TappedDisplay>(std::move(rig.display), dent);
  };
  trial::Trial trial(scene("tennis_ball", quick()), options);
  for (int i = 0; i < saved_at; ++i) ASSERT_TRUE(trial.tick());
  const std::vector<std::byte> world = trial.world().save();
  const State state = trial.state();
  ASSERT_TRUE(tool && dent);
  const Stamped<TrackedTool> tool_then = *tool;
  const Stamped<DentSample> dent_then = *dent;

  const std::vector<std::uint64_t> first = trace(trial, 400);
  for (int i = 0; i < 2; ++i) {  // twice: restoring may not use up what was saved
    trial.world().restore(world);
    trial.state() = state;
    *tool = tool_then;
    *dent = dent_then;
    EXPECT_EQ(trace(trial, 400), first);
  }
}

TEST(TrialSave, GoesOnTheSameFromTheApproach) { goes_on_from(900); }
TEST(TrialSave, GoesOnTheSameFromAPress) { goes_on_from(2200); }
TEST(TrialSave, GoesOnTheSameFromARelease) { goes_on_from(4300); }

// ---- devices that fail
// ---------------------------------------------------------------------------------------

// Watches a run for what must hold under any fault.
struct Onlooker {
  double fastest = 0.0, hardest = 0.0;            // of commands, m/s and m/s^2
  double true_fastest = 0.0, true_hardest = 0.0;  // of the machine
  double outside = -1.0;                          // m, of the tip outside the undeformed ball
  double moved_in_hold = 0.0;                     // m, of commands once at rest
  std::int64_t holds = 0, held = 0, ticks = 0;
  std::uint32_t reasons = 0;
  Time last_hold{};
  Mode last = Mode::away;

  void see(const trial::Glance& g) {
    const Vec3 command = g.out.tip.p();
    const double dt = g.scene.dt;
    const Vec3 velocity = ticks > 0 ? Vec3((command - command_) / dt) : Vec3::Zero();
    fastest = std::max(fastest, velocity.norm());
    hardest = std::max(hardest, (velocity - velocity_).norm() / dt);
    true_fastest = std::max(true_fastest, g.truth.tip_velocity.norm());
    true_hardest = std::max(true_hardest, g.truth.tip_acceleration.norm());
    if (g.scene.objects.size() == 1 && g.out.mode != Mode::away && entered(g))
      outside = std::max(outside, height(g));
    if (g.out.mode == Mode::hold) {
      holds += last == Mode::hold ? 0 : 1;
      held_for_ = last == Mode::hold ? held_for_ + dt : 0.0;
      // From 50 mm/s at 0.41 m/s^2 it is at rest after 0.122 s.
      if (held_for_ > 0.125) moved_in_hold = std::max(moved_in_hold, velocity.norm() * dt);
      reasons |= g.out.why & kHoldReasons;
      last_hold = g.tick.t;
      ++held;
    }
    last = g.out.mode;
    command_ = command;
    velocity_ = velocity;
    ++ticks;
  }
  // Differences of commands of 0.2 m, each rounded to 2^-55 m: 1e-16 / (1e-3)^2 = 1e-10 m/s^2.
  void expect_within_limits() const {
    EXPECT_LE(fastest, 0.050 + 1e-9);
    EXPECT_LE(hardest, 0.41 + 1e-7);
    EXPECT_LE(true_fastest, 0.050 + 1e-9);
    EXPECT_LE(true_hardest, 0.41 + 1e-7);
  }

 private:
  static double height(const trial::Glance& g) {
    const Object& ball = g.scene.objects.front();
    const double radius = std::get<Sphere>(ball.surface.shape()).radius;
    return (g.truth.tip - ball.X_WO.origin()).norm() + g.truth.tip_radius - radius;
  }
  bool entered(const trial::Glance& g) {
    entered_ = entered_ || height(g) < 0.0;
    return entered_;
  }
  Vec3 command_{0, 0, 0}, velocity_{0, 0, 0};
  double held_for_ = 0.0;
  bool entered_ = false;
};

struct Seen {
  trial::TrialResult result;
  Onlooker onlooker;
};
Seen look(const models::Setup& setup, trial::TrialOptions options = {},
          std::function<void(const trial::Glance&)> also = {}) {
  Seen seen;
  options.watch = [&](const trial::Glance& g) {
    seen.onlooker.see(g);
    if (also) also(g);
  };
  seen.result = run(setup, std::move(options));
  return seen;
}

std::string number(double x) { return std::to_string(x); }

// The newest pose is at most a frame (1/120 s) older than the beginning of the black-out, and is lost when it
// is older than 100 ms. It ends with the first packet: a frame, 3.5 ms of latency, a server slot of 10 ms,
// and the network's delay, which exceeds 30 ms once in half a million (e^-13).
void black_out(double at, Mode during) {
  constexpr double kFor = 0.4;
  Mode before = Mode::hold;
  bool fresh_before = false;
  Time newest{};
  const Seen seen = look(scene("tennis_ball", quick({"truth.tracker.blackout_at_s=" + number(at),
                                                     "truth.tracker.blackout_for_s=" + number(kFor)})),
                         {}, [&](const trial::Glance& g) {
                           const double t = seconds(g.tick.t.time_since_epoch());
                           if (t < at) before = g.out.mode;
                           // Recovery within one tick of good data.
                           const bool fresh = g.in.tool.t > newest && age(g.tick.t, g.in.tool.t) < 0.045;
                           if (fresh_before && t > at + kFor) {
                             EXPECT_NE(g.out.mode, Mode::hold) << t;
                           }
                           fresh_before = fresh;
                           newest = g.in.tool.t;
                         });
  EXPECT_EQ(before, during);
  ASSERT_EQ(seen.result.holds.size(), 1U);
  EXPECT_EQ(seen.result.holds[0].second, kToolLost);
  const double began = seconds(seen.result.holds[0].first.time_since_epoch());
  EXPECT_GE(began, at + 0.100 - 1.0 / 120 - 1e-9);
  EXPECT_LE(began, at + 0.102);
  const double ended = seconds(seen.onlooker.last_hold.time_since_epoch());
  EXPECT_GE(ended, at + kFor);
  EXPECT_LE(ended, at + kFor + 1.0 / 120 + 0.0035 + 0.010 + 0.030);
  EXPECT_EQ(seen.onlooker.moved_in_hold, 0.0);
  EXPECT_EQ(seen.result.contacts, 1);
  EXPECT_NE(seen.result.last_mode, Mode::hold);
  EXPECT_LE(seen.onlooker.outside, 0.0);
  seen.onlooker.expect_within_limits();
}

TEST(TrialFault, TrackerBlackOutWhileFollowing) { black_out(1.0, Mode::follow); }
TEST(TrialFault, TrackerBlackOutInContact) { black_out(2.2, Mode::contact); }

TEST(TrialFault, ATrackerThatNeverComesBackEndsInHold) {
  const Seen seen = look(
      scene("tennis_ball", quick({"truth.tracker.blackout_at_s=2.2", "truth.tracker.blackout_for_s=100"})));
  EXPECT_EQ(seen.result.last_mode, Mode::hold);
  EXPECT_EQ(seen.onlooker.holds, 1);
  EXPECT_EQ(seen.onlooker.moved_in_hold, 0.0);
  seen.onlooker.expect_within_limits();
}

TEST(TrialFault, LostPacketsAreNoLostTool) {
  const Seen seen = look(scene("tennis_ball", quick({"truth.tracker.loss=0.3"})));
  EXPECT_TRUE(seen.result.holds.empty());
  EXPECT_EQ(seen.result.contacts, 1);
}

// 0.91 kg hang on the sensor: 8.92 N of its 12 N. So 3.08 N of the tool are the most that it can tell, less
// 0.37 N of inertia (0.91 kg x 0.41 m/s^2), some noise, and steps of 0.025 N.
TEST(TrialFault, ASaturatedForceSensorHoldsUntilItReadsAgain) {
  double force_at_hold = kUnset;
  bool good_before = true;
  const Seen seen =
      look(scene("tennis_ball", quick({"truth.force.range_N=12", "truth.force.zero_N=0"})), {},
           [&](const trial::Glance& g) {
             if (g.out.mode == Mode::hold && std::isnan(force_at_hold))
               force_at_hold = g.truth.contact_force.norm();
             EXPECT_EQ(g.out.mode == Mode::hold, g.in.wrench.health == Health::saturated);
             EXPECT_EQ((g.out.why & kForceSaturated) != 0, g.in.wrench.health == Health::saturated);
             good_before = g.in.wrench.health == Health::ok;
           });
  ASSERT_FALSE(seen.result.holds.empty());
  for (const auto& [t, why] : seen.result.holds) EXPECT_EQ(why, kForceSaturated);
  EXPECT_NEAR(force_at_hold, 12.0 - 0.91 * 9.80665, 0.45);
  EXPECT_GT(seen.onlooker.held, 500);
  EXPECT_TRUE(good_before);
  EXPECT_NE(seen.result.last_mode, Mode::hold);  // released: the sensor reads again
  EXPECT_EQ(seen.result.contacts, 1);
  EXPECT_LE(seen.onlooker.outside, 0.0);
  seen.onlooker.expect_within_limits();
}

// A range of 3 N is less than the weight of what it carries: nothing ever moves.
TEST(TrialFault, ASensorThatCannotCarryItsLoadNeverLetsTheMachineMove) {
  const Seen seen = look(scene("tennis_ball", quick({"truth.force.range_N=3"})));
  ASSERT_EQ(seen.result.holds.size(), 1U);
  EXPECT_EQ(seen.result.holds[0].second, kForceSaturated);
  EXPECT_EQ(seconds(seen.result.holds[0].first.time_since_epoch()), 0.0);
  EXPECT_EQ(seen.result.last_mode, Mode::hold);
  EXPECT_EQ(seen.onlooker.held, seen.onlooker.ticks);
  EXPECT_EQ(seen.onlooker.fastest, 0.0);
  EXPECT_EQ(seen.onlooker.true_fastest, 0.0);
}

// Off by 0.3 mm along each axis, both ways: one contact, and no pressing goes unnoticed for longer than the
// force filter needs (5 Hz: 1 N reads as 0.1 N after 3.4 ms; 0.3 N after 13 ms; 30 ms with noise and
// threshold).
TEST(TrialFault, ARegistrationErrorOf300MicrometresNeverHidesAPress) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {0.3, -0.3}) {
      std::array<std::string, 3> bias{"0", "0", "0"};
      bias[static_cast<std::size_t>(axis)] = number(sign);
      const std::string text = "truth.tracker.bias_mm=[" + bias[0] + "," + bias[1] + "," + bias[2] + "]";
      SCOPED_TRACE(text);
      int unnoticed = 0;
      int longest = 0;
      const Seen seen = look(scene("tennis_ball", quick({text})), {}, [&](const trial::Glance& g) {
        const bool pressing = g.truth.contact_force.norm() > 0.5;
        unnoticed = pressing && g.out.mode != Mode::contact ? unnoticed + 1 : 0;
        longest = std::max(longest, unnoticed);
      });
      EXPECT_EQ(seen.result.contacts, 1);
      EXPECT_LE(longest, 30);  // ticks, ms
      EXPECT_TRUE(seen.result.holds.empty());
      EXPECT_LE(seen.onlooker.outside, 0.0);
      seen.onlooker.expect_within_limits();
    }
}

double force_at_limit(const models::Setup& setup, std::int32_t& contacts, double& deepest) {
  trial::PressMeasure measure(setup);
  trial::TrialOptions options;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  contacts = run(setup, options).contacts;
  const auto met = [](const trial::PressFigures& press) {
    return !std::isnan(press.miss);
  };  // not only planned
  EXPECT_EQ(std::count_if(measure.presses().begin(), measure.presses().end(), met), 1);
  deepest = measure.presses().front().peak_deflection;
  return measure.presses().front().force_at_limit;
}
const Set kDeep{"user.approach_mm_s=[20]", "user.press_s=4", "user.hold_s=0.3", "user.release_s=2"};

// A sensor turned by 5 degrees about x takes cos 5 = 0.9962 of a force along z for the whole: 12.08 N feel
// like 12.03, and the ball answers 0.05 N too hard. The weight's share, 8.92 N x sin 5 = 0.78 N sideways, is
// tared away.
TEST(TrialFault, ASensorTurnedByFiveDegreesIsAForceErrorOfFourPerMille) {
  std::int32_t contacts = 0;
  double deepest = 0.0;
  const double straight = force_at_limit(scene("tennis_ball", kDeep), contacts, deepest);
  for (const char* turned : {"[5,0,0]", "[0,5,0]", "[-5,0,0]"}) {
    Set set = kDeep;
    set.push_back(std::string("truth.force.turned_deg=") + turned);
    const double force = force_at_limit(scene("tennis_ball", set), contacts, deepest);
    EXPECT_EQ(contacts, 1) << turned;
    EXPECT_NEAR(force, 12.0, 1.0) << turned;
    EXPECT_NEAR(force - straight, 12.0 * (1.0 / std::cos(5.0 * std::numbers::pi / 180.0) - 1.0), 0.06)
        << turned;
    EXPECT_LE(deepest, 6.05e-3) << turned;
  }
}

// ---- presses that are right
// ----------------------------------------------------------------------------------

TEST(TrialPress, SpeedAndAccelerationStayWithinTheLimitsOnEveryTickOfTheBall) {
  const Seen seen = look(scene("tennis_ball"));
  EXPECT_GT(seen.onlooker.ticks, 60'000);
  EXPECT_EQ(seen.result.contacts, 5);
  seen.onlooker.expect_within_limits();
  EXPECT_GT(seen.onlooker.fastest, 0.02);  // it did move
  EXPECT_GT(seen.onlooker.hardest, 0.3);
  EXPECT_LE(seen.onlooker.outside, 0.0);
  EXPECT_TRUE(seen.result.holds.empty());
}

TEST(TrialPress, TwelveNewtonAtTheLimitFromEveryPolarAngle) {
  for (const char* polar : {"0", "12.5", "25", "37.5", "50"}) {
    Set set = kDeep;
    set.push_back(std::string("user.polar_deg=") + polar);
    std::int32_t contacts = 0;
    double deepest = 0.0;
    const double force = force_at_limit(scene("tennis_ball", set), contacts, deepest);
    EXPECT_EQ(contacts, 1) << polar;
    EXPECT_NEAR(force, 12.0, 1.0) << polar;
    EXPECT_LE(deepest, 6.05e-3) << polar;
  }
}

// The machine begins where it stands: its tip may be outside of the object until it has got there.
TEST(TrialPress, AnObjectThatStandsAsideIsEnteredWithoutAHold) {
  for (const char* set : {"object.ball.position_mm=[20,0,-20]", "object.ball.position_mm=[-15,15,-20]"}) {
    const trial::TrialResult result = run(scene("tennis_ball", quick({set})));
    EXPECT_TRUE(result.holds.empty()) << set;
    EXPECT_EQ(result.contacts, 1) << set;
  }
}

TEST(TrialPress, TheLimitIsHeldUnderThirtyNewton) {
  for (const int limit : {6, 4, 2}) {
    std::int32_t contacts = 0;
    double deepest = 0.0;
    double strongest = 0.0;
    const models::Setup setup =
        scene("push_limit", {"user.push_N=30", "object.ball.limit_mm=" + std::to_string(limit)});
    trial::PressMeasure measure(setup);
    trial::TrialOptions options;
    options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
    contacts = run(setup, options).contacts;
    deepest = measure.presses().front().peak_deflection;
    strongest = measure.presses().front().peak_force;
    EXPECT_EQ(contacts, 1) << limit;
    EXPECT_LE(deepest, limit * 1e-3 + 0.05e-3);
    EXPECT_GE(deepest, limit * 1e-3 - 0.05e-3) << "the push did not reach the limit";
    EXPECT_GT(strongest, 25.0) << "there was no such push";
  }
}

// ---- a deformed surface of our own
// ---------------------------------------------------------------------------

// The ball dented by the true tool, as a mesh: rings of points around the tool's axis, each pushed radially
// inwards along a raised cosine of the width that a thin ball dimples over, tip radius + sqrt(R depth)
// [sources/ball 2], and further where it would still be inside the tool's tip. It passes through the tool's
// lowest point. Made from the truth and nothing of dent.h.
class DentedBall {
 public:
  DentedBall(const Vec3& centre, double radius, const Vec3& tool, double tool_radius)
      : centre_(centre), radius_(radius) {
    const Vec3 way = tool - centre;
    axis_ = way.normalized();
    depth = std::max(0.0, radius + tool_radius - way.norm());
    x_ = axis_.unitOrthogonal();
    y_ = axis_.cross(x_);
    const double width = tool_radius + std::sqrt(radius * depth);
    for (int ring = 0; ring <= kRings; ++ring)
      for (int i = 0; i < kSectors; ++i) {
        const double angle = kStep * ring;
        const double turn = 2.0 * std::numbers::pi * i / kSectors;
        const Vec3 u =
            std::cos(angle) * axis_ + std::sin(angle) * (std::cos(turn) * x_ + std::sin(turn) * y_);
        const double beside = std::min(1.0, radius * angle / width);
        double at = radius - depth * 0.5 * (1.0 + std::cos(std::numbers::pi * beside));
        // Where the ray enters the tool's sphere, if it does.
        const double along = u.dot(way);
        const double inside = along * along - way.squaredNorm() + tool_radius * tool_radius;
        if (inside > 0.0) at = std::min(at, along - std::sqrt(inside));
        mesh_[static_cast<std::size_t>(ring)][static_cast<std::size_t>(i)] = at * u;
      }
  }

  // Height of a point above the mesh along its own radius; never less than its distance. Beside the mesh:
  // above the ball.
  [[nodiscard]] double height(const Vec3& p) const {
    const Vec3 ray = (p - centre_).normalized();
    const double angle = std::acos(std::clamp(ray.dot(axis_), -1.0, 1.0));
    if (angle >= kStep * kRings) return (p - centre_).norm() - radius_;
    double turn = std::atan2(ray.dot(y_), ray.dot(x_));
    if (turn < 0.0) turn += 2.0 * std::numbers::pi;
    const auto sector = static_cast<int>(turn / (2.0 * std::numbers::pi) * kSectors) % kSectors;
    const auto ring = static_cast<int>(angle / kStep);
    // The flat triangles are chords: a ray near an edge may belong to a neighbour.
    for (int r = std::max(0, ring - 1); r <= std::min(kRings - 1, ring + 1); ++r)
      for (int s = sector - 1; s <= sector + 1; ++s) {
        double at = 0.0;
        if (meets(ray, corner(r, s), corner(r + 1, s), corner(r + 1, s + 1), at) ||
            meets(ray, corner(r, s), corner(r + 1, s + 1), corner(r, s + 1), at))
          return (p - centre_).norm() - at;
      }
    return kUnset;
  }

  double depth = 0.0;

 private:
  static constexpr int kRings = 80, kSectors = 24;
  static constexpr double kStep = 0.2e-3 / 0.033;  // rad: rings 0.2 mm apart, 16 mm in all

  [[nodiscard]] const Vec3& corner(int ring, int sector) const {
    return mesh_[static_cast<std::size_t>(ring)][static_cast<std::size_t>((sector + kSectors) % kSectors)];
  }
  // Ray from the centre through a triangle: at * ray = a + b1 (b - a) + b2 (c - a).
  static bool meets(const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c, double& at) {
    Mat3 m;
    m << ray, a - b, a - c;
    const double det = m.determinant();
    if (std::abs(det) < 1e-18) return false;
    const Vec3 x = m.inverse() * a;
    at = x[0];
    constexpr double kEdge = -1e-9;
    return x[1] >= kEdge && x[2] >= kEdge && x[1] + x[2] <= 1.0 - kEdge;
  }

  Vec3 centre_, axis_, x_, y_;
  double radius_;
  std::array<std::array<Vec3, kSectors>, kRings + 1> mesh_;
};

TEST(DentedBall, PassesThroughTheToolsLowestPointAndIsTheBallElsewhere) {
  // A tip of 2 mm whose centre is 31 mm above that of the ball: its lowest point is at 29 mm, 4 mm deep.
  const DentedBall dent(Vec3(0, 0, 0.1), 0.033, Vec3(0, 0, 0.131), 0.002);
  EXPECT_NEAR(dent.depth, 0.004, 1e-12);
  EXPECT_NEAR(dent.height(Vec3(0, 0, 0.129)), 0.0, 1e-9);
  EXPECT_NEAR(dent.height(Vec3(0, 0, 0.133)), 0.004, 1e-9);
  EXPECT_NEAR(dent.height(Vec3(0, -0.033, 0.1)), 0.0, 1e-12);
  // 14 mm along the ball the dent, 2 + sqrt(33 x 4) = 13.5 mm wide, has ended: 14 / 33 rad.
  const double angle = 14.0 / 33.0;
  EXPECT_NEAR(dent.height(Vec3(0.033 * std::sin(angle), 0, 0.1 + 0.033 * std::cos(angle))), 0.0, 30e-6);
  // Half way down the flank it is half as deep, 2 mm: at 6.745 mm / 33 mm rad.
  const double half = 0.5 * (2.0 + std::sqrt(132.0)) / 33.0;
  EXPECT_NEAR(dent.height(Vec3(0.033 * std::sin(half), 0, 0.1 + 0.033 * std::cos(half))), 0.002, 30e-6);
}

struct Margin {
  double worst = -1.0;         // m, height of the tip's outermost point above the mesh
  double worst_excess = -1.0;  // m, above the margin of that tick
  double deepest = 0.0;
  int ticks = 0;
};
// Bound: what the rig states, display.margin + display.margin_speed x age of the surface that the core has
// (0.8 mm + 50 mm/s x 10..50 ms).
Margin margin_of(const Set& set) {
  Margin margin;
  const models::Setup setup = scene("tennis_ball", set);
  trial::TrialOptions options;
  options.watch = [&](const trial::Glance& g) {
    if (g.tick.index % 10 != 0 || g.out.mode != Mode::contact || g.in.dent.health != Health::ok) return;
    const Object& ball = g.scene.objects.front();
    const Vec3 centre = ball.X_WO.p();
    const DentedBall dent(centre, std::get<Sphere>(ball.surface.shape()).radius, g.truth.tool_tip.e(),
                          g.truth.tool_radius);
    const Vec3 tip = g.truth.tip.e();
    const double height = dent.height(tip + g.truth.tip_radius * (tip - centre).normalized());
    ASSERT_TRUE(std::isfinite(height));
    const double bound = g.scene.display.margin + g.scene.display.margin_speed * age(g.tick.t, g.in.dent.t);
    margin.worst = std::max(margin.worst, height);
    margin.worst_excess = std::max(margin.worst_excess, height - bound);
    margin.deepest = std::max(margin.deepest, dent.depth);
    ++margin.ticks;
  };
  EXPECT_TRUE(run(setup, options).holds.empty());
  return margin;
}

TEST(TrialDent, TheTipIsInsideAnIndependentDentedBallWithinTheMargin) {
  const Margin slow = margin_of({"user.approach_mm_s=[20]", "user.press_s=4", "user.release_s=2"});
  EXPECT_GT(slow.ticks, 300);
  EXPECT_GT(slow.deepest, 5.5e-3);
  EXPECT_LE(slow.worst_excess, 0.0);
  EXPECT_LE(slow.worst, 0.8e-3);  // a slow press needs nothing of what age allows
  const Margin fast = margin_of(quick());
  EXPECT_GT(fast.ticks, 100);
  EXPECT_GT(fast.deepest, 3.5e-3);
  EXPECT_LE(fast.worst_excess, 0.0);
  const Margin oblique = margin_of(quick({"user.polar_deg=40", "user.azimuth_deg=30"}));
  EXPECT_GT(oblique.ticks, 100);
  EXPECT_LE(oblique.worst_excess, 0.0);
  RecordProperty("worst_um", static_cast<int>(1e6 * std::max({slow.worst, fast.worst, oblique.worst})));
}

}  // namespace
}  // namespace enc::bench
