// The passivity controller of the hexapod, in whole runs of the twin.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/unit/trial/measure/controlled_replay.h"
#include "trial/ledger/ledger_measure.h"
#include "trial/measure/passivity_measure.h"
#include "trial/measure/press_measure.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using Set = std::vector<std::string>;
const Set kControlledHexapod{"rig.admittance.passivity=controlled"};

models::Setup loaded(const std::string& scene, Set set, const Set& more = {}) {
  set.insert(set.end(), more.begin(), more.end());
  return models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", "", set);
}

struct Pressed {
  double press = 0.0, release = 0.0, in = 0.0, out = 0.0;  // N, N, J, J
  PassivityFigures controller;
  double surplus = 0.0;  // J, by the truth
  TrialResult result;
};
Pressed pressed_in(const models::Setup& setup, std::uint64_t seed = 1) {
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
  Pressed felt;
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
  const Pressed off = pressed_in(loaded("tennis_ball", {})),
                on = pressed_in(loaded("tennis_ball", kControlledHexapod));
  EXPECT_EQ(on.result.contacts, off.result.contacts);
  EXPECT_NEAR(on.press, off.press, 0.02);
  EXPECT_NEAR(on.release, off.release, 0.02);
  EXPECT_NEAR(on.in, off.in, 0.01 * off.in);
  EXPECT_NEAR(on.out, off.out, 0.01 * off.out);
  EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed";
  EXPECT_LE(on.surplus, 0.1e-3) << "J, true";
  EXPECT_TRUE(std::isnan(off.controller.began)) << "nothing of it is remembered";
}

// Hands that bounce off, come back while the tip returns, and change their tool. Where only the way that is
// left under a push of now is looked at, a hand that meets the tip on its way gets 0.30 mJ (seeds 2 and 21).
TEST(TrialSpare, ASessionGivesOutLessThanATenthOfAMillijoule) {
  for (const std::uint64_t seed : {2U, 13U, 21U}) {
    const Pressed on = pressed_in(loaded("session", {}, kControlledHexapod), seed);
    EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed, seed " << seed;
    EXPECT_LE(on.surplus, 0.1e-3) << "J, true, seed " << seed;
    EXPECT_GT(on.controller.acted, 0.1) << "s";
  }
}

// A hand that comes on while the tip, deep inside of a tooth, is still on its way out: 0.70 and 0.28 mJ where
// nothing is reckoned for that.
TEST(TrialSpare, ALessonGivesOutLessThanATenthOfAMillijoule) {
  for (const std::uint64_t seed : {15U, 27U, 41U}) {
    const Pressed on = pressed_in(loaded("training", {"follow.inset_mm=0.1"}, kControlledHexapod), seed);
    EXPECT_LE(on.surplus, 0.1e-3) << "J, true, seed " << seed;
    EXPECT_GT(on.controller.acted, 0.1) << "s";
  }
}

// Waiting 0.1 mm inside, the tooth is hardly rendered with the controller; at 0.01 mm it is.
TEST(TrialSpare, ALessonFromTheSurfaceIsFelt) {
  const Set near{"follow.inset_mm=0.01"};
  const Pressed off = pressed_in(loaded("training", near), 3),
                on = pressed_in(loaded("training", near, kControlledHexapod), 3);
  EXPECT_LT(on.press, 2.5) << "N, of 10; " << off.press << " without it";
  EXPECT_LT(on.release, 2.5) << "N; " << off.release << " without it";
  EXPECT_GT(on.in, 0.8 * off.in) << "J";
  EXPECT_LE(on.surplus, 0.1e-3) << "J, true";
}

// A tip that is late is 26 mm off its tool: it comes, and does not stand where it was when the hand had come.
TEST(TrialSpare, ATipThatIsLateComesWithTheController) {
  EXPECT_LT(pressed_in(loaded("session", {}, kControlledHexapod), 24).controller.acted, 10.0) << "s";
}

// A wall of 0.03 N/mm, of which the certificate says from 0.106 on.
const Set kSoft{"rig.force.tare=start", "rig.contact.softest_N_per_mm=0",
                "behaviour.spring.stiffness_N_per_mm=0.03", "pusher.hold_s=3", "pusher.repeats=2"};

TEST(TrialSpare, ASoftWallThatSwingsGivesOutNothing) {
  const Pressed on = pressed_in(loaded("stiffness", kSoft, kControlledHexapod));
  EXPECT_LE(on.controller.given, 0.1e-3) << "J, observed";
  EXPECT_LE(on.surplus, 0.1e-3) << "J, true";
  EXPECT_GT(on.controller.acted, 0.1) << "s";
}

// J, by the truth: what a contact gave out more than was put in, at any moment, until the tip is back.
double given_out(const models::Setup& setup, std::uint64_t seed) {
  double given = 0.0, most = 0.0;
  TrialOptions options;
  options.seed = seed;
  options.work = true;
  options.watch = [&](const Glance& glance) {
    const bool on = glance.out.mode == Mode::contact || glance.out.mode == Mode::restore;
    given = on ? given - glance.truth.work.contact : 0.0;
    most = std::max(most, given);
  };
  (void)Trial(setup, options).run();
  return most;
}

// The zero of a sensor is never quite known: what it is off by pays for nothing. 0.4 mJ where a reading below
// zero counts as a pull, or the threshold is not taken off.
TEST(TrialSpare, ASensorThatIsOffPaysForNothing) {
  using Hand = std::pair<const char*, const char*>;
  for (const auto& [hand, damper] : {Hand{"0.7", "4"}, Hand{"2", "8"}}) {
    const std::string stiffness = std::string("stiffness_N_per_mm=") + hand;
    const std::string damping = std::string("damping_Ns_per_m=") + damper;
    models::Setup setup =
        loaded("stiffness",
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

// A hand that is gone pays no debts: the tip comes back all the same, and is there for the next touch.
TEST(TrialSpare, WhatIsOwedEndsWithItsContact) {
  Set set = kSoft;
  for (const char* more : {"pusher.rest_s=25", "pusher.depth_mm=5"}) set.emplace_back(more);
  double held = 0.0, longest = 0.0;  // s, with nobody there
  TrialOptions options;
  options.watch = [&](const Glance& glance) {
    const bool alone = !glance.truth.touching && (glance.out.why & kPassive) != 0;
    held = alone ? held + glance.scene.dt : 0.0;
    longest = std::max(longest, held);
  };
  (void)Trial(loaded("stiffness", set, kControlledHexapod), options).run();
  EXPECT_GT(longest, 0.1) << "s";
  EXPECT_LT(longest, 4.5) << "s";
}

TEST(TrialSpare, ARecordedRunReplaysToTheSameBits) {
  expect_acts_and_replays(loaded("stiffness", kSoft, kControlledHexapod));
}

TEST(TrialSpare, WhereNothingIsRenderedItIsRefused) {
  const auto refused = [&](const models::Setup& setup) {
    try {
      static_cast<void>(prepare(setup.scene, setup.rig));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("not refused");
  };
  EXPECT_EQ(refused(loaded("plane", kControlledHexapod)), "not refused");
  EXPECT_THAT(refused(loaded("tracking", kControlledHexapod)),
              testing::HasSubstr("the scene renders nothing"));
  EXPECT_THAT(refused(loaded("rig_A", kControlledHexapod)), testing::HasSubstr("the scene renders nothing"));
  models::Setup empty = loaded("plane", kControlledHexapod);
  empty.scene.objects.clear();
  EXPECT_THAT(refused(empty), testing::HasSubstr("the scene has no object"));
}

}  // namespace
}  // namespace enc::trial
