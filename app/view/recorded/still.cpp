#include "app/view/recorded/still.h"

#include <algorithm>

#include "app/view/moment/depict.h"

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

// Moves the twin's tool to where a tracker saw one; out of sight if it saw none.
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

}  // namespace

void take_still(trial::Trial& trial, const trial::Glance& glance, bool simulated, Still& to) {
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
  to.platform = world.machine ? world.machine->state().pose : Pose<'R', 'H'>();
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

Moment moment_of(trial::Trial& trial, const Still& still, mjData* data) {
  const sim::World& world = trial.world();
  const mjModel* model = trial.world().physics().model();
  const double* from = still.at.data();
  for (const PoseArray& part : kPoseArrays) {
    std::copy_n(from, part.count(model), part.to(data));
    from += part.count(model);
  }
  const Moment moment{trial.setup(),
                      trial.scene(),
                      model,
                      data,
                      world.machine ? &world.machine->machine() : nullptr,
                      world.pusher.has_value(),
                      world.X_WR(),
                      still.platform,
                      still.q_WT,
                      still.truth,
                      still.state,
                      still.out,
                      still.now};
  shift_objects(moment, data);
  return moment;
}

}  // namespace enc::app
