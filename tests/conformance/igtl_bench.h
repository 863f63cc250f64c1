// A driver of tool data in front of our server on a port of this machine.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hw_drivers/igtl/drive/igtl_tracker.h"
#include "hw_drivers/igtl/fake/tool_server.h"
#include "hw_drivers/net/clocks.h"
#include "tests/support/devices.h"

namespace enc::test {

// A pose each 10 ms while a tool is in view.
struct VisibleTool final : PoseTracker {
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    if (!in_view || now - last < Duration(10'000'000)) return false;
    last = now;
    newest = {{0, Pose<'C', 'T'>::shift(0.1, 0.2, 0.9)}, now - Duration(3'000'000), Health::ok};
    return true;
  }
  Time last{};
  std::atomic<bool> in_view = true;
};

struct IgtlTable final : DefaultOffer::Defaults {
  using DefaultOffer::Defaults::value;
  void value(const Setting& key, double& number) override {
    if (key.name == "least_delay_ms") number = 0.003;  // s
    if (key.name == "silent_ms") number = 0.2;
    if (key.name == "timeout_ms") number = 0.3;
  }
  void value(const Setting& key, std::int64_t& whole) override {
    if (key.name == "port") whole = port;
  }
  void value(const Setting& key, std::string& text) override {
    if (key.name == "transport") text = transport;
    if (key.name == "message") text = message;
  }
  std::int64_t port = 0;
  std::string transport = "udp", message = "TRANSFORM";
};

struct IgtlBench {
  Offer offer() {
    return {table, defaults.rig, defaults.reach, Duration(1'000'000), defaults.log, false, false, tools};
  }
  struct PollCount {
    int news = 0;
    double oldest = 0.0;  // s
  };
  PollCount watch(PoseTracker& driver, int cycles) {
    PollCount watched;
    for (int i = 0; i < cycles; ++i) {
      const Time at(net::steady_now() - begun);
      if (driver.poll(at, newest)) {
        ++watched.news;
        watched.oldest = std::max(watched.oldest, age(at, newest.t));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return watched;
  }

  // Discards the stream from before the run, until three polls find next to nothing.
  void settle(PoseTracker& driver, Time& at) {
    for (int i = 0; i < 3; ++i) {
      at += Duration(1'000'000);
      EXPECT_FALSE(driver.poll(at, newest));
    }
  }

  DefaultOffer defaults;
  IgtlTable table;
  std::vector<std::string> tools{"stylus"};
  Measurement<TrackedTool> newest;
  Duration begun = net::steady_now();
};

// The bench with our server.
struct IgtlPort : IgtlBench {
  explicit IgtlPort(igtl::Transport transport = igtl::Transport::udp)
      : server(tracker, {"stylusToTracker"}, {.transport = transport}) {
    table.port = server.port();
    if (transport == igtl::Transport::tcp) table.transport = "tcp";
  }
  VisibleTool tracker;
  igtl::ToolServer server;
};

}  // namespace enc::test
