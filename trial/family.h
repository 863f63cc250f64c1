// Table of the differences between the two families of machines. Only family.cpp asks which one a scene has.
#pragma once

#include <string>
#include <vector>

#include "core/control/scene/scene.h"
#include "core/control/task/tasks.h"
#include "core/devices/signals.h"
#include "models/setup/scene_file.h"
#include "trial/certificates.h"

namespace enc::trial {

// s, time of a device's sample; unset: the device has sent none.
template <class V>
[[nodiscard]] double stamp_of(const Measurement<V>& sample) {
  return sample.health == Health::absent ? kUnset : seconds(sample.t.time_since_epoch());
}

struct Family {
  // True: an arm, which takes a force (impedance rendering) and touches a bare finger with its prop. False: a
  // hexapod, which takes a pose and measures the force.
  bool takes_force;

  // Used before the first tick.
  std::vector<ObjectCertificate> (*certificates)(const models::Setup& setup, const Scene& scene, bool whole);
  std::vector<ArmStrength> (*strengths)(const models::Setup& setup, const Scene& scene);
  PassivityForm (*passivity_form)(const Scene& scene);
  // Unit of each joint that the machine reports: "rad", or "m" for a slide.
  std::vector<std::string> (*joint_units)(const Scene& scene);

  // Used in each tick.
  Point<'R'> (*tip)(const Inputs& in);    // as the machine reports it
  double (*tip_stamp)(const Inputs& in);  // stamp_of() that report
  const Passivity& (*passivity)(const State& state);
};

[[nodiscard]] const Family& family_of(const models::Setup& setup);
[[nodiscard]] const Family& family_of(const Scene& scene);

}  // namespace enc::trial
