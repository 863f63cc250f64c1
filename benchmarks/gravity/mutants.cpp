// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::gravity {
namespace {

const Mutants kMutants{
    "gravity",
    {{.what =
          "real arm 15 % heavier, with half the torque, half the counts, joints that end early, and Euler",
      .set = {"truth.arm.mass_scale=1.15", "truth.arm.peak_torque_Nm=[0.065,0.065,0.065]",
              "truth.arm.continuous_torque_Nm=[0.0143,0.0143,0.0143]", "truth.arm.counts=[2048,2048,2048]",
              "truth.arm.machine.joint_high=[0.5,1.2,2.5]", "truth.arm.integrator=euler"},
      .kills = {"residual.equal_masses.max", "residual.key_published.max", "stall.max", "continuous.min",
                "tip_mass.max", "resolution.max", "coverage.best.share_percent", "swing.error.max"}},
     {.what = "payload that is not the believed one; KDL's arm 0.1 % longer; the chain for the closed form; "
              "three times the work",
      .changes = {"other_payload", "longer_arm", "chain", "three_times"},
      .kills = {"torque_apart_from_mujoco.max", "mass_apart_from_mujoco.max", "drift.*.max",
                "apart_from_kdl.*.max", "kdl_ratio.median", "twin.step_over_reference.median"}}}};

}  // namespace
}  // namespace enc::bench::gravity
