// What the drivers of the laboratory are offered in tests of threads: a table of a few keys, and where they
// say what they have to say.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/devices/default_offer.h"
#include "trial/devices/device_log.h"

namespace enc::test {

// s: longer than any test, on any machine; and shorter.
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
  std::string transport = "udp";               // of tool data
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
  trial::DeviceLog log;  // of the driver
  trial::DeviceLog log_of_fake;
};

}  // namespace enc::test
