// The fakes of all drivers of a rig, over one twin: a command on one connection affects the readings on the
// others. They need one thread, which the owner provides. A fault of a fake has a text form:
// "netft:loss=5%@2s+500ms".
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"
#include "trial/devices/device_log.h"

namespace enc::app {

struct Fault {
  std::string driver;  // driver whose fake has the fault
  Trouble trouble;
  double at = 0.0;        // s of the fakes' time
  double lasts = kUnset;  // s; unset: to the end
};

// Reads DRIVER:KIND[=VALUE][@TIME][+TIME]. Throws Error (kind input) with the expected form. `where`: source
// named in the message.
[[nodiscard]] Fault fault_of(const std::string& text, const std::string& where);
[[nodiscard]] std::string text_of(const Trouble& trouble);
// The kinds, each with its value, for --help: "loss=5%, jitter=20ms, ..."
[[nodiscard]] std::string fault_examples();

// The fakes of all drivers of a rig.
struct FakesOptions {
  trial::DriverSource drivers{};
  std::uint64_t seed = 1;
  bool lockstep = false;  // time advances by a period with each set-point; otherwise with the wall clock
  std::vector<Fault> faults{};
};

class Fakes {
 public:
  // Throws Error: a driver without a fake, a port in use, a scene that does not fit.
  Fakes(models::Setup setup, FakesOptions options);
  Fakes(const Fakes&) = delete;
  Fakes& operator=(const Fakes&) = delete;

  [[nodiscard]] std::vector<std::string> describe() const;
  // One turn: waits for a request or the end of a period, at most 50 ms, answers, and advances time.
  void turn();
  // Adds a fault from now on: `fault.at` counts from here. Throws Error (kind input), as for those of the
  // options: no such fake, or its connection does not support the fault.
  void suffer(const Fault& fault, const std::string& where);
  void heal();  // ends all faults
  [[nodiscard]] std::vector<std::string> log() const { return log_.lines(); }
  [[nodiscard]] sim::World& world() { return *world_; }
  [[nodiscard]] std::int64_t begun() const { return begun_; }  // number of clients that came

 private:
  struct FaultPlan {
    Fault fault;
    Fake* fake;
    Time from, to;
    bool begun = false, over = false;
    bool by_hand = false;  // typed by hand: not tied to a run
  };
  [[nodiscard]] FaultPlan planned(const Fault& fault, const std::string& where);
  void trouble();  // starts and ends the due faults
  void end(FaultPlan& plan);
  void say(const FaultPlan& plan, const char* what);
  void advance();
  void begin();
  void wait(Duration most);

  models::Setup setup_;
  FakesOptions options_;
  Scene scene_;
  std::unique_ptr<sim::World> world_;
  std::vector<std::byte> first_;  // the world before its first tick
  trial::DeviceLog log_;
  Rig rig_;
  std::unique_ptr<StereoCamera> camera_;  // the twin's, for a fake of the rig's
  std::vector<std::unique_ptr<Fake>> fakes_;
  std::vector<std::string> names_;  // names of their drivers
  std::vector<FaultPlan> plans_;
  Tick now_;
  std::int64_t begun_ = 0;
  Duration due_{};  // wall clock at the end of the next period
};

}  // namespace enc::app
