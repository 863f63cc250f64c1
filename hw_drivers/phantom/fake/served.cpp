#include "hw_drivers/phantom/fake/served.h"

#include "core/base/error.h"
#include "core/machine/arm.h"
#include "hw_drivers/arm/fake/server.h"
#include "hw_drivers/phantom/drive/settings.h"
#include "hw_drivers/phantom/wire/hd.h"

namespace enc::phantom {

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  PhantomSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.arm) throw Error("the scene names no [arm], which a fake PHANToM is; choose another scene");
  const Arm arm(offer.spec.arm.machine);
  arm::ArmServerSettings of;
  of.name = "PHANToM";
  of.place = settings.fake_place();
  of.usual_error = hd::kWarmMotors;
  of.home = arm.tip(arm.zero()).xyz;
  of.advance = offer.advance;
  of.begin = offer.begin;
  of.seed = offer.seed;
  return std::make_unique<arm::ArmServer>(*offer.rig.arm, of, offer.log);
}

}  // namespace enc::phantom
