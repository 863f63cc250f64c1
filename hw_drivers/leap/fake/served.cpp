#include "hw_drivers/leap/fake/served.h"

#include "hw_drivers/hand/fake/server.h"
#include "hw_drivers/leap/drive/settings.h"

namespace enc::leap {

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  LeapSettings settings;
  settings.declare(offer.table);
  const arm::Place place = settings.fake_place();
  hand::HandSettings lines;
  lines.address = place.host;
  lines.port = place.port;
  return hand::served(offer, lines, "Leap device");
}

}  // namespace enc::leap
