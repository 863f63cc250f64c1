// Shadow mode: verdicts and tapes; its own channel alone names each error of a twin.
#include "trial/identify/shadow/shadow.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <fstream>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/identify/shadow/shadow_runs.h"
#include "trial/identify/shadow/channels.h"

namespace enc::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;
using trial::Divergence, trial::Quantity;

Divergence off_by(double value, double half) {
  return {trial::Channel::tool, trial::Quantity::tool_latency, "", {value, half}, 1.0};
}

TEST(ShadowVerdict, FartherThanTheBoundAndThanChance) {
  EXPECT_FALSE(off_by(0.9, 0.1).diverges());
  EXPECT_TRUE(off_by(1.1, 0.1).diverges());
  EXPECT_TRUE(off_by(-1.1, 0.1).diverges());
  EXPECT_FALSE(off_by(1.1, 0.8).diverges());  // an interval that wide includes the bound
  EXPECT_TRUE(off_by(1.1, 0.8).vague());
  EXPECT_TRUE(off_by(5.0, 0.8).diverges());
  EXPECT_FALSE(off_by(5.0, 0.8).vague());
  EXPECT_FALSE(off_by(0.0, 0.1).vague());
  EXPECT_TRUE(off_by(kUnset, kUnset).vague());
  EXPECT_FALSE(off_by(kUnset, kUnset).diverges());
}

Measurement<TipSample> tip_at(double t, double x, Health health = Health::ok) {
  const Vec<'R'> moving(2.0 * x, 0, 0);
  return {{Pose<'R', 'H'>::shift(x, 0, 0), moving, moving}, Time(from_seconds(t)), health};
}

TEST(ShadowTape, KnowsWhereTheMachineWasBetweenItsStamps) {
  trial::TipTrace trace;
  EXPECT_TRUE(trace.empty());
  EXPECT_FALSE(trace.knows(Time(from_seconds(0.0))));
  trace.see(tip_at(1.000, 0.1));
  trace.see(tip_at(1.000, 0.7));  // no news
  trace.see(tip_at(1.001, 0.9, Health::fault));
  trace.see(tip_at(1.002, 0.3));
  trace.see(tip_at(1.500, 0.5));
  EXPECT_NEAR(trace.at(Time(from_seconds(1.001))).X_RH.p().x(), 0.2, 1e-12);
  EXPECT_NEAR(trace.at(Time(from_seconds(1.0015))).velocity.xyz[0], 0.5, 1e-12);
  EXPECT_EQ(trace.at(Time(from_seconds(0.0))).X_RH.p().x(), 0.1);
  EXPECT_EQ(trace.at(Time(from_seconds(9.0))).X_RH.p().x(), 0.5);
  EXPECT_TRUE(trace.knows(Time(from_seconds(1.001))));
  EXPECT_FALSE(trace.knows(Time(from_seconds(0.999))));
  EXPECT_FALSE(trace.knows(Time(from_seconds(1.2))));  // no data for half a second
  EXPECT_FALSE(trace.knows(Time(from_seconds(1.501))));
}

TEST(ShadowTwins, OneMoreOfThemLiesWithinTheirInterval) {
  const models::Interval twins = trial::of_twins({1.0, 2.0, 3.0, 2.0, kUnset});
  EXPECT_NEAR(twins.value, 2.0, 1e-12);
  // Student's t of 3 degrees of freedom, 3.18; scatter of 0.8165, and of their mean.
  EXPECT_NEAR(twins.half, 3.18 * 0.8165 * std::sqrt(1.25), 0.05);
  EXPECT_TRUE(std::isnan(trial::of_twins({1.0, 2.0}).value));
}

TEST(ShadowTwins, AreTheSetUpWithWhatIsPutOverIt) {
  const trial::Shadow other = shadowed(pressing(), 3, {}, {"behaviour.wall.stiffness_N_per_mm=1.9"});
  const Divergence* rendered = found(other, trial::Quantity::rendered);
  ASSERT_NE(rendered, nullptr);
  EXPECT_NEAR(rendered->off.value, 2.0 / 1.9 - 1.0, 3e-3);
  EXPECT_TRUE(rendered->diverges());
  EXPECT_THAT(refusal([] { (void)shadowed(pressing(), 3, {}, {"truth.tracker.latenzy_ms=4"}); }),
              HasSubstr("did you mean"));
}

// A laboratory's rig has no truth: its calibration alone states the place of its camera, and the twin's
// camera stands there.
TEST(ShadowTwins, OfARigWithoutTruthSeeAsItsCalibrationSays) {
  const TemporaryFolder folder;
  const std::string frame = "position_mm = [0, -900, 600]\nrotation_deg = [0, 0, 0]\n";
  const std::string sim = bytes_of(tests::source_dir() + "/models/rigs/sim.toml");
  std::ofstream(folder.file("mine.toml"))
      << replaced(replaced(sim, "[truth.frames.W_C]\n" + frame, ""), frame,
                  "position_mm = [3, -896, 604]\nrotation_deg = [1, -1, 1.4]\n");
  const models::Setup twin = set_up(carrying(), folder.file("mine.toml"));
  const models::Setup real =
      set_up(carrying(), folder.file("mine.toml"),
             {"truth.frames.W_C.position_mm=[3,-896,604]", "truth.frames.W_C.rotation_deg=[1,-1,1.4]"});
  const trial::Shadow shadow = shadowed_beside(real, 7, twin);
  EXPECT_THAT(named(shadow), testing::ElementsAre());
  for (const char* axis : {"x", "y", "z"}) {
    const Divergence* place = found(shadow, trial::Quantity::registration, axis);
    ASSERT_NE(place, nullptr);
    EXPECT_FALSE(place->vague());
  }
}

// The machine's data end here, but the machine goes on; its last reading stays.
AlterFrame lost_from(const std::function<bool(const RecordedTick&, double share)>& begins) {
  struct SampleLoss {
    bool is = false;
    Measurement<TipSample> last;
  };
  return [begins, lost = SampleLoss{}](RecordedTick& frame, double share) mutable {
    lost.is = lost.is || begins(frame, share);
    if (!lost.is) lost.last = frame.in.tip;
    frame.in.tip = lost.last;
    if (lost.is) frame.in.tip.health = Health::fault;
  };
}

TEST(ShadowLostLink, NothingIsHeldAgainstAMachineThatIsNotHeardOf) {
  const auto in_second_push = [](const RecordedTick& frame, double share) {
    return share > 0.5 && frame.out.deflection > 3e-3;
  };
  const trial::Shadow probed = shadowed_frames(probing(), 7, lost_from(in_second_push));
  EXPECT_THAT(named(probed), testing::ElementsAre());
  EXPECT_NE(found(probed, trial::Quantity::stiffness), nullptr);
  const auto late = [](const RecordedTick&, double share) { return share > 0.6; };
  const trial::Shadow carried = shadowed_frames(carrying(), 7, lost_from(late));
  EXPECT_THAT(named(carried), testing::ElementsAre());
  EXPECT_NE(found(carried, trial::Quantity::registration, "x"), nullptr);
}

// Packets are tied to their arrival: a delay common to all is invisible in their stamps.
TEST(ShadowUnjudged, TheAgeByStampsOfAWireTellsNoLatency) {
  const ShadowedScene still{"clamped_tool", {}};
  models::Setup twin = set_up(still);
  EXPECT_NE(found(shadowed_beside(twin, 5, twin), trial::Quantity::tool_latency), nullptr);
  twin.rig.tracker.driver = "igtl";
  const trial::Shadow shadow = shadowed_beside(set_up(still), 5, twin);
  EXPECT_EQ(found(shadow, trial::Quantity::tool_latency), nullptr);
  EXPECT_THAT(shadow.unjudged,
              testing::Contains(testing::Field(&trial::Remark::text,
                                               HasSubstr("stamps that are tied to when packets come"))));
  EXPECT_THAT(shadow.facts, testing::Contains(testing::Field(&trial::Remark::text,
                                                             HasSubstr("by their stamps packets come"))));
}

// The machine gets no command and reports its place: registration needs only that.
TEST(ShadowUnjudged, ADryRunTellsRegistrationByThePress) {
  const auto dry = [](RecordedTick& frame, double) { frame.in.withheld = true; };
  const trial::Shadow shadow =
      shadowed_frames(pressing(), 7, dry, {"truth.frames.W_C.position_mm=[0,-900,601]"});
  EXPECT_THAT(named(shadow), testing::ElementsAre("tool registration away"));
  EXPECT_EQ(found(shadow, trial::Quantity::machine_time), nullptr);
}

// The machine carries, presses and moves nothing: the report states that, and there is no failure.
TEST(ShadowUnjudged, WhatARecordCannotTellIsSaid) {
  const trial::Shadow shadow = shadowed({"clamped_tool", {}}, 5);
  EXPECT_FALSE(shadow.diverges());
  ASSERT_FALSE(shadow.unjudged.empty());
  EXPECT_THAT(shadow.unjudged.front().text, HasSubstr("stood still"));
  for (const char* axis : {"x", "y", "z"}) {
    const Divergence* place = found(shadow, trial::Quantity::registration, axis);
    ASSERT_NE(place, nullptr);
    EXPECT_LT(std::abs(place->off.value), place->bound);
  }
}

// Shadow mode finds each injected error with its size, and names it by its own channel alone.

struct InjectedFault {
  const char* what;
  const ShadowedScene& scene;
  std::vector<std::string> altered, twin;
  std::string name;  // name of the expected channel
  Quantity quantity;
  std::string axis;
  double size;  // SI
};

std::vector<std::string> ball_of(double rubber_MPa, double pressure_kPa, double felt_MPa) {
  return {"truth.ball.rubber_modulus_MPa=" + std::to_string(rubber_MPa),
          "truth.ball.pressure_kPa=" + std::to_string(pressure_kPa),
          "truth.ball.felt_modulus_MPa=" + std::to_string(felt_MPa)};
}

const std::vector<InjectedFault>& injections() {
  const auto with = [](const char* set) { return std::vector<std::string>{set}; };
  const auto four = with("truth.hexapod.delay_cycles=4"), seven = with("truth.hexapod.delay_cycles=7");
  const auto camera = with("truth.frames.W_C.position_mm=[0,-900,600]");
  static const std::vector<InjectedFault> kAll{
      // All moduli of the ball and its pressure: its force is larger by that share at each depth.
      {"5 % of stiffness", probing(), ball_of(2.73, 10.5, 0.21), ball_of(2.6, 10, 0.2), "force stiffness",
       Quantity::stiffness, "", 0.05},
      {"5 % of stiffness, softer", probing(), ball_of(2.47, 9.5, 0.19), ball_of(2.6, 10, 0.2),
       "force stiffness", Quantity::stiffness, "", -0.05},
      {"1 mm of the object's place", probing(), with("truth.ball.misplaced_mm=[0,0,-1]"),
       with("truth.ball.misplaced_mm=[0,0,0]"), "force object_place", Quantity::object_place, "", 1e-3},
      {"3 ms of the machine", probing(), seven, four, "machine machine_time", Quantity::machine_time, "",
       3e-3},
      {"3 ms of the tracker", carrying(), with("truth.tracker.latency_ms=6.5"),
       with("truth.tracker.latency_ms=3.5"), "tool tool_latency", Quantity::tool_latency, "", 3e-3},
      {"3 ms of its server", carrying(), with("truth.tracker.process_ms=12.2"),
       with("truth.tracker.process_ms=9.2"), "tool tool_latency", Quantity::tool_latency, "", 3e-3},
      {"3 ms of its stamps", carrying(), with("truth.tracker.stamp_error_ms=3"),
       with("truth.tracker.stamp_error_ms=0"), "tool tool_stamps", Quantity::tool_stamps, "", 3e-3},
      // A camera that stands farther sees everything nearer to it.
      {"1 mm of registration along x", carrying(), with("truth.frames.W_C.position_mm=[1,-900,600]"), camera,
       "tool registration x", Quantity::registration, "x", -1e-3},
      {"1 mm of registration along y", carrying(), with("truth.frames.W_C.position_mm=[0,-899,600]"), camera,
       "tool registration y", Quantity::registration, "y", -1e-3},
      {"3 ms of the machine", carrying(), seven, four, "machine machine_time", Quantity::machine_time, "",
       3e-3},
      {"5 % of stiffness, rendered", pressing(), with("behaviour.wall.stiffness_N_per_mm=2.1"),
       with("behaviour.wall.stiffness_N_per_mm=2"), "rendering rendered_stiffness", Quantity::rendered, "",
       0.05},
      {"4 ms of the tracker", pressing(), with("truth.tracker.process_ms=13.2"),
       with("truth.tracker.process_ms=9.2"), "tool tool_latency", Quantity::tool_latency, "", 4e-3},
      {"3 ms of its stamps", pressing(), with("truth.tracker.stamp_error_ms=3"),
       with("truth.tracker.stamp_error_ms=0"), "tool tool_stamps", Quantity::tool_stamps, "", 3e-3},
      {"1 mm of registration", pressing(), with("truth.frames.W_C.position_mm=[0,-900,601]"), camera,
       "tool registration away", Quantity::registration, "away", -1e-3},
      {"3 ms of the machine", pressing(), seven, four, "machine machine_time", Quantity::machine_time, "",
       3e-3},
      // The noise of the markers, 8 um at the tip, stays.
      {"noise of the tracker", pressing(), with("truth.tracker.noise_mm=[0.05,0.03,0.03]"),
       with("truth.tracker.noise_mm=[0.0166,0.0069,0.0108]"), "tool tool_noise", Quantity::tool_noise, "",
       1.68},
      {"a tenth of the packets lost", pressing(), with("truth.tracker.loss=0.1"),
       with("truth.tracker.loss=0"), "tool tool_loss", Quantity::tool_loss, "", 0.1},
      // Steps of 0.025 N and the reported acceleration add to both.
      {"noise of the force", pressing(), with("truth.force.noise_N=0.05"), with("truth.force.noise_N=0.0125"),
       "force force_noise", Quantity::force_noise, "", 2.26},
      {"zero of the force", pressing(), with("truth.force.zero_N=1.6"), with("truth.force.zero_N=0.5"),
       "force force_zero x", Quantity::force_zero, "x", -2.52},
      {"8 deg of the force sensor", pressing(), with("truth.force.turned_deg=[8,0,0]"),
       with("truth.force.turned_deg=[0,0,0]"), "force force_turned", Quantity::force_turned, "",
       8.0 / kDegPerRad},
  };
  return kAll;
}

// The resolution is limited by the machine's steps, 3 um, and by 0.2 % of the force in each of them.
double least_seen(Quantity quantity) {
  if (quantity == Quantity::stiffness || quantity == Quantity::rendered) return 2e-3;
  if (quantity == Quantity::force_noise || quantity == Quantity::force_zero) return 0.03;
  return quantity == Quantity::registration ? 5e-6 : 2e-6;
}

TEST(ShadowTable, EachErrorIsNamedByItsChannelAlone) {
  for (const InjectedFault& one : injections()) {
    const std::string row = std::string(one.what) + " in " + one.scene.name;
    const trial::Shadow shadow = shadowed(one.scene, 7, one.altered, one.twin);
    EXPECT_THAT(named(shadow), ElementsAre(one.name)) << row;
    const trial::Divergence* size = found(shadow, one.quantity, one.axis);
    ASSERT_NE(size, nullptr) << row;
    EXPECT_NEAR(size->off.value, one.size, std::max(size->off.half, least_seen(one.quantity))) << row;
    EXPECT_LT(size->off.half, 0.5 * std::abs(one.size)) << row;
  }
}

// The result must not depend on one seed: each of six others names the three errors alone, and the printed
// interval of 95 % holds the size for at least five. A tracker's own latency changes in steps of 1.67 ms, so
// only its name is checked.
TEST(ShadowTable, TheThreeErrorsAreNamedAloneWithEachSeed) {
  for (const char* what :
       {"5 % of stiffness", "3 ms of the tracker", "3 ms of its server", "1 mm of registration along x"}) {
    const auto row = std::find_if(injections().begin(), injections().end(),
                                  [what](const InjectedFault& one) { return std::string(one.what) == what; });
    ASSERT_NE(row, injections().end()) << what;
    int held = 0;
    const int seeds = tests::thorough(2, 6);
    for (int i = 1; i <= seeds; ++i) {
      const std::uint64_t seed = 200 + static_cast<std::uint64_t>(i);
      const trial::Shadow shadow = shadowed(row->scene, seed, row->altered, row->twin);
      EXPECT_THAT(named(shadow), ElementsAre(row->name)) << what << ", seed " << seed;
      const trial::Divergence* size = found(shadow, row->quantity, row->axis);
      ASSERT_NE(size, nullptr) << what << ", seed " << seed;
      if (std::abs(size->off.value - row->size) < std::max(size->off.half, least_seen(row->quantity))) ++held;
    }
    if (row->altered.front().starts_with("truth.tracker.latency_ms")) continue;
    EXPECT_GE(held, seeds - 1) << what;
  }
}

// Two errors at once do not hide each other: stamps that are late make a late packet look punctual.
TEST(ShadowTable, LatencyAndStampsOfAPressingToolAreBothNamed) {
  const trial::Shadow shadow =
      shadowed(pressing(), 7, {"truth.tracker.stamp_error_ms=3", "truth.tracker.process_ms=12.2"},
               {"truth.tracker.stamp_error_ms=0", "truth.tracker.process_ms=9.2"});
  EXPECT_THAT(named(shadow), testing::UnorderedElementsAre("tool tool_stamps", "tool tool_latency"));
}

// The report lists a divergence that no size, place or time explains as unexplained.
TEST(ShadowTable, AForceOfAnotherLawOrAWorseSensorHasARest) {
  EXPECT_THAT(named(shadowed(probing(), 7, {"truth.force.noise_N=0.3"}, {"truth.force.noise_N=0.0125"})),
              testing::Contains("force force_rest"));
  EXPECT_THAT(named(shadowed(probing(), 7, {"truth.ball.friction=0.15"}, {"truth.ball.friction=0.02"})),
              testing::Contains("force force_rest"));
}

// A divergence that is too large for a size estimate still counts.
TEST(ShadowTable, AnObjectThatIsFarAwayDiverges) {
  const std::vector<std::string> believed{"truth.ball.misplaced_mm=[0,0,0]"};
  for (const char* place : {"-12", "-5", "5", "12"}) {
    const trial::Shadow shadow =
        shadowed(probing(), 7, {"truth.ball.misplaced_mm=[0,0," + std::string(place) + "]"}, believed);
    EXPECT_TRUE(shadow.diverges()) << place;
    if (place[0] == '-') {
      EXPECT_THAT(named(shadow), testing::Contains("force gross")) << place;
      EXPECT_EQ(found(shadow, Quantity::stiffness), nullptr) << place;
    }
  }
}

TEST(ShadowTable, ATurnedCameraDiverges) {
  const trial::Shadow shadow = shadowed(carrying(), 7, {"truth.frames.W_C.rotation_deg=[0,0,60]"},
                                        {"truth.frames.W_C.rotation_deg=[0,0,0]"});
  EXPECT_THAT(named(shadow), ElementsAre("tool gross"));
  ASSERT_FALSE(shadow.gross.empty());
  EXPECT_THAT(shadow.gross.front().text, testing::HasSubstr("did not go where the machine carried it"));
}

// The report lists a push of any length, also if the twin feels little: only weight and inertia.
TEST(ShadowTable, APushWhereTheTwinHasNothingDiverges) {
  for (const char* repeats : {"probe.repeats=1", "probe.repeats=2"}) {
    const ShadowedScene scene{"rig_identify", {repeats, "probe.dwell_s=1", "probe.rest_s=1"}};
    const trial::Shadow shadow = shadowed(scene, 7, {}, {"truth.ball.misplaced_mm=[0,0,12]"});
    EXPECT_THAT(named(shadow), testing::Contains("force gross")) << repeats;
    ASSERT_FALSE(shadow.gross.empty());
    EXPECT_THAT(shadow.gross.front().text, testing::HasSubstr("where the twin has nothing")) << repeats;
  }
}

// A tracker that is much noisier than the twin's does not count as a lost tool while little moves.
TEST(ShadowTable, ANoisyTrackerThatSeesLittleMotionIsNoGrossDivergence) {
  const ShadowedScene scene{"tracking",
                            {"travel.dwell_s=3", "travel.ways=both_ways", "travel.stops_mm=[0,0.3]"}};
  const trial::Shadow shadow = shadowed(scene, 7, {"truth.tracker.noise_mm=[0.3,0.3,0.3]"},
                                        {"truth.tracker.noise_mm=[0.019,0.011,0.011]"});
  EXPECT_TRUE(shadow.gross.empty()) << shadow.gross.front().text;
}

// A limit cycle at standstill must show, whatever the machine does on its way.
TEST(ShadowTable, AMachineThatHuntsWhereItStandsHasARest) {
  const auto hunting = [](RecordedTick& frame, double share) {
    if (frame.in.tip.value.velocity.norm() > 1e-3) return;
    const Pose<'R', 'H'> said = frame.in.tip.value.X_RH;
    frame.in.tip.value.X_RH =
        Pose<'R', 'H'>(Quat(said.q()), Vec3(said.p() + Vec3(0.3e-3 * std::sin(2e3 * share), 0.0, 0.0)));
  };
  EXPECT_THAT(named(shadowed_frames(carrying(), 7, hunting)), testing::Contains("machine machine_rest"));
}

// The tool is later than any tracker, and its stamps, too: as over a wire, whose stamps are tied to the
// arrival of packets.
TEST(ShadowTable, AToolThatIsSeenMuchTooLateDiverges) {
  constexpr std::size_t kTicks = 800;
  std::deque<Measurement<TrackedTool>> under_way;
  const auto later = [&under_way](RecordedTick& frame, double) {
    under_way.push_back(frame.in.tool);
    frame.in.tool = {};
    if (under_way.size() <= kTicks) return;
    frame.in.tool = under_way.front();
    under_way.pop_front();
    frame.in.tool.t += from_seconds(1e-3 * static_cast<double>(kTicks));
  };
  const trial::Shadow shadow = shadowed_frames(carrying(), 7, later);
  EXPECT_THAT(named(shadow), testing::Contains("tool gross"));
  ASSERT_FALSE(shadow.gross.empty());
  EXPECT_THAT(shadow.gross.front().text, testing::HasSubstr("no tracker is so late"));
}

// No truth of the twin reaches these bounds: the test alters the record frame by frame.
TEST(ShadowTable, AMachineThatSaysItStandsElsewhereIsNamed) {
  const auto aside = [](RecordedTick& frame, double) {
    const Pose<'R', 'H'> said = frame.in.tip.value.X_RH;
    frame.in.tip.value.X_RH = Pose<'R', 'H'>(Quat(said.q()), Vec3(said.p() + Vec3(0.0, 0.1e-3, 0.0)));
  };
  const trial::Shadow shadow = shadowed_frames(probing(), 7, aside);
  EXPECT_THAT(named(shadow), testing::Contains("machine machine_place y"));
  const trial::Divergence* place = found(shadow, Quantity::machine_place, "y");
  ASSERT_NE(place, nullptr);
  EXPECT_NEAR(place->off.value, 0.1e-3, 5e-6);
}

TEST(ShadowTable, AForceThatComesLaterIsNamed) {
  const auto late = [](RecordedTick& frame, double) { frame.in.wrench.t += from_seconds(3e-3); };
  const trial::Shadow shadow = shadowed_frames(probing(), 7, late);
  EXPECT_THAT(named(shadow), ElementsAre("force force_time"));
  const trial::Divergence* time = found(shadow, Quantity::force_time);
  ASSERT_NE(time, nullptr);
  EXPECT_NEAR(time->off.value, 3e-3, 0.3e-3);
}

TEST(ShadowTable, AMachineThatSpeedsUpOtherwiseHasARest) {
  EXPECT_THAT(named(shadowed(carrying(), 7, {}, {"truth.hexapod.acceleration_m_s2=0.3"})),
              testing::Contains("machine machine_rest"));
}

// The replay does not shake a platform on elastic legs: it places the platform at its reported pose.
TEST(ShadowTable, AMachineOnElasticLegsIsJudgedAsAnyOther) {
  const trial::Shadow shadow = shadowed(probing(), 3, {"truth.hexapod.form=structural"});
  EXPECT_THAT(named(shadow), ElementsAre());
  const trial::Divergence* stiffness = found(shadow, Quantity::stiffness);
  ASSERT_NE(stiffness, nullptr);
  EXPECT_LT(stiffness->off.half, 0.5 * stiffness->bound);
}

// Other seeds of this very set-up: none reaches a bound.
void expect_below_bounds(const ShadowedScene& scene) {
  for (int i = 1; i <= tests::thorough(4, 20); ++i) {
    const std::uint64_t seed = 100 + static_cast<std::uint64_t>(i);
    const trial::Shadow shadow = shadowed(scene, seed);
    EXPECT_FALSE(shadow.found.empty());
    for (const trial::Divergence& one : shadow.found) {
      EXPECT_FALSE(one.diverges()) << scene.name << " " << seed << " " << word_of(one.quantity) << one.axis;
      EXPECT_LT(std::abs(one.off.value), one.bound)
          << scene.name << " " << seed << " " << word_of(one.quantity) << one.axis;
    }
  }
}
TEST(ShadowTable, WhereNothingWasAlteredAProbeStaysBelowItsBounds) { expect_below_bounds(probing()); }
TEST(ShadowTable, WhereNothingWasAlteredACarriedToolStaysBelowItsBounds) { expect_below_bounds(carrying()); }
TEST(ShadowTable, WhereNothingWasAlteredAPressStaysBelowItsBounds) { expect_below_bounds(pressing()); }

}  // namespace
}  // namespace enc::test
