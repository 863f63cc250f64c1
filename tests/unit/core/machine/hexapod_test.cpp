// The geometry of sources/hexapod 2, against the numbers printed there; and the load limit of the machine.
#include "core/machine/hexapod.h"

#include <algorithm>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/control/scene/scene.h"
#include "core/devices/mode.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::Loop;

// The set of sources/hexapod 2, for which that page prints joints, excursions and travels.
HexapodGeometry published() {
  HexapodGeometry g;
  g.base_radius = 0.140;
  g.platform_radius = 0.0975;
  g.base_half_angle = 22.0 * M_PI / 180.0;
  g.platform_half_angle = 18.0 * M_PI / 180.0;
  g.height = 0.150;
  g.tip_height = 0.190;
  g.stroke = 0.024;
  return g;
}

// H for a platform that is moved by `shift` and turned by `turn` about the catalogue's pivot, 30 mm above the
// platform joints.
Pose<'R', 'H'> about_pivot(const Vec3& shift, const Quat& turn = Quat::Identity()) {
  return {turn, Vec3(Vec3(0, 0, 0.180) + shift + turn * Vec3(0, 0, 0.160))};
}

struct Excursion {
  double least, most;
};
Excursion excursion(const Hexapod& machine, int axis, double travel) {
  Excursion e{0.0, 0.0};
  for (const double sign : {-1.0, 1.0}) {
    const Vec3 unit = Vec3::Unit(axis % 3);
    const auto X_RH = axis < 3 ? about_pivot(sign * travel * unit)
                               : about_pivot(Vec3::Zero(), Quat(Eigen::AngleAxisd(sign * travel, unit)));
    const auto change = (machine.inverse(X_RH).array() - machine.zero_length()).eval();
    e = {std::min(e.least, change.minCoeff()), std::max(e.most, change.maxCoeff())};
  }
  return e;
}

TEST(Hexapod, JointsStandWhereTheTableSays) {
  const Hexapod machine{published()};
  const std::array<std::array<double, 2>, 6> base{{{129.806, 52.445},
                                                   {-19.484, 138.638},
                                                   {-110.322, 86.193},
                                                   {-110.322, -86.193},
                                                   {-19.484, -138.638},
                                                   {129.806, -52.445}}};
  const std::array<std::array<double, 2>, 6> platform{{{72.457, 65.240},
                                                       {20.271, 95.369},
                                                       {-92.728, 30.129},
                                                       {-92.728, -30.129},
                                                       {20.271, -95.369},
                                                       {72.457, -65.240}}};
  for (int leg = 0; leg < 6; ++leg) {
    const auto i = static_cast<std::size_t>(leg);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(machine.base_joint(leg)(axis) * 1e3, base[i][static_cast<std::size_t>(axis)], 6e-4) << leg;
      EXPECT_NEAR(machine.platform_joint(leg)(axis) * 1e3, platform[i][static_cast<std::size_t>(axis)], 6e-4)
          << leg;
    }
    EXPECT_EQ(machine.base_joint(leg).z(), 0.0);
    EXPECT_NEAR(machine.platform_joint(leg).z(), -0.190, 1e-15);
  }
}

TEST(Hexapod, AllStrutsAreOfOneLengthAtZero) {
  const Hexapod machine{published()};
  EXPECT_NEAR(machine.zero_length(), 0.16110, 5e-6);
  EXPECT_LT((machine.inverse(machine.zero()).array() - machine.zero_length()).abs().maxCoeff(), 1e-15);
  EXPECT_NEAR(machine.zero().p().z(), 0.340, 1e-15);
  // Strut tilt 21.39 degrees: cos = 150 / L0.
  EXPECT_NEAR(std::acos(0.150 / machine.zero_length()) / kDegree, 21.39, 0.005);
}

TEST(Hexapod, StrutsMoveAtTheCatalogueTravelsAsTheTableSays) {
  const Hexapod machine{published()};
  struct Row {
    const char* name;
    double travel, least, most, at_stroke;
  };
  const std::array<Row, 6> rows{{{"X", 0.050, -10.4, 23.8, 0.0503},
                                 {"Y", 0.050, -10.0, 23.5, 0.0509},
                                 {"Z", 0.025, -23.0, 23.5, 0.0255},
                                 {"tX", 15 * kDegree, -18.0, 23.2, 15.5 * kDegree},
                                 {"tY", 15 * kDegree, -19.4, 23.1, 15.5 * kDegree},
                                 {"tZ", 30 * kDegree, -3.9, 23.5, 30.6 * kDegree}}};
  for (int axis = 0; axis < 6; ++axis) {
    const Row& row = rows[static_cast<std::size_t>(axis)];
    const Excursion e = excursion(machine, axis, row.travel);
    EXPECT_NEAR(e.least * 1e3, row.least, 0.055) << row.name;
    EXPECT_NEAR(e.most * 1e3, row.most, 0.055) << row.name;
    double travel = 0.0;
    for (; std::max(-excursion(machine, axis, travel).least, excursion(machine, axis, travel).most) <= 0.024;
         travel += row.travel / 5000) {
    }
    EXPECT_NEAR(travel / row.at_stroke, 1.0, axis < 3 ? 0.0015 : 0.004)
        << row.name;  // half of the table's last digit
  }
}

TEST(Hexapod, LimitsAreNamed) {
  const Hexapod machine{published()};
  EXPECT_EQ(machine.limit(machine.zero()), ReachLimit::none);
  EXPECT_EQ(machine.limit(about_pivot(Vec3(0, 0, 0.0254))), ReachLimit::none);
  EXPECT_EQ(machine.limit(about_pivot(Vec3(0, 0, 0.0260))), ReachLimit::stroke);
  EXPECT_EQ(machine.limit(about_pivot({0, 0, 0}, Quat(Eigen::AngleAxisd(15.1 * kDegree, Vec3::UnitX())))),
            ReachLimit::tilt);
  EXPECT_EQ(machine.limit(about_pivot({0, 0, 0}, Quat(Eigen::AngleAxisd(30.1 * kDegree, Vec3::UnitZ())))),
            ReachLimit::yaw);
  EXPECT_EQ(machine.limit(about_pivot({0, 0, 0}, Quat(Eigen::AngleAxisd(29.9 * kDegree, Vec3::UnitZ())))),
            ReachLimit::none);
  EXPECT_NE(machine.limit(Pose<'R', 'H'>{}), ReachLimit::none);  // NaN
}

TEST(Hexapod, JacobianIsTheDerivativeOfTheLengths) {
  const Hexapod machine{published()};
  const auto X_RH = about_pivot({0.011, -0.007, 0.004}, Quat(Eigen::AngleAxisd(0.1, Vec3(1, 2, -2) / 3.0)));
  const Hexapod::Jacobian J = machine.jacobian(X_RH);
  constexpr double h = 1e-6;
  for (int column = 0; column < 6; ++column) {
    const auto moved = [&](double d) {
      const Vec3 unit = Vec3::Unit(column % 3);
      return column < 3 ? Pose<'R', 'H'>(X_RH.q(), Vec3(X_RH.p() + d * unit))
                        : Pose<'R', 'H'>(Quat(Eigen::AngleAxisd(d, unit)) * X_RH.q(), Vec3(X_RH.p()));
    };
    const Hexapod::Lengths slope = (machine.inverse(moved(h)) - machine.inverse(moved(-h))) / (2 * h);
    EXPECT_LT((J.col(column) - slope).cwiseAbs().maxCoeff(), 1e-9) << column;
  }
}

TEST(Hexapod, ConditionAtZeroIs425AboutThePivot) {
  HexapodGeometry geometry = published();
  geometry.tip_height = 0.030;  // H at the pivot
  const Hexapod machine{geometry};
  Hexapod::Jacobian J = machine.jacobian(machine.zero());
  J.rightCols<3>() /= 0.100;  // rad per 100 mm, as sources/hexapod 3
  const auto s = Eigen::JacobiSVD<Hexapod::Jacobian>(J).singularValues().eval();
  EXPECT_NEAR(s(0) / s(5), 4.25, 0.01);
  const std::array<double, 6> printed{2.28, 1.51, 1.51, 0.71, 0.54, 0.54};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(s(i), printed[static_cast<std::size_t>(i)], 0.006) << i;
}

TEST(Hexapod, ForwardSaysWhenThereIsNoAnswer) {
  const Hexapod machine{published()};
  EXPECT_FALSE(machine.forward(Hexapod::Lengths::Constant(kUnset), machine.zero()));
  Hexapod::Lengths impossible = Hexapod::Lengths::Constant(0.161);
  impossible(0) = 1.0;  // no strut reaches so far while its neighbour is short
  EXPECT_FALSE(machine.forward(impossible, machine.zero()));
}

TEST(Hexapod, OwnGeometryReachesEveryCatalogueTravel) {
  // sources/hexapod 1: X, Y +-50 mm, Z +-25 mm, tilts +-15 deg, yaw +-30 deg, each alone from zero, about the
  // catalogue's pivot.
  const Hexapod machine{HexapodGeometry{}};
  const Vec3 pivot(0, 0, -(machine.geometry().tip_height - 0.030));  // in H
  const auto reached = [&](const Vec3& shift, const Quat& q) {
    const Vec3 p = machine.zero().p() + pivot + shift - q * pivot;
    return machine.limit(Pose<'R', 'H'>(q, p)) == ReachLimit::none;
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(reached({sign * 0.050, 0, 0}, Quat::Identity()));
    EXPECT_TRUE(reached({0, sign * 0.050, 0}, Quat::Identity()));
    EXPECT_TRUE(reached({0, 0, sign * 0.025}, Quat::Identity()));
    for (int axis = 0; axis < 3; ++axis) {
      const double degrees = axis < 2 ? 14.999 : 29.999;
      EXPECT_TRUE(
          reached(Vec3::Zero(), Quat(Eigen::AngleAxisd(sign * degrees * M_PI / 180.0, Vec3::Unit(axis)))))
          << axis;
    }
  }
}

// The machine does not render a load beyond its limit: it stands still under a harder push.

RigSpec weak(double payload) {
  RigSpec rig;
  rig.manipulator.payload = payload;
  return rig;
}

// 13 N less 0.91 kg * 9.80665 m/s^2 = 4.07595 N; a spring of 2 N/mm reaches that at 2.037974 mm.
TEST(Payload, CutsTheDeflectionWhereTheForceReachesIt) {
  const Scene scene = prepare(test::ball_scene(), weak(13.0));
  EXPECT_NEAR(scene.strength, 4.0759485, 1e-9);
  EXPECT_NEAR(scene.objects[0].limit, 2.03797425e-3, 1e-12);
  EXPECT_EQ(scene.objects[0].wanted, 6e-3);
  const Scene strong = prepare(test::ball_scene(), {});
  EXPECT_EQ(strong.objects[0].limit, 6e-3);
  EXPECT_EQ(strong.objects[0].wanted, 6e-3);
}

TEST(Payload, RefusesAMachineThatCarriesNothing) {
  EXPECT_THROW((void)prepare(test::ball_scene(), weak(8.9)), Error);
  EXPECT_THROW((void)prepare(test::ball_scene(), weak(9.0)), Error) << "0.08 N are felt before the inset";
}

TEST(Payload, PushedHarderItStandsAtTheLimitAndSaysSo) {
  Loop loop(prepare(test::ball_scene(), weak(13.0)));
  loop.tool_tip = Point<'W'>(0, 0, test::kTop + test::kToolRadius + 0.020);
  loop.tick(1000);
  loop.tool_tip = Point<'W'>(0, 0, test::kTop + test::kToolRadius - 0.0005);
  loop.force = Vec<'W'>(0, 0, -4.0);
  loop.tick(2000);
  EXPECT_EQ(loop.out.mode, Mode::contact);
  EXPECT_FALSE(loop.out.why & kOverload);
  loop.force = Vec<'W'>(0, 0, -12.0);
  loop.tick(2000);
  const Point<'W'> there = loop.tip();
  EXPECT_EQ(loop.out.mode, Mode::contact) << "no hold: the machine stands, which is the safe thing";
  EXPECT_TRUE(loop.out.why & kOverload);
  EXPECT_TRUE(loop.out.why & kAtLimit);
  EXPECT_NEAR(loop.out.deflection, loop.scene.objects[0].limit, 1e-12);
  EXPECT_NE(why_text(loop.out.why).find("pressed harder than the machine carries"), std::string::npos);
  loop.force = Vec<'W'>(0, 0, -90.0);
  loop.tick(1000);
  EXPECT_LT((loop.tip() - there).norm(), 1e-9);
}

}  // namespace
}  // namespace enc
