#include "hw_drivers/forcedimension/fake/served.h"

#include "core/base/error.h"
#include "hw_drivers/arm/fake/server.h"
#include "hw_drivers/forcedimension/drive/settings.h"
#include "hw_drivers/forcedimension/wire/dhd.h"

namespace enc::forcedimension {

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  ForceDimensionSettings settings;
  settings.declare(offer.table);
  if (offer.advance)
    throw Error("driver 'forcedimension' keeps no step with its fake; leave out --lockstep", {},
                ErrorKind::device);
  return arm::served(offer, "Force Dimension", settings.fake_place(), dhd::kCommunication);
}

}  // namespace enc::forcedimension
