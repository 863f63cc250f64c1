// The class of a loop, and what becomes of 0.1 and 1 mm where friction and counts decide.
#include "core/control/safety/certificate/certificate.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace enc::certificate {
namespace {

const SampledLoop kArm{0.075, 0.0114, 1e-3};
const Steps kEncoder{0.048, 28.7e-6};
const Hand kHand{0.1, 4.0, 300.0};

SampledLoop held(SampledLoop loop) {
  loop.hand = kHand;
  return loop;
}

TEST(Certificate, ClassesFollowOneAnotherAsTheStiffnessGrows) {
  const SampledLoop loop = held({0.1, 0.2, 1e-3, 1e-3});
  const Steps none{0.0, 0.0};
  EXPECT_EQ(certify(loop, none, {100.0, {}}).verdict, Class::passive);
  EXPECT_EQ(certify(loop, none, {300.0, {}}).verdict, Class::held);
  EXPECT_EQ(certify(loop, none, {4000.0, {}}).verdict, Class::unstable);
  // With a damper above b a wall is stable and not passive.
  EXPECT_EQ(certify(loop, none, {300.0, {0.5, 0.0}}).verdict, Class::alone);
  // What a hand does not hold friction may, where it is small.
  EXPECT_EQ(certify(loop, {0.05, 0.0}, {4000.0, {}}).verdict, Class::unstable);
  EXPECT_EQ(certify(loop, {3.0, 0.0}, {4000.0, {}}).verdict, Class::local);
}

TEST(Certificate, CountsAreNotPassiveWhereTheyPushMoreThanFrictionHolds) {
  const SampledLoop loop{0.1, 2.0, 1e-3};
  EXPECT_EQ(certify(loop, {0.05, 1e-4}, {900.0, {}}).verdict, Class::passive);
  const Certificate over = certify(loop, {0.05, 1e-4}, {1100.0, {}});
  EXPECT_EQ(over.verdict, Class::alone);
  EXPECT_EQ(over.plane.region, Region::limit_cycle);
}

// Of the damper, too: a count makes the rate jump by step/T and back.
TEST(Certificate, CountsOfADamperAreNotPassiveWhereTheyPushMoreThanFrictionHolds) {
  const SampledLoop loop{0.1, 0.5, 1e-3};
  EXPECT_EQ(certify(loop, {0.005, 30e-6}, {300.0, {}}).verdict, Class::passive);
  EXPECT_EQ(certify(loop, {0.005, 30e-6}, {300.0, {0.15, 0.0}}).verdict, Class::alone);
  EXPECT_EQ(certify(loop, {0.010, 30e-6}, {300.0, {0.15, 0.0}}).verdict, Class::passive);
}

// A hand may also take away: its spring has the damper come late by more than the device alone does.
TEST(Certificate, StableAloneAndNotWithThisHandIsAClassOfItsOwn) {
  SampledLoop loop{0.1, 0.2, 1e-3, 10e-3};
  loop.hand = {0.02, 1.0, 1000.0};
  const Damper damper{10.0, 0.0};
  ASSERT_LT(spectral_radius(loop.alone(), 300.0, damper.fixed), 1.0);
  ASSERT_GT(spectral_radius(loop, 300.0, damper.fixed), 1.0);
  EXPECT_EQ(certify(loop, kEncoder, {300.0, damper}).verdict, Class::unheld);
  EXPECT_EQ(certify(loop.alone(), kEncoder, {300.0, damper}).verdict, Class::alone);
  EXPECT_EQ(certify(loop, kEncoder, {150.0, damper}).verdict, Class::alone);
}

// What grows too slowly to be seen is not still: undamped, an undelayed spring at 0.1 rad/s and a late one.
TEST(Certificate, WhatIsTooSlowToBeWatchedIsNotCalledStill) {
  const SampledLoop slow{1.0, 0.0, 1e-3}, late{0.1, 0.0, 1e-4, 50e-3};
  EXPECT_EQ(release(slow, {0.0, 0.0}, 0.01, 0.0, kLarge).rest, Rest::away);
  EXPECT_EQ(release(late, {0.0, 0.0}, 1.0, 0.0, kLarge).rest, Rest::away);
  EXPECT_EQ(certify(slow, {0.0, 0.0}, {0.01, {}}).verdict, Class::unstable);
  EXPECT_EQ(certify(late, {0.0, 0.0}, {1.0, {}}).verdict, Class::unstable);
  EXPECT_EQ(release(slow, {1e-6, 0.0}, 0.01, 0.0, kLarge).rest, Rest::unknown);
  const Certificate unknown = certify(slow, {1e-8, 0.0}, {0.01, {}});
  EXPECT_EQ(unknown.verdict, Class::unknown);
  EXPECT_FALSE(unknown.missing.empty());
  EXPECT_EQ(release(slow, {1e-3, 0.0}, 0.01, 0.0, kLarge).rest, Rest::still);  // it never moves
}

// A mass that its damper stops within no time at all follows it: down to the wall's edge, with friction or
// not.
TEST(Certificate, LightMassIsNotFrozen) {
  const SampledLoop light{1e-9, 0.5, 1e-3}, heavy{1e-4, 0.5, 1e-3};
  for (const double friction : {0.0, 1e-3}) {
    const Released found = release(light, {friction, 0.0}, 100.0, 0.0, kLarge);
    EXPECT_EQ(found.rest, Rest::still) << friction;
    EXPECT_LT(found.swing, 1e-5) << friction;
    // Its force moves it by K T/b of the way in a period, as the eigenvalues say: up to twice.
    EXPECT_EQ(release(light, {friction, 0.0}, 900.0, 0.0, kLarge).rest, Rest::still) << friction;
    EXPECT_EQ(release(light, {friction, 0.0}, 1100.0, 0.0, kLarge).rest, Rest::away) << friction;
    EXPECT_EQ(release(heavy, {friction, 0.0}, 1.1 * critical_stiffness(heavy), 0.0, kLarge).rest, Rest::away)
        << friction;
  }
}

TEST(Certificate, WhatCreepsIsStill) {
  EXPECT_EQ(release({0.1, 16.0, 1e-3}, {0.0, 0.0}, 0.1, 0.0, kLarge).rest, Rest::still);
  EXPECT_EQ(release({0.1, 16.0, 1e-3}, {0.0, 0.0}, 10.0, 0.0, kLarge).rest, Rest::still);
  EXPECT_EQ(release({0.1, 16.0, 1e-3}, {1e-5, 0.0}, 10.0, 0.0, kLarge).rest, Rest::still);
}

// On its way down to what its counts keep going, which is more than 1 % of where it came from.
TEST(Certificate, WhatGoesDownToALimitCycleIsWatchedOn) {
  const SampledLoop loop{0.1, 0.16, 1e-3};
  const Released slow = release(loop, {0.0, 1e-4}, 300.0, 0.0, 50.0 * kSmall);
  EXPECT_EQ(slow.rest, Rest::cycle);
  EXPECT_EQ(release(loop, {0.0, 0.0}, 300.0, 0.0, 50.0 * kSmall).rest, Rest::still);
}

// The PHANToM, pressed: settles from 0.1 mm up to 3500 N/m and not at 5000; from 1 mm up to 1000, not at
// 2000.
TEST(Certificate, ThePhantomSettlesWhereItWasFoundTo) {
  const auto rest = [](double stiffness, double from) {
    return release(kArm, {0.048, 0.0}, stiffness, 0.0, from).rest;
  };
  EXPECT_EQ(rest(3500.0, kSmall), Rest::still);
  EXPECT_EQ(rest(1000.0, kLarge), Rest::still);
  EXPECT_EQ(rest(2000.0, kLarge), Rest::away);
  EXPECT_EQ(rest(8000.0, kSmall), Rest::away);
  EXPECT_EQ(certify(kArm, kEncoder, {1000.0, {}}).verdict, Class::local);
  EXPECT_EQ(certify(kArm, kEncoder, {2000.0, {}}).large.rest, Rest::away);
  EXPECT_EQ(certify(kArm, kEncoder, {2000.0, {}}).small.rest, Rest::still);
}

TEST(Certificate, ReleaseWithoutFrictionAgreesWithTheEigenvalues) {
  for (const double delay : {0.0, 0.3e-3, 1e-3, 4.5e-3})
    for (const double filter : {kUnset, 0.5})
      for (const Hand& hand : {Hand{}, kHand}) {
        SampledLoop loop{0.1, 0.4, 1e-3, delay, 2, filter, hand};
        const double critical = critical_stiffness(loop, {0.1, 0.0});
        EXPECT_EQ(release(loop, {0.0, 0.0}, 0.95 * critical, 0.1, kLarge).rest, Rest::still) << delay;
        EXPECT_EQ(release(loop, {0.0, 0.0}, 1.05 * critical, 0.1, kLarge).rest, Rest::away) << delay;
      }
}

// Sinusoidal and of energy balance, so within some per cent of the simulation.
TEST(Certificate, DescribingFunctionForetellsWhatFrictionStops) {
  for (const double damping : {0.0114, 0.2})
    for (const double delay : {0.0, 1e-3, 3e-3})
      for (const double amplitude : {kSmall, kLarge}) {
        const SampledLoop loop{0.075, damping, 1e-3, delay};
        const double k = friction_stiffness(loop, 0.05, {}, amplitude);
        EXPECT_EQ(release(loop, {0.05, 0.0}, 0.8 * k, 0.0, amplitude).rest, Rest::still) << delay;
        EXPECT_NE(release(loop, {0.05, 0.0}, 1.25 * k, 0.0, amplitude).rest, Rest::still) << delay;
      }
}

TEST(Certificate, CountsKeepALoopGoingWhereFrictionDoesNotHoldThem) {
  const SampledLoop loop{0.1, 0.3, 1e-3, 1e-3};
  EXPECT_EQ(release(loop, {0.2, 2e-3}, 150.0, 0.0, kLarge).rest, Rest::still);
  const Released hunts = release(loop, {0.02, 2e-3}, 150.0, 0.0, 1e-2);
  EXPECT_EQ(hunts.rest, Rest::cycle);
  EXPECT_GT(hunts.swing, 0.2e-3);
  EXPECT_LT(hunts.swing, 2e-3);  // over one edge
}

TEST(Certificate, MissingFiguresAreNamed) {
  const auto missing = [](const SampledLoop& loop, const Steps& steps, const Asked& asked) {
    const Certificate found = certify(loop, steps, asked);
    EXPECT_EQ(found.verdict, Class::unknown);
    EXPECT_EQ(found.rows.size(), 8U);
    EXPECT_EQ(found.small.rest, Rest::unknown);
    return found.missing;
  };
  const Asked asked{100.0, {}};
  EXPECT_EQ(missing({0.1, kUnset, 1e-3}, kEncoder, asked), "damping");
  EXPECT_EQ(missing({0.1, -1.0, 1e-3}, kEncoder, asked), "damping");
  EXPECT_EQ(missing({0.1, 0.1, 0.0}, kEncoder, asked), "period");
  EXPECT_EQ(missing({0.1, 0.1, 1e-3, -1.0}, kEncoder, asked), "delay");
  EXPECT_EQ(missing({0.0, 0.1, 1e-3}, kEncoder, asked), "mass");
  EXPECT_EQ(missing(held({0.0, 0.1, 1e-3}), kEncoder, asked), "mass");  // though the hand has one
  EXPECT_EQ(missing({0.1, 0.1, 1e-3, 0.601}, kEncoder, asked), "delay: more than 600 periods");
  EXPECT_EQ(missing({0.1, 0.1, 1e-3, 0.0, 0}, kEncoder, asked), "ticks");
  EXPECT_EQ(missing({0.1, 0.1, 1e-3, 0.0, 1, -1.0}, kEncoder, asked), "filter");
  EXPECT_EQ(missing(kArm, {kUnset, 1e-5}, asked), "friction");
  EXPECT_EQ(missing(kArm, {0.1, kUnset}, asked), "encoder step");
  EXPECT_EQ(missing(kArm, kEncoder, {0.0, {}}), "stiffness");
  EXPECT_EQ(missing(kArm, kEncoder, {kUnset, {}}), "stiffness");
  EXPECT_EQ(missing(kArm, kEncoder, {100.0, {kUnset, 0.0}}), "damper");
}

TEST(Certificate, RowsAreFoundByName) {
  const Certificate found = certify(held(kArm), kEncoder, {300.0, {11.5, 0.0}});
  EXPECT_GT(row_of(found, "exact_with_hand").bound, 0.0);
  EXPECT_THROW((void)row_of(found, "nonsense"), std::out_of_range);
}

}  // namespace
}  // namespace enc::certificate
