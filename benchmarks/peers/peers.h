// What others offer for the same work, to race against: the module encounter_peers. A shared object of its
// own, so that nothing but `encounter bench` maps these libraries.
#pragma once

#include <array>
#include <memory>

#include "core/machine/arm.h"
#include "core/mesh/mesh.h"

namespace enc::bench {

class NearestPeer {
 public:
  struct Found {
    std::array<float, 3> point;
    float distance;  // m, without sign
  };
  virtual ~NearestPeer() = default;
  // Nearest surface point within `radius` of p, m.
  virtual Found nearest(const std::array<float, 3>& p, float radius) = 0;
};

struct ArmAnswer {
  Vec3 tip;         // m
  PerJoint torque;  // against gravity and for a force at the tip, N m
};
class ArmPeer {
 public:
  virtual ~ArmPeer() = default;
  // Kinematics, Jacobian J, gravity g: tip and g + J^T force.
  virtual ArmAnswer answer(const PerJoint& q, const Vec3& force) = 0;
};

// Embree 3, rtcPointQuery. Throws Error (kind device) where it refuses.
[[nodiscard]] std::unique_ptr<NearestPeer> make_embree(const Mesh& mesh);
// Orocos KDL, of a chain (ArmKind::chain). Throws as the other.
[[nodiscard]] std::unique_ptr<ArmPeer> make_kdl(const ArmMachine& machine);

// Null: the library was not there when this was built.
struct PeersModule {
  std::unique_ptr<NearestPeer> (*embree)(const Mesh& mesh) = nullptr;
  std::unique_ptr<ArmPeer> (*kdl)(const ArmMachine& machine) = nullptr;
};

}  // namespace enc::bench
