#include "hw_drivers/phantom/fake/served.h"

#include "hw_drivers/arm/fake/server.h"
#include "hw_drivers/phantom/drive/settings.h"
#include "hw_drivers/phantom/wire/hd.h"

namespace enc::phantom {

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  PhantomSettings settings;
  settings.declare(offer.table);
  return arm::served(offer, "PHANToM", settings.fake_place(), hd::kWarmMotors);
}

}  // namespace enc::phantom
