// What a driver is offered where there is no rig file: every key of its table keeps its default.
#pragma once

#include "core/control/scene/scene.h"
#include "core/devices/driver.h"

namespace enc::test {

struct DefaultOffer {
  struct Defaults : Settings {
    void value(const Setting&, double&) override {}
    void value(const Setting&, std::int64_t&) override {}
    void value(const Setting&, std::string&) override {}
    void value(const Setting&, std::vector<double>&) override {}
  };
  struct Silent final : Log {
    void say(const std::string&) override {}
  };
  Offer with(const Reach& promised) { return {table, rig, promised, Duration(1'000'000), log}; }
  Offer with() { return with(reach); }

  Defaults table;
  RigSpec rig;
  Reach reach = reach_of(rig);
  Silent log;
};

}  // namespace enc::test
