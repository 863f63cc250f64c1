#include "sim/bodies/arm_model.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/rotation.h"

namespace enc::sim {
namespace {

using Rgba = std::array<float, 4>;
constexpr Rgba kProp{0.90F, 0.55F, 0.20F, 1};
const char* const kJoints[kMostJoints] = {"arm_1", "arm_2", "arm_3"};
const char* const kElbow = "arm_elbow";  // PHANToM joint in place of arm_3: q3 - q2

void name(mjsElement* element, const char* text) {
  if (mjs_setName(element, text) != 0)
    throw Error(std::string("two parts of the simulated world are called '") + text + "'");
}

struct Solid {
  double mass;   // kg
  Vec3 centre;   // centre of mass from the body's origin, m
  Vec3 inertia;  // about that centre, along the body's axes, kg m^2
};

// The mount of a part: a body, or the base, which is a frame of the world without a body.
struct Mount {
  mjsBody* body;
  mjsFrame* frame = nullptr;
};
void hang(mjsElement* part, const Mount& on) {
  if (on.frame != nullptr && mjs_setFrame(part, on.frame) != 0)
    throw Error("a part of the arm cannot be put on its base");
}

mjsBody* add_body(const Mount& on, const Vec3& at, const Solid& solid) {
  mjsBody* body = mjs_addBody(on.body, nullptr);
  hang(body->element, on);
  set3(body->pos, at);
  body->explicitinertial = true;
  body->mass = solid.mass;
  set3(body->ipos, solid.centre);
  set3(body->inertia, solid.inertia);
  return body;
}

mjsJoint* add_joint(mjsBody* body, const char* called, mjtJoint type, const Vec3& axis) {
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  name(joint->element, called);
  joint->type = type;
  set3(joint->axis, axis);
  return joint;
}

// Sets rotor, friction and limits of a motor's joint, or of the tendon in its place. `more`: inertia that
// turns with it and has no body.
template <class Actuator>
void fit_drive(Actuator* driven, const ArmParts& parts, std::size_t i, double more) {
  const ArmDrive& drive = parts.machine.drives[i];
  driven->armature = drive.rotor_inertia * drive.ratio * drive.ratio + more;
  driven->damping[0] = parts.truth.viscous[i];
  if (parts.truth.friction_form == ArmFriction::dry) {
    driven->frictionloss = parts.truth.friction[i];
    // Friction must hold without creep. With MuJoCo's own impedance of 0.9, a tip under half of the friction
    // creeps 0.1 mm in a second. MuJoCo takes no time constant below two of its time steps.
    driven->solref_friction[0] = parts.truth.friction_time;
    driven->solimp_friction[0] = driven->solimp_friction[1] = 0.9999;
  }
  driven->limited = mjLIMITED_TRUE;
  driven->range[0] = drive.low;
  driven->range[1] = drive.high;
}

// The published inertias may be impossible for a body: I_xx of the published upper arm exceeds the sum of the
// other two. The excess goes to the joint, where it counts about the hinge alone. The equations of motion
// need no more.
double split(Solid& solid) {
  Vec3& inertia = solid.inertia;
  const double most = inertia.x() + inertia.z();
  const double rest = std::max(0.0, inertia.y() - most);
  inertia.y() -= rest;
  return rest;
}

// Checks an inertia published about the hinge, with the centre of mass `length` away from it.
void check_about_hinge(double mass, double across, double along, double length, const char* key) {
  const double shift = mass * length * length;
  if (across < shift || along < shift)
    throw Error("an inertia about the axis is smaller than mass and centre of mass alone would make it", key);
}

struct Phantom {
  mjsBody *turret, *upper, *forearm;
};

// Upper arm and forearm, each with its part of the parallelogram.
struct ArmSegments {
  Solid upper, forearm;
  double weightless;                 // share of the forearm's mass without weight
  double second = 0.0, third = 0.0;  // inertia without a body, on the joints of motors 2 and 3, kg m^2
};

// The parallelogram without its loop (docs/reference/phantom_twin.md, sources/twin 5). The link stays
// parallel to the upper arm and the crank to the forearm, so their own inertias are added to those. A mass m
// at a u2 + b u3 contributes m a^2, m a b and m b^2, with u2 along the upper arm and u3 along the forearm. A
// mass m / 4 at twice a and b contributes as much. So the link's middle, at l1 / 2 and l3, becomes a point of
// the forearm, 2 l3 from the elbow. The crank has a = 0 and is inertia alone. Weight depends on m a and m b,
// which this changes. Gravity compensation corrects the weight of the forearm, the centre of mass that of the
// upper arm. The upper arm's mass is free, because it turns about a fixed point. It is large enough for its
// inertia.
ArmSegments carried(const PhantomGeometry& g) {
  check_about_hinge(g.m_be, g.I_be.x(), g.I_be.y(), g.l5, "truth.arm.machine.I_be");
  check_about_hinge(g.m_df, g.I_df.x(), g.I_df.z(), g.l6, "truth.arm.machine.I_df");
  // Published axes: x is the hinge. Across it, y and z are the axes that are vertical with the link at 0 and
  // at 90 degrees.
  const auto lying = [](const Vec3& I) { return Vec3(I.z(), I.x(), I.y()); };
  ArmSegments c{};
  const double quarter = 0.25 * g.m_c, middle = 0.5 * g.l2, beyond = 2.0 * g.l3;
  const double mass = g.m_a + quarter;
  const double centre = (g.m_a * middle + quarter * beyond) / mass;
  if (!(centre > 0.0)) throw Error("neither forearm nor link has a mass that moves", "truth.arm.machine.m_a");
  const double spread =
      g.m_a * (middle - centre) * (middle - centre) + quarter * (beyond - centre) * (beyond - centre);
  c.forearm = {mass, {0, 0, -centre}, lying(g.I_a) + lying(g.I_df) + Vec3(spread, spread, 0)};
  c.third = split(c.forearm);
  const double with_weight = (g.m_a * middle + g.m_c * g.l3 - g.m_df * g.l6) / centre;
  c.weightless = 1.0 - with_weight / mass;

  const double moment = g.m_be * g.l5 + (0.5 * g.m_c + g.m_a - with_weight) * g.l1;  // along u2, kg m
  const Vec3 about_hinge = lying(g.I_be) + lying(g.I_c);
  const double held = 0.01 * std::min(about_hinge.y(), about_hinge.z());
  if (!(held > 0.0 && g.m_be > 0.0))
    throw Error("the upper arm has no mass or no inertia", "truth.arm.machine.m_be");
  const double heavy = std::max(g.m_be, moment * moment / held);
  const double shift = moment * moment / heavy;
  c.upper = {heavy, {moment / heavy, 0, 0}, about_hinge - Vec3(0, shift, shift)};
  c.second = split(c.upper);
  return c;
}

// The upper arm lies along x at q = 0, the forearm along -z. All hinges are along -y, so that a positive
// angle lifts the upper arm and swings the forearm out. Motor 3 turns the forearm against the turret: q3 is
// the sum of both hinges' angles, and a tendon reads it.
mjsBody* build_phantom(mjSpec* spec, const Mount& base, const ArmParts& parts) {
  const PhantomGeometry& g = parts.machine.phantom;
  const Vec3 o = Vec3::Zero();
  const ArmSegments c = carried(g);
  Phantom p{};
  p.turret = add_body(base, o, {g.m_be, o, Vec3::Constant(g.I_base)});  // its mass does not move
  fit_drive(add_joint(p.turret, kJoints[0], mjJNT_HINGE, Vec3::UnitZ()), parts, 0, 0.0);
  p.upper = add_body({p.turret}, o, c.upper);
  fit_drive(add_joint(p.upper, kJoints[1], mjJNT_HINGE, -Vec3::UnitY()), parts, 1, c.second);
  p.forearm = add_body({p.upper}, {g.l1, 0, 0}, c.forearm);
  p.forearm->gravcomp = c.weightless;
  // MuJoCo searches for negative compensation only if some body has a positive one; the turret's has no
  // effect.
  if (c.weightless < 0.0) p.turret->gravcomp = 1.0;
  mjsJoint* elbow = add_joint(p.forearm, kElbow, mjJNT_HINGE, -Vec3::UnitY());
  elbow->limited = mjLIMITED_TRUE;
  elbow->range[0] = -g.coupled_high;
  elbow->range[1] = -g.coupled_low;
  mjsTendon* third = mjs_addTendon(spec, nullptr);
  name(third->element, kJoints[2]);
  mjs_wrapJoint(third, kJoints[1], 1.0);
  mjs_wrapJoint(third, kElbow, 1.0);
  fit_drive(third, parts, 2, c.third);
  return add_body({p.forearm}, {0, 0, -g.l2}, {parts.prop ? parts.prop->mass : 0.0, o, o});
}

mjsBody* build_chain(const Mount& base, const ArmParts& parts) {
  Mount on = base;
  for (std::size_t i = 0; i < parts.machine.links.size(); ++i) {
    const ChainLink& link = parts.machine.links[i];
    mjsBody* next = add_body(on, link.origin, {link.mass, link.centre, link.inertia});
    const mjtJoint type = link.kind == JointKind::hinge ? mjJNT_HINGE : mjJNT_SLIDE;
    fit_drive(add_joint(next, kJoints[i], type, link.axis), parts, i, 0.0);
    on = {next};
  }
  return add_body(on, parts.machine.tip, {parts.prop ? parts.prop->mass : 0.0, Vec3::Zero(), Vec3::Zero()});
}

// The prop's front. Its own friction and stop apply to every contact.
void add_front(mjsBody* prop, const ArmParts& parts) {
  const PropSpec& spec = *parts.prop;
  mjsGeom* front = mjs_addGeom(prop, nullptr);
  name(front->element, "prop_front");
  front->type = mjGEOM_BOX;
  set3(front->size, 0.5 * spec.size);
  front->pos[2] = -0.5 * spec.size.z();
  front->mass = 0;
  front->contype = front->conaffinity = 1;
  front->condim = 3;
  front->priority = 1;
  front->friction[0] = parts.truth.prop_friction;
  front->solref[0] = parts.truth.contact_time;
  front->solref[1] = 1.0;
  front->solimp[0] = front->solimp[1] = 0.999;
  if (spec.kind == PropKind::drum) {
    front->solref[0] = parts.truth.belt_time;
    front->solimp[0] = front->solimp[1] = parts.truth.belt_impedance;
  }
  std::copy(kProp.begin(), kProp.end(), front->rgba);
}

}  // namespace

void build_arm(mjSpec* spec, const ArmParts& parts) {
  spec->compiler.degree = false;  // ranges are in rad
  mjsBody* world = mjs_findBody(spec, "world");
  const Mount base{world, mjs_addFrame(world, nullptr)};
  set3(base.frame->pos, parts.X_WR.p());
  const Quat q(parts.X_WR.q());
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(wxyz, 4, base.frame->quat);
  mjsBody* tip =
      parts.machine.kind == ArmKind::phantom ? build_phantom(spec, base, parts) : build_chain(base, parts);
  name(tip->element, "prop");
  if (parts.prop != nullptr) add_front(tip, parts);
}

ArmBody::ArmBody(const Physics& physics, std::size_t joints)
    : joints_(joints), tip_(physics.id(mjOBJ_BODY, "prop")) {
  mjModel* m = physics.model();
  folds_ = mj_name2id(m, mjOBJ_JOINT, kElbow) >= 0;
  for (std::size_t i = 0; i < std::min(joints, kMostJoints); ++i) {
    const int id = physics.id(mjOBJ_JOINT, folds_ && i == 2 ? kElbow : kJoints[i]);
    qpos_[i] = m->jnt_qposadr[id];
    dof_[i] = m->jnt_dofadr[id];
  }
  front_ = mj_name2id(m, mjOBJ_GEOM, "prop_front");
  if (front_ < 0) return;
  middle_ = Vec3(0, 0, -m->geom_size[3 * front_ + 2]);
  m->geom_sameframe[front_] = mjSAMEFRAME_NONE;  // the front is rotated against its body
}

PerJoint ArmBody::joints(const mjData* d) const noexcept {
  PerJoint q{};
  for (std::size_t i = 0; i < joints_; ++i) q[i] = d->qpos[qpos_[i]];
  if (folds_) q[2] += q[1];
  return q;
}

PerJoint ArmBody::rates(const mjData* d) const noexcept {
  PerJoint v{};
  for (std::size_t i = 0; i < joints_; ++i) v[i] = d->qvel[dof_[i]];
  if (folds_) v[2] += v[1];
  return v;
}

std::size_t ArmBody::joint_of(int dof) const noexcept {
  const auto* found = std::find(dof_.begin(), dof_.end() - 1, dof);
  return static_cast<std::size_t>(found - dof_.begin());
}

void ArmBody::put(mjData* d, const PerJoint& joints, const PerJoint& rates) const noexcept {
  for (std::size_t i = 0; i < joints_; ++i) {
    const bool fold = folds_ && i == 2;
    d->qpos[qpos_[i]] = joints[i] - (fold ? joints[1] : 0.0);
    d->qvel[dof_[i]] = rates[i] - (fold ? rates[1] : 0.0);
  }
}

PerJoint ArmBody::load(const mjData* d) const noexcept {
  PerJoint torque{};
  for (std::size_t i = 0; i < joints_; ++i) torque[i] = d->qfrc_bias[dof_[i]] - d->qfrc_passive[dof_[i]];
  if (folds_) torque[1] -= torque[2];
  return torque;
}

Mat3 ArmBody::mass(const mjModel* m, const mjData* d) const {
  const auto dofs = static_cast<std::size_t>(m->nv);
  std::vector<mjtNum> full(dofs * dofs);
  mj_fullM(m, d, full.data());
  Mat3 own = Mat3::Zero();
  for (std::size_t i = 0; i < joints_; ++i)
    for (std::size_t k = 0; k < joints_; ++k)
      own(static_cast<int>(i), static_cast<int>(k)) =
          full[static_cast<std::size_t>(dof_[i]) * dofs + static_cast<std::size_t>(dof_[k])];
  if (!folds_) return own;
  Mat3 G = Mat3::Identity();  // d (these joints of MuJoCo) / d (joints of the arm)
  G(2, 1) = -1.0;
  return G.transpose() * own * G;
}

Point<'W'> ArmBody::tip(const mjData* d) const noexcept {
  return Point<'W'>(Vec3(Eigen::Map<const Vec3>(d->xpos + 3 * tip_)));
}

Quat ArmBody::turned(const mjData* d) const noexcept {
  const double* q = d->xquat + 4 * tip_;
  return {q[0], q[1], q[2], q[3]};
}

Vec<'W'> ArmBody::tip_velocity(const mjModel* m, const mjData* d) const noexcept {
  double v[6];
  mj_objectVelocity(m, d, mjOBJ_XBODY, tip_, v, 0);
  return {v[3], v[4], v[5]};
}

void ArmBody::drive(mjData* d, const PerJoint& torque) const noexcept {
  for (std::size_t i = 0; i < joints_; ++i) d->qfrc_applied[dof_[i]] = torque[i];
  if (folds_) d->qfrc_applied[dof_[1]] += torque[2];
}

void ArmBody::face(mjModel* m, const mjData* d, const Quat& q_WN, const Vec3& surface) const noexcept {
  if (front_ < 0) return;
  const Quat turn = turned(d).conjugate() * q_WN;
  const double wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy_n(wxyz, 4, m->geom_quat + 4 * front_);
  set3(m->geom_pos + 3 * front_, turn * middle_);
  set3(m->geom_surfacevel + 6 * front_, q_WN.conjugate() * surface);
  m->flg_surfacevel = m->flg_surfacevel || !surface.isZero();
}

}  // namespace enc::sim
