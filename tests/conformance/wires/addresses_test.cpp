// Addresses and ports that are right, and those that are not: for each driver with a wire, in front of its
// fake or of somebody else's.
#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/gcs/drive/net_link.h"
#include "hw_drivers/gcs/fake/server.h"
#include "hw_drivers/igtl/drive/igtl_tracker.h"
#include "hw_drivers/igtl/fake/tool_server.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/fake/server.h"
#include "tests/support/devices/default_offer.h"
#include "tests/support/devices/following_machine.h"
#include "tests/support/devices/served.h"
#include "trial/devices/device_log.h"

namespace enc::test {
namespace {

using testing::HasSubstr;

struct SteadyForce final : ForceSensor {
  Stamped<Wrench> read(Time now) noexcept override {
    return {{Vec<'F'>(0, 0, -3.0), Vec<'F'>(0.1, 0, 0)}, now, Health::ok};
  }
};
struct SteadyTool final : PoseTracker {
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override {
    newest = {{0, Pose<'C', 'T'>::shift(0.1, 0.2, 0.9)}, now, Health::ok};
    return true;
  }
};

// Of any driver: where its device is. Times are longer than usual, as other tests take the processor, too.
struct Whereabouts final : DefaultOffer::Defaults {
  using DefaultOffer::Defaults::value;
  void value(const Setting& key, double& number) override {
    if (key.name == "timeout_ms") number = 0.3;  // s
    if (key.name == "silent_ms" || key.name == "watchdog_ms") number = 0.2;
  }
  void value(const Setting& key, std::int64_t& whole) override {
    if (const auto port = ports.find(key.name); port != ports.end()) whole = port->second;
  }
  void value(const Setting& key, std::string& text) override {
    if (key.name == "address") text = address;
  }
  std::string address;
  std::map<std::string, std::int64_t, std::less<>> ports{};
};

// The three fakes of a laboratory at an address, and what leads there.
struct ThreeWires {
  explicit ThreeWires(const std::string& at)
      : address(at),
        machine_server(machine, {}, at, 0, log),
        box(force, netft::gamma(), at, netft::Ports{}),
        tool_server(tracker, {"stylusToTracker"}, {.address = at}) {}
  [[nodiscard]] Whereabouts to_machine() const { return table({{"port", machine_server.port()}}); }
  [[nodiscard]] Whereabouts to_force() const {
    return table(
        {{"port", box.port()}, {"http_port", box.http_port()}, {"command_port", box.command_port()}});
  }
  [[nodiscard]] Whereabouts to_tools() const { return table({{"port", tool_server.port()}}); }
  [[nodiscard]] Whereabouts table(std::map<std::string, std::int64_t, std::less<>> ports) const {
    Whereabouts table;
    table.address = address;
    table.ports = std::move(ports);
    return table;
  }

  std::string address;
  trial::DeviceLog log;
  FollowingMachine machine;
  SteadyForce force;
  SteadyTool tracker;
  gcs::Server machine_server;
  netft::Server box;
  igtl::ToolServer tool_server;
  Served served_machine{machine_server}, served_box{box}, served_tools{tool_server};
};

struct Asker {
  Offer offer(Settings& table) {
    return {table, defaults.rig, machine.can, Duration(1'000'000), log, false, false, tools};
  }
  // What a driver says where it finds nothing.
  template <class Make>
  std::string refused(Make make, Whereabouts table) {
    try {
      static_cast<void>(make(offer(table)));
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::device);
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "";
  }
  DefaultOffer defaults;
  FollowingMachine machine;
  trial::DeviceLog log;
  std::vector<std::string> tools{"stylus"};
};

bool this_machine_has_ipv6() {
  try {
    return net::listen_tcp("::1", 0).is_open();
  } catch (const Error&) {
    return false;
  }
}

TEST(Addresses, OfEveryDriverMayBeOfIPv6) {
  if (!this_machine_has_ipv6()) GTEST_SKIP() << "there is no ::1 here";
  const ThreeWires there("::1");
  Asker asker;
  Whereabouts to_machine = there.to_machine(), to_force = there.to_force(), to_tools = there.to_tools();
  const auto machine = gcs::connected(asker.offer(to_machine));
  const auto force = netft::streaming(asker.offer(to_force));
  const auto tracker = igtl::subscribed(asker.offer(to_tools));
  for (const std::string& said : {machine->describe(), force->describe(), tracker->describe()})
    EXPECT_THAT(said, HasSubstr(" [::1]:"));
  EXPECT_THAT(force->describe(), HasSubstr("its command interface agrees"));
  const Duration begun = net::steady_now();
  Stamped<Wrench> wrench;
  Stamped<TrackedTool> tool;
  for (int i = 0; i < 2000 && (wrench.health != Health::ok || tool.health != Health::ok); ++i) {
    const Time now(net::steady_now() - begun);
    wrench = force->read(now);
    tracker->poll(now, tool);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_NEAR(wrench.value.force.xyz[2], -3.0, 1e-6);
  EXPECT_EQ(tool.value.tool, 0);
  EXPECT_EQ(machine->read(Time(net::steady_now() - begun)).health, Health::ok);
  EXPECT_TRUE(machine->linked() && force->linked() && tracker->linked());
}

TEST(Addresses, ANameThatNobodyKnowsIsOneLineOfEveryDriver) {
  Asker asker;
  Whereabouts nowhere;
  nowhere.address = "no.such.host.invalid";
  for (const std::string& said :
       {asker.refused(gcs::connected, nowhere), asker.refused(netft::streaming, nowhere),
        asker.refused(igtl::subscribed, nowhere)})
    EXPECT_THAT(said,
                testing::AllOf(testing::StartsWith("no.such.host.invalid:"),
                               HasSubstr("'no.such.host.invalid' is no address and no name that is known"),
                               HasSubstr("see the address in the rig file")));
}

// It takes the connection, as a program that hangs does, and never an answer comes.
TEST(Addresses, AServerThatSaysNothingIsNoController) {
  const net::Socket silent = net::listen_tcp("127.0.0.1", 0);
  Whereabouts table;
  table.address = "127.0.0.1";
  table.ports = {{"port", silent.port()}};
  const Duration before = net::steady_now();
  EXPECT_EQ(Asker().refused(gcs::connected, table),
            net::place("127.0.0.1", silent.port()) +
                ": no answer to *IDN? within 1000 ms; see that it is a C-887, and ready");
  EXPECT_LT(net::steady_now() - before, Duration(10'000'000'000));
}

// Each device at the port of another one.
TEST(Addresses, APortOfAnotherDeviceIsSaid) {
  const ThreeWires there("127.0.0.1");
  Asker asker;
  EXPECT_THAT(asker.refused(gcs::connected, there.table({{"port", there.box.http_port()}})),
              HasSubstr("no answer to *IDN? within 1000 ms; see that it is a C-887"));
  Whereabouts page = there.to_force(), records = there.to_force(), commands = there.to_force();
  page.ports["http_port"] = there.machine_server.port();
  EXPECT_THAT(asker.refused(netft::streaming, page),
              HasSubstr("no whole answer within 300 ms; see that it is a Net F/T"));
  records.ports["port"] = there.tool_server.port();
  EXPECT_THAT(asker.refused(netft::streaming, records),
              HasSubstr("its page answers, and no record comes within 300 ms"));
  commands.ports["command_port"] = there.box.http_port();
  EXPECT_THAT(asker.refused(netft::streaming, commands),
              HasSubstr("takes READCALINFO and says nothing; see driver.netft.command_port"));
  EXPECT_THAT(asker.refused(igtl::subscribed, there.table({{"port", there.box.port()}})),
              HasSubstr("no tool data within 300 ms; see that its server runs"));
  EXPECT_EQ(asker.refused(gcs::connected, there.to_machine()), "");
  EXPECT_EQ(asker.refused(netft::streaming, there.to_force()), "");
  EXPECT_EQ(asker.refused(igtl::subscribed, there.to_tools()), "");
}

}  // namespace
}  // namespace enc::test
