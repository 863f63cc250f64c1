#include "hw_drivers/igtl/fake/tool_server.h"

#include <utility>

#include "core/error.h"
#include "hw_drivers/igtl/drive/settings.h"

namespace enc::igtl {

ToolServer::ToolServer(PoseTracker& tracker, std::vector<std::string> devices, const std::string& address,
                       std::uint16_t port, Duration alive)
    : tracker_(tracker),
      devices_(std::move(devices)),
      address_(address),
      socket_(net::bind_udp(address, port)),
      alive_(alive) {}

std::string ToolServer::describe() const { return "tool data at " + net::place(address_, port()); }

// One client: who asks later takes its place.
void ToolServer::serve(Time now) {
  std::array<std::byte, kMostBytes> bytes{};
  for (std::size_t got = socket_.receive(bytes); got > 0; got = socket_.receive(bytes)) {
    Message message;
    if (read({bytes.data(), got}, message) != Wrong::nothing) continue;
    if (message.type.view() == "STT_TRANS") asked_ = true;
    if (message.type.view() == "STP_TRANS") asked_ = false;
    if (asked_) send(Written("STATUS", "Server", now.time_since_epoch().count(), ++number_, status_ok()));
  }
}

void ToolServer::publish(Time now) {
  if (now < sent_) sent_ = now;  // its world has begun anew
  Stamped<TrackedTool> newest;
  if (tracker_.poll(now, newest)) {
    const std::int64_t stamp = newest.t.time_since_epoch().count();
    const auto tool = static_cast<std::size_t>(newest.value.tool);
    if (newest.health == Health::ok && newest.value.tool >= 0 && tool < devices_.size()) {
      sent_ = now;
      send(Written("TRANSFORM", devices_[tool], stamp, ++number_, transform(newest.value.X_CT), kPoseKey,
                   pose_text(newest.value.X_CT)));
    }
  } else if (now - sent_ >= alive_) {
    sent_ = now;
    send(Written("STATUS", "Server", now.time_since_epoch().count(), ++number_, status_ok()));
  }
}

void ToolServer::send(const Written& message) noexcept {
  if (asked_) static_cast<void>(socket_.reply(message.bytes()));
}

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  IgtlSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.tracker)
    throw Error(
        "the scene names no [tracker], whose poses a server of tool data sends; choose another scene");
  std::vector<std::string> devices;
  for (const std::string& tool : offer.tools) devices.push_back(tool + settings.suffix);
  return std::make_unique<ToolServer>(*offer.rig.tracker, std::move(devices), settings.address,
                                      static_cast<std::uint16_t>(settings.port),
                                      offer.advance ? Duration{} : kServerPeriod);
}

}  // namespace enc::igtl
