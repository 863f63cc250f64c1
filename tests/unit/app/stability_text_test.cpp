// Whose bounds `check` shows, and how: the same every time, whatever is equal.
#include "app/stability_text.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace enc::app {
namespace {

using certificate::Class;
using certificate::Row;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using trial::Certified;

Certified one(const std::string& object, Class verdict, double margin,
              const std::string& row = "exact_with_hand") {
  Certified made{object, 600.0, {}};
  made.certificate.verdict = verdict;
  made.certificate.rows.push_back({row, "|z| < 1", 600.0 * margin, margin, true, "test"});
  return made;
}

std::string shown(const std::vector<Certified>& all) { return nearest_its_bound(all).object; }

TEST(StabilityText, TheRowsAreOfTheOneThatIsNearestToItsBound) {
  const Certified tip = one("", Class::alone, 2.0), a = one("a", Class::alone, 2.0),
                  b = one("b", Class::alone, 1.5);
  EXPECT_EQ(shown({tip, a, b}), "b");
  EXPECT_EQ(shown({tip, a, one("c", Class::alone, 2.0)}), "a") << "of equal ones the first";
  EXPECT_EQ(shown({tip, a}), "a") << "and an object before the free tip";
  EXPECT_EQ(shown({tip, one("c", Class::alone, 3.0)}), "");
  EXPECT_EQ(shown({tip, b, one("u", Class::unknown, NAN)}), "u") << "what is not known before what is";
  const Certified over = one("o", Class::unstable, 0.9), far = one("f", Class::unstable, 0.2);
  EXPECT_EQ(shown({tip, one("u", Class::unknown, NAN), over, far}), "f")
      << "what is beyond first, the farthest";
  Certified copy = a;
  copy.object = "z";
  copy.like = "a";
  EXPECT_EQ(shown({copy, a}), "a") << "whose own they are";
  EXPECT_EQ(shown({a, one("p", Class::alone, 1.0, "gil_hulin")}), "a") << "a formula to compare is no bound";
}

TEST(StabilityText, WhereASearchEndedOneSideIsKnown) {
  const models::Setup setup;
  Certified soft = one("soft", Class::alone, 2.0, "large_signal");
  Row& row = soft.certificate.rows.front();
  row.bound = INFINITY;
  row.low = 88.5;
  soft.ramp = 0.5;
  EXPECT_THAT(stability_text(setup, {soft}), ContainsRegex("large_signal +from 0.0885 +2 x "));
  row.side = Row::Side::below;
  EXPECT_THAT(stability_text(setup, {soft}), ContainsRegex("large_signal +from < 0.0885 +> 2 x "));
  row.side = Row::Side::above;
  row.margin = 1.0;
  EXPECT_THAT(stability_text(setup, {soft}), ContainsRegex("large_signal +from > 0.0885 +< 1 x "));
}

TEST(StabilityText, WhatIsNotKnownIsNotSaidToBeBeyond) {
  models::Setup setup;
  Certified unknown = one("a", Class::unknown, NAN);
  unknown.certificate.missing = "damping";
  EXPECT_THAT(
      stability_text(setup, {unknown}),
      AllOf(HasSubstr("NOT KNOWN: whether object 'a' is stable is not known: no damping; write [arm.loop]"),
            Not(HasSubstr("BEYOND"))));
  setup.rig.arm.loop.emplace();
  const auto said = [&](const char* missing) {
    unknown.certificate.missing = missing;
    return stability_text(setup, {unknown});
  };
  EXPECT_THAT(said("damping"),
              AllOf(HasSubstr("no damping; correct 'viscous_Nms'"), Not(HasSubstr("write"))));
  EXPECT_THAT(said("friction"), HasSubstr("correct 'friction_Nm' in its [arm.loop]"));
  EXPECT_THAT(said("encoder step"), HasSubstr("correct 'counts'"));
  EXPECT_THAT(said("hand's damping"), HasSubstr("'hand_damping_Ns_per_m' into its [contact]"));
  EXPECT_THAT(said("delay: more than 600 periods"),
              HasSubstr("not known: delay: more than 600 periods; correct 'delay_ms'"));
  EXPECT_THAT(said("what a release does: too slow to be simulated"), HasSubstr("make it stiffer"));
}

}  // namespace
}  // namespace enc::app
