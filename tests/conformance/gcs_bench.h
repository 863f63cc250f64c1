// The driver of the C-887 with the fake controller at the other end of its link, in wall time. The driver's
// thread is also the fake's: the fake answers at once, and its time passes while the thread waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "core/base/latest.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/gcs/fake/server.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/wires/string_link.h"
#include "tests/support/devices.h"
#include "trial/devices/device_log.h"

namespace enc::test {

// Like the loop: a set-point follows the reading of its tick.
inline void tell(Manipulator& machine, const Pose<'R', 'H'>& to) {
  static_cast<void>(machine.read(Time{}));
  machine.command(to);
}

struct GcsBench {
  // Visible state of the fake while the driver lives.
  struct FakeState {
    double x = 0.0;  // m
    bool at_rest = true;
  };

  class FakeLink final : public wires::StringLink {
   public:
    explicit FakeLink(GcsBench& bench) : bench_(bench) {}
    std::size_t send(std::string_view bytes) noexcept override {
      if (closed()) return 0;
      const std::string_view answers = bench_.controller.take(bytes);
      if (!bench_.silent) hear(answers);
      return bytes.size();
    }
    [[nodiscard]] bool closed() const noexcept override { return bench_.hung_up; }
    void wait(Duration most) noexcept override {
      if (!unread()) std::this_thread::sleep_for(most);
      bench_.pass(now());
    }
    [[nodiscard]] Duration now() const noexcept override { return net::steady_now(); }

   private:
    GcsBench& bench_;
  };

  explicit GcsBench(const gcs::ControllerSettings& with = {}) : controller(machine, with) {
    settings.watchdog = 0.05;  // s: other tests share the processor
  }
  Offer offer() { return {defaults.table, defaults.rig, machine.can, Duration(1'000'000), log}; }
  std::unique_ptr<Manipulator> driver() {
    return std::make_unique<gcs::GcsManipulator>(offer(), settings, std::make_unique<FakeLink>(*this));
  }
  // Called by the driver's thread while there is one.
  void pass(Duration now) noexcept {
    time = now;
    if (const int error = failure.exchange(gcs::kNoError); error != gcs::kNoError) controller.fail(error);
    controller.cycle(Time(now));
    latest.write({controller.measured()[0], controller.at_rest()});
  }
  FakeState seen() noexcept {
    latest.read(seen_);
    return seen_;
  }

  DefaultOffer defaults;
  gcs::GcsSettings settings;
  trial::DeviceLog log;
  FollowingMachine machine;
  gcs::Controller controller;
  Duration time{};
  std::atomic<int> failure = gcs::kNoError;
  std::atomic<bool> silent = false, hung_up = false;

 private:
  LatestValue<FakeState> latest;
  FakeState seen_;
};

// The fake C-887 on a free port of this machine, and an offer whose table names it.
struct GcsPort {
  struct Table final : DefaultOffer::Defaults {
    using DefaultOffer::Defaults::value;
    void value(const Setting& key, double& number) override {
      if (key.name == "watchdog_ms") number = 0.05;  // s
    }
    void value(const Setting& key, std::int64_t& whole) override {
      if (key.name == "port") whole = port;
    }
    std::int64_t port = 0;
  };

  explicit GcsPort(const gcs::ControllerSettings& settings = {})
      : server(machine, settings, "127.0.0.1", 0, log) {
    table.port = server.port();
  }
  Offer offer() { return {table, defaults.rig, machine.can, Duration(1'000'000), log}; }

  DefaultOffer defaults;
  Table table;
  trial::DeviceLog log;
  FollowingMachine machine;
  gcs::Server server;
  FakeServer served{server};
};

}  // namespace enc::test
