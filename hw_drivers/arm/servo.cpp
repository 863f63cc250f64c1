#include "hw_drivers/arm/servo.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/thread_priority.h"

namespace enc::arm {
namespace {

constexpr std::chrono::microseconds kLook{500};  // interval of the watch
constexpr const char* kTooLate = "its own thread came too late, or never again";

}  // namespace

Servo::Servo(const ServoSettings& settings, Log& log, std::function<void()> cut,
             std::function<std::string(int)> words)
    : settings_(settings), log_(log), cut_(std::move(cut)), words_(std::move(words)), guard_(settings.guard) {
  if (settings_.watched) watch_ = std::thread([this] { watch(); });
}

Servo::~Servo() { end(); }

void Servo::end() noexcept {
  end_ = true;
  lost_ = true;  // a turn that still comes gets no force, and uses no log
  if (watch_.joinable()) watch_.join();
}

void Servo::watch() noexcept {
  // Before the loop, and before a device's thread with the loop's priority: neither can starve the watch.
  net::shift_priority(1);
  while (!end_) {
    std::this_thread::sleep_for(kLook);
    if (!end_ && !lost_ && silence() > settings_.silent) lose(kTooLate);
  }
}

void Servo::lose(const std::string& why) noexcept {
  if (lost_.exchange(true)) return;
  cut_();
  log_.say(fmt::format("arm lost: {}; its force is off; see to it, then begin a new run", why));
}

Vec<'R'> Servo::turn(const ArmReading& reading) noexcept {
  const Duration before(turned_.exchange(reading.at.count(), std::memory_order_acq_rel));
  const Duration gap = before != Duration{} ? reading.at - before : Duration{};
  longest_ = std::max(longest_.load(), gap.count());
  // The watch may have slept, too: a process that was stopped wakes all its threads at once.
  if (seconds(gap) > settings_.silent) lose(kTooLate);
  ++turns_;
  orders_.read(order_);
  const bool hot = reading.warmth >= settings_.hottest;
  if (reading.error != 0) ++errors_, error_ = reading.error;
  if (!reading.pressed) ++opened_;
  warmth_ = std::max(warmth_.load(), reading.warmth);
  const bool error = reading.error != 0 || hot;
  const Vec<'R'> force = guard_.pass(reading.at, order_, reading.pressed, error);
  reports_.write({reading, guard_.faulty(reading.at), guard_.counts()});
  return lost_ ? Vec<'R'>::zero() : force;
}

Measurement<ArmSample> Servo::read(Time now) noexcept {
  tick_ = net::steady_now();
  if (reports_.read(report_) || !read_) {
    // Subtract the reading's age once, when it is new. A reading never comes from the future.
    const Duration old = std::max(Duration{}, tick_ - report_.reading.at);
    stamp_ = read_ ? std::max(stamp_, now - old) : now - old;
    read_ = true;
  }
  const bool fault = refused_ || report_.faulty || !report_.reading.pressed || !linked();
  return {report_.reading.sample, stamp_, fault ? Health::fault : Health::ok};
}

void Servo::command(const Vec<'R'>& force) noexcept {
  refused_ = !force.finite();
  if (refused_) return;
  ++given_.number;
  given_.force = force;
  given_.given = tick_;
  given_.stopped = false;
  orders_.write(given_);
}

void Servo::stop() noexcept {
  given_.stopped = true;
  orders_.write(given_);
}

bool Servo::comes(double within) const {
  const Duration until = net::steady_now() + from_seconds(within);
  while (turns_ == 0 && net::steady_now() < until) std::this_thread::sleep_for(kLook);
  return turns_ > 0;
}

double Servo::silence() const noexcept {
  const Duration last(turned_.load(std::memory_order_acquire));
  return last == Duration{} ? 0.0 : seconds(net::steady_now() - last);
}

std::vector<std::string> Servo::remarks(const std::string& name) const {
  std::vector<std::string> lines{fmt::format("{}: {} readings, longest without one {:.1f} ms", name,
                                             turns_.load(), 1e3 * seconds(Duration(longest_.load())))};
  if (warmth_ > 0.0) lines.back() += fmt::format(", warmest motor {:.0f} %", 100.0 * warmth_);
  const GuardCounts& counts = report_.counts;
  if (counts.watchdog > 0)
    lines.push_back(fmt::format("{}: no force, {} times: the loop was silent for {:g} ms", name,
                                counts.watchdog, 1e3 * settings_.guard.watchdog));
  if (opened_ > 0)
    lines.push_back(
        fmt::format("{}: no force in {} readings: the dead man's switch was open", name, opened_.load()));
  if (counts.clipped > 0)
    lines.push_back(
        fmt::format("{}: {} forces were limited to its {:g} N", name, counts.clipped, settings_.guard.most));
  if (errors_ > 0)
    lines.push_back(
        fmt::format("{}: {} readings had an error, the last one {}", name, errors_.load(), words_(error_)));
  return lines;
}

}  // namespace enc::arm
