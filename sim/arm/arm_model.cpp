#include "sim/arm/arm_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/rotation.h"

namespace enc::sim {
namespace {

using Rgba = std::array<float, 4>;
constexpr Rgba kMetal{0.72F, 0.74F, 0.78F, 1}, kDark{0.20F, 0.22F, 0.26F, 1}, kAccent{0.30F, 0.42F, 0.62F, 1};
constexpr Rgba kProp{0.90F, 0.55F, 0.20F, 1};
const char* const kJoints[kMostJoints] = {"arm_1", "arm_2", "arm_3"};

void set3(double* to, const Vec3& v) { std::copy_n(v.data(), 3, to); }
void name(mjsElement* element, const char* text) {
  if (mjs_setName(element, text) != 0)
    throw Error(std::string("two parts of the simulated world are called '") + text + "'");
}

struct Solid {
  double mass;   // kg
  Vec3 centre;   // of mass, from the body's origin, m
  Vec3 inertia;  // about it, along the body's axes, kg m^2
};

mjsBody* add_body(mjsBody* parent, const Vec3& at, const Solid& solid) {
  mjsBody* body = mjs_addBody(parent, nullptr);
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

// A motor's joint: its rotor, friction, limits. `more`: inertia that turns with it and has no body.
void fit_drive(mjsJoint* joint, const ArmParts& parts, std::size_t i, double more) {
  const ArmDrive& drive = parts.machine.drives[i];
  joint->armature = drive.rotor_inertia * drive.ratio * drive.ratio + more;
  joint->damping[0] = parts.truth.viscous[i];
  if (parts.truth.friction_form == ArmFriction::dry) {
    joint->frictionloss = parts.truth.friction[i];
    // What holds must not creep: with MuJoCo's own impedance of 0.9 a tip under half of the friction does,
    // 0.1 mm in a second.
    joint->solimp_friction[0] = joint->solimp_friction[1] = 0.9999;
  }
  joint->limited = mjLIMITED_TRUE;
  joint->range[0] = drive.low;
  joint->range[1] = drive.high;
}

// The published inertias need not be those of a body: I_xx of the published upper arm is larger than the sum
// of the other two. What no body has is put on its joint, where it counts about the hinge alone: that is all
// that the equations of motion see of it.
double split(Solid& solid) {
  Vec3& inertia = solid.inertia;
  const double most = inertia.x() + inertia.z();
  const double rest = std::max(0.0, inertia.y() - most);
  inertia.y() -= rest;
  return rest;
}

// About its centre of mass, where the published one is about the hinge, `length` away.
void to_centre(Solid& solid, double across, double along, double length, const char* key) {
  const double shift = solid.mass * length * length;
  if (across < shift || along < shift)
    throw Error("an inertia about the axis is smaller than mass and centre of mass alone would make it", key);
  solid.inertia.y() = across - shift;
}

void tie(mjSpec* spec, const char* called, const char* joint, double upper, double crank) {
  mjsTendon* tendon = mjs_addTendon(spec, nullptr);
  name(tendon->element, called);
  mjs_wrapJoint(tendon, joint, 1.0);
  mjs_wrapJoint(tendon, "arm_2", upper);
  mjs_wrapJoint(tendon, "arm_3", crank);
  mjsEquality* equal = mjs_addEquality(spec, nullptr);
  equal->type = mjEQ_TENDON;
  equal->objtype = mjOBJ_TENDON;
  mjs_setString(equal->name1, called);
  std::fill_n(equal->data, 5, 0.0);
  equal->solref[0] = 2.0 * spec->option.timestep;
  equal->solref[1] = 1.0;
  equal->solimp[0] = equal->solimp[1] = 0.9999;
}

void limit_fold(mjSpec* spec, const PhantomGeometry& g) {
  mjsTendon* fold = mjs_addTendon(spec, nullptr);
  name(fold->element, "arm_fold");
  mjs_wrapJoint(fold, "arm_2", 1.0);
  mjs_wrapJoint(fold, "arm_3", -1.0);
  fold->limited = mjLIMITED_TRUE;
  fold->range[0] = g.coupled_low;
  fold->range[1] = g.coupled_high;
}

void draw(mjsBody* body, mjtGeom type, const Vec3& from, const Vec3& to, double radius, Rgba rgba) {
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom->type = type;
  set3(geom->fromto, from);
  set3(geom->fromto + 3, to);
  geom->size[0] = radius;
  geom->contype = geom->conaffinity = 0;
  geom->mass = 0;
  std::copy(rgba.begin(), rgba.end(), geom->rgba);
}

struct Phantom {
  mjsBody *turret, *upper, *crank, *link, *forearm;
};

void draw_phantom(mjsBody* base, const Phantom& p, const PhantomGeometry& g) {
  const Vec3 o = Vec3::Zero();
  draw(base, mjGEOM_CYLINDER, {0, 0, -g.l2 - 0.02}, {0, 0, -g.l2 - 0.05}, 0.06, kDark);
  draw(base, mjGEOM_CYLINDER, {0, 0, -g.l2 - 0.03}, {0, 0, -0.055}, 0.012, kMetal);
  draw(p.turret, mjGEOM_CYLINDER, {0, 0, -0.055}, {0, 0, -0.035}, 0.040, kAccent);
  draw(p.turret, mjGEOM_CAPSULE, {0, -0.022, -0.035}, {0, -0.022, 0}, 0.006, kMetal);
  draw(p.turret, mjGEOM_CAPSULE, {0, 0.022, -0.035}, {0, 0.022, 0}, 0.006, kMetal);
  draw(p.upper, mjGEOM_CYLINDER, {g.l5, 0, 0}, {2.4 * g.l5, 0, 0}, 0.0125,
       kDark);  // motors as counterweights
  draw(p.upper, mjGEOM_CAPSULE, {g.l5, 0, 0}, {g.l1, 0, 0}, 0.0055, kMetal);
  draw(p.crank, mjGEOM_CYLINDER, {0, 0, g.l6}, {0, 0, 2.0 * g.l6}, 0.0125, kDark);
  draw(p.crank, mjGEOM_CAPSULE, {0, 0, g.l6}, {0, 0, -g.l3}, 0.005, kMetal);
  draw(p.link, mjGEOM_CAPSULE, o, {g.l1, 0, 0}, 0.003, kMetal);
  draw(p.forearm, mjGEOM_CAPSULE, o, {0, 0, -g.l2}, 0.0045, kMetal);
}

// Along x where they hang or lie at q = 0: upper arm and link; along -z: crank and forearm. All hinges are
// along -y, so that a positive angle lifts the upper arm and swings the forearm out.
mjsBody* build_phantom(mjSpec* spec, mjsBody* base, const ArmParts& parts) {
  const PhantomGeometry& g = parts.machine.phantom;
  const Vec3 o = Vec3::Zero();
  // Published axes: x is the hinge; across it, y and z are those which are vertical where the link lies at 0
  // and at 90 degrees.
  const auto lying = [](const Vec3& I) { return Vec3(I.z(), I.x(), I.y()); };
  Solid be{g.m_be, {g.l5, 0, 0}, lying(g.I_be)};
  Solid df{g.m_df, {0, 0, g.l6}, lying(g.I_df)};
  Solid link{g.m_c, {0.5 * g.l1, 0, 0}, lying(g.I_c)};
  Solid forearm{g.m_a, {0, 0, -0.5 * g.l2}, lying(g.I_a)};
  to_centre(be, g.I_be.x(), g.I_be.y(), g.l5, "truth.arm.machine.I_be");
  be.inertia.z() -= g.m_be * g.l5 * g.l5;
  to_centre(df, g.I_df.x(), g.I_df.z(), g.l6, "truth.arm.machine.I_df");
  df.inertia.x() -= g.m_df * g.l6 * g.l6;
  const double at_upper = split(be) + split(link), at_crank = split(df) + split(forearm);

  Phantom p{};
  p.turret = add_body(base, o, {g.m_be, o, Vec3::Constant(g.I_base)});  // its mass stands still
  fit_drive(add_joint(p.turret, kJoints[0], mjJNT_HINGE, Vec3::UnitZ()), parts, 0, 0.0);
  p.upper = add_body(p.turret, o, be);
  fit_drive(add_joint(p.upper, kJoints[1], mjJNT_HINGE, -Vec3::UnitY()), parts, 1, at_upper);
  p.crank = add_body(p.turret, o, df);
  fit_drive(add_joint(p.crank, kJoints[2], mjJNT_HINGE, -Vec3::UnitY()), parts, 2, at_crank);
  p.link = add_body(p.crank, {0, 0, -g.l3}, link);
  add_joint(p.link, "arm_link", mjJNT_HINGE, -Vec3::UnitY());
  p.forearm = add_body(p.upper, {g.l1, 0, 0}, forearm);
  add_joint(p.forearm, "arm_forearm", mjJNT_HINGE, -Vec3::UnitY());
  tie(spec, "arm_forearm_follows_crank", "arm_forearm", 1.0, -1.0);
  tie(spec, "arm_link_follows_upper", "arm_link", -1.0, 1.0);
  limit_fold(spec, g);
  if (parts.draw) draw_phantom(base, p, g);
  return add_body(p.forearm, {0, 0, -g.l2}, {parts.prop ? parts.prop->mass : 0.0, o, o});
}

mjsBody* build_chain(mjsBody* base, const ArmParts& parts) {
  mjsBody* body = base;
  for (std::size_t i = 0; i < parts.machine.links.size(); ++i) {
    const ChainLink& link = parts.machine.links[i];
    mjsBody* next = add_body(body, link.origin, {link.mass, link.centre, link.inertia});
    const mjtJoint type = link.kind == JointKind::hinge ? mjJNT_HINGE : mjJNT_SLIDE;
    fit_drive(add_joint(next, kJoints[i], type, link.axis), parts, i, 0.0);
    if (parts.draw && link.kind == JointKind::slide) {  // its rail
      const ArmDrive& drive = parts.machine.drives[i];
      draw(body, mjGEOM_CAPSULE, link.origin + drive.low * link.axis, link.origin + drive.high * link.axis,
           0.004, kAccent);
    }
    if (parts.draw) {
      draw(next, mjGEOM_CAPSULE, Vec3::Zero(), Vec3(link.centre + 1e-4 * Vec3::UnitX()), 0.008, kMetal);
      if (link.origin.norm() > 1e-3) draw(body, mjGEOM_CAPSULE, Vec3::Zero(), link.origin, 0.006, kAccent);
    }
    body = next;
  }
  if (parts.draw && parts.machine.tip.norm() > 1e-3)
    draw(body, mjGEOM_CAPSULE, Vec3::Zero(), parts.machine.tip, 0.006, kMetal);
  return add_body(body, parts.machine.tip, {parts.prop ? parts.prop->mass : 0.0, Vec3::Zero(), Vec3::Zero()});
}

// The prop's front. Its own friction and stop count, whatever touches it.
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
  std::copy(kProp.begin(), kProp.end(), front->rgba);
}

}  // namespace

void build_arm(mjSpec* spec, const ArmParts& parts) {
  spec->compiler.degree = false;  // ranges are in rad
  mjsBody* base = mjs_addBody(mjs_findBody(spec, "world"), nullptr);
  name(base->element, "arm_base");
  set3(base->pos, parts.X_WR.p());
  const Quat q(parts.X_WR.q());
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(wxyz, 4, base->quat);
  mjsBody* tip =
      parts.machine.kind == ArmKind::phantom ? build_phantom(spec, base, parts) : build_chain(base, parts);
  name(tip->element, "prop");
  if (parts.prop != nullptr) add_front(tip, parts);
}

ArmBody::ArmBody(const Physics& physics, std::size_t joints)
    : joints_(joints), tip_(physics.id(mjOBJ_BODY, "prop")) {
  mjModel* m = physics.model();
  for (std::size_t i = 0; i < std::min(joints, kMostJoints); ++i) {
    const int id = physics.id(mjOBJ_JOINT, kJoints[i]);
    qpos_[i] = m->jnt_qposadr[id];
    dof_[i] = m->jnt_dofadr[id];
  }
  if (const int id = mj_name2id(m, mjOBJ_JOINT, "arm_forearm"); id >= 0) {
    forearm_ = m->jnt_qposadr[id];
    link_ = m->jnt_qposadr[physics.id(mjOBJ_JOINT, "arm_link")];
  }
  front_ = mj_name2id(m, mjOBJ_GEOM, "prop_front");
  if (front_ < 0) return;
  middle_ = Vec3(0, 0, -m->geom_size[3 * front_ + 2]);
  m->geom_sameframe[front_] = mjSAMEFRAME_NONE;  // it is turned against its body
}

PerJoint ArmBody::joints(const mjData* d) const noexcept {
  PerJoint q{};
  for (std::size_t i = 0; i < joints_; ++i) q[i] = d->qpos[qpos_[i]];
  return q;
}

PerJoint ArmBody::rates(const mjData* d) const noexcept {
  PerJoint v{};
  for (std::size_t i = 0; i < joints_; ++i) v[i] = d->qvel[dof_[i]];
  return v;
}

Point<'W'> ArmBody::tip(const mjData* d) const noexcept {
  return Point<'W'>(Vec3(Eigen::Map<const Vec3>(d->xpos + 3 * tip_)));
}

Vec<'W'> ArmBody::tip_velocity(const mjModel* m, const mjData* d) const noexcept {
  double v[6];
  mj_objectVelocity(m, d, mjOBJ_XBODY, tip_, v, 0);
  return {v[3], v[4], v[5]};
}

void ArmBody::drive(mjData* d, const PerJoint& torque) const noexcept {
  for (std::size_t i = 0; i < joints_; ++i) d->qfrc_applied[dof_[i]] = torque[i];
}

void ArmBody::face(mjModel* m, const mjData* d, const Quat& q_WN, const Vec3& surface) const noexcept {
  if (front_ < 0) return;
  const double* q = d->xquat + 4 * tip_;
  const Quat turn = Quat(q[0], q[1], q[2], q[3]).conjugate() * q_WN;
  const double wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy_n(wxyz, 4, m->geom_quat + 4 * front_);
  set3(m->geom_pos + 3 * front_, turn * middle_);
  set3(m->geom_surfacevel + 6 * front_, q_WN.conjugate() * surface);
  m->flg_surfacevel = m->flg_surfacevel || !surface.isZero();
}

double ArmBody::gap(const mjData* d) const noexcept {
  if (forearm_ < 0) return 0.0;
  const double fold = d->qpos[qpos_[1]] - d->qpos[qpos_[2]];
  return std::max(std::abs(d->qpos[forearm_] + fold), std::abs(d->qpos[link_] - fold));
}

}  // namespace enc::sim
