#include "hw_drivers/forcedimension/fake/served.h"

#include "core/base/error.h"
#include "core/machine/arm.h"
#include "hw_drivers/arm/fake/server.h"
#include "hw_drivers/forcedimension/drive/settings.h"
#include "hw_drivers/forcedimension/wire/dhd.h"

namespace enc::forcedimension {

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  ForceDimensionSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.arm)
    throw Error("the scene names no [arm], which a fake of Force Dimension is; choose another scene");
  if (offer.advance)
    throw Error("driver 'forcedimension' keeps no step with its fake; leave out --lockstep", {},
                ErrorKind::device);
  const Arm arm(offer.spec.arm.machine);
  arm::ArmServerSettings of;
  of.name = "Force Dimension";
  of.place = settings.fake_place();
  of.usual_error = dhd::kCommunication;
  of.home = arm.tip(arm.zero()).xyz;
  of.begin = offer.begin;
  of.seed = offer.seed;
  return std::make_unique<arm::ArmServer>(*offer.rig.arm, of, offer.log);
}

}  // namespace enc::forcedimension
