// What of the world concerns an arm: its torques, its prop and what is seen of both.
#include <cmath>
#include <limits>

#include "sim/world.h"

namespace enc::sim {
namespace {

struct Faced {
  std::size_t object = 0;
  Vec<'W'> normal;
};

// The surface that the prop stands for: the one nearest to the finger.
Faced nearest_surface(const Scene& scene, const Point<'W'>& p) {
  Faced faced;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.least_distance(p) >= least) continue;
    const Nearest at = object.surface.nearest(object.X_WO.inverse() * p);
    if (at.distance >= least) continue;
    least = at.distance;
    faced = {i, object.X_WO * at.normal};
  }
  return faced;
}

}  // namespace

Pose<'W', 'R'> arm_base(const ArmTruth& truth) {
  const Quat turned = rotation_xyz(truth.turned);
  return {turned, Vec3(truth.misplaced - turned * Arm(true_machine(truth)).tip({}).e())};
}

void World::set_up_arm(const WorldSpec& spec) {
  arm_ability_ = {spec.rig.arm.machine, spec.rig.arm.peak, spec.rig.arm.continuous};
  const Arm believed(spec.rig.arm.machine);
  arm.emplace(spec.twin.arm, believed, dt_);
  arm_body_.emplace(physics_, believed.joints());
  tip_geom_ = arm_body_->front();
  truth_.tip_radius = 0.0;  // its front is flat
  mj_kinematics(physics_.model(), physics_.data());
  truth_.tip = arm_body_->tip(physics_.data());
  if (user_) truth_.tool_tip = user_->start();
  face_prop(0.0);
}

// The gimbal of the prop keeps its front parallel to the surface that it stands for: the one that it is told.
// Before, it faces what is nearest to it.
void World::face_prop(double h) {
  mjModel* m = physics_.model();
  mjData* d = physics_.data();
  Vec3 running = Vec3::Zero();
  if (!prepared_.objects.empty()) {
    const bool told = twin_.arm.facing == PropFacing::told;
    const Vec<'R'>& wanted = arm->state().facing_wanted;
    const Faced to =
        nearest_surface(prepared_, !told && truth_.tool_tip.finite() ? truth_.tool_tip : truth_.tip);
    const Object& object = prepared_.objects[to.object];
    const Vec<'W'> normal = told && wanted.finite() ? X_WR_ * wanted : to.normal;
    arm->face(normal.e(), h, next_.index == 0);
    running = arm->state().surface_speed * (object.X_WO.q() * object.interaction.way);
  }
  arm_body_->face(m, d, arm->facing(), running);
}

void World::drive_arm(double, double h) {
  mjData* d = physics_.data();
  face_prop(h);
  PerJoint torque = arm->state().torque;
  const PerJoint friction = arm->friction(arm_body_->rates(d));
  for (std::size_t i = 0; i < torque.size(); ++i) torque[i] += friction[i];
  arm_body_->drive(d, torque);
}

void World::begin_arm_work() { step_work_->begin(physics_, scale(), &*arm_body_, arm->state().torque); }

void World::count_arm_work(double h) {
  step_work_->count(physics_, *arm_body_, twin_.arm, arm->state().torque, arm->friction(step_work_->rates()),
                    h, truth_.work);
}

// Forces are those of the step's last stage, which is as good as at this very time; velocities are evaluated
// once more, as places were after the step.
void World::observe_arm() {
  const mjModel* m = physics_.model();
  mjData* d = physics_.data();
  mj_comPos(m, d);
  mj_comVel(m, d);
  truth_.contact_force = contact_force(truth_.touching);
  truth_.tip = arm_body_->tip(d);
  truth_.tip_velocity = arm_body_->tip_velocity(m, d);
  truth_.joints = arm_body_->joints(d);
  truth_.motor_torque = arm->motor_torque();
  for (std::size_t i = 0; i < kMostJoints; ++i) truth_.warmth[i] = arm->warmth(i);
}

}  // namespace enc::sim
