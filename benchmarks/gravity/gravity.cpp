// Gravity compensation of the arm [VisHap 2.3.2, eq. 4 and 5]: what it leaves at the tip over the workspace,
// what the published way to add a prop costs, the machine beside its catalogue, the race against KDL.
#include "benchmarks/gravity/gravity.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/kit/kit.h"
#include "sim/spec/arm_spec.h"

namespace enc::bench::gravity {

namespace {

// Of n places along each way, the i-th in the order x, y, z: from -0.5 to 0.5.
Vec3 place_in_cube(int i, int n) {
  const int x = i % n, y = i / n % n, z = i / (n * n);
  return Vec3(x, y, z) / (n - 1) - Vec3::Constant(0.5);
}

}  // namespace

double share_in_reach(const Arm& arm, const Vec3& centre, int n) {
  int reached = 0;
  PerJoint q;
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 p = centre + place_in_cube(i, n).cwiseProduct(Eigen::Map<const Vec3>(ArmBox::kSize.data()));
    if (arm.inverse(Point<'R'>(p), q)) ++reached;
  }
  return static_cast<double>(reached) / (n * n * n);
}

ArmBox place_box(const Arm& arm, int n) {
  constexpr double kStep = 0.005;
  ArmBox box;
  const double reach = arm.tip(arm.zero()).e().norm();
  const int ahead = static_cast<int>(1.3 * reach / kStep), high = static_cast<int>(2.0 * reach / kStep);
  for (int i = 0; i <= ahead; ++i)
    for (int k = 0; k <= high; ++k) {
      const Vec3 centre(i * kStep, 0.0, k * kStep - reach);
      const double share = share_in_reach(arm, centre, 5);
      if (share <= box.share) continue;
      box.share = share;
      box.centre = centre;
    }
  const Vec3 size = Eigen::Map<const Vec3>(ArmBox::kSize.data());
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 p = box.centre + place_in_cube(i, n).cwiseProduct(size);
    PerJoint q;
    if (!arm.inverse(Point<'R'>(p), q)) continue;
    box.poses.push_back(q);
    box.points.push_back(p);
  }
  return box;
}

Vec3 residual(const Laden& believed, Compensation form, const Laden& real, const PerJoint& encoder_step,
              const PerJoint& q) {
  const PerJoint weight = real.arm.gravity(q, real.payload, Payload::exact);
  PerJoint left{};
  for (std::size_t i = 0; i < kMostJoints; ++i) left[i] = -weight[i];
  if (form != Compensation::none) {
    PerJoint read = q;
    for (std::size_t i = 0; i < kMostJoints; ++i)
      if (encoder_step[i] > 0.0) read[i] = encoder_step[i] * std::round(q[i] / encoder_step[i]);
    const Mat3 J = believed.arm.jacobian(read);
    const PerJoint wanted = believed.arm.gravity(
        read, believed.payload, form == Compensation::exact ? Payload::exact : Payload::published);
    const PerJoint motors = believed.arm.torque(J, believed.arm.force(J, wanted));
    for (std::size_t i = 0; i < kMostJoints; ++i) left[i] += motors[i];
  }
  return real.arm.force(real.arm.jacobian(q), left).e();
}

Spread residuals(const Laden& believed, Compensation form, const Laden& real, const PerJoint& encoder_step,
                 const ArmBox& box) {
  Spread spread;
  for (const PerJoint& q : box.poses)
    spread.force.push_back(residual(believed, form, real, encoder_step, q).norm());
  if (spread.force.empty()) return spread;
  spread.median = median(spread.force);
  spread.most = *std::max_element(spread.force.begin(), spread.force.end());
  return spread;
}

GravityRig gravity_rig(const BenchContext& context) {
  models::Setup setup = load_scene(context, "wall");
  const double prop = setup.scene.prop ? setup.scene.prop->mass : 0.0;
  GravityRig rig{{Arm(setup.rig.arm.machine), prop},
                 {Arm(sim::true_machine(setup.twin.arm)), prop},
                 {},
                 std::move(setup)};
  for (std::size_t i = 0; i < rig.real.arm.joints(); ++i)
    rig.encoder_step[i] =
        2.0 * M_PI / (rig.setup.twin.arm.counts[i] * rig.real.arm.machine().drives[i].ratio);
  return rig;
}

void add_figure(BenchResult& result, const std::string& id, double paper, double twin, const char* unit,
                const std::string& note, double low, double high) {
  const Role role = std::isnan(paper) ? Role::ours : Role::predicted;
  result.figures.push_back({"gravity." + id, paper, twin, unit, role, low, high, note});
}

void add_cost(BenchResult& result, const std::string& id, double value, const char* unit,
              const std::string& note, double low, double high) {
  add_figure(result, id, kUnset, value, unit, note, low, high);
  result.figures.back().cost = true;
}

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const GravityRig rig = gravity_rig(context);
  add_statics(rig, context, result);
  if (context.progress) context.progress(0.5);
  add_catalogue(rig, result);
  add_twin(rig, context, result);
  if (context.progress) context.progress(0.7);
  add_race(rig, context, result);
}

const Entry kEntry{"gravity", "wall",
                   "gravity compensation of the arm: residual force over the workspace, catalogue, race "
                   "against KDL (VisHap eq. 5)",
                   run};

}  // namespace enc::bench::gravity
