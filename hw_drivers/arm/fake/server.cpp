#include "hw_drivers/arm/fake/server.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/machine/arm.h"
#include "hw_drivers/net/clocks.h"

namespace enc::arm {
namespace {

constexpr Duration kForgotten{1'000'000'000};  // a client that is silent for this long is gone

}  // namespace

ArmServer::ArmServer(HapticArm& arm, const ArmServerSettings& settings, Log& log)
    : arm_(arm),
      settings_(settings),
      log_(log),
      socket_(net::bind_udp(settings.place.host, settings.place.port)),
      line_(net::BadLine::Wire::datagrams, settings.seed) {
  const ArmAbility ability = arm_.ability();
  state_.home = settings_.home;
  state_.peak = ability.peak;
  state_.continuous = ability.continuous;
  state_.buttons = 1;
  if (settings_.advance) state_.flags |= kLockstep;
}

std::string ArmServer::describe() const {
  return settings_.name + " at " + net::place(settings_.place.host, port());
}

void ArmServer::wait_on(std::vector<int>& descriptors) const {
  if (!line_.dead()) descriptors.push_back(socket_.descriptor());  // unread data would wake without end
}

void ArmServer::serve(Time now) {
  if (line_.dead()) return;
  std::array<std::byte, sizeof(Command) + 1> bytes{};
  for (std::size_t got = socket_.receive(bytes); got > 0; got = socket_.receive(bytes)) {
    Command command;
    if (!read(std::span(bytes).first(got), command)) continue;
    if (command.header.message == Message::hello) {
      if (greet(command, now)) return;  // `now` is no longer valid
      continue;
    }
    if (command.session != session_) continue;
    heard_ = net::steady_now();
    if (command.header.message == Message::bye) leave();
    if (command.header.message == Message::force) obey(command);
  }
}

bool ArmServer::greet(const Command& command, Time now) {
  if (command.session == session_) {  // the first answer was lost
    send(now);
    return false;
  }
  if (session_ != 0 && net::steady_now() - heard_ < kForgotten) {
    log_.say(fmt::format("fake {}: a second client was refused", settings_.name));
    return false;
  }
  if (session_ != 0) leave();
  session_ = command.session;
  heard_ = net::steady_now();
  socket_.answer_sender();
  state_.number = state_.answers = answered_ = 0;
  forces_ = barks_ = 0;
  largest_ = 0.0;
  line_.begin(settings_.begin ? Time{} : now);
  if (!settings_.begin) {
    send(now);
    return false;
  }
  settings_.begin();  // publishes the first state
  return true;
}

void ArmServer::obey(const Command& command) {
  const Vec<'R'> force(command.force[0], command.force[1], command.force[2]);
  enabled_ = command.enabled != 0;
  watchdog_ = command.watchdog;
  force_ = enabled_ && force.finite() ? force : Vec<'R'>::zero();
  if (enabled_) ++forces_, largest_ = std::max(largest_, force_.norm());
  arm_.command(force_);
  state_.answers = command.number;
  answered_ = std::max(answered_, command.state);
  if (settings_.advance) settings_.advance();
}

void ArmServer::watch() {
  if (!enabled_ || !(watchdog_ > 0.0) || seconds(net::steady_now() - heard_) <= watchdog_) return;
  if (force_.norm() > 0.0) ++barks_;
  force_ = Vec<'R'>::zero();
  arm_.command(force_);
}

void ArmServer::leave() {
  session_ = 0;
  enabled_ = false;
  force_ = Vec<'R'>::zero();
  arm_.stop();
  std::string line = fmt::format("fake {}: the client is gone; it commanded {} forces of up to {:.2f} N",
                                 settings_.name, forces_, largest_);
  if (barks_ > 0) line += fmt::format("; the firmware's watchdog ended a force {} times", barks_);
  log_.say(line);
}

void ArmServer::publish(Time now) {
  watch();
  if (session_ != 0 && arm_.read(now).health != Health::absent) send(now);
}

void ArmServer::send(Time now) {
  const Measurement<ArmSample> sample = arm_.read(now);
  ++state_.number;
  state_.joints = sample.value.joints;
  state_.tip = sample.value.tip.xyz;
  state_.velocity = sample.value.velocity.xyz;
  line_.put(now, bytes_of(state_));
  line_.leave(now, [this](std::span<const std::byte> bytes) { static_cast<void>(socket_.reply(bytes)); });
}

bool ArmServer::knows(const Trouble& trouble) const {
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  if (trouble.kind == Trouble::Kind::error_code) return !(trouble.value < 1.0 || trouble.value > kMost);
  return !settings_.advance && line_.knows(trouble.kind);
}

void ArmServer::suffer(const Trouble& trouble) {
  if (trouble.kind != Trouble::Kind::error_code) return line_.suffer(trouble);
  state_.error =
      std::isnan(trouble.value) ? settings_.usual_error : static_cast<std::uint32_t>(trouble.value);
}

void ArmServer::heal(Trouble::Kind kind) {
  if (kind == Trouble::Kind::error_code) state_.error = 0;
  line_.heal(kind);
}

std::unique_ptr<Fake> served(const FakeOffer& offer, const std::string& name, const Place& place,
                             std::uint32_t usual_error) {
  if (!offer.rig.arm)
    throw Error("the scene names no [arm], which a fake " + name + " is; choose another scene");
  const Arm arm(offer.spec.arm.machine);
  ArmServerSettings of;
  of.name = name;
  of.place = place;
  of.usual_error = usual_error;
  of.home = arm.tip(arm.zero()).xyz;
  of.advance = offer.advance;
  of.begin = offer.begin;
  of.seed = offer.seed;
  return std::make_unique<ArmServer>(*offer.rig.arm, of, offer.log);
}

}  // namespace enc::arm
