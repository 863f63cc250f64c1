// A fake arm in a thread, for the drivers of arms and the fake libraries of their vendors in this process.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

#include "hw_drivers/arm/fake/server.h"
#include "hw_drivers/net/clocks.h"
#include "tests/conformance/arm/still_arm.h"
#include "tests/support/devices.h"
#include "trial/devices/device_log.h"

namespace enc::test {

class ArmBench {
 public:
  ArmBench(const ArmMachine& machine, const std::string& name, std::uint32_t usual_error)
      : arm(machine),
        server(arm,
               {.name = name,
                .place = {"127.0.0.1", 0},
                .usual_error = usual_error,
                .home = arm.arm.tip({}).xyz},
               log) {
    defaults.rig.arm.machine = machine;
  }
  ~ArmBench() {
    end_ = true;
    thread_.join();
  }
  ArmBench(const ArmBench&) = delete;
  ArmBench& operator=(const ArmBench&) = delete;

  // Changes or reads the fake while its thread rests.
  template <class Act>
  auto with(Act act) {
    const std::lock_guard lock(mutex_);
    return act();
  }
  [[nodiscard]] Vec<'R'> force() {
    return with([&] { return arm.force; });
  }
  [[nodiscard]] bool motors_on() {
    return with([&] { return server.enabled(); });
  }
  // True once `condition` holds; false if it does not within twenty seconds.
  template <class Condition>
  static bool until(Condition condition) {
    for (const Duration end = net::steady_now() + Duration(20'000'000'000); net::steady_now() < end;) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  // Commands like the loop until the condition holds.
  template <class Condition>
  bool push_until(HapticArm& driver, const Vec<'R'>& push, Condition condition) {
    return until([&] {
      sample = driver.read(Time(net::steady_now()));
      driver.command(push);
      return condition();
    });
  }

  DefaultOffer defaults;
  trial::DeviceLog log;
  StillArm arm;
  arm::ArmServer server;
  Measurement<ArmSample> sample;
  std::atomic<bool> publishes = true;         // false: the device's scheduler makes no calls
  std::atomic<Duration::rep> zero_since = 0;  // steady clock, ns: since when the force is zero; 0: it is not

 private:
  void serve() {
    while (!end_) {
      with([this] {
        const Time now(net::steady_now());
        server.serve(now);
        if (publishes) server.publish(now);
        if (arm.force.norm() > 0.0)
          zero_since = 0;
        else if (zero_since == 0)
          zero_since = net::steady_now().count();
      });
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  }

  std::mutex mutex_;
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] { serve(); }};
};

}  // namespace enc::test
