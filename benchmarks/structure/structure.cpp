// The structural hexapod: sag, vibration and convergence against theory; its cost, and that of a closed loop
// of bodies and constraints.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "sim/bodies/legs.h"
#include "trial/trial.h"

namespace enc::bench::structure {
namespace {

// The machine alone, legs and platform, for the benchmark `structure`: as tendons, as in the twin, and as a
// closed loop of bodies with `connect` constraints, which exists for comparison only.

enum class LegForm : std::uint8_t { tendon, connect };

// The servo's motion of H: 10 mm and 3 degrees at 1 Hz, slanted, from a sudden start.
struct LegCommand {
  Pose<'R', 'H'> pose;
  Vec<'R'> velocity, turning;
};

class LegModel {
 public:
  LegModel(LegForm form, const sim::StructureTruth& truth);

  void step(const LegCommand& from, const LegCommand& to);  // one physics step
  void push(const Vec3& force);                             // on H, N, until the next call
  [[nodiscard]] Vec3 tip() const;                           // H in R, m
  [[nodiscard]] double gap() const;                         // m, opening of the loops; 0 for tendons
  // The natural frequencies of the equations of motion, by differences of qacc, ascending, Hz (tendons).
  [[nodiscard]] Hexapod::Lengths measured_modes();
  [[nodiscard]] const Hexapod& machine() const { return machine_; }
  [[nodiscard]] const sim::Legs& legs() const { return legs_; }
  [[nodiscard]] sim::Physics& physics() { return physics_; }

 private:
  Hexapod machine_;
  sim::Physics physics_;
  sim::Legs legs_;
  int qpos_ = 0, dof_ = 0;  // of the platform
};

constexpr double kBehind = 0.91;  // kg behind the sensor
constexpr double kRod = 1e-4;     // kg, of half a leg in the closed loop: negligible

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
  tie->solref[0] = 0.001;  // s: the stiffest that a step of 0.5 ms allows
  tie->solimp[0] = tie->solimp[1] = 0.9999;
  // The tendon's spring and damper on the slide, whose zero is the leg's length at zero.
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
  set3(d->qfrc_applied + dof_, force);  // the free joint's velocities are those of H
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

using sim::StructureTruth;

constexpr double kMostStep = 8.0, kMostTick = 30.0;  // yardsticks: measured 3.1 and 15

struct Report {
  BenchResult& result;
  void add(std::string id, double twin, const char* unit, double low, double high, std::string note) const {
    result.figures.push_back({std::move(id), kUnset, twin, unit, Role::ours, low, high, std::move(note)});
  }
};

void add_cost(BenchResult& result, std::string id, double value, const char* unit, double high,
              std::string note) {
  Report{result}.add(std::move(id), value, unit, kUnset, high, std::move(note));
  result.figures.back().cost = true;
}

StructureTruth truth_of(const char* integrator, double timestep) {
  StructureTruth truth;
  truth.integrator = integrator;
  truth.timestep = timestep;
  return truth;
}

// The swing, H every millisecond.
struct Path {
  std::vector<Vec3> tip;
  double us_per_step = 0.0;  // CPU
  double gap = 0.0;          // m
};
Path swung(LegForm form, const char* integrator, double timestep, double seconds = 1.0) {
  LegModel model(form, truth_of(integrator, timestep));
  const int steps = static_cast<int>(std::lround(seconds / timestep));
  const int each = static_cast<int>(std::lround(1e-3 / timestep));
  Path path;
  const double start = thread_seconds();
  for (int i = 0; i < steps; ++i) {
    model.step(swing(model.machine(), i * timestep), swing(model.machine(), (i + 1) * timestep));
    path.gap = std::max(path.gap, model.gap());
    if ((i + 1) % each == 0) path.tip.push_back(model.tip());
  }
  path.us_per_step = (thread_seconds() - start) / steps * 1e6;
  return path;
}

double rms(const Path& a, const Path& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.tip.size(); ++i) sum += (a.tip[i] - b.tip[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.tip.size()));
}

// One integrator of one form, with its time step halved repeatedly.
struct Family {
  LegForm form;
  const char* integrator;
  std::vector<double> steps;  // s
  double order, tolerance;    // bounds for the halvings from `bounded` on
  std::size_t bounded;
  [[nodiscard]] const char* name() const { return form == LegForm::tendon ? "tendon" : "connect"; }
};
const std::vector<Family>& families() {
  // Steps without bounds are for the table alone: they are not small against the period of the fastest
  // vibration.
  static const std::vector<double> kFine{0.25e-3, 0.125e-3, 0.0625e-3, 0.03125e-3, 0.015625e-3, 0.0078125e-3};
  static const std::vector<Family> kAll{
      {LegForm::tendon, "rk4", {1e-3, 0.5e-3, 0.25e-3, 0.125e-3}, 4.0, 0.4, 2},
      {LegForm::tendon, "euler", kFine, 1.0, 0.2, 4},
      {LegForm::tendon, "implicitfast", kFine, 1.0, 0.2, 4},
      {LegForm::connect, "rk4", {0.5e-3, 0.25e-3}, 0.0, 0.0, 99},
  };
  return kAll;
}

// The default of truth.structure.
bool ships(const Family& family, double step) {
  const StructureTruth shipped;
  return family.form == LegForm::tendon && family.integrator == shipped.integrator &&
         std::abs(step - shipped.timestep) < 1e-9;
}

// Error against its own converged path; each halving's order; cost.
CostCurve converge(const Report& report, const Family& family, const Path& truth,
                   const std::vector<Path>& paths) {
  double before = kUnset;
  Series error_of_step{.name = fmt::format("{}, {}", family.name(), family.integrator), .mark = Mark::both};
  CostCurve error_of_cost{error_of_step.name};
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Path& path = paths[i];
    const double h = family.steps[i];
    const double error = rms(path, truth);
    const std::string id = fmt::format("structure.{}.{}.{:g}", family.name(), family.integrator, h * 1e6);
    report.add(id + ".error.rms", error * 1e6, "um", kUnset, ships(family, h) ? 0.35 : kUnset,
               fmt::format("{:.1f} us a step, {:.0f} x real time; closure gap {:.2g} um", path.us_per_step,
                           h * 1e6 / path.us_per_step, path.gap * 1e6));
    add_cost(report.result, id + ".cost.mean", path.us_per_step, "us", kUnset, "CPU time a step");
    if (i > 0) {
      const bool bounded = i >= family.bounded;
      report.add(id + ".order", std::log2(before / error), "",
                 bounded ? family.order - family.tolerance : kUnset,
                 bounded ? family.order + family.tolerance : kUnset,
                 "log2 of the error at twice this step over the error here");
    }
    before = error;
    error_of_step.add(h * 1e6, error * 1e6);
    error_of_cost.cost.push_back(path.us_per_step / (h * 1e6));
    error_of_cost.error.push_back(error * 1e6);
  }
  report.result.plots.front().series.push_back(error_of_step);
  return error_of_cost;
}

struct Job {
  LegForm form;
  const char* integrator;
  double step;  // s
  Path path{};
};
// The two converged paths, of tendons and of the closed loop, and then those of each family. All cores take
// part; the cost of a step is the CPU time of its thread.
std::vector<Job> all_swung(const BenchContext& context) {
  const double seconds = context.quick ? 0.25 : 1.0;
  const double finest = context.quick ? 0.0625e-3 : 0.015625e-3;
  std::vector<Job> jobs{{LegForm::tendon, "rk4", finest}, {LegForm::connect, "rk4", finest}};
  for (const Family& family : families())
    for (const double step : family.steps) jobs.push_back({family.form, family.integrator, step});
  in_parallel(
      jobs.size(),
      [&](std::size_t i) { jobs[i].path = swung(jobs[i].form, jobs[i].integrator, jobs[i].step, seconds); },
      context.progress);
  return jobs;
}

void work_and_precision(const Report& report, const BenchContext& context) {
  const std::vector<Job> jobs = all_swung(context);
  report.result.plots.push_back(
      {"structure.error_over_step",
       "Error of H over the time step",
       "time step (us)",
       "rms error of H (um)",
       true,
       true,
       {},
       "By theory RK4 falls with the fourth power of the step once that resolves the fastest vibration, the "
       "others with the first; the table has the orders found."});
  std::vector<CostCurve> curves;
  std::size_t next = 2;
  for (const Family& family : families()) {
    std::vector<Path> paths;
    for (std::size_t i = 0; i < family.steps.size(); ++i) paths.push_back(jobs[next++].path);
    const bool own = !context.mutated("other_form");
    curves.push_back(
        converge(report, family, jobs[(family.form == LegForm::tendon) == own ? 0 : 1].path, paths));
  }
  report.result.plots.push_back(
      cost_beside_error({.id = "structure.error_over_cost",
                         .title = "Work and precision of the hexapod's legs",
                         .x_label = "CPU time for each second of experiment (s)",
                         .y_label = "rms error of H (um)",
                         .caption = "Lower left is better: less error for less work."},
                        curves));
  report.add("structure.connect.from_tendon.rms", rms(jobs[1].path, jobs[0].path) * 1e6, "um", kUnset, kUnset,
             "between the two converged paths: 12 rods of 1 g more, soft closure");
}

// Of the legs that the formulas are about, over those of the physics.
double stiffer(const BenchContext& context) { return context.mutated("stiffer_reference") ? 1.02 : 1.0; }

void static_sag(const Report& report, const BenchContext& context) {
  LegModel model(LegForm::tendon, StructureTruth{});
  const LegCommand still{model.machine().zero(), Vec<'R'>::zero(), Vec<'R'>::zero()};
  const auto settled = [&](const Vec3& force) {
    model.push(force);
    for (int i = 0; i < 10000; ++i) model.step(still, still);  // 5 s: the softest mode fades with 4.4 /s
    mj_forward(model.physics().model(), model.physics().data());
    return model.tip();
  };
  const Vec3 free = settled(context.mutated("weight_left") ? Vec3(0, 0, -0.1) : Vec3::Zero());
  const Hexapod::Jacobian K = stiffer(context) * model.legs().stiffness();
  report.add("structure.zero.error", (free - still.pose.p()).norm() * 1e6, "um", 0, 1e-3,
             "H from its zero at rest: the weight is calibrated out");
  const Hexapod::Jacobian C = K.inverse();
  for (int axis = 2; axis >= 0; --axis) {
    const Vec3 force = -50.0 * Vec3::Unit(axis);
    const double sag = -(settled(force) - free)(axis);
    const double expected = axis == 2 ? 50.0 / K(2, 2) : 50.0 * C(axis, axis);
    const char* name = std::array{"x", "y", "z"}[static_cast<std::size_t>(axis)];
    report.add(fmt::format("structure.sag.{}.50", name), sag * 1e6, "um", 0.995 * expected * 1e6,
               1.005 * expected * 1e6,
               axis == 2 ? "against 50 N / (J'KJ)zz, 0.5 %"
                         : "against 50 N (J'KJ)^-1, 0.5 %: H is 190 mm above the joints and tilts");
  }
}

void modes(const Report& report, const BenchContext& context) {
  LegModel model(LegForm::tendon, StructureTruth{});
  const Hexapod::Lengths expected = std::sqrt(stiffer(context)) * model.legs().modes();
  const Hexapod::Lengths found = model.measured_modes();
  for (int i = 0; i < 6; ++i)
    report.add(fmt::format("structure.mode.{}.frequency", i + 1), found(i), "Hz", 0.995 * expected(i),
               1.005 * expected(i),
               fmt::format("by differences of the physics; M^-1 J'KJ says {:.1f} Hz", expected(i)));
}

// The scene in structural form.
models::Setup on_legs(const BenchContext& context, std::vector<std::string> more = {}) {
  more.emplace_back("truth.hexapod.form=structural");
  return load_scene(context, "tennis_ball", {}, more);
}

// A world of the scene in structural form, without a person; the benchmark commands its machine directly.
struct Machine {
  explicit Machine(const BenchContext& context, const std::vector<std::string>& more)
      : setup(on_legs(context, more)) {
    setup.scene.user.reset();
    scene = trial::prepare_setup(setup);
    world = std::make_unique<sim::World>(sim::WorldSpec{setup.scene, setup.rig, setup.twin, scene,
                                                        context.models + "/mjcf", context.seed, false});
  }
  const sim::Truth& go(const Vec3& from_zero, int ticks) {
    const Vec3 there = world->machine->machine().zero().p() + from_zero;
    world->machine->command(Pose<'R', 'H'>(Quat::Identity(), there));
    for (int i = 0; i < ticks; ++i) {
      world->advance();
      simulated += scene.dt;
      for (const double f : world->truth().leg_force) strongest = std::max(strongest, std::abs(f));
    }
    return world->truth();
  }
  models::Setup setup;
  Scene scene;
  std::unique_ptr<sim::World> world;
  double strongest = 0.0;  // leg force, N
  double simulated = 0.0;  // s
};

void payload(const Report& report, const BenchContext& context) {
  Machine m(context, {"truth.structure.payload_kg=10", "truth.hexapod.repeatability_um=0"});
  const double sag = -m.go(Vec3::Zero(), 1000).tip.xyz[2];
  const double kz = stiffer(context) * m.world->legs->stiffness()(2, 2);
  const double expected = 10.0 * 9.80665 / kz;
  report.add("structure.payload.sag", sag * 1e6, "um", 0.99 * expected * 1e6, 1.01 * expected * 1e6,
             "10 kg put on after calibration, at zero, against m g / (J'KJ)zz");
  sim::Physics& physics = m.world->physics();
  const int platform = physics.id(mjOBJ_BODY, "platform");
  for (const Vec3& corner : {Vec3(0.03, 0, 0.01), Vec3(-0.03, 0.03, -0.01), Vec3(0, -0.03, 0.015)})
    m.go(corner, 1500);
  physics.data()->xfrc_applied[6 * platform + 2] = context.mutated("double_push") ? -200.0 : -100.0;
  const double pushed = -m.go(Vec3::Zero(), 2000).tip.xyz[2];
  const double both = expected + 100.0 / kz;
  report.add("structure.payload.pushed.sag", pushed * 1e6, "um", 0.99 * both * 1e6, 1.01 * both * 1e6,
             "and 100 N more, likewise");
  report.add("structure.payload.leg_force.max", m.strongest, "N", 0, 171,
             "10 kg, the platform and 100 N, on the way through the workspace; sources/hexapod 3 has 74 N "
             "for 100 N");
  if (context.mutated("no_number")) {
    physics.data()->qvel[0] = kUnset;
    m.go(Vec3::Zero(), 1);
  }
  report.result.simulated += m.simulated;
  report.add("structure.payload.diverged", static_cast<double>(m.world->diverged_at()), "tick", -1, -1,
             "-1: never");
}

void repeatability(const Report& report, const BenchContext& context) {
  Machine m(context, {});
  sim::Stream random(context.seed, "arrivals");
  std::vector<Vec3> arrivals;
  const int count = static_cast<int>(context.count(100, 25));
  Vec3 mean = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    m.go(0.003 * random.normal3().normalized(), 500);
    arrivals.push_back(m.go(Vec3::Zero(), 1500).tip.e());
    mean += arrivals.back() / count;
  }
  double sum = 0.0;
  for (const Vec3& at : arrivals) sum += (at - mean).squaredNorm();
  report.result.simulated += m.simulated;
  // The rms of n numbers has an error of 1 / sqrt(2 n): 4 % for 300; four sigma.
  const double room = 4.0 / std::sqrt(6.0 * count);
  report.add("structure.repeatability.rms", std::sqrt(sum / (3.0 * (count - 1))) * 1e6, "um",
             0.5 * (1.0 - room), 0.5 * (1.0 + room),
             fmt::format("true H, along each axis, {} arrivals from random directions", count));
}

void speed(const Report& report, const BenchContext& context) {
  Yardstick yardstick;
  std::vector<double> steps(context.quick ? 3 : 7);  // s
  const int work = context.mutated("four_times") ? 4 : 1;
  for (double& step : steps) {
    for (int i = 0; i < 64; ++i) yardstick.measure();
    step = 0.0;
    for (int i = 0; i < work; ++i) step += 1e-6 * swung(LegForm::tendon, "rk4", 0.5e-3).us_per_step;
  }
  add_cost(report.result, "structure.times_real_time.swing", 0.5e-3 / median(steps), "x", kUnset,
           "legs and platform, 10 mm and 3 deg at 1 Hz, one core, CPU time of its thread");
  add_cost(report.result, "structure.step_over_yardstick.median", median(steps) / yardstick.seconds(), "x",
           kMostStep, "a step of it over a fixed piece of work of the same run (kit/cost.h)");
  trial::TrialOptions options{.seed = context.seed, .seconds = context.quick ? 10.0 : 30.0};
  Yardstick beside;
  options.watch = beside.watch();
  trial::Trial trial(on_legs(context), options);
  const double start = thread_seconds();
  const trial::TrialResult run = trial.run();
  for (int i = 1; i < work; ++i) trial::Trial(on_legs(context), options).run();
  const double cpu = thread_seconds() - start;
  report.result.simulated += run.simulated;
  add_cost(report.result, "structure.times_real_time.scene", run.simulated / cpu, "x", kUnset,
           "tennis_ball with core, hand, tracker, display, the same way");
  add_cost(report.result, "structure.tick_over_yardstick.mean",
           cpu / static_cast<double>(run.ticks) / beside.seconds(), "x", kMostTick, "a tick of it, likewise");
}

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const Report report{result};
  speed(report, context);  // runs alone, because it measures time
  work_and_precision(report, context);
  const std::array<void (*)(const Report&, const BenchContext&), 4> others{static_sag, modes, payload,
                                                                           repeatability};
  std::array<BenchResult, others.size()> parts;
  in_parallel(others.size(), [&](std::size_t i) { others[i](Report{parts[i]}, context); });
  for (const BenchResult& part : parts) {
    result.simulated += part.simulated;
    result.figures.insert(result.figures.end(), part.figures.begin(), part.figures.end());
  }
}

const Reads kReads{"structure", {.also = {"truth.structure"}}};
const Entry kEntry{"structure", "tennis_ball",
                   "hexapod on elastic legs: sag, modes, order of the integrator, cost", run};

}  // namespace
}  // namespace enc::bench::structure
