// Orocos KDL in its usual form: a chain of segments and one solver for each question.
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "benchmarks/peers/peers.h"
#include "core/base/error.h"

namespace enc::bench {
namespace {

KDL::Vector vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// A segment's frame stands at its joint; the last frame stands at the tip. Masses are given in that frame.
KDL::Chain chain_of(const ArmMachine& machine) {
  KDL::Chain chain;
  for (const ChainLink& link : machine.links) {
    const bool last = &link == &machine.links.back();
    const Vec3 end = last ? machine.tip : Vec3::Zero();
    const auto kind = link.kind == JointKind::hinge ? KDL::Joint::RotAxis : KDL::Joint::TransAxis;
    const KDL::RotationalInertia inertia(link.inertia.x(), link.inertia.y(), link.inertia.z());
    chain.addSegment(KDL::Segment(link.name,
                                  KDL::Joint(link.name, vector(link.origin), vector(link.axis), kind),
                                  KDL::Frame(vector(link.origin + end)),
                                  KDL::RigidBodyInertia(link.mass, vector(link.centre - end), inertia)));
  }
  return chain;
}

class Kdl final : public ArmPeer {
 public:
  explicit Kdl(const ArmMachine& machine)
      : chain_(chain_of(machine)),
        place_(chain_),
        slope_(chain_),
        weight_(chain_, KDL::Vector(0, 0, -kStandardGravity)),
        q_(chain_.getNrOfJoints()),
        gravity_(chain_.getNrOfJoints()),
        jacobian_(chain_.getNrOfJoints()) {}

  ArmAnswer answer(const PerJoint& q, const Vec3& force) override {
    for (unsigned i = 0; i < q_.rows(); ++i) q_(i) = q[i];
    if (place_.JntToCart(q_, tip_) < 0 || slope_.JntToJac(q_, jacobian_) < 0 ||
        weight_.JntToGravity(q_, gravity_) < 0)
      throw Error("KDL refuses a pose of the arm", {}, ErrorKind::device);
    ArmAnswer answer{{tip_.p.x(), tip_.p.y(), tip_.p.z()}, {}};
    for (unsigned i = 0; i < q_.rows(); ++i)
      answer.torque[i] = gravity_(i) + jacobian_.data.col(i).head<3>().dot(force);
    return answer;
  }

 private:
  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive place_;
  KDL::ChainJntToJacSolver slope_;
  KDL::ChainDynParam weight_;
  KDL::JntArray q_, gravity_;
  KDL::Jacobian jacobian_;
  KDL::Frame tip_;
};

}  // namespace

std::unique_ptr<ArmPeer> make_kdl(const ArmMachine& machine) { return std::make_unique<Kdl>(machine); }

}  // namespace enc::bench
