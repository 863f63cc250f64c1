// The certificate of each object of a scene: the shipped ones, and what is stiffer or softer than may be.
#include "trial/certificates.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/unit/trial/runs.h"

namespace enc::trial {
namespace {

using certificate::Class;

std::vector<Certified> of(const std::string& name, const std::vector<std::string>& set = {}) {
  const models::Setup setup = models::load(tests::source_dir() + "/models/scenes/" + name + ".toml", "", set);
  return certificates_of(setup, prepare_setup(setup));
}

TEST(Certificates, OfTheShippedScenes) {
  for (const char* name : {"wall", "button", "keypad", "drum", "tiles", "plane", "tennis_ball", "session"})
    for (const Certified& one : of(name)) {
      EXPECT_FALSE(one.beyond()) << name << ": " << name_of(one) << " " << class_text(one);
      EXPECT_FALSE(one.unknown()) << name << ": " << name_of(one) << " " << class_text(one);
    }
  EXPECT_EQ(of("wall").size(), 2U);  // and the tip that nobody touches
  EXPECT_EQ(of("tennis_ball").size(), 1U);
  EXPECT_TRUE(of("rig_A").empty()) << "a real ball is pressed";
}

// The wall is stable alone, and no device of 0.02 N s/m renders it passively [Colgate and Schenkel].
TEST(Certificates, TheWallOfThePaperIsNotPassive) {
  const Certified wall = of("wall").back();
  EXPECT_EQ(wall.certificate.verdict, Class::alone);
  EXPECT_EQ(wall.asked, 600.0);
  EXPECT_LT(certificate::row_of(wall.certificate, "colgate_schenkel").margin, 0.5);
  EXPECT_GT(certificate::row_of(wall.certificate, "exact_with_hand").margin, 1.0);
}

TEST(Certificates, WhatIsTooStiffOrTooSoftIsBeyond) {
  const double most = certificate::row_of(of("wall").back().certificate, "exact_with_hand").bound;
  const auto wall = [](double stiffness) {
    return of("wall", {"behaviour.phantom_wall.stiffness_N_per_mm=" + std::to_string(1e-3 * stiffness)})
        .back();
  };
  EXPECT_FALSE(wall(0.98 * most).beyond());
  EXPECT_TRUE(wall(1.02 * most).beyond());
  const std::vector<Certified> soft =
      of("stiffness", {"behaviour.spring.stiffness_N_per_mm=0.15", "truth.pusher.stiffness_N_per_mm=0.7",
                       "truth.pusher.damping_Ns_per_m=4"});
  ASSERT_EQ(soft.size(), 1U);
  EXPECT_EQ(soft[0].certificate.verdict, Class::local);
  EXPECT_GT(soft[0].swing, 1e-3);
}

// The hand of the scene presses within two seconds; a person whom a real device sees does as they like.
TEST(Certificates, APersonAtARealDevicePushesQuickly) {
  const auto ramp = [](const std::vector<std::string>& set) { return of("tennis_ball", set).back().ramp; };
  EXPECT_EQ(ramp({}), 2.0);
  for (const char* role : {"force", "tracker"})
    EXPECT_EQ(ramp({std::string("rig.") + role + ".driver=\"sample\""}), 0.5) << role;
  EXPECT_EQ(ramp({"rig.manipulator.driver=\"sample\""}), 2.0);
  EXPECT_EQ(ramp({"rig.force.driver=\"sample\"", "user.press_s=0.2"}), 0.2);
}

// A search that ended at its last step has no bound, and says so; what swings itself neither.
TEST(Certificates, ALargeSignalBoundIsOneSidedWhereTheSearchEnds) {
  using Side = certificate::Row::Side;
  const auto row = [](const std::string& name, const std::vector<std::string>& set) {
    const models::Setup setup =
        models::load(tests::source_dir() + "/models/scenes/" + name + ".toml", "", set);
    return certificate::row_of(certificates_of(setup, prepare_setup(setup), true).back().certificate,
                               "large_signal");
  };
  const certificate::Row stiff = row("stiffness", {"behaviour.spring.stiffness_N_per_mm=2"});
  EXPECT_EQ(stiff.side, Side::below);
  EXPECT_NEAR(stiff.low, 1000.0, 1e-6);
  const certificate::Row gum = row("training", {});
  EXPECT_EQ(gum.side, Side::at);
  EXPECT_LT(gum.low, 500.0);
  const certificate::Row swings =
      row("stiffness", {"behaviour.spring.stiffness_N_per_mm=0.15", "truth.pusher.stiffness_N_per_mm=0.7",
                        "truth.pusher.damping_Ns_per_m=4"});
  EXPECT_EQ(swings.side, Side::above);
  EXPECT_NEAR(swings.low, 150.0, 1e-6);
}

// So many copies of the wall's object, each elsewhere on the arm's plane.
models::Setup tiled(std::size_t count) {
  models::Setup setup = models::load(tests::source_dir() + "/models/scenes/keypad.toml", "", {});
  const ObjectSpec key = setup.scene.objects.front();
  setup.scene.objects.assign(count, key);
  for (std::size_t i = 0; i < count; ++i) {
    ObjectSpec& one = setup.scene.objects[i];
    one.name = "k" + std::to_string(i);
    const std::size_t row = i / 10;
    const auto column = static_cast<double>(i % 10), line = static_cast<double>(row);
    one.position.x() = 4e-3 * (column - 4.5);
    one.position.y() = 2e-3 * (line - 0.05 * static_cast<double>(count));
  }
  setup.scene.user.reset();
  return setup;
}

std::ptrdiff_t whole_ones(const std::vector<Certified>& all) {
  return std::count_if(all.begin(), all.end(), [](const Certified& one) { return one.like.empty(); });
}

// A whole certificate takes a millisecond.
TEST(Certificates, ManyObjectsThatAreAlikeShareTheWorst) {
  const models::Setup many = tiled(200);
  const std::vector<Certified> found = certificates_of(many, prepare_setup(many));
  ASSERT_EQ(found.size(), 201U);
  EXPECT_LE(whole_ones(found), 4) << "the free tip, and one of each class";
  const Certified& last = found.back();
  const double shared = certificate::row_of(last.certificate, "exact_with_hand").bound;
  for (const std::size_t i : {0U, 57U, 111U, 199U}) {
    models::Setup single = many;
    single.scene.objects = {many.scene.objects[i]};
    const Certified own = certificates_of(single, prepare_setup(single)).back();
    EXPECT_TRUE(own.like.empty());
    EXPECT_EQ(own.certificate.verdict, found[i + 1].certificate.verdict);
    if (own.certificate.verdict == last.certificate.verdict) {
      EXPECT_GE(certificate::row_of(own.certificate, "exact_with_hand").bound, shared * (1.0 - 1e-9)) << i;
    }
  }
}

// Of the floor of `reaching`, which may be touched anywhere.
TEST(Certificates, AreOfTheWorstOfAFewPlaces) {
  const models::Setup setup =
      models::load(tests::source_dir() + "/models/scenes/wall.toml", "", {"rig.arm.speed_mm_s=600"});
  models::Setup anywhere = setup;
  anywhere.scene.user.reset();
  const Certified pressed = certificates_of(setup, prepare_setup(setup)).back();
  const Certified worst = certificates_of(anywhere, prepare_setup(anywhere)).back();
  EXPECT_TRUE(pressed.pressed);
  EXPECT_FALSE(worst.pressed);
  EXPECT_NEAR((worst.place.e() - pressed.place.e()).norm(), 0.05, 1e-9);
  EXPECT_LT(certificate::row_of(worst.certificate, "exact_with_hand").bound,
            certificate::row_of(pressed.certificate, "exact_with_hand").bound);
}

// Nobody's hand is on it: what only a hand would hold is beyond.
TEST(Certificates, AFreeTipHasNoHandOnIt) {
  const Certified tip = of("wall", {"rig.arm.loop.delay_ms=20"}).front();
  ASSERT_TRUE(tip.free_tip());
  EXPECT_TRUE(tip.beyond()) << class_text(tip);
  Certified held = tip;
  held.certificate.verdict = Class::held;
  EXPECT_TRUE(held.beyond());
  held.certificate.verdict = Class::unheld;
  EXPECT_FALSE(held.beyond());
}

}  // namespace
}  // namespace enc::trial
