// Devices that cannot be reached or used: the output of `encounter devices` for each cause, and wrong
// addresses.
#include "tests/support/devices.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/fake/server.h"
#include "hw_drivers/igtl/drive/igtl_tracker.h"
#include "hw_drivers/igtl/fake/tool_server.h"
#include "hw_drivers/igtl/wire/content.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/big_endian.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/fake/server.h"
#include "hw_drivers/netft/wire/messages.h"
#include "tests/support/run_program.h"
#include "trial/devices/device_log.h"

namespace enc::test {
namespace {

using igtl::OutgoingMessage;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::Result;

// ---- `encounter devices` before servers that behave like real ones in public reports. It prints each cause
// with the counts of a run's report, and returns exit code 3.

// Simulates the devices of the rig `fakes` that `real` does not name.
Result devices(const std::vector<std::string>& real, const char* seconds) {
  std::vector<std::string> words{"devices", "fakes", "--for-s",
                                 seconds,   "--set", "rig.manipulator.driver=sim"};
  for (const std::string& set : real) words.insert(words.end(), {"--set", set});
  return tests::run_program(words, tests::kShipped);
}

struct PoseMessage {
  double x = 0.0;  // m
  std::int64_t stamp_ns = 0;
  const char* device = "StylusToTracker";
  // CRC in the header of the pose and of the answer to GET_STATUS.
  std::uint64_t pose_crc = 1, status_crc = 1;  // 1: the right one; else the value in the header
};

// A tracker's own server, over TCP, which sends the result of `pose` 100 times a second.
class TrackerServer {
 public:
  explicit TrackerServer(PoseMessage (*pose)(int)) : pose_(pose) {}
  ~TrackerServer() {
    end_ = true;
    thread_.join();
  }
  TrackerServer(const TrackerServer&) = delete;
  TrackerServer& operator=(const TrackerServer&) = delete;
  [[nodiscard]] Result asked(const char* seconds = "0.6") const {
    return devices({"rig.force.driver=sim", "rig.driver.igtl.transport=tcp",
                    "rig.driver.igtl.port=" + std::to_string(listener_.port())},
                   seconds);
  }

 private:
  static void send(net::Socket& client, const OutgoingMessage& message, std::uint64_t crc) {
    std::vector<std::byte> bytes(message.bytes().begin(), message.bytes().end());
    constexpr std::size_t kCrc = 50;
    if (crc != 1) net::put(std::span(bytes), kCrc, crc);
    static_cast<void>(client.send(bytes));
  }
  void serve() {
    while (!end_ && !listener_.wait(Duration(10'000'000))) {
    }
    net::Socket client = listener_.accept();
    igtl::Stream heard;
    for (int k = 0; !end_; ++k) {
      const PoseMessage sent = pose_(k);
      heard.came(client.receive(heard.room()));
      for (auto bytes = heard.next(); !bytes.empty(); bytes = heard.next())
        send(client, OutgoingMessage("STATUS", "Server", 0, igtl::status(1)), sent.status_crc);
      send(client,
           OutgoingMessage("TRANSFORM", sent.device, sent.stamp_ns,
                           igtl::transform(Pose<'C', 'T'>::shift(sent.x, 0.02, 0.9))),
           sent.pose_crc);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  PoseMessage (*pose_)(int);
  net::Socket listener_ = net::listen_tcp("127.0.0.1", 0);
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] { serve(); }};
};

double moving(int k) { return 0.01 * std::sin(k / 15.0); }
std::int64_t fresh() { return (net::steady_now() + Duration(1'000'000'000'000)).count(); }

TEST(Devices, ATrackerThatIsWellIsUsable) {
  const Result result = TrackerServer([](int k) { return PoseMessage{moving(k), fresh()}; }).asked();
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("samples a second"), HasSubstr(" poses, 0 old or twice, 0 wrong"),
                                Not(HasSubstr("NOT USABLE"))));
}

TEST(Devices, AToolOfAnotherNameIsNamedBesideTheExpectedOne) {
  const Result result = TrackerServer([](int k) {
                          return PoseMessage{moving(k), fresh(), "StylusToReference"};
                        }).asked();
  EXPECT_EQ(result.code, 3) << result.out;
  EXPECT_THAT(result.out,
              AllOf(ContainsRegex("[1-9][0-9]+ of tools that the scene does not name, such as "
                                  "'StylusToReference'; expected 'stylusToTracker'"),
                    ContainsRegex("NOT USABLE: it sent no sample: [0-9]+ of tools that the scene")));
}

TEST(Devices, AWrongCrcIsCountedApartAndAMissingOneIsCalledSo) {
  const Result none = TrackerServer([](int k) {
                        return PoseMessage{moving(k), fresh(), "StylusToTracker", 0};
                      }).asked();
  EXPECT_EQ(none.code, 3) << none.out;
  EXPECT_THAT(none.out,
              AllOf(ContainsRegex("0 wrong; [1-9][0-9]+ with a wrong CRC: 0, the server does not"),
                    ContainsRegex("NOT USABLE: it sent no sample: [0-9]+ with a wrong CRC: 0, the")));
  const Result other = TrackerServer([](int k) {
                         return PoseMessage{moving(k), fresh(), "StylusToTracker", 77};
                       }).asked();
  EXPECT_EQ(other.code, 3) << other.out;
  EXPECT_THAT(other.out,
              AllOf(ContainsRegex("0 wrong; [1-9][0-9]+ with a wrong CRC"), Not(HasSubstr("CRC: 0"))));
}

TEST(Devices, AServerOfWhichNoMessageHasACrcIsNotTakenForASilentOne) {
  const Result result = TrackerServer([](int k) {
                          return PoseMessage{moving(k), fresh(), "StylusToTracker", 0, 0};
                        }).asked();
  EXPECT_EQ(result.code, 3) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("NOT THERE"), HasSubstr("what it sends has CRC 0")));
}

TEST(Devices, AStampThatStandsStillIsCountedAndItsOnePoseIsNoTracking) {
  const Result result = TrackerServer([](int k) { return PoseMessage{moving(k), 0}; }).asked();
  EXPECT_EQ(result.code, 3) << result.out;
  EXPECT_THAT(
      result.out,
      AllOf(ContainsRegex(" 1 poses, 1 old or twice, 0 wrong; [1-9][0-9]+ with a stamp "
                          "that stands still"),
            HasSubstr("1 sample"),
            ContainsRegex("NOT USABLE: it sent nothing new in the last .* s: [0-9]+ with a stamp that stands "
                          "still")));
}

TEST(Devices, APoseThatIsRepeatedToTheBitIsNoTracking) {
  const Result result = TrackerServer([](int) { return PoseMessage{0.01, fresh()}; }).asked();
  EXPECT_EQ(result.code, 3) << result.out;
  EXPECT_THAT(result.out, AllOf(ContainsRegex("[1-9][0-9]+ equal to the bit to the pose before"),
                                HasSubstr("NOT USABLE: all poses are equal to the bit")));
}

TEST(Devices, APoseThatFreezesInTheMiddleIsNoTracking) {
  const Result frozen = TrackerServer([](int k) {
                          return PoseMessage{moving(std::min(k, 60)), fresh()};
                        }).asked("2");
  EXPECT_EQ(frozen.code, 3) << frozen.out;
  EXPECT_THAT(frozen.out,
              ContainsRegex("NOT USABLE: the last [0-9]+ poses, of [01]\\.[0-9]+ s, are equal to the "
                            "bit: it repeats the last pose"));
  // Frozen for 0.1 s, and then in view again.
  const Result back = TrackerServer([](int k) {
                        return PoseMessage{moving(k >= 40 && k < 50 ? 40 : k), fresh()};
                      }).asked("1");
  EXPECT_EQ(back.code, 0) << back.out << back.err;
}

struct SteadySensor final : ForceSensor {
  Measurement<Wrench> read(Time now) noexcept override {
    return {{Vec<'F'>(0, 0, newtons), Vec<'F'>::zero()}, now, Health::ok};
  }
  std::atomic<double> newtons = 3.0;
};

// A Net Box whose counter may have another rate.
struct ForceServer {
  explicit ForceServer(double counter = netft::kNetBoxRate) { server.box().count_at(counter); }
  [[nodiscard]] Result asked(const std::vector<std::string>& more = {}) {
    const FakeServer served(server);
    std::vector<std::string> set{"rig.tracker.driver=sim",
                                 "rig.driver.netft.port=" + std::to_string(server.port()),
                                 "rig.driver.netft.http_port=" + std::to_string(server.http_port()),
                                 "rig.driver.netft.command_port=" + std::to_string(server.command_port()),
                                 "rig.driver.netft.silent_ms=500"};  // other tests share the processor
    set.insert(set.end(), more.begin(), more.end());
    return devices(set, "0.6");
  }
  SteadySensor sensor;
  netft::Server server{sensor, netft::gamma(), "127.0.0.1", netft::Ports{}};
};

TEST(Devices, ABoxThatIsWellIsUsableWithAnyCounterThatIsKnown) {
  const Result net_box = ForceServer().asked();
  EXPECT_EQ(net_box.code, 0) << net_box.out << net_box.err;
  EXPECT_THAT(net_box.out, Not(HasSubstr("its counter runs")));
  const Result axia = ForceServer(3906.25).asked();
  EXPECT_EQ(axia.code, 0) << axia.out << axia.err;
  EXPECT_THAT(axia.out, HasSubstr("its counter runs at 3,906/s"));
}

TEST(Devices, ACounterOfAnUnknownRateIsRefusedAndMayBeSet) {
  const Result unknown = ForceServer(5000.0).asked();
  EXPECT_EQ(unknown.code, 3) << unknown.out;
  EXPECT_THAT(unknown.out,
              ContainsRegex("NOT THERE: .*: its counter runs at [45],[0-9][0-9][0-9]/s, not 7,000; "
                            "expected .*set driver.netft.counter_Hz"));
  const Result set = ForceServer(5000.0).asked({"rig.driver.netft.counter_Hz=5000"});
  EXPECT_EQ(set.code, 0) << set.out << set.err;
  EXPECT_THAT(set.out, HasSubstr("its counter runs at 5,000/s"));
}

TEST(Devices, AFaultInTheMiddleIsNoSuccess) {
  ForceServer there;
  there.server.suffer({Trouble::Kind::error_code, 0x80000004});
  const Result result = there.asked();
  EXPECT_EQ(result.code, 3) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("status 0x80000004: temperature"),
                                ContainsRegex("NOT USABLE: [0-9]+ of [0-9]+ samples report a fault")));
}

TEST(Devices, AForceBeyondTheRatingIsSaturated) {
  ForceServer there;
  there.sensor.newtons = -450.0;  // beyond the 400 along z
  const Result result = there.asked();
  EXPECT_EQ(result.code, 3) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("N m, in F, saturated"),
                                ContainsRegex("[1-9][0-9]+ beyond the rating of an axis \\(cfgmr\\)"),
                                HasSubstr("NOT USABLE: its last sample is saturated")));
}

// ---- Right and wrong addresses and ports: for each driver with a wire, in front of its fake or of another
// program.

struct SteadyForce final : ForceSensor {
  Measurement<Wrench> read(Time now) noexcept override {
    return {{Vec<'F'>(0, 0, -3.0), Vec<'F'>(0.1, 0, 0)}, now, Health::ok};
  }
};
struct SteadyTool final : PoseTracker {
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    newest = {{0, Pose<'C', 'T'>::shift(0.1, 0.2, 0.9)}, now, Health::ok};
    return true;
  }
};

// Address of any driver's device. Times are longer than usual, because other tests share the processor.
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

// The three fakes of a laboratory at an address, and the tables that lead to them.
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
  FakeServer served_machine{machine_server}, served_box{box}, served_tools{tool_server};
};

struct Asker {
  Offer offer(Settings& table) {
    return {table, defaults.rig, machine.can, Duration(1'000'000), log, false, false, tools};
  }
  // The error message of a driver that finds no device.
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
  Measurement<Wrench> wrench;
  Measurement<TrackedTool> tool;
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

// The server accepts the connection, like a hung program, and never answers.
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

// Each driver connects to the port of another device.
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
