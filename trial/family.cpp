#include "trial/family.h"

#include "sim/spec/twin_spec.h"

namespace enc::trial {
namespace {

std::vector<std::string> units_of(const Arm& arm) {
  std::vector<std::string> units;
  for (std::size_t i = 0; i < arm.joints(); ++i) {
    const bool slide =
        arm.machine().kind == ArmKind::chain && arm.machine().links[i].kind == JointKind::slide;
    units.emplace_back(slide ? "m" : "rad");
  }
  return units;
}

constexpr Family kArm{
    .takes_force = true,
    .certificates = arm_certificates,
    .strengths = arm_strengths,
    .passivity_form = [](const Scene& scene) { return impedance_of(scene).rig.passivity; },
    .joint_units = [](const Scene& scene) { return units_of(impedance_of(scene).arm); },
    .tip = [](const Inputs& in) { return in.arm.value.tip; },
    .tip_stamp = [](const Inputs& in) { return stamp_of(in.arm); },
    .passivity = [](const State& state) -> const Passivity& {
      return recall<ImpedanceState>(state).passivity.energy;
    },
};

constexpr Family kHexapod{
    .takes_force = false,
    .certificates = hexapod_certificates,
    .strengths = [](const models::Setup& /*setup*/,
                    const Scene& /*scene*/) { return std::vector<ArmStrength>(); },
    .passivity_form =
        [](const Scene& scene) {
          const AdmittanceTask* render = scene.admittance();
          return render != nullptr ? render->passivity : PassivityForm::none;
        },
    .joint_units = [](const Scene& /*scene*/) { return std::vector<std::string>(); },
    .tip = [](const Inputs& in) { return in.tip.value.X_RH.origin(); },
    .tip_stamp = [](const Inputs& in) { return stamp_of(in.tip); },
    .passivity = [](const State& state) -> const Passivity& {
      return recall<AdmittanceState>(state).spent.energy;
    },
};

}  // namespace

const Family& family_of(const models::Setup& setup) {
  return *sim::PerMachine<const Family*>{&kHexapod, &kArm}.of(setup.scene);
}
const Family& family_of(const Scene& scene) { return scene.impedance() != nullptr ? kArm : kHexapod; }

std::vector<ObjectCertificate> certificates_of(const models::Setup& setup, const Scene& scene, bool whole) {
  return family_of(scene).certificates(setup, scene, whole);
}

std::vector<ArmStrength> strengths_of(const models::Setup& setup, const Scene& scene) {
  return family_of(scene).strengths(setup, scene);
}

}  // namespace enc::trial
