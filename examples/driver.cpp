// Your own driver: a force sensor that always reports zero. In a rig file: [force] driver = "steady".
// hw_drivers/sample shows a device with two roles, hw_drivers/netft one on a real network.
#include <cstdint>
#include <string>

#include "core/devices/module.h"

namespace {

using namespace enc;

// The table [driver.steady] of the rig file.
struct Keys {
  std::string address = "192.168.1.1";
  void declare(Settings& table) { table.value({.name = "address", .meaning = "of the sensor"}, address); }
};

class ConstantSensor final : public ForceSensor {
 public:
  explicit ConstantSensor(const Offer& offer) {
    keys_.declare(offer.table);
  }  // connect; throw Error without an answer
  std::string describe() const override { return "steady at " + keys_.address; }
  // Return the newest sample; a driver never waits here.
  Measurement<Wrench> read(Time now) noexcept override {
    return {{Vec<'F'>::zero(), Vec<'F'>::zero()}, now, Health::ok};
  }

 private:
  Keys keys_;
};

constexpr DriverModule kDriver{.settings = [](Settings& table) { Keys{}.declare(table); },
                               .force = make<ForceSensor, ConstantSensor>};
constexpr ModuleInfo kInfo{.name = "steady", .driver = &kDriver};

}  // namespace

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() { return &kInfo; }
