#include "tests/property/arm_bodies.h"

#include <algorithm>

#include "core/spec/scene_spec.h"

namespace enc::test {
namespace {

mjsBody* add_body(mjsBody* parent, const Vec3& at, double mass, const Vec3& centre, const Vec3& inertia) {
  mjsBody* body = mjs_addBody(parent, nullptr);
  std::copy_n(at.data(), 3, body->pos);
  std::copy_n(centre.data(), 3, body->ipos);
  std::copy_n(inertia.data(), 3, body->inertia);
  body->mass = mass;
  body->explicitinertial = true;
  return body;
}

void add_joint(mjsBody* body, mjtJoint type, const Vec3& axis, const ArmDrive* drive = nullptr) {
  mjsJoint* joint = mjs_addJoint(body, nullptr);
  joint->type = type;
  std::copy_n(axis.data(), 3, joint->axis);
  if (drive != nullptr) joint->armature = drive->rotor_inertia * drive->ratio * drive->ratio;
}

void add_payload(mjsBody* link, const Vec3& tip, double mass) {
  if (mass > 0.0) add_body(link, tip, mass, Vec3::Zero(), Vec3::Constant(1e-15));
}

sim::SpecPtr empty() {
  sim::SpecPtr spec(mj_makeSpec());
  spec->option.gravity[2] = -kStandardGravity;
  spec->compiler.degree = 0;
  return spec;
}

}  // namespace

Built phantom(const ArmMachine& machine, double payload) {
  const PhantomGeometry& g = machine.phantom;
  sim::SpecPtr spec = empty();
  const Vec3 lift(0, -1, 0);
  // Cavusoglu's x, y, z are y, z, x of R at zero.
  const auto turned = [](const Vec3& I) { return Vec3(I.z(), I.x(), I.y()); };
  // be and df are published about the origin of R: here about their centres. As bodies they break A + B >= C;
  // turning about the vertical with the turret, they may borrow from I_base what they lack.
  double I_base = g.I_base;
  const auto body_inertia = [&](const Vec3& I, double mass, const Vec3& centre) {
    Vec3 own = turned(I) - mass * (centre.squaredNorm() * Vec3::Ones() - centre.cwiseProduct(centre));
    const double lack = std::max(0.0, 0.5 * (own.y() - own.x() - own.z()) + 1e-9);
    own += lack * Vec3(1, 0, 1);
    I_base -= lack;
    return own;
  };
  const Vec3 be_centre(g.l5, 0, 0), df_centre(0, 0, g.l6);
  const Vec3 be_inertia = body_inertia(g.I_be, g.m_be, be_centre);
  const Vec3 df_inertia = body_inertia(g.I_df, g.m_df, df_centre);
  mjsBody* world = mjs_findBody(spec.get(), "world");
  mjsBody* turret = add_body(world, {0, 0, 0}, 0.1, {0, 0, 0}, Vec3::Constant(I_base));
  add_joint(turret, mjJNT_HINGE, {0, 0, 1}, &machine.drives[0]);
  mjsBody* be = add_body(turret, {0, 0, 0}, g.m_be, be_centre, be_inertia);
  add_joint(be, mjJNT_HINGE, lift, &machine.drives[1]);
  mjsBody* a = add_body(be, {g.l1, 0, 0}, g.m_a, {0, 0, -0.5 * g.l2}, turned(g.I_a));
  add_joint(a, mjJNT_HINGE, lift);
  add_payload(a, {0, 0, -g.l2}, payload);
  mjsBody* df = add_body(turret, {0, 0, 0}, g.m_df, df_centre, df_inertia);
  add_joint(df, mjJNT_HINGE, lift, &machine.drives[2]);
  mjsBody* c = add_body(df, {0, 0, -g.l3}, g.m_c, {0.5 * g.l1, 0, 0}, turned(g.I_c));
  add_joint(c, mjJNT_HINGE, lift);
  Eigen::MatrixXd G(5, 3);
  G << 1, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, -1;
  return {sim::Physics(std::move(spec)), G};
}

Built chain(const ArmMachine& machine, double payload) {
  sim::SpecPtr spec = empty();
  mjsBody* body = mjs_findBody(spec.get(), "world");
  for (std::size_t i = 0; i < machine.links.size(); ++i) {
    const ChainLink& link = machine.links[i];
    body = add_body(body, link.origin, link.mass, link.centre, link.inertia);
    add_joint(body, link.kind == JointKind::hinge ? mjJNT_HINGE : mjJNT_SLIDE, link.axis, &machine.drives[i]);
  }
  add_payload(body, machine.tip, payload);
  return {sim::Physics(std::move(spec)),
          Eigen::MatrixXd::Identity(static_cast<int>(machine.links.size()), 3)};
}

ArmTwin twin(const ArmMachine& machine, double payload, const sim::ArmTruth& truth) {
  sim::SpecPtr spec = empty();
  spec->option.integrator = mjINT_RK4;
  spec->option.timestep = 0.001;
  PropSpec prop;
  prop.mass = payload;
  sim::build_arm(spec.get(), {machine, truth, &prop, Pose<'W', 'R'>::shift(0.1, -0.2, 0.3)});
  sim::Physics physics(std::move(spec));
  const sim::ArmBody body(physics, Arm(machine).joints());
  return {std::move(physics), body};
}

}  // namespace enc::test
