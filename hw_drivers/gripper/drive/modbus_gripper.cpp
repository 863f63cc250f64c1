#include "hw_drivers/gripper/drive/modbus_gripper.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/lockstep.h"
#include "hw_drivers/net/socket.h"

namespace enc::gripper {

ModbusGripper::ModbusGripper(const Offer& offer, const GripperSettings& settings)
    : settings_(settings),
      coupler_(settings),
      found_(inspect(coupler_, settings)),
      log_(offer.log),
      lockstep_(offer.lockstep),
      conversation_(coupler_, settings) {
  if (offer.rig.force.stale < settings.poll)
    throw Error(
        fmt::format("{}: stale_ms of [force] is {:g}, and poll_ms is {:g}: each reading would be lost "
                    "before the next; expected poll_ms and twice the longest answer",
                    settings.place(), 1e3 * offer.rig.force.stale, 1e3 * settings.poll),
        {}, ErrorKind::device);
  if (!lockstep_) thread_ = std::thread([this] { talk(); });
}

ModbusGripper::~ModbusGripper() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
}

std::string ModbusGripper::describe() const {
  return fmt::format("coupler {} at {}, {} digital outputs, {} inputs, watchdog {} ms, answered",
                     net::printable(found_.identity), settings_.place(), found_.outputs, found_.inputs,
                     found_.watchdog);
}

Measurement<GripSample> ModbusGripper::read(Time now) noexcept {
  tick_ = now.time_since_epoch();
  if (lockstep_) turn();
  bool news = reports_.read(report_);
  // Only the first reading waits, so that a run does not begin in hold.
  for (const Duration begun = net::steady_now();
       !read_ && !report_.read && linked() && net::steady_now() - begun < from_seconds(settings_.timeout);) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    news = reports_.read(report_) || news;
  }
  if (!report_.read) return {report_.jaws, now, linked() ? Health::absent : Health::fault};
  // Subtract the report's age once, when it is new. The inputs are from the middle of question and answer.
  if (news) {
    const Duration middle = report_.asked + (report_.answered - report_.asked) / 2;
    const Time t = lockstep_ ? now : now - std::max(Duration{}, net::steady_now() - middle);
    stamp_ = read_ ? std::max(stamp_, t) : t;
    read_ = true;
  }
  const bool good = linked() && report_.trap == Trap::none;
  return {report_.jaws, stamp_, good ? said_ : Health::fault};
}

// The gripper has one force, which a person sets at its rotary switch.
void ModbusGripper::command(const Grip& grip) noexcept {
  if (grip.closed && !std::isfinite(grip.force)) {
    said_ = Health::fault;
    return;
  }
  constexpr double kSame = 1e-3;
  const bool other = grip.closed && std::abs(grip.force - settings_.force) > kSame * settings_.force;
  said_ = other ? Health::out_of_range : Health::ok;
  ++order_.number;
  order_.closed = grip.closed;
  orders_.write(order_);
}

void ModbusGripper::stop() noexcept {
  if (order_.number == 0) return;
  ++order_.stops;
  order_.stopped = order_.number;
  orders_.write(order_);
  if (lockstep_) return turn();
  constexpr Duration kStopTime{100'000'000};
  for (const Duration until = net::steady_now() + kStopTime;
       stops_ < order_.stops && linked() && net::steady_now() < until;)
    std::this_thread::sleep_for(std::chrono::microseconds(100));
}

void ModbusGripper::talk() noexcept {
  Duration due = net::steady_now();
  while (!end_) {
    turn();
    if (!linked()) return;
    due = std::max(due + from_seconds(settings_.poll), net::steady_now());
    const Duration left = due - net::steady_now();
    if (left > Duration{}) std::this_thread::sleep_for(left);
  }
  turn();  // carries out a stop that came last
}

void ModbusGripper::turn() noexcept {
  if (!linked()) return;
  Order order;
  if (orders_.read(order)) conversation_.take(order);
  // In lockstep the rest between two directions passes in the run's time.
  const bool linked =
      lockstep_ ? conversation_.turn([this] { return tick_; }) : conversation_.turn(net::steady_now);
  const Report& report = conversation_.report();
  stops_ = report.stops;
  ++turns_;
  longest_ = std::max(longest_.load(), (report.answered - report.asked).count());
  if (report.trap != Trap::none && report.trap != told_) {
    ++traps_;
    log_.say(settings_.place() + ": " + words_of(report, coupler_.why()));
  }
  told_ = report.trap;
  linked_ = linked;  // whoever reads a lost report finds the link lost
  reports_.write(report);
}

std::vector<std::string> ModbusGripper::remarks() const {
  std::string line = fmt::format("{}: {} readings, the longest answer took {:.1f} ms", describe(),
                                 turns_.load(), 1e3 * seconds(Duration(longest_.load())));
  if (const std::int64_t traps = traps_; traps > 0) line += fmt::format("; {} faults", traps);
  return {line};
}

std::unique_ptr<Gripper> connected(const Offer& offer) {
  GripperSettings settings;
  settings.declare(offer.table);
  settings.timeout = net::longest_wait(settings.timeout, offer.lockstep);
  return std::make_unique<ModbusGripper>(offer, settings);
}

}  // namespace enc::gripper
