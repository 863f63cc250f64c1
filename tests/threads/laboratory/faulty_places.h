// The three devices of the laboratory's rig behind their fakes, each on a free port of this machine. Each
// device sends numbers that repeat themselves and grow, so that torn or old values show.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/fake/server.h"
#include "hw_drivers/igtl/drive/igtl_tracker.h"
#include "hw_drivers/igtl/fake/tool_server.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/fake/server.h"
#include "tests/support/devices.h"
#include "trial/devices/device_log.h"

namespace enc::test {

// s: longer than any test on any machine; and shorter.
inline constexpr double kPatient = 100.0, kImpatient = 0.03;

struct FaultyTable final : DefaultOffer::Defaults {
  using DefaultOffer::Defaults::value;
  void value(const Setting& key, double& number) override {
    if (const auto own = numbers.find(key.name); own != numbers.end()) number = own->second;
  }
  void value(const Setting& key, std::int64_t& whole) override {
    if (const auto own = ports.find(key.name); own != ports.end()) whole = own->second;
  }
  void value(const Setting& key, std::string& text) override {
    if (key.name == "address") text = "127.0.0.1";
    if (key.name == "transport") text = transport;
  }
  std::string transport = "udp";               // for tool data
  std::map<std::string_view, double> numbers;  // SI
  std::map<std::string_view, std::int64_t> ports;
};

struct FaultyPlace {
  Offer offer(const Reach& reach) {
    return {table, defaults.rig, reach, Duration(1'000'000), log, false, false, tools};
  }
  DefaultOffer defaults;
  FaultyTable table;
  std::vector<std::string> tools{"stylus"};
  trial::DeviceLog log, log_of_fake;  // of the driver, and of its fake
};

struct FaultyGcs : FaultyPlace {
  // `patience`: time in s without an answer until the driver reports a lost link.
  explicit FaultyGcs(double patience, std::uint64_t seed = 1)
      : server(std::make_unique<gcs::Server>(machine, gcs::ControllerSettings{}, "127.0.0.1",
                                             std::uint16_t{0}, log_of_fake, std::function<void()>{}, seed)) {
    table.numbers = {{"timeout_ms", patience}, {"watchdog_ms", kPatient}};
    table.ports = {{"port", server->port()}};
  }
  std::unique_ptr<Manipulator> driver() { return gcs::connected(offer(machine.can)); }

  FollowingMachine machine;
  std::unique_ptr<gcs::Server> server;
};

// Force and torque are equal along all axes.
struct CountingSensor final : ForceSensor {
  Measurement<Wrench> read(Time now) noexcept override {
    const double x = kStep * static_cast<double>(++number);
    return {{Vec<'F'>(x, x, x), Vec<'F'>(x, x, x)}, now, Health::ok};
  }
  static constexpr double kStep = 1e-4;  // N, N m
  std::int64_t number = 0;
};
struct FaultyNetft : FaultyPlace {
  explicit FaultyNetft(double patience, std::uint64_t seed = 1)
      : server(std::make_unique<netft::Server>(sensor, netft::gamma(), "127.0.0.1", netft::Ports{}, seed)) {
    table.numbers = {{"timeout_ms", kPatient}, {"silent_ms", patience}};
    table.ports = {{"port", server->port()},
                   {"http_port", server->http_port()},
                   {"command_port", server->command_port()}};
  }
  std::unique_ptr<ForceSensor> driver() { return netft::streaming(offer(defaults.reach)); }

  CountingSensor sensor;
  std::unique_ptr<netft::Server> server;
};

// Sends a pose each millisecond, with equal x and y.
struct CountingTracker final : PoseTracker {
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    if (now - last < Duration(1'000'000)) return false;
    last = now;
    const double x = kStep * static_cast<double>(++number);
    newest = {{0, Pose<'C', 'T'>::shift(x, x, 0.9)}, now, Health::ok};
    return true;
  }
  static constexpr double kStep = 1e-6;  // m
  std::int64_t number = 0;
  Time last{};
};
struct FaultyIgtl : FaultyPlace {
  explicit FaultyIgtl(double patience, std::uint64_t seed = 1,
                      igtl::Transport transport = igtl::Transport::udp)
      : server(std::make_unique<igtl::ToolServer>(
            tracker, std::vector<std::string>{"stylusToTracker"},
            igtl::ToolServerSettings{.transport = transport, .seed = seed})) {
    table.transport = transport == igtl::Transport::udp ? "udp" : "tcp";
    table.numbers = {{"timeout_ms", kPatient}, {"silent_ms", patience}};
    table.ports = {{"port", server->port()}};
  }
  std::unique_ptr<PoseTracker> driver() { return igtl::subscribed(offer(defaults.reach)); }

  CountingTracker tracker;
  std::unique_ptr<igtl::ToolServer> server;
};

}  // namespace enc::test
