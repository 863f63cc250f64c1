#include "sim/bodies/step_work.h"

#include <algorithm>
#include <cmath>

namespace enc::sim {

// The solver's result at the start of the step. The step itself will find it, because it starts from the same
// point.
void StepWork::look(const Physics& physics) {
  const mjModel* m = physics.model();
  mjData* d = physics.data();
  warm_.assign(d->qacc_warmstart, d->qacc_warmstart + m->nv);
  mj_forward(m, d);
  std::copy(warm_.begin(), warm_.end(), d->qacc_warmstart);
}

void StepWork::begin(const Physics& physics, const Scale& tool, const ArmBody* arm, const PerJoint& torque) {
  const mjModel* m = physics.model();
  const mjData* d = physics.data();
  tool_ = tool;
  if (tool.dof >= 0) {
    velocity_ = Eigen::Map<const Vec3>(d->qvel + tool.dof);
    applied_ = Eigen::Map<const Vec3>(d->qfrc_applied + tool.dof);
    applied_ += tool.mass * Eigen::Map<const Vec3>(m->opt.gravity);
  }
  if (arm == nullptr) return;
  joints_ = arm->joints(d);
  rates_ = arm->rates(d);
  std::copy_n(d->qpos, std::min<std::size_t>(static_cast<std::size_t>(m->nq), kMostDofs), qpos_.begin());
  tip_ = arm->tip(d).e();
  turned_ = arm->turned(d);
  if (torque == torque_) return;  // no jump: the torque is unchanged since the last step
  look(physics);
  held_ = held_back(physics, *arm);
  torque_ = torque;
}

Vec3 StepWork::pushed(const Physics& physics, double h) const {
  if (tool_.dof < 0) return Vec3::Zero();
  const Vec3 now = Eigen::Map<const Vec3>(physics.data()->qvel + tool_.dof);
  return applied_ - tool_.mass * (now - velocity_) / h;
}

// Dry friction and the stops, i.e. every constraint except contacts, as in the last stage of the step.
StepWork::EndTorques StepWork::held_back(const Physics& physics, const ArmBody& arm) {
  const mjModel* m = physics.model();
  const mjData* d = physics.data();
  EndTorques held;
  const auto dofs = std::min<std::size_t>(static_cast<std::size_t>(m->nv), kMostDofs);
  for (int row = 0; row < d->nefc; ++row) {
    const int type = d->efc_type[row];
    if (type > mjCNSTR_LIMIT_TENDON) break;  // contacts come last
    if (type == mjCNSTR_FRICTION_DOF || type == mjCNSTR_FRICTION_TENDON) {
      const bool tendon = type == mjCNSTR_FRICTION_TENDON;
      held.friction[tendon ? 2 : arm.joint_of(d->efc_id[row])] += d->efc_force[row];
      continue;
    }
    const double* way = d->efc_J + static_cast<std::ptrdiff_t>(row) * m->nv;
    for (std::size_t i = 0; i < dofs; ++i) held.stops[i] += d->efc_force[row] * way[i];
  }
  return held;
}

// A touch that ended within the step leaves no contact point. At the start of the step, the front's point
// nearest to the tool's tip is halfway between both. Returned in the axes of the body that carries the prop.
Vec3 StepWork::touched_first(const Physics& physics, const ArmBody& arm) const {
  const mjModel* m = physics.model();
  const Eigen::Map<const Vec3> middle(m->geom_pos + 3 * arm.front()), half(m->geom_size + 3 * arm.front());
  const double* q = m->geom_quat + 4 * arm.front();
  const Quat front(q[0], q[1], q[2], q[3]);
  const auto dof = static_cast<std::size_t>(tool_.dof);  // as many coordinates as speeds
  const Vec3 tool(qpos_[dof], qpos_[dof + 1], qpos_[dof + 2]);
  const Vec3 centre = turned_.conjugate() * (tool - tip_);
  const Vec3 near = middle + front * (front.conjugate() * (centre - middle)).cwiseMax(-half).cwiseMin(half);
  const double far = (near - centre).norm();
  if (far < 1e-9) return near;
  return 0.5 * (near + centre + tool_.radius / far * (near - centre));
}

void StepWork::count(const Physics& physics, const ArmBody& arm, const ArmTruth& truth,
                     const PerJoint& torque, const PerJoint& smooth, double h, Work& sum) {
  const mjData* d = physics.data();
  const PerJoint joints = arm.joints(d), rates = arm.rates(d);
  for (std::size_t i = 0; i < kMostJoints; ++i) {
    const double way = joints[i] - joints_[i];
    sum.motors += torque[i] * way;
    sum.friction -= smooth[i] * way;
    // The cubic through both ends has this rate at its middle.
    const double middle = 1.5 * way / h - 0.25 * (rates_[i] + rates[i]);
    sum.viscous +=
        truth.viscous[i] * h / 6.0 * (rates_[i] * rates_[i] + 4.0 * middle * middle + rates[i] * rates[i]);
  }
  const Vec3 force = pushed(physics, h);
  const bool touched = d->ncon > 0 || force.norm() > 1e-9;
  const EndTorques now = held_back(physics, arm);
  for (std::size_t i = 0; i < kMostDofs && i < static_cast<std::size_t>(physics.model()->nv); ++i)
    sum.friction -= 0.5 * (held_.stops[i] + now.stops[i]) * (d->qpos[i] - qpos_[i]);
  for (std::size_t i = 0; i < kMostJoints; ++i)
    sum.friction -= 0.5 * (held_.friction[i] + now.friction[i]) * (joints[i] - joints_[i]);
  held_ = now;
  sum.rates = rates;
  if (!touched) return;
  // The touched point, fixed to the body that carries the prop.
  const Vec3 tip = arm.tip(d).e();
  const Quat turned = arm.turned(d);
  const Vec3 at = d->ncon > 0 ? Vec3(turned.conjugate() * (Eigen::Map<const Vec3>(d->contact[0].pos) - tip))
                              : touched_first(physics, arm);
  sum.contact += force.dot(tip + turned * at - tip_ - turned_ * at);
}

}  // namespace enc::sim
