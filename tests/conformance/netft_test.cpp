// The driver of the Net F/T and its fake over loopback.
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/fake/server.h"
#include "hw_drivers/netft/wire/messages.h"
#include "tests/support/devices.h"
#include "tests/support/error_of.h"

namespace enc::test {
namespace {

using testing::HasSubstr;

struct PressSensor final : ForceSensor {
  Measurement<Wrench> read(Time now) noexcept override {
    const double f = newtons;
    return {{Vec<'F'>(0, 0, f), Vec<'F'>(0.1, 0, 0)}, now, health};
  }
  std::atomic<double> newtons = -12.5;
  std::atomic<Health> health = Health::ok;
};

double longest_silence_ms(const ForceSensor& sensor) {
  const std::string line = sensor.remarks().at(0), words = "longest without one ";
  const std::size_t at = line.find(words);
  EXPECT_NE(at, std::string::npos) << line;
  return at == std::string::npos ? 0.0 : std::stod(line.substr(at + words.size()));
}

struct NetftPorts {
  struct Table final : DefaultOffer::Defaults {
    using DefaultOffer::Defaults::value;
    void value(const Setting& key, double& number) override {
      if (key.name == "silent_ms") number = 0.05;  // s: other tests share the processor
      if (key.name == "timeout_ms") number = 0.3;
    }
    void value(const Setting& key, std::int64_t& whole) override {
      if (key.name == "port") whole = port;
      if (key.name == "http_port") whole = http_port;
      if (key.name == "command_port") whole = command_port;
    }
    void value(const Setting& key, std::string& text) override {
      if (key.name == "address") text = "127.0.0.1";
    }
    std::int64_t port = 0, http_port = 0, command_port = 0;
  };
  NetftPorts() {
    table.port = server.port();
    table.http_port = server.http_port();
    table.command_port = server.command_port();
  }
  Offer offer() { return {table, defaults.rig, defaults.reach, Duration(1'000'000), defaults.log}; }
  std::string refused() {
    return error_of([&] { static_cast<void>(netft::streaming(offer())); }, ErrorKind::device);
  }

  DefaultOffer defaults;
  Table table;
  PressSensor sensor;
  netft::Server server{sensor, netft::gamma(), "127.0.0.1", netft::Ports{}};
};

// Time counts from the first call.
struct Loop {
  Duration begun = net::steady_now();
  [[nodiscard]] Time now() const { return Time(net::steady_now() - begun); }
  Measurement<Wrench> read_for(ForceSensor& sensor, int cycles) const {
    Measurement<Wrench> sample;
    for (int i = 0; i < cycles; ++i) {
      sample = sensor.read(now());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return sample;
  }
};

TEST(NetftDriver, ReadsWhatTheSensorSays) {
  NetftPorts there;
  const FakeServer served(there.server);
  const auto driver = netft::streaming(there.offer());
  EXPECT_THAT(driver->describe(), HasSubstr("Net F/T at 127.0.0.1:"));
  EXPECT_TRUE(driver->is_fake());
  EXPECT_THAT(driver->describe(),
              HasSubstr("configuration 'Gamma SI-130-10', 1000 records a second, answered, its command "
                        "interface agrees"));
  const Loop loop;
  Measurement<Wrench> sample = loop.read_for(*driver, 50);
  ASSERT_EQ(sample.health, Health::ok);
  EXPECT_NEAR(sample.value.force.xyz[2], -12.5, 1e-6);
  EXPECT_NEAR(sample.value.torque.xyz[0], 0.1, 1e-6);
  there.sensor.newtons = 3.0;
  sample = loop.read_for(*driver, 50);
  EXPECT_NEAR(sample.value.force.xyz[2], 3.0, 1e-6);
  there.sensor.health = Health::saturated;
  EXPECT_EQ(loop.read_for(*driver, 50).health, Health::saturated);
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("transducer saturated"));
}

// A run without a first record would begin in hold. Only the first reading waits for one.
TEST(NetftDriver, TheFirstReadingHasARecordAndNoOtherOneWaits) {
  NetftPorts there;
  auto served = std::make_unique<FakeServer>(there.server);
  Offer patient = there.offer();
  const Offer offer{patient.table, patient.rig, patient.reach, Duration(200'000'000), patient.log};
  const auto driver = netft::streaming(offer);
  const Loop loop;
  const Time begun = loop.now();
  const Measurement<Wrench> first = driver->read(begun);
  EXPECT_EQ(first.health, Health::ok) << "within a period, which is long here";
  EXPECT_LE(first.t, begun);
  served.reset();
  constexpr int kReadings = 20;
  const Duration before = net::steady_now();
  for (int i = 0; i < kReadings; ++i) static_cast<void>(driver->read(loop.now()));
  EXPECT_LT(net::steady_now() - before, kReadings * offer.period / 4);
}

// The fake's codes are status words: without a code it uses a word that the box may send.
TEST(NetftDriver, AnErrorOfTheFakeWithoutACodeIsAStatusOfTheBox) {
  NetftPorts there;
  EXPECT_TRUE(there.server.knows({Trouble::Kind::error_code, 4294967295.0}));
  EXPECT_FALSE(there.server.knows({Trouble::Kind::error_code, 4294967296.0}));
  ASSERT_TRUE(there.server.knows({Trouble::Kind::error_code}));
  there.server.suffer({Trouble::Kind::error_code});
  const FakeServer served(there.server);
  const auto driver = netft::streaming(there.offer());
  EXPECT_EQ(Loop{}.read_for(*driver, 20).health, Health::fault);
  EXPECT_THAT(driver->remarks().at(0), HasSubstr("status 0x90000000: analog board"));
}

TEST(NetftDriver, ASilentBoxIsLostAndStaysSo) {
  NetftPorts there;
  auto served = std::make_unique<FakeServer>(there.server);
  const auto driver = netft::streaming(there.offer());
  const Loop loop;
  EXPECT_EQ(loop.read_for(*driver, 20).health, Health::ok);
  EXPECT_TRUE(driver->linked());
  served.reset();
  EXPECT_EQ(loop.read_for(*driver, 100).health, Health::fault);
  EXPECT_FALSE(driver->linked());
  // Silence counts until the link is lost: afterwards the driver no longer listens.
  const double silent = longest_silence_ms(*driver);
  EXPECT_GE(silent, 50.0);
  served = std::make_unique<FakeServer>(there.server);
  EXPECT_EQ(loop.read_for(*driver, 50).health, Health::fault);
  EXPECT_FALSE(driver->linked());
  EXPECT_EQ(longest_silence_ms(*driver), silent);
}

// The process stops within a tick: the samples that it then reads arrived after the tick began.
TEST(NetftDriver, AfterATickThatWasHeldUpForceIsAsFreshAsBefore) {
  NetftPorts there;
  const FakeServer served(there.server);
  const auto driver = netft::streaming(there.offer());
  const Loop loop;
  ASSERT_EQ(loop.read_for(*driver, 100).health, Health::ok);
  const Time began = loop.now();
  constexpr double kHeldUp = 0.25;  // s: all its records are in the socket
  std::this_thread::sleep_for(std::chrono::duration<double>(kHeldUp));
  EXPECT_LE(driver->read(began).t, began);
  double freshest = kHeldUp;
  for (int i = 0; i < 100; ++i) {
    const Measurement<Wrench> sample = loop.read_for(*driver, 1);
    freshest = std::min(freshest, age(loop.now(), sample.t));
  }
  EXPECT_LT(freshest, 0.1 * kHeldUp);
}

TEST(NetftDriver, WhoDoesNotAnswerIsNamed) {
  NetftPorts there;
  EXPECT_THAT(there.refused(), HasSubstr("no whole answer within 300 ms; see that it is a Net F/T"));
  {
    const FakeServer served(there.server);
    there.table.port = 1;
    EXPECT_THAT(there.refused(),
                HasSubstr("127.0.0.1:1: its page answers, and no record comes within 300 ms"));
    there.table.port = there.server.port();
    EXPECT_EQ(there.refused(), "");
  }
  there.table.http_port = 1;
  EXPECT_THAT(there.refused(), HasSubstr("127.0.0.1:1: nobody listens there"));
}

TEST(NetftDriver, ACommandInterfaceThatMeansOtherUnitsIsRefused) {
  NetftPorts there;
  const FakeServer served(there.server);
  netft::NetftSettings settings;
  settings.address = "127.0.0.1";
  settings.command_port = there.server.command_port();
  const std::vector<std::byte> answer = netft::ask_calibration(settings);
  ASSERT_EQ(answer.size(), netft::kCalibrationSize);
  netft::agree(answer, netft::gamma(), settings);
  netft::Configuration pounds = netft::gamma();
  pounds.per_newton /= 4.4482216152605;
  EXPECT_THAT(error_of([&] { netft::agree(answer, pounds, settings); }),
              HasSubstr("its command interface 1000000 for unit 2 and 1000000 for unit 3"));
  settings.command_port = 1;
  EXPECT_TRUE(netft::ask_calibration(settings).empty()) << "nobody listens there";
}

TEST(NetftDriver, AnotherPageIsNotFound) {
  NetftPorts there;
  const FakeServer served(there.server);
  netft::NetftSettings settings;
  settings.address = "127.0.0.1";
  settings.http_port = there.server.http_port();
  EXPECT_THAT(netft::fetch(settings, "/netftapi2.xml?index=3"), HasSubstr("<prodname>Net F/T</prodname>"));
  EXPECT_THAT(error_of([&] { static_cast<void>(netft::fetch(settings, "/else")); }),
              HasSubstr("/else answered with HTTP status 404, expected 200"));
}

}  // namespace
}  // namespace enc::test
