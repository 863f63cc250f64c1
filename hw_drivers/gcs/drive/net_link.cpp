#include "hw_drivers/gcs/drive/net_link.h"

#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/drive/lockstep_manipulator.h"

namespace enc::gcs {

std::unique_ptr<Manipulator> connected(const Offer& offer) {
  constexpr Duration kConnect{2'000'000'000};
  GcsSettings settings;
  settings.declare(offer.table);
  net::Socket socket = net::connect_tcp(settings.address, static_cast<std::uint16_t>(settings.port), kConnect,
                                        from_seconds(settings.timeout));
  auto link = std::make_unique<NetLink>(std::move(socket));
  if (offer.lockstep) return std::make_unique<LockstepManipulator>(offer, settings, std::move(link));
  return std::make_unique<GcsManipulator>(offer, settings, std::move(link));
}

}  // namespace enc::gcs
