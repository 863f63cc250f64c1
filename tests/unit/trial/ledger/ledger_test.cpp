// The energy ledger: terms that are known beforehand, and whole runs of the twin.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/ledger/arm_ledger.h"
#include "trial/ledger/ledger_measure.h"

namespace enc::trial {
namespace {

models::Setup setup_of(const std::string& scene, const std::vector<std::string>& set = {}) {
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "", set);
}

std::vector<ContactLedger> ledger_of(const models::Setup& setup, std::uint64_t seed, double time_s) {
  TrialOptions options;
  LedgerMeasure measure(setup, options);
  options.seed = seed;
  options.seconds = time_s;
  options.watch = [&](const Glance& glance) { measure.see(glance); };
  Trial trial(setup, options);
  (void)trial.run();
  return measure.contacts();
}

LawAt free_tip() {
  LawAt law;
  law.live = true;
  law.stiffness = 300.0;
  law.damping = 10.0;
  return law;
}

// 300 N/m by 2 mm along and 1 mm across: 0.75 mJ; 10 N s/m at 0.1 m/s: 0.1 W.
TEST(ArmLaw, OfAFreeTipIsASpringAndADamper) {
  const LawAt law = free_tip();
  const TipAt tip{{1e-3, 0, -2e-3}, {0, 0, -0.1}};
  EXPECT_NEAR(stored(law, tip), 0.5 * 300.0 * 5e-6, 1e-15);
  EXPECT_NEAR(damped(law, tip), 0.1, 1e-15);
  EXPECT_TRUE(ideal_force(law, tip).isApprox(Vec3(-0.3, 0, 0.6 + 1.0)));
}

// What is stored in a button is the integral of its force: along the way through its trigger and its bottom.
TEST(ArmLaw, StoresInAButtonWhatItsForceTakes) {
  const models::Setup setup = setup_of("button");
  const Trial trial(setup, {});
  const Object& button = trial.scene().objects.front();
  ASSERT_EQ(button.interaction.kind, Interaction::click);
  LawAt law = free_tip();
  law.felt = true;
  law.object = &button;
  for (int i = 0; i < 20; ++i) {
    const double depth = 0.1e-3 + 0.3e-3 * i;
    constexpr double kStep = 1e-6;
    const auto at = [](double z) { return TipAt{{0, 0, -z}, Vec3::Zero()}; };
    const double slope = (stored(law, at(depth + kStep)) - stored(law, at(depth - kStep))) / (2.0 * kStep);
    EXPECT_NEAR(slope, ideal_force(law, at(depth)).z(), 1e-4) << depth;
  }
}

TEST(Ledger, OpensByWhatIsLeftOut) {
  ContactLedger one;
  one.hand = 5e-3;
  one.carried = 1e-3;
  one.delay = 0.5e-3;
  one.spring = 2e-3;
  one.joints = 4.5e-3;
  EXPECT_NEAR(one.closure(), 0.0, 1e-12);
  one.delay = -one.delay;
  EXPECT_NEAR(one.left_over(), -1e-3, 1e-12);
  EXPECT_NEAR(one.closure(), 0.2, 1e-12);
  EXPECT_EQ(ContactLedger{}.closure(), 0.0);
}

// A button is pressed: the target stands, so nothing is carried; a machine that pushes what it is asked for
// has no limits; and all of it adds up, whoever presses.
TEST(Ledger, OfAButtonCloses) {
  for (int i = 1; i <= tests::thorough(1, 4); ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const std::vector<ContactLedger> all = ledger_of(setup_of("keypad"), seed, 6.0);
    ASSERT_FALSE(all.empty());
    for (const ContactLedger& one : all) {
      EXPECT_LT(one.closure(), 0.01) << seed << ' ' << one.left_over();
      EXPECT_GT(one.hand, 0.5e-3);
      EXPECT_GT(one.delay, 0.0);
      EXPECT_NEAR(one.limits, 0.0, 1e-9);
      EXPECT_NEAR(one.carried, 0.0, 0.01 * one.hand);
    }
  }
}

// Both sides are measured apart: a truth that is told wrong opens it.
TEST(Ledger, IsRedWhereAPartIsWrong) {
  const models::Setup hit = setup_of("hit_ball");
  models::Setup heavier = hit;
  heavier.twin.arm.mass_scale = 1.5;  // the arm flies on when it has let go of the ball
  TrialOptions options;
  LedgerMeasure measure(heavier, options);
  options.seconds = 3.0;
  options.watch = [&](const Glance& glance) { measure.see(glance); };
  Trial trial(hit, options);
  (void)trial.run();
  ASSERT_FALSE(measure.contacts().empty());
  for (const ContactLedger& one : measure.contacts()) EXPECT_GT(one.closure(), 0.05);
  const models::Setup setup = setup_of("keypad");
  for (ContactLedger one : ledger_of(setup, 1, 6.0)) {
    one.joints = 0.0;  // a quarter of the work is theirs
    EXPECT_GT(one.closure(), 0.1);
  }
}

TEST(Ledger, OfATennisBallCloses) {
  for (const std::uint64_t seed : {1, 2}) {
    const std::vector<ContactLedger> all = ledger_of(setup_of("tennis_ball"), seed, 25.0);
    ASSERT_FALSE(all.empty());
    for (const ContactLedger& one : all) EXPECT_LT(one.closure(), 0.01) << seed << ' ' << one.left_over();
  }
}

// A plane presses and releases alike: it takes nothing, also where the tip waited inside it.
TEST(Ledger, OfALosslessPlaneTakesNothing) {
  for (const char* set :
       {"follow.inset_mm=0.1", "follow.inset_mm=0.5", "follow.inset_mm=1", "rig.force.threshold_N=0.5"}) {
    const std::vector<ContactLedger> all = ledger_of(setup_of("plane", {set}), 1, 25.0);
    ASSERT_FALSE(all.empty());
    for (const ContactLedger& one : all) EXPECT_NEAR(one.law, 0.0, 0.02e-3 + 0.02 * one.largest()) << set;
  }
}

double surplus_of(const std::string& scene, const std::vector<std::string>& set, double time_s,
                  std::uint64_t seed = 1) {
  return worst_surplus(ledger_of(setup_of(scene, set), seed, time_s));
}

// Out beyond what was put in: nothing of a wall within its bound, over which a finger slides, and much of one
// beyond it, along the normal and across alike; of a soft plane that a hexapod renders, much less with the
// controller.
TEST(Ledger, TellsWhatCameOutBeyondWhatWasPutIn) {
  EXPECT_LT(surplus_of("wall", {}, 12.0), 0.02e-3);
  EXPECT_GT(surplus_of("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=5"}, 12.0), 10e-3);
  const std::string form = "rig.admittance.passivity=";
  EXPECT_LT(surplus_of("session", {form + "controlled"}, 20.0), 0.1e-3);
  EXPECT_GT(surplus_of("session", {form + "none"}, 20.0), 0.3e-3);
}

// A prop that is met on its way: what its law gives to the machine's own motion before the touch is nobody's
// (0.21 mJ), and there the controller stands aside (1.8 mJ where it takes from the push that sends the prop).
TEST(Ledger, OfAPropThatIsMetOnItsWay) {
  EXPECT_LT(surplus_of("reaching", {}, 46.1, 19), 0.1e-3);
  EXPECT_LT(surplus_of("reaching", {"rig.arm.passivity=controlled"}, 27.0, 12), 0.1e-3);
}

// A prop that is pressed, and leaps because the finger slides away under it, is still looked after: without
// that this hand gets 172 mJ. Others get as much sideways, where nothing is controlled (reference/stability).
TEST(Ledger, OfAPropThatLeapsUnderItsFinger) {
  EXPECT_LT(surplus_of("wall",
                       {"rig.arm.passivity=controlled", "behaviour.phantom_wall.stiffness_N_per_mm=2.4",
                        "user.slide_mm=60", "user.slide_mm_s=60", "user.hold_s=2"},
                       60.0),
            1e-3);
}

// A hand that pushes a tip past the depth that its object is known to: what is stored there is counted, too.
TEST(Ledger, OfATooStiffToothTakesNothing) {
  for (const ContactLedger& one : ledger_of(setup_of("training"), 5, 60.0))
    EXPECT_GT(one.law, -0.05 * one.largest() - 0.05e-3) << one.contact;
}

// Closure does not see how the hexapod's generated energy is shared out: its parts are known here. A filter
// of 5 Hz is what is late; counts and noise of a closed way cancel; nothing is limited.
TEST(Ledger, OfATennisBallNamesWhatIsLate) {
  const auto first = [](const std::vector<std::string>& set) {
    return ledger_of(setup_of("tennis_ball", set), 1, 20.0).front();
  };
  const ContactLedger one = first({}), late = first({"rig.force.filter_hz=2.5"});
  EXPECT_LT(one.delay, -1e-3);
  EXPECT_LT(std::abs(one.quantisation), 0.02 * std::abs(one.delay));
  EXPECT_LT(std::abs(one.sampling), 0.05 * std::abs(one.delay));
  EXPECT_LT(std::abs(one.limits), 0.1 * std::abs(one.delay));
  EXPECT_LT(late.delay, 1.3 * one.delay);
  EXPECT_NEAR(late.limits, one.limits, 0.05e-3);
  EXPECT_NEAR(late.law, one.law, 0.02 * one.law) << "what the ball takes is the same";
}

// It looks on: a run is the same to the bit whether its work is counted or not, and counts none unasked.
TEST(Ledger, LeavesTheRunAlone) {
  for (const char* scene : {"keypad", "tennis_ball"}) {
    const models::Setup setup = setup_of(scene);
    std::array<std::uint64_t, 2> hashes{};
    for (const bool counted : {false, true}) {
      TrialOptions options;
      options.seconds = 6.0;
      options.work = counted;
      double most = 0.0;
      options.watch = [&](const Glance& glance) {
        most = std::max(most, std::abs(glance.truth.work.contact));
      };
      Trial trial(setup, options);
      hashes[counted ? 1 : 0] = trial.run().hash;
      EXPECT_EQ(most > 0.0, counted) << scene;
    }
    EXPECT_EQ(hashes[0], hashes[1]) << scene;
  }
}

TEST(Ledger, SaysNothingWhereNothingIsRendered) { EXPECT_TRUE(ledger_of(setup_of("rig_A"), 1, 5.0).empty()); }

}  // namespace
}  // namespace enc::trial
