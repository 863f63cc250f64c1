#include "hw_drivers/igtl/fake/tool_server.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/net/big_endian.h"

namespace enc::igtl {

// ---- the server socket

Door::Door(Transport transport, const std::string& address, std::uint16_t port, std::uint64_t seed)
    : transport_(transport),
      socket_(transport == Transport::tcp ? net::listen_tcp(address, port) : net::bind_udp(address, port)),
      line_(transport == Transport::tcp ? net::BadLine::Wire::stream : net::BadLine::Wire::datagrams, seed) {}

// A stalled line does not wait on its sockets, because unread data would wake the server without end.
void Door::wait_on(std::vector<int>& descriptors) const {
  const bool stands = line_.suffers(Trouble::Kind::stall);
  if (stands || (transport_ == Transport::udp && line_.dead())) return;
  descriptors.push_back(socket_.descriptor());
  if (client_.is_open()) descriptors.push_back(client_.descriptor());
}

bool Door::open(Time now) {
  if (transport_ == Transport::udp || line_.suffers(Trouble::Kind::stall)) return false;
  if (client_.is_open()) {  // only a read reveals that the client has gone
    stream_.came(client_.receive(stream_.room()));
    if (client_.closed()) client_ = {};
  }
  net::Socket who = socket_.accept();
  if (!who.is_open() || line_.dead() || client_.is_open()) return false;  // refused: the connection closes
  client_ = std::move(who);
  stream_.begin();
  unsent_.clear();
  line_.begin(now);
  return true;
}

std::span<const std::byte> Door::next() {
  if (line_.dead()) return {};
  if (transport_ == Transport::udp) return std::span(datagram_).first(socket_.receive(datagram_));
  std::span<const std::byte> message = stream_.next();
  if (message.empty() && !stream_.lost()) {
    stream_.came(client_.receive(stream_.room()));
    message = stream_.next();
  }
  if (stream_.lost()) client_ = {};
  return message;
}

void Door::put(Time now, std::span<const std::byte> message) {
  if (transport_ == Transport::udp || client_.is_open()) line_.put(now, message);
}

void Door::leave(Time now) {
  line_.leave(now, [this](std::span<const std::byte> bytes) {
    if (transport_ == Transport::udp)
      static_cast<void>(socket_.reply(bytes));
    else
      unsent_.add(bytes);
  });
  if (transport_ == Transport::udp || unsent_.empty()) return;
  unsent_.send(client_);
  if (client_.closed() || unsent_.overfull()) {
    client_ = {};
    unsent_.clear();
  }
}

void Door::suffer(const Trouble& trouble) noexcept {
  line_.suffer(trouble);
  if (trouble.kind == Trouble::Kind::disconnect) client_ = {};
}

// ---- the server of tool data

namespace {

constexpr std::uint16_t kUsualError = 18;                 // STATUS code: hardware failure
constexpr std::array<std::byte, 1> kTaken{std::byte{0}};  // content of RTS_TDATA

Duration resolution(std::span<const std::byte> content) {
  if (content.size() < 4) return {};
  return std::max<std::int32_t>(net::take<std::int32_t>(content, 0), 0) * Duration(1'000'000);
}

}  // namespace

ToolServer::ToolServer(PoseTracker& tracker, std::vector<std::string> devices,
                       const ToolServerSettings& settings)
    : tracker_(tracker),
      devices_(std::move(devices)),
      settings_(settings),
      door_(settings.transport, settings.address, settings.port, settings.seed) {}

std::string ToolServer::describe() const {
  return (streams() ? "tracker's server at " : "tool data at ") + net::place(settings_.address, port());
}

void ToolServer::serve(Time now) {
  if (door_.open(now)) {  // a streaming server sends to every client, in the oldest message type
    asked_ = true;
    tdata_ = knows_two_ = false;
    apart_ = {};
  }
  for (auto bytes = door_.next(); !bytes.empty(); bytes = door_.next())
    if (Message message; read(bytes, message) == MessageFault::nothing) answer(now, message);
  door_.leave(now);
}

void ToolServer::answer(Time now, const Message& message) {
  const std::string_view type = message.type.view();
  knows_two_ = knows_two_ || message.numbered;
  if (type == "STT_TDATA" || type == "STP_TDATA") {
    tdata_ = type == "STT_TDATA";
    apart_ = tdata_ ? resolution(message.content) : Duration{};
    say(now, "RTS_TDATA", "Tracker", 0, kTaken);
  }
  if (!streams()) {
    door_.answer_sender();
    if (type == "STT_TRANS" && !asked_) door_.begin(now);
  }
  if (type == "STT_TRANS") asked_ = true;
  if (type == "STP_TRANS") asked_ = false;
  if (asked_ && (!streams() || type == "GET_STATUS")) say_status(now);
}

void ToolServer::publish(Time now) {
  if (now < sent_) sent_ = posed_ = now;  // the simulation was restarted
  Measurement<TrackedTool> newest;
  const bool seen = tracker_.poll(now, newest) && newest.health == Health::ok && newest.value.tool >= 0 &&
                    static_cast<std::size_t>(newest.value.tool) < devices_.size();
  if (seen && status_ == 1 && now - posed_ >= apart_) {
    say_pose(now, newest);
  } else if (now - sent_ >= settings_.alive && (!streams() || settings_.alive == Duration{})) {
    sent_ = now;
    say_status(now);
  }
  door_.leave(now);
}

void ToolServer::say_pose(Time now, const Measurement<TrackedTool>& newest) {
  sent_ = posed_ = now;
  const std::string& device = devices_[static_cast<std::size_t>(newest.value.tool)];
  const std::int64_t stamp = newest.t.time_since_epoch().count();
  const std::string exact = pose_text(newest.value.X_CT);
  if (tdata_)
    say(now, "TDATA", "Tracker", stamp, element(device, newest.value.X_CT), kPoseKey, exact);
  else
    say(now, "TRANSFORM", device, stamp, transform(newest.value.X_CT), kPoseKey, exact);
}

void ToolServer::say_status(Time now) {
  say(now, "STATUS", kFakeName, now.time_since_epoch().count(), status(status_));
}

void ToolServer::say(Time now, const char* type, std::string_view device, std::int64_t stamp_ns,
                     std::span<const std::byte> content, std::string_view key, std::string_view value) {
  ++number_;
  if (!asked_) return;
  if (!streams() || knows_two_)
    door_.put(now, OutgoingMessage(type, device, stamp_ns, number_, content, key, value).bytes());
  else
    door_.put(now, OutgoingMessage(type, device, stamp_ns, content).bytes());
}

bool ToolServer::knows(const Trouble& trouble) const {
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  if (trouble.kind == Trouble::Kind::error_code) return !(trouble.value < 0.0 || trouble.value > kMost);
  return door_.knows(trouble.kind);
}

void ToolServer::suffer(const Trouble& trouble) {
  if (trouble.kind == Trouble::Kind::error_code) {
    status_ = std::isnan(trouble.value) ? kUsualError : static_cast<std::uint16_t>(trouble.value);
  } else {
    door_.suffer(trouble);
  }
  if (trouble.kind == Trouble::Kind::disconnect) asked_ = false;
}

void ToolServer::heal(Trouble::Kind kind) {
  if (kind == Trouble::Kind::error_code) status_ = 1;
  door_.heal(kind);
}

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  IgtlSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.tracker)
    throw Error(
        "the scene names no [tracker], whose poses a server of tool data sends; choose another scene");
  std::vector<std::string> devices;
  for (const std::string& tool : offer.tools) devices.push_back(tool + settings.suffix);
  return std::make_unique<ToolServer>(
      *offer.rig.tracker, std::move(devices),
      ToolServerSettings{settings.streams() ? Transport::tcp : Transport::udp, settings.address,
                         static_cast<std::uint16_t>(settings.port),
                         offer.advance ? Duration{} : kServerPeriod, offer.seed});
}

}  // namespace enc::igtl
