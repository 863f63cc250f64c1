// Tools for tests of drivers: an offer whose settings keep their defaults, a machine that follows at once, a
// fake in a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "core/control/scene/scene.h"
#include "core/devices/device.h"
#include "core/devices/driver.h"
#include "core/devices/fake.h"
#include "hw_drivers/net/clocks.h"

namespace enc::test {

// The offer to a driver without a rig file: every key of its table keeps its default.
struct DefaultOffer {
  struct Defaults : Settings {
    void value(const Setting&, double&) override {}
    void value(const Setting&, std::int64_t&) override {}
    void value(const Setting&, std::string&) override {}
    void value(const Setting&, std::vector<double>&) override {}
  };
  struct SilentLog final : Log {
    void say(const std::string&) override {}
  };
  Offer with(const Reach& promised) { return {table, rig, promised, Duration(1'000'000), log}; }
  Offer with() { return with(reach); }

  Defaults table;
  RigSpec rig;
  Reach reach = reach_of(rig);
  SilentLog log;
};

// The simplest machine behind a fake controller: it reaches each command at once.
struct FollowingMachine final : Manipulator {
  [[nodiscard]] Reach reach() const override { return can; }
  Measurement<TipSample> read(Time now) noexcept override {
    return {{pose, Vec<'R'>::zero(), Vec<'R'>::zero()}, now, Health::ok};
  }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override { pose = X_RH; }
  void stop() noexcept override {}

  Reach can{0.05, 0.41, Hexapod{HexapodGeometry{}}};
  Pose<'R', 'H'> pose = can.machine.zero();
};

// Serves a fake in a thread in wall time, as `encounter fake` does.
class FakeServer {
 public:
  explicit FakeServer(Fake& fake) : fake_(fake) {}
  ~FakeServer() { end(); }
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  Fake& fake_;
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] {
    while (!end_) {
      const Time now(net::steady_now());
      fake_.serve(now);
      fake_.publish(now);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }};
};

}  // namespace enc::test
