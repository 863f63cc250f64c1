// The devices of a rig over their protocols in virtual time, for tests and benchmarks: the laboratory's
// drivers on one side, and on the other their fakes in front of the earlier roles. The machine's connection
// is a string; force and tool data go over loopback, where a datagram arrives as soon as it is sent.
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

// Faults of the machine's connection. For force and tool data use the faults of their fakes
// (core/devices/fake.h).
struct Spoilt {
  bool silent = false;   // receives no answer, though data are taken
  bool cut = false;      // a cut cable: no data are received or taken
  bool hung_up = false;  // closed by the other side
  std::string instead;   // replaces the next answer, once
  bool half = false;     // half of the next answer, and then silence
};

// The devices that go over their protocols.
struct Which {
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
  // whose ticks come through here. The rig must be destroyed before this object. `tools`: names of the
  // scene's, by index.
  void fit_out(Rig& rig, const RigSpec& spec, const Tables& tables, std::span<const std::string> tools,
               Log& log, Which which = {true, true, true});

  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] gcs::Controller& controller() { return *controller_; }
  [[nodiscard]] netft::Server& box() { return *box_; }
  [[nodiscard]] igtl::ToolServer& tools() { return *tools_; }
  // Delays the next tick by this time, and its clock misses that many cycles. Until then the loop stands
  // still. The thread of the machine's driver goes on, or stands too, as if the process were stopped.
  void stand(Duration how_long, bool process) {
    standing_ = how_long;
    process_stands_ = process;
  }

  Spoilt machine;

 private:
  class Link;
  class Clock;
  void pass(Time now);
  // Puts the machine's driver into its role, and the earlier device behind a fake.
  void put_machine(Rig& rig, const Offer& offer, Settings& table);
  // The earlier tracker answers on loopback, by the tools' names.
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
