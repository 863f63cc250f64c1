// The certificate of each object of a scene: the shipped ones, and what is stiffer or softer than may be.
#include "trial/certificates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/trial/runs.h"

namespace enc::trial {
namespace {

using certificate::Class;
using testing::HasSubstr;

std::vector<Certified> of(const std::string& name, const std::vector<std::string>& set = {}) {
  const models::Setup setup =
      models::load(std::string(ENCOUNTER_SOURCE_DIR) + "/models/scenes/" + name + ".toml", "", set);
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

}  // namespace
}  // namespace enc::trial
