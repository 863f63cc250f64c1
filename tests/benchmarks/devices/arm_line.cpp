#include "tests/benchmarks/devices/arm_line.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>

#include "core/control/scene/scene.h"
#include "core/devices/driver.h"
#include "core/machine/arm.h"
#include "hw_drivers/forcedimension/drive/delta_arm.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/phantom/drive/phantom_arm.h"
#include "hw_drivers/phantom/wire/hd.h"
#include "tests/benchmarks/devices/driver_values.h"

namespace enc::bench::devices {
namespace {

constexpr std::int64_t kSilentTicks = 4;  // silent_ms of both drivers

// True if the condition holds within 20 s of wall time: a busy machine is slow, and no bound of a test.
template <class Condition>
bool holds_soon(Condition condition) {
  using std::chrono::steady_clock;
  for (const auto until = steady_clock::now() + std::chrono::seconds(20); steady_clock::now() < until;) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
  return condition();
}

}  // namespace

class ArmLine::Slot final : public HapticArm {
 public:
  explicit Slot(ArmLine& of) : of_(of) {}
  ~Slot() override { of_.disconnect(); }
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;
  [[nodiscard]] ArmAbility ability() const override { return of_.twin_->ability(); }
  [[nodiscard]] bool linked() const noexcept override { return device().linked(); }
  Measurement<ArmSample> read(Time now) noexcept override { return device().read(now); }
  void command(const Vec<'R'>& force) noexcept override { device().command(force); }
  void stop() noexcept override { device().stop(); }
  void move_prop(const PropCommand& prop) noexcept override { of_.twin_->move_prop(prop); }

 private:
  [[nodiscard]] HapticArm& device() const { return of_.driver_ ? *of_.driver_ : *of_.twin_; }
  ArmLine& of_;
};

// A device that exerts its last force instead of zero.
class ArmLine::ForceKeeper final : public HapticArm {
 public:
  explicit ForceKeeper(HapticArm& arm) : arm_(arm) {}
  [[nodiscard]] ArmAbility ability() const override { return arm_.ability(); }
  [[nodiscard]] bool linked() const noexcept override { return arm_.linked(); }
  Measurement<ArmSample> read(Time now) noexcept override { return arm_.read(now); }
  void command(const Vec<'R'>& force) noexcept override {
    if (force.norm() > 0.0) last_ = force;
    arm_.command(last_);
  }
  void stop() noexcept override { arm_.command(last_); }
  void move_prop(const PropCommand& prop) noexcept override { arm_.move_prop(prop); }

 private:
  HapticArm& arm_;
  Vec<'R'> last_{0, 0, 0};
};

class ArmLine::LineClock final : public Clock {
 public:
  LineClock(ArmLine& of, std::unique_ptr<Clock> clock) : of_(of), clock_(std::move(clock)) {}
  Tick next() override {
    missed_ = 0;
    Tick tick = clock_->next();
    const Time until = tick.t + std::exchange(of_.standing_, {});
    const bool process = std::exchange(of_.process_stands_, false) && tick.t < until;
    if (process) of_.server_->suffer({Trouble::Kind::stall});
    of_.pass(tick.t);
    for (; tick.t < until; ++missed_) {
      tick = clock_->next();
      if (process && tick.t >= until) of_.server_->heal(Trouble::Kind::stall);
      of_.pass(tick.t);
      if (missed_ == 0) of_.force_in_stand_ = 0;
      if (of_.exerts()) of_.force_in_stand_ = static_cast<int>(missed_) + 1;
    }
    return tick;
  }
  [[nodiscard]] std::int64_t missed() const noexcept override { return missed_; }

 private:
  ArmLine& of_;
  std::unique_ptr<Clock> clock_;
  std::int64_t missed_ = 0;
};

// Serves in wall time while the driver comes or goes.
template <class Act>
void ArmLine::serve_while(Act act) {
  std::atomic<bool> end = false;
  std::thread serving([&] {
    while (!end) {
      server_->serve(now_);
      server_->publish(now_);
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  });
  act();
  end = true;
  serving.join();
}

void ArmLine::disconnect() {
  if (driver_) serve_while([&] { driver_.reset(); });  // its clock stands: no call seems to hang
  net::stand_at({});
}

void ArmLine::fit_out(Rig& rig) {
  twin_ = std::move(rig.arm);
  rig.arm = std::make_unique<Slot>(*this);
  rig.clock = std::make_unique<LineClock>(*this, std::move(rig.clock));
}

std::string ArmLine::said() const { return fmt::format("{}", fmt::join(log_.lines(), "; ")); }

void ArmLine::connect() {
  const Arm arm(spec_.arm.machine);
  keeper_ = std::make_unique<ForceKeeper>(*twin_);
  server_ = std::make_unique<arm::ArmServer>(keeps_force_ ? *keeper_ : *twin_,
                                             arm::ArmServerSettings{.place = {"127.0.0.1", 0},
                                                                    .usual_error = phantom::hd::kWarmMotors,
                                                                    .home = arm.tip(arm.zero()).xyz},
                                             log_);
  DriverValues table;  // as shipped, but without the ramp
  table.numbers = {{"ramp_N_per_s", 0.0}, {"device_watchdog_ms", firmware_}, {"timeout_ms", 20.0}};
  table.wholes = {{"serial", server_->port()}};
  table.texts = {{"library", "fake"}, {"device", fmt::format("127.0.0.1:{}", server_->port())}};
  const Reach reach = reach_of(spec_);
  const Offer offer{table, spec_, reach, Duration(1'000'000), log_};
  const Duration stands = net::steady_now();
  net::stand_at(stands);  // so that no call is late, however slow the machine is
  base_ = stands - now_.time_since_epoch();
  serve_while(
      [&] { driver_ = vendor_ == Vendor::phantom ? phantom::opened(offer) : forcedimension::opened(offer); });
}

void ArmLine::pass(Time now) {
  now_ = now;
  if (!driver_) return;
  net::stand_at(base_ + now.time_since_epoch());
  if (library_ == LibraryState::calls) return exchange(now);
  if (library_ == LibraryState::hears_noise) server_->publish(now);
  if (++quiet_ > kSilentTicks) await_loss(now);
}

// One call of the library: it has the state, and its answer has the force.
void ArmLine::exchange(Time now) {
  quiet_ = 0;
  server_->publish(now);
  std::vector<int> descriptors;
  server_->wait_on(descriptors);
  if (descriptors.empty()) return;  // the process stands
  pollfd ready{descriptors.front(), POLLIN, 0};
  holds_soon([&] {
    ::poll(&ready, 1, 1);
    server_->serve(now);
    return server_->answered() || !driver_->linked();
  });
  if (!driver_->linked()) await_loss(now);
}

// The driver's watch looks twice in each millisecond: it has its look before the tick goes on.
void ArmLine::await_loss(Time now) {
  if (never_lost_) return;
  never_lost_ = !holds_soon([&] {
    server_->serve(now);
    return !driver_->linked() && !server_->enabled();
  });
}

}  // namespace enc::bench::devices
