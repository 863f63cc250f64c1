// The measures of a run.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "app/check/check.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/unit/trial/runs.h"
#include "trial/measure/finger_measure.h"
#include "trial/measure/frame_force.h"
#include "trial/measure/press_measure.h"
#include "trial/measure/seen_measure.h"
#include "trial/measure/touch_measure.h"
#include "trial/precision/precision.h"
#include "trial/trackers/threaded_tracker.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using test::Set, test::shipped;
using testing::AllOf, testing::HasSubstr, testing::Not;

std::size_t departures(const std::string& scene, std::uint64_t seed, const Set& set = {}) {
  const models::Setup setup = shipped(scene, set);
  PressMeasure presses(setup);
  TrialOptions options{.seed = seed};
  options.watch = [&](const Glance& glance) { presses.see(glance); };
  Trial(setup, options).run();
  return presses.departures().size();
}

// The tip stays 5 um inside, which is 1 N for a tooth of 200 N/mm: no fault of force or machine. A zero that
// drifts is a fault.
TEST(PressMeasure, AToothIsSmallerByTheSkinAndStillItself) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) EXPECT_EQ(departures("training", seed), 0U) << seed;
  EXPECT_GT(departures("tennis_ball", 1, {"truth.force.drift_N_per_sqrt_s=0.5"}), 0U);
}

// A sensor whose zero is wrong but trusted: seed 6 makes the true force too hard, seed 2 too soft, for a ball
// and for a tooth.
TEST(PressMeasure, NamesAForceThatIsTooHardAndOneThatIsTooSoft) {
  const Set off{"rig.force.tare=start", "rig.force.tare_time_s=0", "truth.force.zero_N=2"};
  for (const char* scene : {"tennis_ball", "training"})
    for (const std::uint64_t seed : {2U, 6U}) EXPECT_GT(departures(scene, seed, off), 0U) << scene << seed;
}

// The tip is 0.1 mm deep when the finger meets the tooth of 200 N/mm: its response is 20 N there, before the
// hand pushes.
TEST(PressMeasure, NamesAnInsetThatIsAForce) {
  EXPECT_GT(departures("training", 1, {"follow.inset_mm=0.1"}), 0U);
}

PressMeasure measured(const models::Setup& setup, std::uint64_t seed) {
  double simulated = 0.0;
  return measured_run(setup, seed, simulated);
}

TEST(PressMeasure, ALimitIsReachedWhereTheDeflectionComesToIt) {
  EXPECT_DOUBLE_EQ(near_limit(6e-3), 0.05e-3);
  EXPECT_DOUBLE_EQ(near_limit(0.15e-3), 0.0015e-3) << "not a third of it";
  const models::Setup training = shipped("training");
  const PressMeasure slight = measured(training, 1);
  for (const PressFigures& press : slight.presses()) {
    if (std::isnan(press.miss)) continue;
    EXPECT_DOUBLE_EQ(press.limit, 0.15e-3);
    EXPECT_EQ(press.object, 0);
    EXPECT_TRUE(std::isnan(press.force_at_limit)) << press.peak_deflection;
  }
  // Three contacts, stopped at 6, 4 and 2 mm: each by its own limit.
  const models::Setup three = shipped("synchrony");
  const PressMeasure stopped = measured(three, 1);
  ASSERT_EQ(stopped.presses().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const PressFigures& press = stopped.presses()[i];
    EXPECT_DOUBLE_EQ(press.limit, (6.0 - 2.0 * static_cast<double>(i)) * 1e-3);
    EXPECT_FALSE(std::isnan(press.force_at_limit)) << i;
    EXPECT_LT(press.over_limit, 0.02e-3) << i;
  }
}

// A drawn reach: its bound is the part that a machine of this speed and acceleration can follow. A machine
// slower than the rig assumes misses by more.
TEST(PressMeasure, ADrawnReachIsBoundedByItsOwnPath) {
  const auto missed = [](const PressMeasure& measure) {
    int n = 0;
    for (const PressFigures& press : measure.presses()) n += press.miss > press.miss_bound ? 1 : 0;
    return n;
  };
  const models::Setup session = shipped("session");
  for (const std::uint64_t seed : {9U, 12U}) EXPECT_EQ(missed(measured(session, seed)), 0) << seed;
  // The machine is slower than assumed.
  const models::Setup slow = shipped("session", {"truth.hexapod.servo_hz=1", "user.session.duration_s=40"});
  EXPECT_GT(missed(measured(slow, 9)), 0);
}

// The measures of a run without ground truth, and the strength of a hand.

// As for a real arm and a real finger: the measure does not get the ground truth.
std::size_t empty_contacts(const models::Setup& setup, bool withheld = false) {
  TouchMeasure touches;
  TrialOptions options;
  const sim::Truth none;
  options.watch = [&](const Glance& glance) {
    Inputs in = glance.in;
    in.withheld = withheld;
    touches.see({glance.scene, glance.tick, none, in, glance.out, false});
  };
  static_cast<void>(Trial(setup, options).run());
  EXPECT_TRUE(touches.plan().tried().empty());
  return touches.empty().size();
}

TEST(TouchMeasure, AnArmKnowsWithoutATruthThatNothingPushedItsProp) {
  const models::Setup beside = shipped("wall", {"truth.tracker.bias_mm=[60,0,0]"});
  EXPECT_EQ(empty_contacts(beside), 3U);
  EXPECT_EQ(empty_contacts(beside, true), 0U) << "a machine that is told nothing does not push back";
  for (const char* name : {"wall", "drum", "tiles", "button", "keypad", "room", "hit_ball", "reaching"})
    EXPECT_EQ(empty_contacts(shipped(name)), 0U) << name;
}

// A hand breaks through a wall that no motor holds and strikes the arm's stop. Then its mass rings on its
// grip about its force: by the speed of the impact times sqrt(k m).
TEST(TouchMeasure, AHandPushesHarderThanItsStrengthOnlyByTheImpactOfItsMass) {
  constexpr double kAverage = 1.0;  // s
  const models::Setup setup = shipped("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=1000"});
  const sim::HandTruth& hand = setup.twin.hand;
  TrialOptions options;
  double most = 0.0, mean = 0.0, lasting = 0.0, speed = 0.0;
  options.watch = [&](const Glance& glance) {
    const double force = glance.truth.contact_force.norm();
    most = std::max(most, force);
    mean += glance.scene.dt / kAverage * (force - mean);
    lasting = std::max(lasting, mean);
    speed = std::max(speed, glance.truth.tool_velocity.norm());
  };
  static_cast<void>(Trial(setup, options).run());
  EXPECT_GT(lasting, 0.7 * hand.strength);
  EXPECT_LT(lasting, 1.05 * hand.strength);
  EXPECT_GT(most, hand.strength);
  EXPECT_LT(most, hand.strength + speed * std::sqrt(hand.grip_stiffness * hand.mass));
}

// Presses reveal that the tracker, or the camera, does not stand at its registered place.

// Two presses of 6 mm with little between them.
SeenMeasure seen(const std::string& scene, const Set& more, std::uint64_t seed = 1) {
  Set set{"user.approach_mm_s=[100, 100]",
          "user.approach_from_mm=125",
          "user.depth_mm=6",
          "user.press_s=1",
          "user.hold_s=0.5",
          "user.release_s=1",
          "user.rest_s=0.3"};
  set.insert(set.end(), more.begin(), more.end());
  SeenMeasure measure;
  TrialOptions options{.seed = seed};
  const sim::Truth none;  // as for real devices
  options.watch = [&](const Glance& glance) {
    measure.see({glance.scene, glance.tick, none, glance.in, glance.out, false});
  };
  static_cast<void>(Trial(shipped(scene, set), options).run());
  return measure;
}

Vec3 moved(const SeenMeasure& measure) { return -measure.moved().shift; }

TEST(SeenMeasure, AFingerIsSeenWhereItPushesTheProp) {
  for (const char* scene : {"wall", "button"}) {
    const SeenMeasure measure = seen(scene, {});
    ASSERT_EQ(measure.presses().size(), 2U) << scene;
    EXPECT_LT(measure.shift().shift.norm(), 0.3e-3) << scene;
    EXPECT_EQ(measure.moved().presses, 0U) << scene;
  }
}

// A finger seen too high pushes before the core detects it; a finger seen too low lies on the prop.
TEST(SeenMeasure, ACameraThatHasMovedIsFoundWithItsWay) {
  for (const double mm : {5.0, -5.0, 3.0, -3.0}) {
    const SeenMeasure measure = seen("wall", {"truth.tracker.bias_mm=[0, 0, " + std::to_string(-mm) + "]"});
    ASSERT_EQ(measure.moved().presses, 2U) << mm;
    EXPECT_NEAR(moved(measure).z() * 1e3, mm, 0.6);
    EXPECT_NEAR(moved(measure).head<2>().norm(), 0.0, 1e-6) << "what no press tells is not told";
    EXPECT_EQ(measure.moved().ways, 1);
  }
}

// A wrong registration by pose and not by bias: the rig assumes a place 5 mm lower.
TEST(SeenMeasure, ARegistrationThatIsOffIsFound) {
  Vec3 off = shipped("wall").rig.frames.W_C.position * 1e3;
  off.z() -= 5.0;
  const std::string set = "rig.frames.W_C.position_mm=[" + std::to_string(off.x()) + ", " +
                          std::to_string(off.y()) + ", " + std::to_string(off.z()) + "]";
  const SeenMeasure measure = seen("wall", {set});
  ASSERT_EQ(measure.moved().presses, 2U);
  EXPECT_NEAR(moved(measure).z() * 1e3, 5.0, 0.6);
}

// Presses give no result across the normal, and no wrong one.
TEST(SeenMeasure, AcrossTheNormalAPressTellsNothing) {
  const SeenMeasure measure = seen("wall", {"truth.tracker.bias_mm=[5, 0, 0]"});
  ASSERT_EQ(measure.presses().size(), 2U);
  EXPECT_EQ(measure.moved().presses, 0U);
}

TEST(SeenMeasure, OnePressIsNoEvidence) {
  const SeenMeasure measure = seen("wall", {"user.approach_mm_s=[100]", "truth.tracker.bias_mm=[0, 0, 5]"});
  ASSERT_EQ(measure.presses().size(), 1U);
  EXPECT_EQ(measure.moved().presses, 0U);
}

TEST(SeenMeasureLong, NeverInVainAndAlwaysFoundOverSeeds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(seen("wall", {}, seed).moved().presses, 0U) << seed;
    EXPECT_EQ(seen("button", {}, seed).moved().presses, 0U) << seed;
    for (const char* bias : {"5", "-5"})
      EXPECT_GT(
          seen("wall", {std::string("truth.tracker.bias_mm=[0, 0, ") + bias + "]"}, seed).moved().presses, 0U)
          << seed << " " << bias;
  }
}

// Error against run time: the hand is independent of the step, and the advice names the cheapest setting.

std::vector<Vec3> tool_path(const std::string& scene, const Set& set, double seconds) {
  std::vector<Vec3> path;
  TrialOptions options{.seconds = seconds};
  options.watch = [&](const Glance& glance) { path.push_back(glance.truth.tool_tip.e()); };
  (void)Trial(shipped(scene, set), options).run();
  return path;
}

// Tremor, drift and plan: 0.15 mm rms of drift that was drawn at each step made another hand for each step.
TEST(Precision, AHandIsTheSameWhateverTheStep) {
  for (const char* scene : {"tennis_ball", "session"}) {
    const std::vector<Vec3> coarse = tool_path(scene, {}, 1.5);
    for (const char* step : {"500", "250", "100"}) {
      const std::vector<Vec3> fine = tool_path(scene, {std::string("truth.world.timestep_us=") + step}, 1.5);
      ASSERT_EQ(fine.size(), coarse.size());
      double most = 0.0;
      for (std::size_t i = 0; i < fine.size(); ++i) most = std::max(most, (fine[i] - coarse[i]).norm());
      EXPECT_LT(most, 0.12e-3) << "m, " << scene << " at " << step << " us";
      EXPECT_GT(most, 0.0);
    }
  }
}

TEST(Precision, QuantitiesThatAreNoNumbersAreNoSmallError) {
  using All = std::vector<double>;
  const All truth{-2.0, 0.5, 0.0};
  EXPECT_DOUBLE_EQ(apart(All{-2.0, 0.5, 0.0}, truth), 0.0);
  EXPECT_DOUBLE_EQ(apart(All{-1.5, 0.5, 0.8}, truth), 0.4);
  EXPECT_TRUE(std::isnan(apart(All{-2.0, kUnset, 0.0}, truth)));
  EXPECT_TRUE(std::isnan(apart(All{-2.0, 0.5, INFINITY}, truth)));
  EXPECT_TRUE(std::isnan(apart(All{-2.0, 0.5}, truth)));
  EXPECT_TRUE(std::isnan(apart(All{0.0, 0.0}, All{0.0, 0.0})));
}

PrecisionPoint point(const char* integrator, double step, double error, double cpu, bool shipped = false) {
  PrecisionPoint made{integrator, step};
  made.error = made.least_error = error;
  made.way = made.least_way = 1e-6;
  made.cpu = cpu;
  made.shipped = shipped;
  return made;
}
Precision made() {
  Precision all;
  all.table = "truth.world";
  all.converged = point("rk4", 20e-6, kUnset, 0.5);
  all.second = point("implicitfast", 10e-6, 0.01, 0.3);
  all.seconds = 12.0;
  all.touched = 5000;
  all.points = {point("implicitfast", 1e-3, 0.08, 0.0050), point("implicitfast", 0.5e-3, 0.04, 0.0090),
                point("rk4", 1e-3, 0.03, 0.0130, true), point("discrete", 1e-3, 0.06, 0.0052),
                point("euler", 1e-3, kUnset, kUnset)};
  all.points.back().failure = "diverged at tick 7";
  return all;
}

TEST(Precision, TheCheapestThatHolds) {
  const std::vector<PrecisionPoint> points = made().points;
  ASSERT_NE(cheapest(points, {0.05}), nullptr);
  EXPECT_EQ(cheapest(points, {0.05})->step, 0.5e-3);
  EXPECT_EQ(cheapest(points, {0.035})->integrator, "rk4");
  EXPECT_EQ(cheapest(points, {0.1})->integrator, "discrete") << "as dear as the cheapest, and errs less";
  EXPECT_EQ(cheapest(points, {0.02}), nullptr);
  EXPECT_EQ(next_cheaper(points, points[2])->step, 0.5e-3);
  EXPECT_EQ(next_cheaper(points, points[1])->integrator, "discrete");
  EXPECT_EQ(next_cheaper(points, points[0]), nullptr);
}

TEST(Precision, AdviceNamesTheSettingAndTheFloor) {
  EXPECT_THAT(
      app::advice_text(made(), {0.05}),
      AllOf(HasSubstr("--set truth.world.timestep_us=500 --set truth.world.integrator=implicitfast"),
            HasSubstr("errs by 0.0400 N, allowed 0.05 N"), HasSubstr("floor about 0.0100 N"),
            HasSubstr("failed: diverged at tick 7"), HasSubstr("the next cheaper, discrete at 1000 us")));
  EXPECT_THAT(app::advice_text(made(), {0.03}), HasSubstr("as it is"));
  EXPECT_THAT(app::advice_text(made(), {0.012}), HasSubstr("none of these"));
  // Two converged runs differ by the floor, so a third one may differ from them by as much.
  EXPECT_THAT(app::advice_text(made(), {0.051}),
              AllOf(HasSubstr("by another converged run 0.0300 to 0.0500 N"), Not(HasSubstr("may be more"))));
  EXPECT_THAT(app::advice_text(made(), {0.045}),
              HasSubstr("by another converged run 0.0300 to 0.0500 N: that may be more than allowed"));
  EXPECT_THAT(app::advice_text(made(), {0.0199}), HasSubstr("none of these errs by less than 0.0199 N"));
  EXPECT_NO_THROW(app::refuse_below_floor(made(), {0.012}));
  EXPECT_THROW(app::refuse_below_floor(made(), {0.005}), Error);
  Precision lucky = made();
  lucky.points[2].error = 0.004;
  EXPECT_NO_THROW(app::refuse_below_floor(lucky, {0.005})) << "a point holds it";
}

// 1 um by the force's own setting, 4 um by all others.
TEST(Precision, AdviceOfThePath) {
  Precision all = made();
  for (PrecisionPoint& one : all.points) one.way = one.least_way = one.integrator == "rk4" ? 1e-6 : 4e-6;
  EXPECT_EQ(cheapest(all.points, {kUnset, 2e-6})->integrator, "rk4");
  EXPECT_EQ(cheapest(all.points, {0.1, 2e-6})->integrator, "rk4") << "both must hold";
  EXPECT_EQ(cheapest(all.points, {0.02, 2e-6}), nullptr) << "both must hold";
  EXPECT_NE(cheapest(all.points, {kUnset, 5e-6})->integrator, "rk4");
  EXPECT_THAT(app::advice_text(all, {kUnset, 1.5e-6}), AllOf(HasSubstr("errs by 1.00 um, allowed 1.5 um"),
                                                             HasSubstr("that may be more than allowed")));
  EXPECT_THAT(app::advice_text(all, {0.05, 2.5e-6}), HasSubstr("errs by 0.0300 N and 1.00 um"));
  all.second.way = 2e-6;
  EXPECT_THROW(app::refuse_below_floor(all, {kUnset, 0.5e-6}), Error);
}

TEST(Precision, ASceneWithoutAHandIsRefused) {
  const SetupWith tracking = [](const Set& set) { return shipped("tracking", set); };
  EXPECT_THROW((void)precision_of(tracking, {}), Error);
}

// A short press of a plane: the shipped setting errs no more than two converged runs and a count of the
// sensor.
TEST(PrecisionLong, ThePlaneHoldsAtWhatShips) {
  PrecisionOptions options;
  options.seconds = 5.0;
  options.cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  options.rounds = 1;
  const Precision all = precision_of([](const Set& set) { return shipped("plane", set); }, options);
  ASSERT_EQ(all.points.size(), 16U);
  const auto shipped =
      std::find_if(all.points.begin(), all.points.end(), [](const auto& one) { return one.shipped; });
  ASSERT_NE(shipped, all.points.end());
  EXPECT_GT(all.touched, 500);
  EXPECT_LT(shipped->error, 0.06) << "N";
  EXPECT_GT(shipped->error, 0.0);
  EXPECT_LT(shipped->cpu * 8.0, all.converged.cpu) << "in one run";
}

// The period has no finite decimal form, and the shipped time step is not among the grid's fractions of it.
TEST(Precision, AnyHapticRateIsTakenAndWhatShipsIsAPoint) {
  PrecisionOptions options;
  options.seconds = 4.0;
  options.cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  options.rounds = 1;
  options.grid = {{"implicitfast"}, {1}};
  options.converged = 10;
  const Precision all = precision_of(
      [](const Set& set) {
        Set own{"rig.loop.rate_hz=1500", "truth.world.timestep_us=222.22222222222223"};
        own.insert(own.end(), set.begin(), set.end());
        return shipped("plane", own);
      },
      options);
  ASSERT_EQ(all.points.size(), 2U);
  EXPECT_FALSE(all.points[0].shipped);
  EXPECT_TRUE(all.points[1].shipped);
  EXPECT_NEAR(all.points[1].step * 4500.0, 1.0, 1e-9);
  for (const PrecisionPoint& point : all.points) EXPECT_EQ(point.failure, "");
  EXPECT_DOUBLE_EQ(all.tick * 1500.0, 1.0);
}

// An arm that hastens to the place of a reach's touch is at its commanded place when they meet.

// m, sorted: between the tip and its target along the surface, at each touch of random reaches.
std::vector<double> apart_when_they_meet(const char* scene) {
  models::Setup setup = shipped(scene, {"truth.hand.aborted=0"});
  setup.scene.user->kind = UserKind::reaches;
  if (!setup.scene.user->reaches) setup.scene.user->reaches.emplace();
  setup.scene.user->reaches->count = 12;
  std::vector<double> apart;
  bool met = true;
  sim::Phase phase = sim::Phase::wait;
  TrialOptions options;
  options.watch = [&](const Glance& glance) {
    if (glance.truth.phase == sim::Phase::approach && phase != glance.truth.phase) met = false;
    phase = glance.truth.phase;
    if (met || glance.truth.aim < 0) return;
    const Object& aimed = glance.scene.objects[static_cast<std::size_t>(glance.truth.aim)];
    const PropTarget at = wanted_at(aimed, glance.truth.tool_tip);
    if (at.distance > glance.truth.tool_radius) return;
    met = true;
    const Vec3 way = (recall<ImpedanceState>(*glance.state).aim.target - glance.truth.tip).e();
    apart.push_back((way - at.normal.e() * at.normal.e().dot(way)).norm());
  };
  Trial(std::move(setup), options).run();
  std::sort(apart.begin(), apart.end());
  return apart;
}

// The tip lags if the law does not get the target's acceleration: 0.5 mm in the middle, 1.6 mm in one of ten.
TEST(Haste, TheTipIsWhereItsTargetIsWhenTheFingerTouches) {
  const std::vector<double> apart = apart_when_they_meet("wall");
  ASSERT_GE(apart.size(), 10U);
  EXPECT_LT(apart[apart.size() / 2], 0.3e-3);
  EXPECT_LT(apart[apart.size() * 9 / 10], 0.6e-3);
}

// Two keys, one 20 mm above the other: from the plane of each key the finger reaches the other one.
TEST(Haste, TheChosenKeyDoesNotFlickerBetweenPictures) {
  for (const std::uint64_t seed : {1U, 5U, 29U}) {
    models::Setup setup =
        shipped("keypad", {"object.key_1.position_mm=[-20,20,20]", "object.key_2.position_mm=[-20,-20,0]",
                           "user.object=key_2", "user.approach_mm_s=[100]", "user.approach_tilt_deg=40"});
    setup.scene.objects.resize(2);
    int changes = 0;
    std::int32_t chosen = -1;
    double since = 0.0;
    TrialOptions options{.seed = seed};
    options.watch = [&](const Glance& glance) {
      if (glance.out.object == chosen) return;
      const double now = seconds(glance.truth.t.time_since_epoch());
      changes += now - since < 0.02 ? 1 : 0;  // sooner than the next picture
      chosen = glance.out.object;
      since = now;
    };
    Trial(std::move(setup), options).run();
    EXPECT_LE(changes, 2) << seed;
  }
}

// The effect of vision on the force: a finger seen at 20 Hz presses a wall. One pair of runs has late or
// early results (up to a frame) and punctual ones; the other pair runs with and without a picture.

constexpr Duration kFrame{50'000'000};
constexpr std::size_t kFrameTicks = 50;
constexpr double kForceStep = 0.2;  // N, between frames

// The tracker has no latency of its own, so that a result can be early.
FeltWay press(Duration jitter, std::uint64_t seed) {
  FeltWay way;
  TrialOptions options{.seed = seed};
  options.fit_out = [&](Rig& rig) {
    rig.tracker = std::make_unique<JitteredTracker>(std::move(rig.tracker),
                                                    JitteredTracker::Spec{kFrame, jitter, seed});
  };
  options.watch = [&](const Glance& glance) { way.see(glance); };
  Trial(shipped("wall", {"truth.tracker.latency_ms=0", "user.approach_mm_s=[100]", "user.rest_s=1"}), options)
      .run();
  return way;
}

TEST(Jitter, OfAFrameChangesNothingThatIsFeltByMoreThanTheForceStep) {
  for (int i = 1; i <= tests::thorough(1, 4); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const ForceDifference apart = felt_apart(press({}, seed), press(kFrame, seed), kFrameTicks);
    EXPECT_GT(apart.ticks, 6000U) << seed;
    EXPECT_GT(apart.tick, 0.0) << seed;
    EXPECT_LE(apart.frame, kForceStep) << seed;
  }
}

// Eight frames late the finger is lost: the force changes, and the measure shows it.
TEST(Jitter, OfEightFramesIsFelt) {
  EXPECT_GT(felt_apart(press({}, 1), press(8 * kFrame, 1), kFrameTicks).frame, 1.0);
}

struct FastPress {
  FrameForce frames;
  double too_deep = 0.0;  // m, depth that the core assumes beyond the truth
  TrialResult result;
};
FastPress press_fast(std::uint64_t seed, bool beside = true) {
  FastPress pressed;
  TrialOptions options{.seed = seed};
  if (beside)
    options.law = [&](const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) {
      pressed.frames.step(scene, tick, in, state, out);
    };
  options.watch = [&](const Glance& glance) {
    if (glance.out.mode != Mode::contact || !glance.truth.touching) return;
    const double deep = glance.truth.tool_radius - glance.truth.tool_tip.xyz[2];
    pressed.too_deep = std::max(pressed.too_deep, glance.out.deflection - deep);
  };
  pressed.result =
      Trial(shipped("wall", {"user.approach_mm_s=[200, 300]", "user.press_s=0.6", "user.hold_s=0.3",
                             "user.release_s=0.4", "user.rest_s=1", "user.depth_mm=5"}),
            options)
          .run();
  return pressed;
}

// The prop stops a fast finger 100 ms before a picture shows it. By the pictures' prediction the finger would
// be 20 mm deep, and lost at the next picture. With seed 12 pictures also leap sideways during the press.
TEST(FrameForce, APictureInContactIsNotFelt) {
  for (const std::uint64_t seed : {1U, 2U, 12U}) {
    const FastPress pressed = press_fast(seed);
    EXPECT_GT(pressed.frames.changes().size(), 40U);
    EXPECT_LE(greatest_change(pressed.frames.changes(), true), kForceStep) << seed;
    EXPECT_GT(greatest_change(pressed.frames.changes(), false), 0.0) << seed;  // at the start of the touch
    EXPECT_LT(pressed.too_deep, 1e-3) << seed;
    EXPECT_EQ(pressed.result.hash, press_fast(seed, false).result.hash) << "the second core disturbs it";
  }
  EXPECT_TRUE(std::isnan(greatest_change({{true, 0.1}}, false)));
  EXPECT_TRUE(std::isnan(greatest_change({{true, 0.1}, {true, kUnset}, {true, 0.2}}, true)));
  EXPECT_EQ(greatest_change({{true, 0.1}, {false, kUnset}, {true, 0.2}}, true), 0.2);
}

// Five ticks, one of them not in contact: two whole frames of two ticks, with 4 N and 0, and with 1 N and -1
// N.
TEST(FeltApart, IsOfTicksInWhichBothAreInContactAndOfWholeFramesOfThem) {
  const auto way = [](const std::vector<double>& newtons) {
    const Scene scene;
    const sim::Truth truth;
    FeltWay made;
    for (const double n : newtons) {
      Outputs out;
      out.mode = std::isnan(n) ? Mode::follow : Mode::contact;
      out.force = Vec<'N'>(0, 0, n);
      made.see({scene, Tick{}, truth, Inputs{}, out});
    }
    return made;
  };
  const ForceDifference apart = felt_apart(way({-5, -5, -5, -5, -5}), way({-5, -9, kUnset, -6, -4}), 2);
  EXPECT_EQ(apart.ticks, 4U);
  EXPECT_DOUBLE_EQ(apart.tick, 4.0);
  EXPECT_DOUBLE_EQ(apart.frame, 2.0);  // from the first two
}

}  // namespace
}  // namespace enc::trial
