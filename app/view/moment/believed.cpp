#include "app/view/moment/believed.h"

#include "core/control/world/moving.h"

namespace enc::app {

AugmentedSpec believed_spec(const models::Setup& setup, const Scene& scene) {
  AugmentedSpec spec;
  spec.camera = setup.rig.camera;
  spec.segmentation = setup.rig.vision.segmentation;
  if (setup.scene.arm) spec.arm = setup.rig.arm.machine;
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
  const Stamped<TrackedTool>& tool = trial.inputs().tool;
  if (tool.health == Health::ok && tool.value.tool >= 0) moment.finger = tool.value.X_CT.origin();
  for (const Object& object : scene.objects)
    moment.moved.push_back(shift_of(object, moved_in(trial.state())));
  return moment;
}

}  // namespace enc::app
