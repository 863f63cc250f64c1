// The driver to copy: a machine that reaches each commanded pose by the next read, and a force sensor that
// always reports zero. A real driver replaces the parts marked "wire". Keep its checks, limits and messages.
#include <cstdint>
#include <string>

#include "core/base/error.h"  // needed by a constructor that throws
#include "core/devices/module.h"

namespace enc::sample {
namespace {

// [driver.sample] of the rig file: one box, one address, two roles.
struct Wire {
  std::string address = "127.0.0.1";
  std::int64_t port = 4711;

  void declare(Settings& table) {
    table.value({.name = "address", .meaning = "address of the controller"}, address);
    table.value({.name = "port", .meaning = "TCP port of the controller", .low = 1, .high = 65535}, port);
  }
  explicit Wire(const Offer& offer) {
    declare(offer.table);
    // wire: connect; if no device answers, throw Error(..., {}, ErrorKind::device) with a remedy
  }
  Wire() = default;
  [[nodiscard]] std::string words() const { return "sample " + address + ":" + std::to_string(port); }
};

class SampleManipulator final : public Manipulator {
 public:
  explicit SampleManipulator(const Offer& offer)
      : wire_(offer), reach_(offer.reach), pose_(reach_.machine.zero()) {}

  [[nodiscard]] std::string describe() const override { return wire_.words() + ", answered (no wire)"; }
  [[nodiscard]] Reach reach() const override { return reach_; }
  // A device without its own clock stamps a reading with the time of the cycle that received it.
  Measurement<TipSample> read(Time now) noexcept override {
    // wire: take the newest datagram, if any; never wait for it
    return {{pose_, Vec<'R'>::zero(), Vec<'R'>::zero()}, now, health_};
  }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override {
    health_ = Health::fault;  // not a number, or not a rotation: refuse and report it
    if (!X_RH.valid()) return;
    health_ = reach_.contains(X_RH) ? Health::ok : Health::out_of_range;
    pose_ = clamped(reach_, pose_, X_RH);
    // wire: send pose_
  }
  void stop() noexcept override {}  // wire: send a stop; this machine already stands

 private:
  Wire wire_;
  Reach reach_;
  Pose<'R', 'H'> pose_;
  Health health_ = Health::ok;
};

class SampleForceSensor final : public ForceSensor {
 public:
  explicit SampleForceSensor(const Offer& offer) : wire_(offer) {}
  [[nodiscard]] std::string describe() const override { return wire_.words() + ", answered (no wire)"; }
  Measurement<Wrench> read(Time now) noexcept override {
    return {{Vec<'F'>::zero(), Vec<'F'>::zero()}, now, Health::ok};
  }

 private:
  Wire wire_;
};

constexpr DriverModule kDriver{.settings = [](Settings& table) { Wire{}.declare(table); },
                               .manipulator = make<Manipulator, SampleManipulator>,
                               .force = make<ForceSensor, SampleForceSensor>};
constexpr ModuleInfo kInfo{.name = "sample", .driver = &kDriver};

}  // namespace
}  // namespace enc::sample

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sample::kInfo;
}
