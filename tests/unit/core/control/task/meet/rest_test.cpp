// An arm that rests while the finger is far: friction holds it, and the law leaves it alone.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/finger_bench.h"

namespace enc {
namespace {

using Bench = test::FingerBench;

// One count of each joint's encoder, as it is read with a window of 2 ms: there, and the next ticks still.
// How far the push strays from what it was, N.
double strays_by_a_count(Bench& bench) {
  const Impedance& law = *bench.loop.scene.impedance();
  ArmSample& arm = bench.loop.in.arm.value;
  const Vec3 before = bench.loop.out.felt.e();
  double most = 0.0;
  for (std::size_t joint = 0; joint < kMostJoints; ++joint) {
    const double count = 2.0 * M_PI / 4096.0 / law.rig.machine.drives[joint].ratio;
    const Mat3 jacobian = law.arm.jacobian(arm.joints);
    arm.joints[joint] += count;
    arm.tip = law.arm.tip(arm.joints);
    arm.velocity = Vec<'R'>(Vec3(jacobian.col(static_cast<Eigen::Index>(joint)) * (count / 2e-3)));
    for (int tick = 0; tick < 100; ++tick) {
      bench.at(-0.150);
      most = std::max(most, (bench.loop.out.felt.e() - before).norm());
      if (tick == 1) arm.velocity = Vec<'R'>::zero();
    }
  }
  return most;
}

// Friction at stretched arms holds the tip 4.5 mm from its target [sources/arm 3]; one count's rate through
// K_v would push with 0.2 N, and the tip would slip at 1 mm/s.
TEST(Rest, ACountMovesNothingWhereFrictionHoldsTheArmFarFromItsTarget) {
  for (const double off : {0.0, 1e-3, 4.5e-3, 9e-3}) {
    Bench bench("wall");
    bench.at(-0.150, 10);
    bench.put_tip({0.9 * off, 0.3 * off, 0.3 * off});
    bench.at(-0.150, 2000);
    EXPECT_LT(strays_by_a_count(bench), 0.02) << off;
  }
}

// One that slipped while its push faded stands with all of it, and a count is no reason to go on.
TEST(Rest, ACountMovesNothingWhereTheArmHasSlipped) {
  Bench bench("wall");
  bench.at(-0.150, 10);
  bench.put_tip({4e-3, 0.0, 2e-3});
  bench.at(-0.150, 60);
  bench.put_tip({3.8e-3, 0.0, 1.9e-3});
  bench.at(-0.150, 2000);
  ASSERT_TRUE(recall<Meeting>(bench.loop.state).aim.slipped);
  EXPECT_GT(bench.loop.out.felt.norm(), 1.0);
  EXPECT_LT(strays_by_a_count(bench), 0.02);
}

// What moves it farther than friction would let it creep wakes the law.
TEST(Rest, AnArmThatIsPushedIsBroughtBack) {
  Bench bench("wall");
  bench.at(-0.150, 2000);
  bench.put_tip({0.0, 0.0, 2e-3});
  bench.at(-0.150, 30);
  EXPECT_GT(bench.loop.out.felt.norm(), 0.5);  // of 300 N/m over 2 mm
}

}  // namespace
}  // namespace enc
