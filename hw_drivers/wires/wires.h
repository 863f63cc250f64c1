// The devices of a rig over their protocols in virtual time, for tests and benchmarks. The laboratory's
// drivers talk to fakes in front of the rig's earlier devices. The machine's connection is a string. Force
// and tool data use loopback, where a datagram arrives as soon as it is sent.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/devices/rig.h"
#include "core/spec/rig_spec.h"
#include "core/spec/settings.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/igtl/fake/tool_server.h"
#include "hw_drivers/netft/fake/server.h"

namespace enc::wires {

// Faults of the machine's connection. The faults of force and tool data are those of their fakes
// (core/devices/fake.h).
struct WireFaults {
  bool silent = false;   // receives no answer, though data are taken
  bool cut = false;      // a cut cable: no data are received or taken
  bool hung_up = false;  // closed by the other side
  std::string instead;   // replaces the next answer, once
  bool half = false;     // half of the next answer, and then silence
};

// The devices that go over their protocols.
struct WireChoice {
  bool machine = true, force = true, tracker = true;
};

// The drivers' own tables, [driver.NAME].
struct Tables {
  Settings &gcs, &netft, &igtl;
};

class Wires {
 public:
  explicit Wires(std::uint64_t seed = 1) : seed_(seed) {}  // seed of losses, delays and noise
  Wires(const Wires&) = delete;
  Wires& operator=(const Wires&) = delete;
  ~Wires();

  // Puts drivers into the roles, and the earlier devices behind fakes. Time advances with the rig's clock,
  // which this object wraps. Destroy the rig before this object. `tools`: names of the scene's tools, by
  // index.
  void fit_out(Rig& rig, const RigSpec& spec, const Tables& tables, std::span<const std::string> tools,
               Log& log, WireChoice which = {true, true, true});

  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] gcs::Controller& controller() { return *controller_; }
  [[nodiscard]] netft::Server& box() { return *box_; }
  [[nodiscard]] igtl::ToolServer& tools() { return *tools_; }
  // Delays the next tick by this time, and its clock misses that many cycles. The loop stands still until
  // then. The thread of the machine's driver continues, or also stops if `process` is true.
  void stand(Duration how_long, bool process) {
    standing_ = how_long;
    process_stands_ = process;
  }

  WireFaults machine;

 private:
  class Link;
  class Clock;
  void pass(Time now);
  // Puts the machine's driver into its role, and the earlier device behind a fake.
  void put_machine(Rig& rig, const Offer& offer, Settings& table);
  // Serves the earlier tracker's data on loopback, by the tools' names.
  void serve_tools(Rig& rig, Settings& table, std::span<const std::string> tools);

  std::uint64_t seed_;
  Time now_{};
  Duration standing_{};  // starts at the next tick
  bool process_stands_ = false;
  Rig twin_;  // the roles that went behind fakes
  std::unique_ptr<gcs::Controller> controller_;
  std::unique_ptr<netft::Server> box_;
  std::unique_ptr<igtl::ToolServer> tools_;
  gcs::GcsManipulator* driver_ = nullptr;
};

}  // namespace enc::wires
