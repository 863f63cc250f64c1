#include "hw_drivers/gripper/fake/server.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::gripper {
namespace {

constexpr int kUsualFailure = static_cast<int>(Exception::device);

}  // namespace

Server::Server(Gripper& gripper, const GripperSettings& settings, double force, Log& log, bool lockstep,
               std::uint64_t seed)
    : image_(gripper, settings, force),
      address_(settings.address),
      log_(log),
      lockstep_(lockstep),
      listener_(net::listen_tcp(settings.address, static_cast<std::uint16_t>(settings.port))),
      line_(net::BadLine::Wire::stream, seed) {}

std::string Server::describe() const { return "EK9000 with gripper at " + net::place(address_, port()); }

void Server::serve(Time now) {
  if (line_.suffers(Trouble::Kind::stall)) return;
  accept(now);
  while (client_.is_open() && answer(now)) {
  }
  if (client_.is_open()) send(now);  // send delayed data
}

void Server::publish(Time now) {
  image_.cycle(now);
  if (image_.fallbacks() == fallbacks_) return;
  fallbacks_ = image_.fallbacks();
  log_.say(fmt::format("{:.3f} s: fake EK9000: its watchdog switched the outputs off",
                       seconds(now.time_since_epoch())));
}

void Server::wait_on(std::vector<int>& descriptors) const {
  if (line_.suffers(Trouble::Kind::stall)) return;  // unread data would wake the server without end
  descriptors.push_back(listener_.descriptor());
  if (client_.is_open()) descriptors.push_back(client_.descriptor());
}

void Server::accept(Time now) {
  net::Socket next = listener_.accept();
  if (!next.is_open() || line_.suffers(Trouble::Kind::disconnect)) return;
  // The new client may have waited for the first one to leave.
  while (client_.is_open() && answer(now)) {
  }
  if (client_.is_open()) return log_.say("fake EK9000: a second client was refused");
  client_ = std::move(next);
  unsent_.clear();
  requests_.begin();
  line_.begin(now);
  switched_before_ = image_.switched();
}

bool Server::answer(Time now) {
  const std::size_t got = client_.receive(requests_.room());
  requests_.came(got);
  for (auto request = requests_.next(); request; request = requests_.next())
    line_.put(now, image_.answer(*request, now));
  send(now);
  if ((got == 0 && client_.closed()) || requests_.lost() || unsent_.overfull()) leave();
  return got > 0;
}

void Server::send(Time now) {
  line_.leave(now, [this](std::span<const std::byte> bytes) { unsent_.add(bytes); });
  unsent_.send(client_);
}

void Server::leave() {
  client_ = {};
  log_.say(fmt::format("fake EK9000: the client is gone; it switched outputs {} times",
                       image_.switched() - switched_before_));
}

bool Server::knows(const Trouble& trouble) const {
  if (trouble.kind == Trouble::Kind::error_code)
    return std::isnan(trouble.value) || CouplerImage::can_fail(trouble.value);
  return !lockstep_ && line_.knows(trouble.kind);
}

void Server::suffer(const Trouble& trouble) {
  if (trouble.kind == Trouble::Kind::error_code)
    return image_.fail(std::isnan(trouble.value) ? kUsualFailure : static_cast<int>(trouble.value));
  line_.suffer(trouble);
  if (trouble.kind == Trouble::Kind::disconnect && client_.is_open()) leave();
}

void Server::heal(Trouble::Kind kind) {
  if (kind == Trouble::Kind::error_code) return image_.fail(0);
  line_.heal(kind);
}

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  GripperSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.gripper)
    throw Error("the scene names no [gripper], which a fake coupler drives; choose another scene");
  return std::make_unique<Server>(*offer.rig.gripper, settings, offer.spec.gripper.force, offer.log,
                                  offer.advance != nullptr, offer.seed);
}

}  // namespace enc::gripper
