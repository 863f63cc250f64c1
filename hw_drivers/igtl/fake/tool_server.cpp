#include "hw_drivers/igtl/fake/tool_server.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "hw_drivers/igtl/drive/settings.h"

namespace enc::igtl {
namespace {

constexpr std::uint16_t kUsualError = 18;  // of a STATUS: the hardware fails

}  // namespace

ToolServer::ToolServer(PoseTracker& tracker, std::vector<std::string> devices, const std::string& address,
                       std::uint16_t port, Duration alive, std::uint64_t seed)
    : tracker_(tracker),
      devices_(std::move(devices)),
      address_(address),
      socket_(net::bind_udp(address, port)),
      alive_(alive),
      line_(net::BadLine::Wire::datagrams, seed) {}

std::string ToolServer::describe() const { return "tool data at " + net::place(address_, port()); }

// One client: who asks later takes its place.
void ToolServer::serve(Time now) {
  if (line_.dead()) return;
  std::array<std::byte, kMostBytes> bytes{};
  for (std::size_t got = socket_.receive(bytes); got > 0; got = socket_.receive(bytes)) {
    Message message;
    if (read({bytes.data(), got}, message) != Wrong::nothing) continue;
    socket_.answer_sender();
    if (message.type.view() == "STT_TRANS" && !asked_) line_.begin(now);
    if (message.type.view() == "STT_TRANS") asked_ = true;
    if (message.type.view() == "STP_TRANS") asked_ = false;
    if (asked_) say_status(now);
  }
  leave(now);
}

void ToolServer::publish(Time now) {
  if (now < sent_) sent_ = now;  // its world has begun anew
  Stamped<TrackedTool> newest;
  if (tracker_.poll(now, newest) && status_ == 1) {
    const std::int64_t stamp = newest.t.time_since_epoch().count();
    const auto tool = static_cast<std::size_t>(newest.value.tool);
    if (newest.health == Health::ok && newest.value.tool >= 0 && tool < devices_.size()) {
      sent_ = now;
      send(now, Written("TRANSFORM", devices_[tool], stamp, ++number_, transform(newest.value.X_CT), kPoseKey,
                        pose_text(newest.value.X_CT)));
    }
  } else if (now - sent_ >= alive_) {
    sent_ = now;
    say_status(now);
  }
  leave(now);
}

void ToolServer::leave(Time now) {
  line_.leave(now, [this](std::span<const std::byte> bytes) { static_cast<void>(socket_.reply(bytes)); });
}

void ToolServer::say_status(Time now) {
  send(now, Written("STATUS", "Server", now.time_since_epoch().count(), ++number_, status(status_)));
}

void ToolServer::send(Time now, const Written& message) {
  if (asked_) line_.put(now, message.bytes());
}

bool ToolServer::knows(const Trouble& trouble) const {
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  if (trouble.kind == Trouble::Kind::error_code) return !(trouble.value < 0.0 || trouble.value > kMost);
  return line_.knows(trouble.kind);
}

void ToolServer::suffer(const Trouble& trouble) {
  if (trouble.kind == Trouble::Kind::error_code) {
    status_ = std::isnan(trouble.value) ? kUsualError : static_cast<std::uint16_t>(trouble.value);
  } else {
    line_.suffer(trouble);
  }
  if (trouble.kind == Trouble::Kind::disconnect) asked_ = false;
}

void ToolServer::heal(Trouble::Kind kind) {
  if (kind == Trouble::Kind::error_code) status_ = 1;
  line_.heal(kind);
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
                                      offer.advance ? Duration{} : kServerPeriod, offer.seed);
}

}  // namespace enc::igtl
