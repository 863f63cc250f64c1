// The fakes of all drivers that a rig names, over one twin: what is told on one wire is seen on the others.
// One thread, which whoever owns them lends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/laboratory/fault_text.h"
#include "core/devices/fake.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"
#include "trial/devices/device_log.h"

namespace enc::app {

struct FakesOptions {
  trial::DriverSource drivers{};
  std::uint64_t seed = 1;
  bool lockstep = false;  // time goes on by a period with each set-point; else with the wall clock
  std::vector<Fault> faults{};
};

class Fakes {
 public:
  // Throws Error: a driver without a fake, a port that is taken, a scene that does not fit.
  Fakes(models::Setup setup, FakesOptions options);
  Fakes(const Fakes&) = delete;
  Fakes& operator=(const Fakes&) = delete;

  [[nodiscard]] std::vector<std::string> describe() const;
  // A turn: waits until somebody asks or a period is over, at most 50 ms, answers, and lets time go on.
  void turn();
  // From now on: `fault.at` counts from here. Throws Error (kind input), as for those of the options: there
  // is no such fake, its wire knows no such trouble.
  void suffer(const Fault& fault, const std::string& where);
  void heal();  // all of them
  [[nodiscard]] std::vector<std::string> log() const { return log_.lines(); }
  [[nodiscard]] sim::World& world() { return *world_; }
  [[nodiscard]] std::int64_t begun() const { return begun_; }  // how often somebody came

 private:
  struct Planned {
    Fault fault;
    Fake* fake;
    Time from, to;
    bool begun = false, over = false;
    bool by_hand = false;  // of the world as it is, and not of each run
  };
  [[nodiscard]] Planned planned(const Fault& fault, const std::string& where);
  void trouble();  // what begins and ends now
  void end(Planned& plan);
  void say(const Planned& plan, const char* what);
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
  std::vector<std::unique_ptr<Fake>> fakes_;
  std::vector<std::string> names_;  // of their drivers
  std::vector<Planned> plans_;
  Tick now_;
  std::int64_t begun_ = 0;
  Duration due_{};  // of the wall clock, when the next period is over
};

}  // namespace enc::app
