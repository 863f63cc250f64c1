// The table of a driver: as shipped, but for the values given here.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/spec/settings.h"

namespace enc::bench::devices {

struct DriverValues final : Settings {
  std::map<std::string, double, std::less<>> numbers{};
  std::map<std::string, std::int64_t, std::less<>> wholes{};
  std::map<std::string, std::string, std::less<>> texts{};

  void value(const Setting& key, double& number) override { take(numbers, key, number); }
  void value(const Setting& key, std::int64_t& whole) override { take(wholes, key, whole); }
  void value(const Setting& key, std::string& text) override { take(texts, key, text); }
  void value(const Setting&, std::vector<double>&) override {}

 private:
  template <class Values, class Value>
  static void take(const Values& values, const Setting& key, Value& value) {
    if (const auto at = values.find(std::string_view(key.name)); at != values.end()) value = at->second;
  }
};

}  // namespace enc::bench::devices
