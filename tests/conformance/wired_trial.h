// The product's loop with its devices behind their wires, in virtual time: the drivers of the laboratory on
// one side, on the other their fakes in front of the same twin that would have filled the roles itself. The
// machine's wire is a string; force and tool data go over loopback, where a datagram is there when it was
// sent.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/igtl/drive/udp_tracker.h"
#include "hw_drivers/igtl/fake/tool_server.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/fake/server.h"
#include "tests/support/devices/served.h"
#include "trial/device_log.h"
#include "trial/trial.h"

namespace enc::test {

// What may happen to a wire.
struct Spoilt {
  bool silent = false;   // nothing comes any more, though it is taken
  bool hung_up = false;  // closed by the other side
  std::string instead;   // once, in place of the next answer
  bool half = false;     // of the next answer, and then nothing
};

class WiredTrial {
 public:
  struct Wires {
    bool machine = true, force = true, tracker = true;
  };
  // The drivers' tables are those of the set-up's rig.
  WiredTrial(models::Setup setup, trial::TrialOptions options, Wires wires = {true, true, true});

  bool tick() { return trial_->tick(); }
  [[nodiscard]] trial::Trial& trial() { return *trial_; }
  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] gcs::Controller& controller() { return *controller_; }
  [[nodiscard]] netft::Box& box() { return box_->box(); }
  [[nodiscard]] const trial::DeviceLog& log() const { return log_; }
  // Turns of the driver alone: the loop stands, and its thread would not.
  void loop_stands(Duration longest);

  Spoilt machine;
  bool force_silent = false, tracker_silent = false;
  std::string force_datagram, tracker_datagram;  // sent once, in place of the next

 private:
  class Link;
  class Clock;
  void put(Rig& rig, const Wires& wires);
  void pass(Time now);

  models::Setup setup_;
  trial::DeviceLog log_;
  Time now_{};
  Rig twin_;  // the roles that went behind their wires
  std::unique_ptr<gcs::Controller> controller_;
  std::unique_ptr<netft::Server> box_;
  std::unique_ptr<igtl::ToolServer> tools_;
  gcs::GcsManipulator* driver_ = nullptr;
  std::unique_ptr<trial::Trial> trial_;
};

}  // namespace enc::test
