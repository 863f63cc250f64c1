#include "benchmarks/structure/structure_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Eigenvalues>

namespace enc::bench::structure {
namespace {

constexpr double kBehind = 0.91;  // kg behind the sensor
constexpr double kRod = 1e-4;     // kg, of half a leg in the closed loop: next to nothing

void set3(double* to, const Vec3& v) { std::copy_n(v.data(), 3, to); }
void set4(double* to, const Quat& q) {
  to[0] = q.w();
  set3(to + 1, q.vec());
}

mjsBody* body_of(mjsBody* parent, const std::string& name, double mass, const Vec3& centre,
                 const Vec3& inertia) {
  mjsBody* body = mjs_addBody(parent, nullptr);
  mjs_setName(body->element, name.c_str());
  body->mass = mass;
  body->explicitinertial = true;
  set3(body->ipos, centre);
  set3(body->inertia, inertia);
  return body;
}

void joint_of(mjsBody* body, mjtJoint type, const Vec3& axis, const std::string& name) {
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  mjs_setName(joint->element, name.c_str());
  joint->type = type;
  set3(joint->axis, axis);
}

// A leg as two bodies: a cardan joint at the base, a slide along the leg, tied to the platform's joint.
void close_loop(mjSpec* spec, const Hexapod& machine, int leg) {
  const std::string name = "leg" + std::to_string(leg);
  const Vec3& foot = machine.base_joint(leg);
  const Vec3 along = machine.zero().p() + machine.platform_joint(leg) - foot;
  mjsBody* lower =
      body_of(mjs_findBody(spec, "base"), name + "_lower", kRod, Vec3(0, 0, 0.03), Vec3::Constant(1e-7));
  set3(lower->pos, foot);
  set4(lower->quat, Quat::FromTwoVectors(Vec3::UnitZ(), along));
  joint_of(lower, mjJNT_HINGE, Vec3::UnitX(), name + "_x");
  joint_of(lower, mjJNT_HINGE, Vec3::UnitY(), name + "_y");
  mjsBody* upper = body_of(lower, name + "_upper", kRod, Vec3(0, 0, 0.12), Vec3::Constant(1e-7));
  joint_of(upper, mjJNT_SLIDE, Vec3::UnitZ(), name);
  mjsEquality* tie = mjs_addEquality(spec, nullptr);
  tie->type = mjEQ_CONNECT;
  tie->objtype = mjOBJ_BODY;
  mjs_setString(tie->name1, "platform");
  mjs_setString(tie->name2, (name + "_upper").c_str());
  set3(tie->data, machine.platform_joint(leg));
  tie->solref[0] = 0.001;  // s: as hard as a step of 0.5 ms allows
  tie->solimp[0] = tie->solimp[1] = 0.9999;
  // The same spring and damper as the tendon's, on the slide, whose zero is the leg's length at zero.
  auto* drive = mjs_asActuator(mjs_findElement(spec, mjOBJ_ACTUATOR, name.c_str()));
  drive->trntype = mjTRN_JOINT;
  drive->biasprm[0] = drive->biasprm[1] * machine.zero_length();
}

sim::SpecPtr spec_of(LegForm form, const sim::StructureTruth& truth, const Hexapod& machine) {
  sim::install_mujoco_handlers();
  sim::SpecPtr spec(mj_makeSpec());
  spec->option.timestep = truth.timestep;
  spec->option.integrator = truth.integrator == "rk4"     ? mjINT_RK4
                            : truth.integrator == "euler" ? mjINT_EULER
                                                          : mjINT_IMPLICITFAST;
  set3(spec->option.gravity, {0, 0, -9.80665});
  mjsBody* world = mjs_findBody(spec.get(), "world");
  mjs_setName(mjs_addBody(world, nullptr)->element, "base");
  mjsBody* platform = body_of(world, "platform", 1.0, Vec3::Zero(), Vec3::Constant(1.0));
  set3(platform->pos, machine.zero().p());
  joint_of(platform, mjJNT_FREE, Vec3::UnitZ(), "platform");
  body_of(platform, "behind_sensor", kBehind, Vec3(0, 0, -0.08), Vec3(0.002, 0.002, 0.0006));
  sim::Legs::build(spec.get(), machine, truth, truth.platform_mass + kBehind);
  if (form == LegForm::connect)
    for (int leg = 0; leg < 6; ++leg) close_loop(spec.get(), machine, leg);
  return spec;
}

}  // namespace

LegCommand swing(const Hexapod& machine, double t) {
  constexpr double kRate = 2.0 * std::numbers::pi;  // 1 Hz
  const Vec3 way = 0.010 * Vec3(2, 1, 2) / 3.0;
  const Vec3 axis = Vec3(1, 2, -2) / 3.0;
  const double angle = 3.0 * std::numbers::pi / 180.0;
  const double s = std::sin(kRate * t);
  const double c = kRate * std::cos(kRate * t);
  return {{Quat(Eigen::AngleAxisd(angle * s, axis)), Vec3(machine.zero().p() + s * way)},
          Vec<'R'>(Vec3(c * way)),
          Vec<'R'>(Vec3(c * angle * axis))};
}

LegModel::LegModel(LegForm form, const sim::StructureTruth& truth)
    : machine_(HexapodGeometry{}),
      physics_(spec_of(form, truth, machine_)),
      legs_(truth, machine_, physics_, Pose<'W', 'R'>::identity()) {
  const int joint = physics_.id(mjOBJ_JOINT, "platform");
  dof_ = physics_.model()->jnt_dofadr[joint];
  qpos_ = physics_.model()->jnt_qposadr[joint];
}

void LegModel::step(const LegCommand& from, const LegCommand& to) {
  legs_.drive(physics_.data(), legs_.at(from.pose, from.velocity, from.turning),
              legs_.at(to.pose, to.velocity, to.turning), physics_.model()->opt.timestep);
  physics_.step();
}

void LegModel::push(const Vec3& force) {
  mjData* d = physics_.data();
  std::fill_n(d->qfrc_applied, physics_.model()->nv, 0.0);
  set3(d->qfrc_applied + dof_, force);  // the free joint's speeds are those of H
}

Vec3 LegModel::tip() const { return Eigen::Map<const Vec3>(physics_.data()->qpos + qpos_); }

double LegModel::gap() const {
  const mjModel* m = physics_.model();
  const mjData* d = physics_.data();
  double largest = 0.0;
  for (int i = 0; i < d->nefc; ++i)
    if (d->efc_type[i] == mjCNSTR_EQUALITY) largest = std::max(largest, std::abs(d->efc_pos[i]));
  return m->neq > 0 ? largest : 0.0;
}

Hexapod::Lengths LegModel::measured_modes() {
  const mjModel* m = physics_.model();
  mjData* d = physics_.data();
  const LegCommand still{machine_.zero(), Vec<'R'>::zero(), Vec<'R'>::zero()};
  const sim::LegMotion zero = legs_.at(still.pose, still.velocity, still.turning);
  legs_.drive(d, zero, zero, m->opt.timestep);
  const std::vector<double> home(d->qpos, d->qpos + m->nq);
  constexpr double kStep = 1e-6;  // m, rad
  Eigen::Matrix<double, 6, 6> slope;
  for (int axis = 0; axis < 6; ++axis) {
    Eigen::Matrix<double, 6, 1> ends[2];
    for (const int side : {0, 1}) {
      Eigen::Matrix<double, 6, 1> moved = Eigen::Matrix<double, 6, 1>::Zero();
      moved(axis) = side == 0 ? -kStep : kStep;
      std::copy(home.begin(), home.end(), d->qpos);
      std::fill_n(d->qvel, m->nv, 0.0);
      mj_integratePos(m, d->qpos, moved.data(), 1.0);
      mj_forward(m, d);
      ends[side] = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(d->qacc + dof_);
    }
    slope.col(axis) = (ends[1] - ends[0]) / (2.0 * kStep);
  }
  std::copy(home.begin(), home.end(), d->qpos);
  Hexapod::Lengths hz =
      Eigen::EigenSolver<Eigen::Matrix<double, 6, 6>>(-slope, false).eigenvalues().real().cwiseSqrt() /
      (2.0 * std::numbers::pi);
  std::sort(hz.data(), hz.data() + 6);
  return hz;
}

}  // namespace enc::bench::structure
