// Every ForceSensor: the simulated one and the driver to copy.
#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "tests/conformance/bench_world.h"
#include "tests/support/built.h"
#include "tests/support/devices/default_offer.h"

namespace enc::test {
namespace {

constexpr double kQuantum = 0.025;          // N
constexpr double kWeight = 0.91 * 9.80665;  // N, of what is behind the sensor

TEST(SimulatedForce, IsAbsentBeforeTheFirstTick) {
  Twin twin;
  EXPECT_EQ(twin.rig.force->read({}).health, Health::absent);
  twin.rig.clock->next();
  EXPECT_EQ(twin.rig.force->read({}).health, Health::ok);
}

TEST(SimulatedForce, IsStampedAtEachTick) {
  Twin twin;
  for (int i = 0; i < 100; ++i) {
    const Tick k = twin.rig.clock->next();
    EXPECT_EQ(twin.rig.force->read({}).t, k.t);
    EXPECT_EQ(twin.rig.force->read({}).t, k.t);  // reading does not advance anything
  }
}

TEST(SimulatedForce, ReadsTheWeightWithNothingTouching) {
  Twin twin(exact_force());
  for (int i = 0; i < 20; ++i) twin.rig.clock->next();
  const Wrench w = twin.rig.force->read({}).value;
  EXPECT_NEAR(w.force.xyz[0], 0.0, 1e-12);
  EXPECT_NEAR(w.force.xyz[1], 0.0, 1e-12);
  EXPECT_NEAR(w.force.xyz[2], -kWeight, kQuantum);  // F's z points up as W's
}

TEST(SimulatedForce, ReadsInSteps) {
  Twin twin;
  for (int i = 0; i < 500; ++i) {
    twin.rig.clock->next();
    for (const double f : twin.rig.force->read({}).value.force.xyz)
      EXPECT_NEAR(f / kQuantum, std::round(f / kQuantum), 1e-9);
  }
}

TEST(SimulatedForce, SaturatesAtItsRangeAndSaysSo) {
  std::vector<std::string> set = exact_force();
  set.emplace_back("truth.force.range_N=10");
  set.emplace_back("user.approach_mm_s=[50]");
  Twin twin(set);
  bool seen = false;
  for (int i = 0; i < 12'000; ++i) {
    twin.tick();
    const auto s = twin.rig.force->read({});
    for (const double f : s.value.force.xyz) EXPECT_LE(std::abs(f), 10.0 + 1e-12);
    // 10 N less the weight of 8.9 N leave about 1 N for the tool; clear of both ends, health must be right.
    const double pressed = -twin.world->truth().contact_force.xyz[2];
    if (pressed > 2.0) {
      EXPECT_EQ(s.health, Health::saturated);
      seen = true;
    }
    if (pressed < 0.1 && twin.world->truth().tip_acceleration.norm() < 0.1) {
      EXPECT_EQ(s.health, Health::ok);
    }
  }
  EXPECT_TRUE(seen);
}

TEST(SimulatedForce, NoiseIsWhatTheRigSays) {
  Twin twin({"truth.force.quantum_N=1e-9", "truth.force.drift_N_per_sqrt_s=0"});
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kSamples = 500;  // before the tool sets out
  for (int i = 0; i < kSamples; ++i) {
    twin.rig.clock->next();
    const double f = twin.rig.force->read({}).value.force.xyz[0];
    sum += f;
    squares += f * f;
  }
  const double n = kSamples;
  const double mean = sum / n;
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 0.0125, 0.0125 * 4 / std::sqrt(2.0 * n));  // 4 sigma
}

TEST(SampleForce, ReadsZeroAndStampsItWithTheCycle) {
  setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
  DefaultOffer offer;
  const auto force = app::load_module("sample").driver->force(offer.with());
  for (int i = 0; i < 5; ++i) {
    const Time now(Duration(1'000'000LL * i));
    const auto s = force->read(now);
    EXPECT_EQ(s.health, Health::ok);
    EXPECT_EQ(s.t, now);
    EXPECT_EQ(s.value.force.norm(), 0.0);
    EXPECT_EQ(s.value.torque.norm(), 0.0);
  }
}

}  // namespace
}  // namespace enc::test
