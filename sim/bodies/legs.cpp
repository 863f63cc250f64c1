#include "sim/bodies/legs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/base/error.h"

namespace enc::sim {
namespace {

using Wrench6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
constexpr int kLegs = 6;
// Stored in mjData's userdata, which is saved with the rest: start time of the step, then four coefficients a
// leg.
constexpr int kWords = 1 + 4 * kLegs;

// MuJoCo requests controls at the time of every stage of a step.
void lead(const mjModel* m, mjData* d) {
  if (m->nuserdata != kWords || m->nu != kLegs) return;  // belongs to another world in this process
  const double s = d->time - d->userdata[0];
  for (int leg = 0; leg < kLegs; ++leg) {
    const double* a = d->userdata + 1 + 4 * leg;
    d->ctrl[leg] = a[0] + s * (a[1] + s * (a[2] + s * a[3]));
  }
}

// c = 2 zeta sqrt(k m / 6): a leg with a sixth of the moved mass has the damping ratio zeta. The vertical
// mode has the stiffness of 5.2 legs instead of 6, so it gets 0.93 zeta; softer modes get less.
double damping_of(const StructureTruth& truth, double moved_mass) {
  return 2.0 * truth.leg_damping * std::sqrt(truth.leg_stiffness * moved_mass / kLegs);
}

std::string leg_name(int leg, const char* end) { return "leg" + std::to_string(leg) + end; }

void add_joint_site(mjsBody* body, const Vec3& at, const std::string& name) {
  mjsSite* site = mjs_addSite(body, nullptr);
  std::copy_n(at.data(), 3, site->pos);
  mjs_setName(site->element, name.c_str());
}

void add_leg(mjSpec* spec, int leg, double stiffness, double damping) {
  const std::string name = leg_name(leg, "");
  mjsTendon* tendon = mjs_addTendon(spec, nullptr);
  mjs_setName(tendon->element, name.c_str());
  mjs_wrapSite(tendon, leg_name(leg, "_base").c_str());
  mjs_wrapSite(tendon, leg_name(leg, "_platform").c_str());
  // force = k (control - length) - c rate; the control leads by c / k of its own rate.
  mjsActuator* drive = mjs_addActuator(spec, nullptr);
  mjs_setName(drive->element, name.c_str());
  drive->trntype = mjTRN_TENDON;
  mjs_setString(drive->target, name.c_str());
  drive->gaintype = mjGAIN_FIXED;
  drive->gainprm[0] = stiffness;
  drive->biastype = mjBIAS_AFFINE;
  drive->biasprm[1] = -stiffness;
  drive->biasprm[2] = -damping;
}

void set_inertia(mjsBody* body, double mass, const Vec3& centre, const Vec3& inertia) {
  body->mass = mass;
  body->explicitinertial = true;
  std::copy_n(centre.data(), 3, body->ipos);
  std::copy_n(inertia.data(), 3, body->inertia);
}

// Weight on the legs: force and moment about H in R's axes, from all moving bodies except the payload.
Wrench6 weight(const Physics& physics, int platform, int payload, const Pose<'W', 'R'>& X_WR) {
  const mjModel* m = physics.model();
  const Eigen::Map<const Vec3> gravity(m->opt.gravity);
  const Eigen::Map<const Vec3> H(physics.data()->xpos + 3 * platform);
  Wrench6 total = Wrench6::Zero();
  for (int body = platform; body < m->nbody; ++body) {
    if (m->body_rootid[body] != platform || body == payload) continue;
    const Vec3 force = X_WR.q().conjugate() * Vec3(m->body_mass[body] * gravity);
    const Vec3 arm =
        X_WR.q().conjugate() * Vec3(Eigen::Map<const Vec3>(physics.data()->xipos + 3 * body) - H);
    total.head<3>() += force;
    total.tail<3>() += arm.cross(force);
  }
  return total;
}

// Mass matrix of the platform with its load, for motions of H along and about R's axes, at zero.
Mat6 mass_matrix(const Physics& physics, int first_dof, const Pose<'W', 'R'>& X_WR) {
  const mjModel* m = physics.model();
  Eigen::MatrixXd all(m->nv, m->nv);
  mj_fullM(m, physics.data(), all.data());
  Mat6 turn = Mat6::Identity();  // MuJoCo: speeds along the world's axes, rates about the body's
  turn.topLeftCorner<3, 3>() = X_WR.q().toRotationMatrix();
  const Mat6 M = all.block<6, 6>(first_dof, first_dof);
  return turn.transpose() * M * turn;
}

// Longest step of a method, in radians of the fastest vibration: its limit less about a tenth.
double longest_step(int integrator) {
  if (integrator == mjINT_DISCRETE) return std::numeric_limits<double>::infinity();
  return integrator == mjINT_RK4 ? 2.5 : 1.8;
}

}  // namespace

void Legs::build(mjSpec* spec, const Hexapod& machine, const StructureTruth& truth, double moved_mass) {
  spec->nuserdata = kWords;
  mjsBody* base = mjs_findBody(spec, "base");
  mjsBody* platform = mjs_findBody(spec, "platform");
  // A disc of the platform's size in its joint plane; the payload is a cube of 10 cm on top of it.
  const double r = machine.geometry().platform_radius;
  const Vec3 plate(0, 0, -machine.geometry().tip_height);
  set_inertia(platform, truth.platform_mass, plate, truth.platform_mass * r * r * Vec3(0.25, 0.25, 0.5));
  if (truth.payload > 0.0) {
    mjsBody* payload = mjs_addBody(platform, nullptr);
    mjs_setName(payload->element, "payload");
    set_inertia(payload, truth.payload, plate + Vec3(0, 0, 0.05), Vec3::Constant(truth.payload * 0.01 / 6.0));
  }
  for (int leg = 0; leg < kLegs; ++leg) {
    add_joint_site(base, machine.base_joint(leg), leg_name(leg, "_base"));
    add_joint_site(platform, machine.platform_joint(leg), leg_name(leg, "_platform"));
    add_leg(spec, leg, truth.leg_stiffness, damping_of(truth, moved_mass));
  }
}

Legs::Legs(const StructureTruth& truth, const Hexapod& machine, Physics& physics, const Pose<'W', 'R'>& X_WR)
    : machine_(machine), stiffness_(truth.leg_stiffness) {
  [[maybe_unused]] static const bool kInstalled = (mjcb_control = lead) != nullptr;  // once in a process
  const mjModel* m = physics.model();
  mjData* d = physics.data();
  damping_ = -m->actuator_biasprm[2];
  const int joint = physics.id(mjOBJ_JOINT, "platform");
  const Pose<'W', 'H'> X_WH = X_WR * machine.zero();
  double* q = d->qpos + m->jnt_qposadr[joint];
  std::copy_n(X_WH.xyz.begin(), 3, q);
  q[3] = X_WH.xyzw[3];
  std::copy_n(X_WH.xyzw.begin(), 3, q + 4);
  mj_fwdPosition(m, d);

  const int platform = physics.id(mjOBJ_BODY, "platform");
  const int payload = mj_name2id(m, mjOBJ_BODY, "payload");
  const Mat6 J = machine.jacobian(machine.zero());
  preload_ = J.transpose().partialPivLu().solve(-weight(physics, platform, payload, X_WR)) / stiffness_;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat6> vibration(
      stiffness(), mass_matrix(physics, m->jnt_dofadr[joint], X_WR), Eigen::EigenvaluesOnly);
  modes_ = vibration.eigenvalues().cwiseSqrt() / (2.0 * std::numbers::pi);
  const double longest = longest_step(m->opt.integrator) / (2.0 * std::numbers::pi * modes_(5));
  if (!(m->opt.timestep <= longest))
    throw Error("the legs vibrate with up to " + std::to_string(std::lround(modes_(5))) +
                    " Hz; expected a time step of at most " + std::to_string(std::lround(longest * 1e6)) +
                    " us; lower 'timestep_us' or take 'integrator = \"discrete\"'",
                "truth.structure.timestep");
}

LegMotion Legs::at(const Pose<'R', 'H'>& X_RH, const Vec<'R'>& velocity,
                   const Vec<'R'>& turning) const noexcept {
  Wrench6 twist;
  twist << velocity.e(), turning.e();
  return {machine_.inverse(X_RH) + preload_, machine_.jacobian(X_RH) * twist};
}

void Legs::drive(mjData* data, const LegMotion& from, const LegMotion& to, double h) const noexcept {
  const double lead_time = damping_ / stiffness_;
  data->userdata[0] = data->time;
  for (int leg = 0; leg < kLegs; ++leg) {
    const double v0 = from.rate(leg);
    const double v1 = to.rate(leg);
    const double mean = (to.length(leg) - from.length(leg)) / h;
    const double a2 = (3.0 * mean - 2.0 * v0 - v1) / h;
    const double a3 = (v0 + v1 - 2.0 * mean) / (h * h);
    double* a = data->userdata + 1 + 4 * leg;
    a[0] = from.length(leg) + lead_time * v0;
    a[1] = v0 + 2.0 * lead_time * a2;
    a[2] = a2 + 3.0 * lead_time * a3;
    a[3] = a3;
  }
}

Hexapod::Lengths Legs::forces(const mjData* data) const noexcept {
  return Eigen::Map<const Hexapod::Lengths>(data->actuator_force);
}

Hexapod::Jacobian Legs::stiffness() const {
  const Mat6 J = machine_.jacobian(machine_.zero());
  return stiffness_ * J.transpose() * J;
}

}  // namespace enc::sim
