#include "hw_drivers/hand/fake/server.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "hw_drivers/hand/wire/coordinates.h"
#include "hw_drivers/hand/wire/line.h"

namespace enc::hand {

std::string lines_of(const Measurement<HandSample>& hand, std::int64_t frame, bool from_wrist) {
  Packet wrist;
  wrist.side = hand.value.side == HandSide::left ? Side::left : Side::right;
  wrist.frame = frame;
  wrist.stamp_ns = hand.t.time_since_epoch().count();
  wrist.fake = true;
  Packet landmarks = wrist;
  const auto pose = pose_to_wire(hand.value.wrist);
  std::copy(pose.begin(), pose.end(), wrist.values.begin());
  wrist.count = kPoseValues;
  landmarks.kind = Kind::landmarks;
  landmarks.count = kLandmarkValues;
  const Pose<'K', 'L'> X_KL = hand.value.wrist.inverse();
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    const Point<'L'>& at = hand.value.joints[i];
    const auto numbers = to_wire(from_wrist ? Vec3((X_KL * at).e()) : Vec3(at.e()));
    std::copy(numbers.begin(), numbers.end(), landmarks.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return line_of(wrist) + line_of(landmarks);
}

Server::Server(HandTracker& tracker, const HandSettings& settings, std::uint64_t seed, std::string name)
    : tracker_(tracker),
      settings_(settings),
      name_(std::move(name)),
      socket_(settings.streams()
                  ? net::listen_tcp(settings.address, static_cast<std::uint16_t>(settings.port))
                  : net::connect_udp(settings.address == "0.0.0.0" ? "127.0.0.1" : settings.address,
                                     static_cast<std::uint16_t>(settings.port))),
      line_(settings.streams() ? net::BadLine::Wire::stream : net::BadLine::Wire::datagrams, seed) {}

std::string Server::describe() const {
  return name_ + (settings_.streams() ? " with hands at " + net::place(settings_.address, port())
                                      : " that sends hands to " + settings_.place());
}

void Server::wait_on(std::vector<int>& descriptors) const {
  if (!settings_.streams() || line_.dead()) return;
  descriptors.push_back(socket_.descriptor());
}

void Server::serve(Time now) {
  if (!settings_.streams() || line_.suffers(Trouble::Kind::stall)) return;
  std::array<std::byte, 256> bytes{};  // a client has nothing to say
  while (client_.is_open() && client_.receive(bytes) > 0) {
  }
  if (client_.is_open() && client_.closed()) client_ = {};
  net::Socket next = socket_.accept();
  if (!next.is_open() || line_.dead() || client_.is_open()) return;
  client_ = std::move(next);
  unsent_.clear();
  line_.begin(now);
}

void Server::publish(Time now) {
  Measurement<HandSample> hand;
  if (tracker_.poll(now, hand) && hand.health == Health::ok) {
    const std::string lines = lines_of(hand, ++frame_, settings_.from_wrist());
    if (!settings_.streams() || client_.is_open()) line_.put(now, std::as_bytes(std::span(lines)));
  }
  leave(now);
}

void Server::leave(Time now) {
  line_.leave(now, [this](std::span<const std::byte> bytes) {
    if (settings_.streams())
      unsent_.add(bytes);
    else
      static_cast<void>(socket_.send(bytes));
  });
  if (unsent_.empty()) return;
  unsent_.send(client_);
  if (!client_.closed() && !unsent_.overfull()) return;
  client_ = {};
  unsent_.clear();
}

bool Server::knows(const Trouble& trouble) const { return line_.knows(trouble.kind); }

void Server::suffer(const Trouble& trouble) {
  line_.suffer(trouble);
  if (trouble.kind == Trouble::Kind::disconnect) client_ = {};
}

void Server::heal(Trouble::Kind kind) { line_.heal(kind); }

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  HandSettings settings;
  settings.declare(offer.table);
  return served(offer, settings, "headset");
}

std::unique_ptr<Fake> served(const FakeOffer& offer, const HandSettings& settings, const std::string& name) {
  if (!offer.rig.hand_tracker)
    throw Error("the scene names no [hand_tracker], whose hands a fake " + name +
                " sends; choose another scene");
  return std::make_unique<Server>(*offer.rig.hand_tracker, settings, offer.seed, name);
}

}  // namespace enc::hand
