#include "trial/identify/shadow/shadow.h"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/trial/identify/shadow/shadow_runs.h"
#include "trial/identify/shadow/channels.h"

namespace enc::test {
namespace {

using testing::HasSubstr;
using trial::Divergence;

Divergence off_by(double value, double half) {
  return {trial::Channel::tool, trial::Quantity::tool_latency, "", {value, half}, 1.0};
}

TEST(ShadowVerdict, FartherThanTheBoundAndThanChance) {
  EXPECT_FALSE(off_by(0.9, 0.1).diverges());
  EXPECT_TRUE(off_by(1.1, 0.1).diverges());
  EXPECT_TRUE(off_by(-1.1, 0.1).diverges());
  EXPECT_FALSE(off_by(1.1, 0.8).diverges());  // an interval that wide is not told from the bound
  EXPECT_TRUE(off_by(1.1, 0.8).vague());
  EXPECT_TRUE(off_by(5.0, 0.8).diverges());
  EXPECT_FALSE(off_by(5.0, 0.8).vague());
  EXPECT_FALSE(off_by(0.0, 0.1).vague());
  EXPECT_TRUE(off_by(kUnset, kUnset).vague());
  EXPECT_FALSE(off_by(kUnset, kUnset).diverges());
}

Stamped<TipSample> tip_at(double t, double x, Health health = Health::ok) {
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
  EXPECT_FALSE(trace.knows(Time(from_seconds(1.2))));  // nobody heard of it for half a second
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
  try {
    (void)shadowed(pressing(), 3, {}, {"truth.tracker.latenzy_ms=4"});
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("did you mean"));
  }
}

// A rig as a laboratory has it: nothing but its calibration says where its camera is. What is real is there.
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

// From here on nobody hears of the machine, which goes on all the same; what it said last stands on.
AlterFrame lost_from(const std::function<bool(const RecordedTick&, double share)>& begins) {
  struct Lost {
    bool is = false;
    Stamped<TipSample> last;
  };
  return [begins, lost = Lost{}](RecordedTick& frame, double share) mutable {
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

// What packets are tied to is when they come: a delay that they all have is not seen in their stamps.
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

// Nothing goes to the machine, and it says where it stands: that is all that registration asks for.
TEST(ShadowUnjudged, ADryRunTellsRegistrationByThePress) {
  const auto dry = [](RecordedTick& frame, double) { frame.in.withheld = true; };
  const trial::Shadow shadow =
      shadowed_frames(pressing(), 7, dry, {"truth.frames.W_C.position_mm=[0,-900,601]"});
  EXPECT_THAT(named(shadow), testing::ElementsAre("tool registration away"));
  EXPECT_EQ(found(shadow, trial::Quantity::machine_time), nullptr);
}

// Nothing is carried, nothing pressed, and nothing moves: it says so, and nothing fails.
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

}  // namespace
}  // namespace enc::test
