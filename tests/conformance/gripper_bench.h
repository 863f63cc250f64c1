// A gripper whose motion a test sees, behind the fake coupler, in wall time.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hw_drivers/gripper/drive/modbus_gripper.h"
#include "hw_drivers/gripper/fake/server.h"
#include "hw_drivers/net/clocks.h"
#include "tests/support/devices.h"
#include "trial/devices/device_log.h"

namespace enc::test {

// Jaws that take 50 ms for a stroke, and keep a list of what they were told.
struct SeenJaws final : Gripper {
  struct GripCommand {
    char what;  // 'c' close, 'o' open, 's' stop
    Duration at;
  };
  Measurement<GripSample> read(Time now) noexcept override {
    constexpr Duration kStroke{50'000'000};
    const std::lock_guard lock(mutex);
    if (moving && !jammed && net::steady_now() - begun > kStroke) {
      moving = false;
      sample.phase = closing ? GripPhase::closed : GripPhase::open;
      sample.holding = closing && tool;
    }
    return {sample, now, Health::ok};
  }
  void command(const Grip& grip) noexcept override {
    const std::lock_guard lock(mutex);
    told.push_back({grip.closed ? 'c' : 'o', net::steady_now()});
    closing = grip.closed;
    begun = net::steady_now();
    moving = true;
    sample.holding = false;
    if (!jammed) sample.phase = closing ? GripPhase::closing : GripPhase::opening;
  }
  void stop() noexcept override {
    const std::lock_guard lock(mutex);
    told.push_back({'s', net::steady_now()});
  }
  [[nodiscard]] std::string words() {
    const std::lock_guard lock(mutex);
    std::string all;
    for (const GripCommand& one : told) all += one.what;
    return all;
  }
  std::mutex mutex;
  GripSample sample{};
  std::vector<GripCommand> told;
  Duration begun{};
  bool moving = false, closing = false;
  std::atomic<bool> tool = true, jammed = false;
};

struct GripperPort {
  struct Table final : DefaultOffer::Defaults {
    using DefaultOffer::Defaults::value;
    void value(const Setting& key, double& number) override {
      if (key.name == "watchdog_ms") number = watchdog;
      if (key.name == "longest_stroke_ms") number = 0.3;
      if (key.name == "timeout_ms") number = 0.3;
    }
    void value(const Setting& key, std::int64_t& whole) override {
      if (key.name == "port") whole = port;
      if (key.name == "unit") whole = unit;
    }
    void value(const Setting& key, std::string& text) override {
      if (key.name == "address") text = "127.0.0.1";
      if (key.name == "product") text = product;
    }
    double watchdog = 1.0;
    std::int64_t port = 0, unit = 1;
    std::string product = "EK9000";
  };
  static gripper::GripperSettings free_port() {
    gripper::GripperSettings settings;
    settings.address = "127.0.0.1";
    settings.port = 0;
    return settings;
  }
  GripperPort() {
    table.port = server.port();
    defaults.rig.force.stale = 0.05;
  }
  Offer offer() { return {table, defaults.rig, defaults.reach, Duration(1'000'000), log}; }
  std::unique_ptr<Gripper> driver() { return gripper::connected(offer()); }

  DefaultOffer defaults;
  Table table;
  SeenJaws jaws;
  trial::DeviceLog log;
  gripper::Server server{jaws, free_port(), 100.0, log};
};

// The loop in wall time.
struct GripLoop {
  Duration begun = net::steady_now();
  [[nodiscard]] Time now() const { return Time(net::steady_now() - begun); }
  // Commands at each cycle until the sample fits, or for 2 s.
  template <class Fits>
  Measurement<GripSample> until(Gripper& device, const Grip* grip, Fits fits) const {
    Measurement<GripSample> sample;
    for (const Duration end = net::steady_now() + Duration(2'000'000'000); net::steady_now() < end;) {
      sample = device.read(now());
      if (fits(sample)) break;
      if (grip != nullptr) device.command(*grip);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return sample;
  }
};

}  // namespace enc::test
