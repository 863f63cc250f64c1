// An arm's parts for the twin's camera: grey and blue metal, far from the hue of skin.
#pragma once

#include "core/machine/arm_shape.h"
#include "sim/camera/shown.h"

namespace enc::trial {

[[nodiscard]] inline sim::Rgb colour_of(Material material) {
  switch (material) {
    case Material::metal:
      return {0.25F, 0.26F, 0.28F};
    case Material::dark:
      return {0.08F, 0.085F, 0.095F};
    case Material::painted:
      return {0.10F, 0.14F, 0.22F};
    case Material::plate:
      break;
  }
  return {0.60F, 0.62F, 0.64F};
}

[[nodiscard]] inline sim::Thing thing_of(const ArmPart& part, const Pose<'C', 'W'>& X_CW) {
  const sim::ThingShape shape = part.form == PartForm::capsule    ? sim::ThingShape::capsule
                                : part.form == PartForm::cylinder ? sim::ThingShape::cylinder
                                                                  : sim::ThingShape::box;
  return {shape, X_CW * part.middle, X_CW.q().toRotationMatrix() * part.axes, part.half,
          colour_of(part.material)};
}

}  // namespace enc::trial
