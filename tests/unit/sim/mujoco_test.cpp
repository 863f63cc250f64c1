#include "sim/bodies/mujoco.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/truth/random.h"

namespace enc::test {
namespace {

using sim::Physics;
using sim::SpecPtr;
using sim::Stream;

// A body and what hangs on it: hinges about drawn axes, one or two branches at each.
std::string branch(Stream& random, int depth) {
  const auto drawn = [&] { return 2.0 * random.uniform() - 1.0; };
  std::string text = fmt::format(
      "<body pos='0.15 {:.3f} {:.3f}'><joint type='hinge' axis='{:.3f} {:.3f} {:.3f}' frictionloss='0.01'/>"
      "<geom type='capsule' size='0.02' fromto='0 0 0 0.15 0 0' mass='0.2'/>",
      0.03 * drawn(), 0.03 * drawn(), drawn(), drawn(), drawn());
  const int branches = depth == 0 ? 0 : random.uniform() < 0.5 ? 1 : 2;
  for (int i = 0; i < branches; ++i) text += branch(random, depth - 1);
  return text + "</body>";
}

// Trees of hinges that fall onto a plane: rows of the constraint Jacobian have different descendants.
std::string falling_trees(std::uint64_t seed) {
  Stream random(seed, "trees");
  std::string text =
      "<mujoco><option timestep='0.002' solver='Newton' tolerance='1e-12' iterations='200' cone='elliptic'/>"
      "<worldbody><geom type='plane' size='5 5 0.1'/>";
  for (int i = 0; i < 4; ++i)
    text += fmt::format(
        "<body pos='{:.1f} 0 0.12'><freejoint/><geom type='box' size='0.05 0.05 0.05' mass='1'/>{}"
        "</body>",
        0.2 * i, branch(random, 2));
  return text + "</worldbody></mujoco>";
}

Physics physics_of(const std::string& xml) {
  std::array<char, 500> why{};
  SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, why.data(), static_cast<int>(why.size())));
  EXPECT_TRUE(spec) << why.data();
  return Physics(std::move(spec));
}

// MuJoCo 4.0.0 differs by up to 4 rad/s in twelve of forty such worlds.
TEST(MuJoCo, ASparseConstraintJacobianStepsAsTheDenseOneDoes) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const std::string xml = falling_trees(seed);
    Physics dense = physics_of(xml), sparse = physics_of(xml);
    dense.model()->opt.jacobian = mjJAC_DENSE;
    sparse.model()->opt.jacobian = mjJAC_SPARSE;
    double apart = 0.0;  // rad/s, m/s
    for (int i = 0; i < 200; ++i) {
      sparse.restore(dense.save());
      ASSERT_TRUE(dense.step() && sparse.step());
      for (int k = 0; k < dense.model()->nv; ++k)
        apart = std::fmax(apart, std::abs(dense.data()->qvel[k] - sparse.data()->qvel[k]));
    }
    EXPECT_LT(apart, 1e-9);
    EXPECT_GT(dense.data()->nefc, 0);
  }
}

TEST(MuJoCo, TheVersionWithTheWrongHessianIsRefused) {
  EXPECT_NE(sim::mujoco_problem(3'010'000).find("version 4"), std::string::npos);
  EXPECT_NE(sim::mujoco_problem(4'000'000).find("4.0.1"), std::string::npos);
  EXPECT_EQ(sim::mujoco_problem(4'000'001), "");
  EXPECT_EQ(sim::mujoco_problem(4'001'000), "");
  EXPECT_EQ(sim::mujoco_problem(), "") << sim::mujoco_version();
}

}  // namespace
}  // namespace enc::test
