#include "hw_drivers/gcs/fake/server.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/gcs/drive/settings.h"

namespace enc::gcs {
namespace {

constexpr int kUsualError = 504;  // a strut does not follow

}  // namespace

Server::Server(Manipulator& machine, const ControllerSettings& settings, const std::string& address,
               std::uint16_t port, Log& log, std::function<void()> begin, std::uint64_t seed)
    : log_(log),
      lockstep_(settings.advance != nullptr),
      controller_(machine, settings),
      address_(address),
      begin_(std::move(begin)),
      listener_(net::listen_tcp(address, port)),
      line_(net::BadLine::Wire::stream, seed) {}

std::string Server::describe() const { return "C-887 at " + net::place(address_, port()); }

void Server::serve(Time now) {
  if (line_.suffers(Trouble::Kind::stall)) return;
  if (accept(now)) return;  // the simulation was restarted, so `now` is no longer valid
  while (client_.is_open() && answer(now)) {
  }
  if (client_.is_open()) send(now);  // send delayed data
}

void Server::wait_on(std::vector<int>& descriptors) const {
  if (line_.suffers(Trouble::Kind::stall)) return;  // unread data would wake the server without end
  descriptors.push_back(listener_.descriptor());
  if (client_.is_open()) descriptors.push_back(client_.descriptor());
}

// The controller serves one client. A second client is refused at once.
bool Server::accept(Time now) {
  net::Socket next = listener_.accept();
  if (!next.is_open() || line_.suffers(Trouble::Kind::disconnect)) return false;
  // The new client may have waited for the first one to leave. Handle the first one's remaining data before
  // that.
  while (client_.is_open() && answer(now)) {
  }
  if (client_.is_open()) {
    log_.say("fake C-887: a second client was refused");
    return false;
  }
  client_ = std::move(next);
  unsent_.clear();
  line_.begin(begin_ ? Time{} : now);
  controller_.forget_line();
  told_before_ = controller_.told();
  stops_before_ = controller_.stops();
  stopped_.clear();
  if (begin_) begin_();
  return begin_ != nullptr;
}

bool Server::answer(Time now) {
  std::array<char, kMostText> bytes{};
  const std::size_t got = client_.receive(std::as_writable_bytes(std::span(bytes)));
  constexpr std::size_t kStopsKept = 16;
  const std::int64_t stops = controller_.stops();
  line_.put(now, std::as_bytes(std::span(controller_.take({bytes.data(), got}))));
  if (controller_.stops() > stops && stopped_.size() < kStopsKept) stopped_.push_back(now);
  send(now);
  if ((got == 0 && client_.closed()) || unsent_.overfull()) leave();
  return got > 0;
}

void Server::leave() {
  client_ = {};
  std::string times;
  for (const Time t : stopped_) times += fmt::format(" {:.3f}", seconds(t.time_since_epoch()));
  log_.say(fmt::format("fake C-887: the client is gone; it commanded {} moves and {} stops{}",
                       controller_.told() - told_before_, controller_.stops() - stops_before_,
                       times.empty() ? times : ", in s:" + times));
}

void Server::send(Time now) {
  line_.leave(now, [this](std::span<const std::byte> bytes) { unsent_.add(bytes); });
  unsent_.send(client_);
}

bool Server::knows(const Trouble& trouble) const {
  constexpr double kMost = std::numeric_limits<int>::max();
  if (trouble.kind == Trouble::Kind::error_code) return !(trouble.value < 1.0 || trouble.value > kMost);
  return !lockstep_ && line_.knows(trouble.kind);
}

void Server::suffer(const Trouble& trouble) {
  if (trouble.kind == Trouble::Kind::error_code)
    return controller_.fail(std::isnan(trouble.value) ? kUsualError : static_cast<int>(trouble.value));
  line_.suffer(trouble);
  if (trouble.kind == Trouble::Kind::disconnect && client_.is_open()) leave();
}

void Server::heal(Trouble::Kind kind) {
  if (kind == Trouble::Kind::error_code) return controller_.mend();
  line_.heal(kind);
}

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  GcsSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.manipulator)
    throw Error("the scene names no [manipulator], which a fake C-887 moves; choose another scene");
  ControllerSettings controller;
  controller.velocity = std::max(settings.velocity, offer.spec.manipulator.speed);
  controller.most_velocity = std::max(controller.most_velocity, controller.velocity);
  controller.origin_height = settings.origin_height;
  controller.advance = offer.advance;
  return std::make_unique<Server>(*offer.rig.manipulator, controller, settings.address,
                                  static_cast<std::uint16_t>(settings.port), offer.log, offer.begin,
                                  offer.seed);
}

}  // namespace enc::gcs
