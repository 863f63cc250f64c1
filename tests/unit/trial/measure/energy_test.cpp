// Energy in whole runs: the passivity controllers of arm and hexapod, and the energy balance.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/control/scene/scene.h"
#include "core/record/replay.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/runs.h"
#include "trial/ledger/arm_ledger.h"
#include "trial/ledger/ledger.h"
#include "trial/measure/finger_measure.h"
#include "trial/measure/passivity_measure.h"
#include "trial/measure/press_measure.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using test::Set;
using testing::HasSubstr;

// The controller acts, and the record of that run replays to the same bits. `time_s` unset: until the user
// ends.
void expect_acts_and_replays(const models::Setup& setup, double time_s = kUnset) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("controlled.encrec");
  TrialOptions options{.seconds = time_s};
  std::uint32_t why = 0;
  options.watch = [&](const Glance& glance) { why |= glance.out.why; };
  Trial trial(setup, options);
  RecordWriter record(path, models::record_texts(setup), layout_hash(trial.scene()));
  trial.record_to(&record);
  const TrialResult result = trial.run();
  record.close();
  EXPECT_NE(why & kPassive, 0U) << "it acted";
  RecordReader reader(path);
  const ReplayResult again = replay(trial.scene(), reader);
  EXPECT_EQ(again.first_difference, -1) << again.what;
  EXPECT_EQ(again.hash, result.hash);
}

// The passivity controller of an arm, in whole runs of the twin.

const Set kControlled{"rig.arm.passivity=controlled"};
constexpr double kCycle = 2.6e-3;  // J: F v T of one, 8.5 N at 0.3 m/s

models::Setup setup_of(const std::string& scene, Set set = {}, const Set& more = {}) {
  set.insert(set.end(), more.begin(), more.end());
  return test::shipped(scene, set);
}

// Energy of a flat wall from ground truth: the tip's true place and not its encoder reading.
struct TrueEnergy {
  double given = 0.0, most = 0.0;  // J: more out than in, in this contact; and the most
  double height = 0.0, pushed = 0.0;
  bool on = false;

  void see(const Glance& glance) {
    const bool touched = glance.out.mode == Mode::contact;
    given = on && touched ? given + pushed * (glance.truth.tip.e().z() - height) : 0.0;
    on = touched;
    most = std::max(most, given);
    height = glance.truth.tip.e().z();
    pushed = -glance.out.force_unfiltered.e().z();
  }
};

struct PassivityResult {
  double slope = kUnset, peak = 0.0, step = 0.0, given = 0.0;
  PassivityFigures controller;
  TrialResult result;
};
PassivityResult felt_in(const models::Setup& setup, std::uint64_t seed = 1) {
  FingerMeasure fingers;
  PassivityMeasure passivity;
  TrueEnergy energy;
  TrialOptions options{.seed = seed};
  options.watch = [&](const Glance& glance) {
    fingers.see(glance);
    passivity.see(glance);
    energy.see(glance);
  };
  PassivityResult felt;
  felt.result = Trial(setup, options).run();
  felt.slope = fingers.fit().slope();
  for (const FingerEncounter& m : fingers.meetings()) {
    felt.peak = std::max(felt.peak, m.peak_force);
    felt.step = std::max(felt.step, m.greatest_step);
  }
  felt.given = energy.most;
  felt.controller = passivity.worst();
  return felt;
}

// The greatest step is that of one tick of an impact, which scatters by 0.1 N: its mean over seeds is judged.
TEST(TrialPassivity, TheShippedWallGivesOutNothingAndFeelsAsItDid) {
  constexpr int kSeeds = 4;
  double steps = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const PassivityResult off = felt_in(setup_of("wall", {}), seed),
                          on = felt_in(setup_of("wall", kControlled), seed);
    steps += on.step - off.step;
    EXPECT_EQ(on.result.contacts, off.result.contacts) << seed;
    EXPECT_NEAR(on.slope, off.slope, 1e-3 * off.slope) << seed;
    EXPECT_NEAR(on.peak, off.peak, 0.02) << seed;
    EXPECT_LE(on.given, 0.1e-3) << "J, true";
    EXPECT_LE(off.given, 0.1e-3) << "J, true: at the shipped stiffness nothing has to be controlled";
    EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed";
    EXPECT_LE(on.controller.dissipated, 0.1e-3) << "J";
    EXPECT_TRUE(std::isnan(off.controller.began)) << "nothing of it is remembered";
  }
  EXPECT_NEAR(steps / kSeeds, 0.0, 0.1);
}

// This wall is useless to a hand, as its law rings. The controller withholds the energy for the ringing.
TEST(TrialPassivity, AWallThatRingsGivesOutLittle) {
  const Set stiff{"behaviour.phantom_wall.stiffness_N_per_mm=5", "user.depth_mm=1"};
  const PassivityResult off = felt_in(setup_of("wall", stiff)),
                        on = felt_in(setup_of("wall", stiff, kControlled));
  EXPECT_GT(off.step, 2.5);
  EXPECT_GT(off.given, 50e-3);
  EXPECT_LT(on.given, 0.1 * off.given) << "what is within a count is not seen";
  EXPECT_LE(on.controller.given, kCycle);
  EXPECT_GT(on.controller.acted, 0.1);
}

// Every object, over seeds. A finger that strikes a moving prop pushes it on in a way that no law foresees:
// that gives 0.14 mJ at most (16 seeds), and stays within F v T of one cycle.
TEST(TrialPassivity, NoShippedSceneGivesOutMoreThanATenthOfAMillijoule) {
  for (const char* scene : {"wall", "button", "keypad", "hit_ball", "reaching"})
    for (int seed = 1; seed <= tests::thorough(1, 4); ++seed) {
      const PassivityFigures of =
          felt_in(setup_of(scene, kControlled), static_cast<std::uint64_t>(seed)).controller;
      EXPECT_LE(of.given, std::string(scene) == "reaching" ? kCycle : 0.1e-3) << scene << ", seed " << seed;
      EXPECT_GE(of.dissipated, 0.0) << scene;
    }
}

// A finger that is lost while it presses, and found again deep inside, gains no energy at any stiffness. At
// 2.7 times the shipped one it gains 0.11 to 0.30 mJ over eight seeds. It would be 17 to 25 if a contact
// began with the spring's whole energy.
TEST(TrialPassivity, AContactThatIsFoundAgainIsNoGift) {
  const Set lost{"truth.tracker.blackout_at_s=2.5", "truth.tracker.blackout_for_s=0.6"};
  const Set stiff{"behaviour.phantom_wall.stiffness_N_per_mm=1.6", lost[0], lost[1]};
  for (int seed = 1; seed <= tests::thorough(2, 5); ++seed) {
    EXPECT_LE(felt_in(setup_of("wall", lost, kControlled), static_cast<std::uint64_t>(seed)).controller.given,
              0.1e-3)
        << seed;
    EXPECT_LE(
        felt_in(setup_of("wall", stiff, kControlled), static_cast<std::uint64_t>(seed)).controller.given,
        0.4e-3)
        << seed;
  }
}

TEST(TrialPassivity, ARecordedRunReplaysToTheSameBits) {
  expect_acts_and_replays(
      setup_of("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=5", "user.depth_mm=1"}, kControlled), 6.0);
}

TEST(TrialPassivity, WhereNothingIsRenderedItIsRefused) {
  models::Setup setup = setup_of("wall", {"behaviour.phantom_wall.interaction.kind=passive"});
  EXPECT_NO_THROW(static_cast<void>(prepare_arm(setup.scene, setup.rig)));
  setup.rig.arm.passivity = PassivityForm::controlled;
  const auto refused = [&] { return test::refusal([&] { (void)prepare_arm(setup.scene, setup.rig); }); };
  EXPECT_THAT(refused(), HasSubstr("every object of the scene is a real one"));
  setup.scene.objects.clear();
  EXPECT_THAT(refused(), HasSubstr("the scene has no object"));
}

// The passivity controller of the hexapod, in whole runs of the twin.

const Set kControlledHexapod{"rig.admittance.passivity=controlled"};

struct PressEnergy {
  double press = 0.0, release = 0.0, in = 0.0, out = 0.0;  // N, N, J, J
  PassivityFigures controller;
  double surplus = 0.0;  // J, by the truth
  TrialResult result;
};
PressEnergy pressed_in(const models::Setup& setup, std::uint64_t seed = 1) {
  PressMeasure presses(setup);
  PassivityMeasure passivity;
  TrialOptions options;
  LedgerMeasure ledger(setup, options);
  options.seed = seed;
  options.watch = [&](const Glance& glance) {
    presses.see(glance);
    passivity.see(glance);
    ledger.see(glance);
  };
  PressEnergy felt;
  Trial trial(setup, options);
  felt.result = trial.run();
  felt.surplus = worst_surplus(ledger.contacts());
  felt.press = presses.rmse_press();
  felt.release = presses.rmse_release();
  felt.in = presses.energy_in();
  felt.out = presses.energy_out();
  felt.controller = passivity.worst();
  return felt;
}

TEST(TrialSpare, TheTennisBallFeelsAsItDid) {
  const PressEnergy off = pressed_in(setup_of("tennis_ball", {})),
                    on = pressed_in(setup_of("tennis_ball", kControlledHexapod));
  EXPECT_EQ(on.result.contacts, off.result.contacts);
  EXPECT_NEAR(on.press, off.press, 0.02);
  EXPECT_NEAR(on.release, off.release, 0.02);
  EXPECT_NEAR(on.in, off.in, 0.01 * off.in);
  EXPECT_NEAR(on.out, off.out, 0.01 * off.out);
  EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed";
  EXPECT_LE(on.surplus, 0.1e-3) << "J, true";
  EXPECT_TRUE(std::isnan(off.controller.began)) << "nothing of it is remembered";
}

// Hands that bounce off, return while the tip returns, and change their tool. A hand that meets the tip on
// its way gets 0.30 mJ (seeds 2 and 21) if the controller only checks the way left under the present push.
TEST(TrialSpare, ASessionGivesOutLessThanATenthOfAMillijoule) {
  for (const std::uint64_t seed : {2U, 13U, 21U}) {
    const PressEnergy on = pressed_in(setup_of("session", {}, kControlledHexapod), seed);
    EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed, seed " << seed;
    EXPECT_LE(on.surplus, 0.1e-3) << "J, true, seed " << seed;
    EXPECT_GT(on.controller.acted, 0.1) << "s";
  }
}

// A hand that comes on while the tip, deep inside a tooth, is still on its way out: 0.70 and 0.28 mJ if the
// controller ignores that.
TEST(TrialSpare, ALessonGivesOutLessThanATenthOfAMillijoule) {
  for (const std::uint64_t seed : {15U, 27U, 41U}) {
    const PressEnergy on =
        pressed_in(setup_of("training", {"follow.inset_mm=0.1"}, kControlledHexapod), seed);
    EXPECT_LE(on.surplus, 0.1e-3) << "J, true, seed " << seed;
    EXPECT_GT(on.controller.acted, 0.1) << "s";
  }
}

// The controller hardly renders the tooth if the tip waits 0.1 mm inside; at 0.01 mm it does.
TEST(TrialSpare, ALessonFromTheSurfaceIsFelt) {
  const Set near{"follow.inset_mm=0.01"};
  const PressEnergy off = pressed_in(setup_of("training", near), 3),
                    on = pressed_in(setup_of("training", near, kControlledHexapod), 3);
  EXPECT_LT(on.press, 2.5) << "N, of 10; " << off.press << " without it";
  EXPECT_LT(on.release, 2.5) << "N; " << off.release << " without it";
  EXPECT_GT(on.in, 0.8 * off.in) << "J";
  EXPECT_LE(on.surplus, 0.1e-3) << "J, true";
}

// A late tip is 26 mm off its tool: it comes, and does not wait where it was when the hand arrived.
TEST(TrialSpare, ATipThatIsLateComesWithTheController) {
  EXPECT_LT(pressed_in(setup_of("session", {}, kControlledHexapod), 24).controller.acted, 10.0) << "s";
}

// A wall of 0.03 N/mm; the certificate asks for 0.106 or more.
const Set kSoft{"rig.force.tare=start", "rig.contact.softest_N_per_mm=0",
                "behaviour.spring.stiffness_N_per_mm=0.03", "pusher.hold_s=3", "pusher.repeats=2"};

TEST(TrialSpare, ASoftWallThatSwingsGivesOutNothing) {
  const PressEnergy on = pressed_in(setup_of("stiffness", kSoft, kControlledHexapod));
  EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed";
  EXPECT_LE(on.surplus, 0.1e-3) << "J, true";
  EXPECT_GT(on.controller.acted, 0.1) << "s";
}

// J, ground truth: most net energy that a contact gave out at any moment, until the tip is back.
double given_out(const models::Setup& setup, std::uint64_t seed) {
  double given = 0.0, most = 0.0;
  TrialOptions options{.seed = seed, .work = true};
  options.watch = [&](const Glance& glance) {
    const bool on = glance.out.mode == Mode::contact || glance.out.mode == Mode::restore;
    given = on ? given - glance.truth.work.contact : 0.0;
    most = std::max(most, given);
  };
  (void)Trial(setup, options).run();
  return most;
}

// The zero of a sensor is never exact, and its error must not add energy. It is 0.4 mJ if a reading below
// zero counts as a pull, or if the threshold is not subtracted.
TEST(TrialSpare, ASensorThatIsOffPaysForNothing) {
  using Hand = std::pair<const char*, const char*>;
  for (const auto& [hand, damper] : {Hand{"0.7", "4"}, Hand{"2", "8"}}) {
    const std::string stiffness = std::string("stiffness_N_per_mm=") + hand;
    const std::string damping = std::string("damping_Ns_per_m=") + damper;
    models::Setup setup =
        setup_of("stiffness",
                 {"rig.force.tare=start", "rig.contact.softest_N_per_mm=0", "truth.pusher." + stiffness,
                  "rig.contact.hand_" + stiffness, "truth.pusher." + damping, "rig.contact.hand_" + damping,
                  "pusher.hold_s=6", "pusher.repeats=12"},
                 kControlledHexapod);
    for (BehaviourSpec& one : setup.scene.behaviours)
      one.curves.press = one.curves.release = {one.stiffness = 100.0};
    for (const std::uint64_t seed : {1U, 5U})
      EXPECT_LE(given_out(setup, seed), 0.1e-3) << "J, true, hand of " << hand << " N/mm, seed " << seed;
  }
}

// A deficit ends with its contact: after the hand has gone, the tip comes back and is ready for the next
// touch.
TEST(TrialSpare, WhatIsOwedEndsWithItsContact) {
  Set set = kSoft;
  for (const char* more : {"pusher.rest_s=25", "pusher.depth_mm=5"}) set.emplace_back(more);
  double held = 0.0, longest = 0.0;  // s, without a hand
  TrialOptions options;
  options.watch = [&](const Glance& glance) {
    const bool alone = !glance.truth.touching && (glance.out.why & kPassive) != 0;
    held = alone ? held + glance.scene.dt : 0.0;
    longest = std::max(longest, held);
  };
  (void)Trial(setup_of("stiffness", set, kControlledHexapod), options).run();
  EXPECT_GT(longest, 0.1) << "s";
  EXPECT_LT(longest, 4.5) << "s";
}

TEST(TrialSpare, ARecordedRunReplaysToTheSameBits) {
  expect_acts_and_replays(setup_of("stiffness", kSoft, kControlledHexapod));
}

TEST(TrialSpare, WhereNothingIsRenderedItIsRefused) {
  const auto refused = [&](const models::Setup& setup) {
    return test::refusal([&] { (void)prepare(setup.scene, setup.rig); });
  };
  EXPECT_EQ(refused(setup_of("plane", kControlledHexapod)), "");
  EXPECT_THAT(refused(setup_of("tracking", kControlledHexapod)), HasSubstr("the scene renders nothing"));
  EXPECT_THAT(refused(setup_of("rig_A", kControlledHexapod)), HasSubstr("the scene renders nothing"));
  models::Setup empty = setup_of("plane", kControlledHexapod);
  empty.scene.objects.clear();
  EXPECT_THAT(refused(empty), HasSubstr("the scene has no object"));
}

// The energy balance: terms that are known beforehand, and whole runs of the twin.

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
  LawAt law{.live = true, .stiffness = 300.0, .damping = 10.0};
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

// The energy stored in a button is the integral of its force along the way through its trigger and its
// bottom.
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
  ContactLedger one{.hand = 5e-3, .carried = 1e-3, .spring = 2e-3, .joints = 4.5e-3, .delay = 0.5e-3};
  EXPECT_NEAR(one.closure(), 0.0, 1e-12);
  one.delay = -one.delay;
  EXPECT_NEAR(one.left_over(), -1e-3, 1e-12);
  EXPECT_NEAR(one.closure(), 0.2, 1e-12);
  EXPECT_EQ(ContactLedger{}.closure(), 0.0);
}

// A button is pressed: the target stands, so the balance has no transport term; a machine that pushes as
// commanded has no limits. All terms add up, for any hand.
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

// Both sides are measured separately: a wrong truth opens the balance.
TEST(Ledger, IsRedWhereAPartIsWrong) {
  const models::Setup hit = setup_of("hit_ball");
  models::Setup heavier = hit;
  heavier.twin.arm.mass_scale = 1.5;  // the arm flies on after it has released the ball
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
    one.joints = 0.0;  // they do a quarter of the work
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

// A plane has one curve for press and release: it takes nothing, also if the tip waited inside it.
TEST(Ledger, OfALosslessPlaneTakesNothing) {
  for (const char* set :
       {"follow.inset_mm=0.1", "follow.inset_mm=0.5", "follow.inset_mm=1", "rig.force.threshold_N=0.5"}) {
    const std::vector<ContactLedger> all = ledger_of(setup_of("plane", {set}), 1, 25.0);
    ASSERT_FALSE(all.empty());
    for (const ContactLedger& one : all) EXPECT_NEAR(one.law, 0.0, 0.02e-3 + 0.02 * one.largest()) << set;
  }
}

double surplus_of(const std::string& scene, const Set& set, double time_s, std::uint64_t seed = 1) {
  return worst_surplus(ledger_of(setup_of(scene, set), seed, time_s));
}

// Net energy out: nothing from a wall within its bound under a sliding finger, and much from one beyond it,
// along the normal and across. The controller reduces that of a hexapod's soft plane greatly.
TEST(Ledger, TellsWhatCameOutBeyondWhatWasPutIn) {
  EXPECT_LT(surplus_of("wall", {}, 12.0), 0.02e-3);
  EXPECT_GT(surplus_of("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=5"}, 12.0), 10e-3);
  const std::string form = "rig.admittance.passivity=";
  EXPECT_LT(surplus_of("session", {form + "controlled"}, 20.0), 0.1e-3);
  EXPECT_GT(surplus_of("session", {form + "none"}, 20.0), 0.3e-3);
}

// A prop that is met on its way. Its law gives 0.21 mJ to the machine's own motion before the touch, and the
// controller does not act there. It would be 1.8 mJ if the controller took from the push that sends the prop.
TEST(Ledger, OfAPropThatIsMetOnItsWay) {
  EXPECT_LT(surplus_of("reaching", {}, 46.1, 19), 0.1e-3);
  EXPECT_LT(surplus_of("reaching", {"rig.arm.passivity=controlled"}, 27.0, 12), 0.1e-3);
}

// The controller's account goes on while a pressed prop leaps because the finger slides away under it.
TEST(Ledger, OfAPropThatLeapsUnderItsFinger) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const models::Setup setup =
        setup_of("wall", {"rig.arm.passivity=controlled", "behaviour.phantom_wall.stiffness_N_per_mm=2.4",
                          "user.slide_mm=60", "user.slide_mm_s=60", "user.hold_s=2"});
    TrialOptions options{.seed = seed, .seconds = 20.0};
    int leaps = 0, counted = 0;
    options.watch = [&](const Glance& glance) {
      const auto& memory = recall<ImpedanceState>(*glance.state);
      const bool pressed = glance.out.mode == Mode::contact && glance.truth.contact_force.norm() > 0.5;
      if (!pressed || !memory.passivity.pressed || memory.aim.caught_up) return;
      ++leaps;
      counted += memory.passivity.energy.on ? 1 : 0;
    };
    Trial trial(setup, options);
    (void)trial.run();
    EXPECT_GT(leaps, 20) << seed;
    EXPECT_GT(counted, 0.9 * leaps) << seed << ' ' << leaps;
  }
}

// A hand that pushes a tip past the known depth of its object: the balance also counts the energy stored
// there.
TEST(Ledger, OfATooStiffToothTakesNothing) {
  for (const ContactLedger& one : ledger_of(setup_of("training"), 5, 60.0))
    EXPECT_GT(one.law, -0.05 * one.largest() - 0.05e-3) << one.contact;
}

// The closure of the balance does not show the parts of the hexapod's generated energy, which are known here.
// The filter of 5 Hz is late; counts and noise of a closed path cancel; there is no limit.
TEST(Ledger, OfATennisBallNamesWhatIsLate) {
  const auto first = [](const Set& set) { return ledger_of(setup_of("tennis_ball", set), 1, 20.0).front(); };
  const ContactLedger one = first({}), late = first({"rig.force.filter_hz=2.5"});
  EXPECT_LT(one.delay, -1e-3);
  EXPECT_LT(std::abs(one.quantisation), 0.02 * std::abs(one.delay));
  EXPECT_LT(std::abs(one.sampling), 0.05 * std::abs(one.delay));
  EXPECT_LT(std::abs(one.limits), 0.1 * std::abs(one.delay));
  EXPECT_LT(late.delay, 1.3 * one.delay);
  EXPECT_NEAR(late.limits, one.limits, 0.05e-3);
  EXPECT_NEAR(late.law, one.law, 0.02 * one.law) << "what the ball takes is the same";
}

// The balance only observes: a run is the same to the bit with and without it, and without a request it
// counts nothing.
TEST(Ledger, LeavesTheRunAlone) {
  for (const char* scene : {"keypad", "tennis_ball"}) {
    const models::Setup setup = setup_of(scene);
    std::array<std::uint64_t, 2> hashes{};
    for (const bool counted : {false, true}) {
      TrialOptions options{.seconds = 6.0, .work = counted};
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
