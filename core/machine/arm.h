// A force-controlled arm with up to three joints and a passive prop at its tip: kinematics, statics and
// inertia [VisHap 2.3]. Geometry is data: a PHANToM, or any chain of hinges and slides.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "core/base/words.h"

namespace enc {

inline constexpr double kStandardGravity = 9.80665;  // m/s^2, along -z of R and W

enum class ArmKind : std::uint8_t { phantom, chain };
constexpr auto words(ArmKind) { return enum_words("phantom", "chain"); }
enum class JointKind : std::uint8_t { hinge, slide };
constexpr auto words(JointKind) { return enum_words("hinge", "slide"); }

// Symbols of [VisHap eq. 5], from Cavusoglu, Feygin and Tendick: a forearm, c parallelogram link, be upper
// arm with motor, df crank with motor. q1 turret, q2 upper arm above horizontal, q3 forearm from vertical
// (absolute). The origin of R is where the axes of turret and upper arm meet; x forwards,
// z upwards. Defaults: model 1.0A, scaled from the published 1.5 by 2/3 (sources/arm 5, derived).
struct PhantomGeometry {
  double l1 = 0.1397, l2 = 0.1130, l3 = 0.02167;  // upper arm, forearm, crank, m
  double l5 = -0.02453, l6 = 0.03513;             // centres of mass of be (signed) and df from the axis, m
  double m_a = 0.01347, m_c = 0.01660, m_be = 0.2325, m_df = 0.1865;  // kg
  // Inertia in Cavusoglu's body axes, kg m^2: x along the axis of q2 and q3, z along be and c but y along a
  // and df. a and c are about their centres of mass, be and df about the origin of R: the published mass
  // matrix has no m_be l5^2 and no m_df l6^2.
  Vec3 I_a{1.441e-5, 5e-8, 1.441e-5}, I_c{2.841e-5, 2.841e-5, 1.5e-7}, I_be{4.929e-4, 4.471e-4, 2.63e-5},
      I_df{3.160e-4, 2.80e-5, 2.776e-4};
  double I_base = 5.276e-4;                         // turret about its axis, kg m^2
  double coupled_low = -0.96, coupled_high = 1.13;  // limits of q2 - q3, rad: -55 and 65 deg (sources/arm 3)
};

// A joint of a chain and the link behind it.
struct ChainLink {
  std::string name;
  JointKind kind = JointKind::slide;
  Vec3 axis{0, 0, 1};    // unit, in the parent link; with all joints at 0, all frames are parallel to R
  Vec3 origin{0, 0, 0};  // joint's origin in the parent link (at its joint), m
  double mass = 0.1;     // kg
  Vec3 centre{0, 0, 0};  // centre of mass from the joint, m
  Vec3 inertia{1e-5, 1e-5, 1e-5};  // about the centre of mass, along the link's axes, kg m^2
};

// Motor, transmission and encoder of a joint. A slide's ratio is in 1/m, and its torque is a force.
struct ArmDrive {
  double low = -M_PI, high = M_PI;  // rad or m
  double ratio = 7.47;              // motor rotation in rad for each rad (or m) of the joint
  double rotor_inertia = 1.03e-6;   // motor's, kg m^2; at the joint it counts times ratio^2
};

struct ArmMachine {
  ArmKind kind = ArmKind::phantom;
  PhantomGeometry phantom;
  std::vector<ChainLink> links;  // chain only; at most kMostJoints
  Vec3 tip{0, 0, 0};             // chain only: H in its last link, m
  std::array<ArmDrive, kMostJoints> drives{{{-M_PI / 2, M_PI / 2, 8.87},
                                            {-2.164, 2.077, 7.47},    // -124 and 119 deg
                                            {-0.506, 3.735, 7.47}}};  // -29 and 214 deg (sources/arm 3)
};

// Form in which the mass of a prop at the tip enters eq. 5.
enum class Payload : std::uint8_t {
  // Added to m_a, "by adjusting m_a in equation 5": joint 3 then gets half of the necessary torque.
  published,
  exact  // acts at the tip
};

class Arm {
 public:
  // Throws Error if the machine has no links or too many, or an impossible length or mass.
  explicit Arm(const ArmMachine& machine);

  [[nodiscard]] const ArmMachine& machine() const { return machine_; }
  [[nodiscard]] std::size_t joints() const { return joints_; }
  [[nodiscard]] PerJoint zero() const { return {}; }  // home: W is the pose of H there

  [[nodiscard]] Point<'R'> tip(const PerJoint& q) const noexcept;
  // d tip / d q, m per rad or m; columns of missing joints are 0. The body Jacobian J^b of eq. 4 is R^T
  // times this one, and its force is R^T F, so that J^bT R^T F = J^T F.
  [[nodiscard]] Mat3 jacobian(const PerJoint& q) const noexcept;
  // Motor torque against gravity [eq. 5], N m or N; payload at the tip, kg. A chain has no m_a, so its
  // payload is exact.
  [[nodiscard]] PerJoint gravity(const PerJoint& q, double payload, Payload form) const noexcept;
  // Mass matrix with rotors, kg m^2 (or kg, kg m); the payload is exact.
  [[nodiscard]] Mat3 mass(const PerJoint& q, double payload) const noexcept;
  // Motor torque from the tip's force, and the inverse [eq. 4]. The inverse is damped near a singular pose,
  // so it is never NaN.
  [[nodiscard]] PerJoint torque(const Mat3& jacobian, const Vec<'R'>& force) const noexcept;
  [[nodiscard]] Vec<'R'> force(const Mat3& jacobian, const PerJoint& torque) const noexcept;
  // Effective mass at the tip, kg: the largest along those axes of R in which it can move, or 0.
  [[nodiscard]] double felt_mass(const Mat3& jacobian, const Mat3& mass) const noexcept;
  // Effective mass along one direction (unit); 0 if the tip cannot move along it.
  [[nodiscard]] double felt_mass(const Mat3& jacobian, const Mat3& mass, const Vec<'R'>& way) const noexcept;
  // Tip force, beyond gravity, for this acceleration (m/s^2): N.
  [[nodiscard]] Vec<'R'> force_to_accelerate(const Mat3& jacobian, const Mat3& mass,
                                             const Vec<'R'>& acceleration) const noexcept;
  // 1 if the tip moves equally well in every direction of the machine, 0 at a singular pose: least over
  // largest singular value of the Jacobian, among those of its joints. 1 rad counts as 1 m.
  [[nodiscard]] double dexterity(const Mat3& jacobian) const noexcept;
  // Joints that place the tip at p (with fewer than three: nearest to p), within limits. Returns false and
  // keeps q if there are no such joints. A chain searches from q.
  [[nodiscard]] bool inverse(const Point<'R'>& p, PerJoint& q) const noexcept;
  // Like inverse(), with a dexterity of at least `least_dexterity` there.
  [[nodiscard]] bool reaches(const Point<'R'>& p, double least_dexterity, PerJoint& q) const noexcept;
  [[nodiscard]] bool within_limits(const PerJoint& q) const noexcept;

 private:
  ArmMachine machine_;
  std::size_t joints_ = kMostJoints;
};

}  // namespace enc
