// The fake C-887 on a free port of this machine, and an offer whose table names it.
#pragma once

#include <cstdint>

#include "hw_drivers/gcs/fake/server.h"
#include "tests/support/devices/default_offer.h"
#include "tests/support/devices/following_machine.h"
#include "tests/support/devices/served.h"
#include "trial/devices/device_log.h"

namespace enc::test {

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
  Served served{server};
};

}  // namespace enc::test
