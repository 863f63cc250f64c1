#include "app/view/moment/moment.h"

#include <algorithm>

#include "app/view/moment/depict.h"
#include "core/control/world/moving.h"

namespace enc::app {
namespace {

constexpr double kOutOfSight = 100.0;  // m

struct PoseArray {
  const mjtNum* (*of)(const mjData* data);
  mjtNum* (*to)(mjData* data);
  int (*count)(const mjModel* model);  // numbers
};

constexpr PoseArray kPoseArrays[] = {
    {[](const mjData* d) -> const mjtNum* { return d->geom_xpos; }, [](mjData* d) { return d->geom_xpos; },
     [](const mjModel* m) { return 3 * static_cast<int>(m->ngeom); }},
    {[](const mjData* d) -> const mjtNum* { return d->geom_xmat; }, [](mjData* d) { return d->geom_xmat; },
     [](const mjModel* m) { return 9 * static_cast<int>(m->ngeom); }},
    {[](const mjData* d) -> const mjtNum* { return d->site_xpos; }, [](mjData* d) { return d->site_xpos; },
     [](const mjModel* m) { return 3 * static_cast<int>(m->nsite); }},
    {[](const mjData* d) -> const mjtNum* { return d->site_xmat; }, [](mjData* d) { return d->site_xmat; },
     [](const mjModel* m) { return 9 * static_cast<int>(m->nsite); }}};

// Moves the twin's tool to the pose that a tracker reported; out of sight without a report.
void put_tool(const mjModel* model, const mjData* data, const View& view, const Quat& q_WT,
              std::vector<double>& at) {
  const int body = mj_name2id(model, mjOBJ_BODY, "tool");
  if (body < 0) return;
  const bool seen = view.tool >= 0 && view.tip.finite() && view.X_WT.valid();
  const Mat3 turn =
      seen ? Mat3((Quat(view.X_WT.q()) * q_WT.conjugate()).toRotationMatrix()) : Mat3::Identity();
  const Vec3 tip = seen ? Vec3(view.tip.e()) : Vec3(Vec3::Constant(kOutOfSight));
  const Eigen::Map<const Vec3> from(data->xpos + 3 * static_cast<std::ptrdiff_t>(body));
  const int first = model->body_geomadr[body];
  for (int g = first; g < first + model->body_geomnum[body]; ++g) {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    Eigen::Map<Vec3> place(at.data() + 3 * static_cast<std::ptrdiff_t>(g));
    Eigen::Map<RowMajor> axes(at.data() + 3 * static_cast<std::ptrdiff_t>(model->ngeom) +
                              9 * static_cast<std::ptrdiff_t>(g));
    place = tip + turn * (place - from);
    axes = RowMajor(turn * Mat3(axes));
  }
}

Pose<'R', 'H'> platform_of(const sim::World& world) {
  return world.machine ? world.machine->state().pose : Pose<'R', 'H'>();
}

// Reads only data of the trial that stay constant, because another thread may run it.
Moment moment_with(trial::Trial& trial, const mjData* data, const Pose<'R', 'H'>& platform, const Quat& q_WT,
                   const sim::Truth& truth, const State& state, const Outputs& out, const Tick& now) {
  const sim::World& world = trial.world();
  return {trial.setup(),
          trial.scene(),
          trial.world().physics().model(),
          data,
          look_of(trial.setup()),
          world.machine ? &world.machine->machine() : nullptr,
          world.pusher.has_value(),
          world.X_WR(),
          platform,
          q_WT,
          truth,
          state,
          out,
          now};
}

}  // namespace

void take_still(trial::Trial& trial, const trial::Glance& glance, bool simulated, RunSnapshot& to) {
  sim::World& world = trial.world();
  const mjModel* model = world.physics().model();
  const mjData* data = world.physics().data();
  to.at.clear();
  for (const PoseArray& part : kPoseArrays)
    to.at.insert(to.at.end(), part.of(data), part.of(data) + part.count(model));
  to.truth = glance.truth;
  to.state = *glance.state;
  to.out = glance.out;
  to.now = glance.tick;
  to.platform = platform_of(world);
  to.q_WT = world.q_WT();
  to.simulated = simulated;
  if (simulated) return;
  const View& view = glance.out.view;
  put_tool(model, data, view, world.q_WT(), to.at);
  to.truth.touching = false;
  to.truth.tool = view.tool;
  to.truth.tool_tip = view.tool >= 0 ? view.tip : Point<'W'>(kUnset, kUnset, kUnset);
  if (view.tool >= 0 && view.X_WT.valid()) to.q_WT = view.X_WT.q();
}

void leave_out_vision(models::Setup& setup) {
  if (!setup.scene.camera) return;
  setup.scene.camera.reset();
  setup.notes.emplace_back("drawn without vision: the finger is tracked as [tracker] of the rig says");
}

Moment moment_of(trial::Trial& trial) {
  sim::World& world = trial.world();
  return moment_with(trial, world.physics().data(), platform_of(world), world.q_WT(), world.truth(),
                     trial.state(), trial.outputs(), trial.now());
}

Moment moment_of(trial::Trial& trial, const RunSnapshot& still, mjData* data) {
  const mjModel* model = trial.world().physics().model();
  const double* from = still.at.data();
  for (const PoseArray& part : kPoseArrays) {
    std::copy_n(from, part.count(model), part.to(data));
    from += part.count(model);
  }
  const Moment moment =
      moment_with(trial, data, still.platform, still.q_WT, still.truth, still.state, still.out, still.now);
  shift_objects(moment, data);
  return moment;
}

AugmentedSpec believed_spec(const models::Setup& setup, const Scene& scene) {
  AugmentedSpec spec;
  spec.camera = setup.rig.camera;
  spec.segmentation = setup.rig.vision.segmentation;
  if (look_of(setup).removed) spec.arm = setup.rig.arm.machine;
  if (setup.scene.prop) spec.prop = setup.scene.prop->size;
  spec.X_WR = scene.X_WR;
  spec.X_WC = scene.X_WC;
  return spec;
}

AugmentedMoment BelievedMoment::of(trial::Trial& trial) {
  const Scene& scene = trial.scene();
  AugmentedMoment moment;
  moment.joints = trial.inputs().arm.value.joints;
  if (const Contact& contact = contact_of(trial.state()); contact.X_WN.valid()) q_WN_ = contact.X_WN.q();
  moment.q_WN = q_WN_;
  const Measurement<TrackedTool>& tool = trial.inputs().tool;
  if (tool.health == Health::ok && tool.value.tool >= 0) moment.finger = tool.value.X_CT.origin();
  for (const Object& object : scene.objects)
    moment.moved.push_back(shift_of(object, moved_in(trial.state())));
  return moment;
}

}  // namespace enc::app
