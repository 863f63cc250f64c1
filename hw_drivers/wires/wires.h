// The devices of a rig behind their wires in virtual time, for tests and benchmarks: the drivers of the
// laboratory on one side, on the other their fakes in front of the same roles that were there before. The
// machine's wire is a string; force and tool data go over loopback, where a datagram is there when it was
// sent.
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

// What may happen to the machine's wire. Force and tool data suffer as their fakes do (core/devices/fake.h).
struct Spoilt {
  bool silent = false;   // nothing comes any more, though it is taken
  bool cut = false;      // a cable: nothing comes, and nothing is taken
  bool hung_up = false;  // closed by the other side
  std::string instead;   // once, in place of the next answer
  bool half = false;     // of the next answer, and then nothing
};

// Which devices go behind their wires.
struct Which {
  bool machine = true, force = true, tracker = true;
};

// The drivers' own tables, [driver.NAME].
struct Tables {
  Settings &gcs, &netft, &igtl;
};

class Wires {
 public:
  explicit Wires(std::uint64_t seed = 1) : seed_(seed) {}  // of what is lost, late or noise
  Wires(const Wires&) = delete;
  Wires& operator=(const Wires&) = delete;
  ~Wires();

  // Puts drivers into the roles, and what filled them behind their wires. Time goes on with the rig's clock,
  // whose ticks come through here. The rig goes before this. `tools`: names of the scene's, by index.
  void fit_out(Rig& rig, const RigSpec& spec, const Tables& tables, std::span<const std::string> tools,
               Log& log, Which which = {true, true, true});

  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] gcs::Controller& controller() { return *controller_; }
  [[nodiscard]] netft::Server& box() { return *box_; }
  [[nodiscard]] igtl::ToolServer& tools() { return *tools_; }
  // The next tick comes so much later, and its clock has missed as many. Until then the loop stands; the
  // thread of the machine's driver goes on, or stands as well, as where the process was stopped.
  void stand(Duration how_long, bool process) {
    standing_ = how_long;
    process_stands_ = process;
  }

  Spoilt machine;

 private:
  class Link;
  class Clock;
  void pass(Time now);
  // Puts the machine's driver into its role, and what filled that behind its wire.
  void put_machine(Rig& rig, const Offer& offer, Settings& table);
  // What filled the tracker's role answers on loopback, by the tools' names.
  void serve_tools(Rig& rig, Settings& table, std::span<const std::string> tools);

  std::uint64_t seed_;
  Time now_{};
  Duration standing_{};  // from the next tick on
  bool process_stands_ = false;
  Rig twin_;  // the roles that went behind their wires
  std::unique_ptr<gcs::Controller> controller_;
  std::unique_ptr<netft::Server> box_;
  std::unique_ptr<igtl::ToolServer> tools_;
  gcs::GcsManipulator* driver_ = nullptr;
};

}  // namespace enc::wires
