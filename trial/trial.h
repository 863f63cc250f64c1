// One run of a scene: the loop of the product, with the counts that every run needs. All code that runs
// scenes uses it.
//
//   clock -> devices -> (disturb) -> step() -> devices -> count, record, watch
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/device.h"
#include "core/devices/rig.h"
#include "core/record/record.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"
#include "trial/certificates.h"
#include "trial/devices/device_log.h"
#include "trial/gate.h"
#include "trial/steered/steering.h"
#include "trial/time/real_time.h"
#include "trial/trial_options.h"

namespace enc::trial {

class Trial {
 public:
  // Throws Error for everything that can be refused; nothing moves before the first tick().
  Trial(models::Setup setup, TrialOptions options);
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;
  ~Trial();  // stops every moving device, as at the end of run()

  void record_to(RecordWriter* record) { record_ = record; }  // null: no record
  TrialResult run();
  // One tick; false when the run is over. run() calls this in a loop.
  bool tick();
  // Commands go to the devices again from the next tick on; a link that is still lost is reported again.
  void resume() noexcept { gate_.resume(); }
  [[nodiscard]] const Gate& gate() const { return gate_; }
  [[nodiscard]] const TrialResult& result() const { return result_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  [[nodiscard]] const std::vector<ObjectCertificate>& certificates() const { return certificates_; }
  [[nodiscard]] const Tick& now() const { return now_; }  // the last tick
  [[nodiscard]] Rig& rig() { return rig_; }
  [[nodiscard]] Inputs& inputs() { return in_; }
  [[nodiscard]] const Inputs& inputs() const { return in_; }
  [[nodiscard]] const Measurement<HandSample>& hand() const { return hand_; }  // the hand tracker's newest
  [[nodiscard]] State& state() { return state_; }
  [[nodiscard]] Outputs& outputs() { return out_; }
  [[nodiscard]] const Outputs& outputs() const { return out_; }
  [[nodiscard]] std::vector<std::string> said() const;  // the devices' messages so far, a line each
  [[nodiscard]] bool has_world() const { return world_ != nullptr; }  // true if a slot is simulated
  [[nodiscard]] sim::World& world() { return *world_; }
  [[nodiscard]] const sim::World& world() const { return *world_; }
  [[nodiscard]] const sim::Truth& truth() const { return world_ ? world_->truth() : unknown_; }

 private:
  void make_rig(bool simulated);
  void put_vision(bool waits, bool threaded);
  void plan_length(double pace);
  [[nodiscard]] bool ends();
  void ask_hands();
  void count();
  void hear(const HandWord& word);

  models::Setup setup_;
  TrialOptions options_;
  std::unique_ptr<RealTime> real_time_;  // made before the devices, whose threads inherit its priority
  Scene scene_;
  const Family& family_;
  std::unique_ptr<sim::World> world_;
  sim::Truth unknown_;
  DeviceLog log_;
  // Made after world and log, so that it is destroyed first.
  Rig rig_;
  Gate gate_;
  Tick now_;
  Inputs in_;
  Measurement<HandSample> hand_;  // not an input: the core does not see it
  Faults faults_;                 // between devices and core
  Outputs out_;
  State state_;
  StateHash hash_;
  std::chrono::nanoseconds before_{};  // wall clock at the start of the last step()
  TrialResult result_;
  std::int64_t last_tick_ = 0;
  RecordWriter* record_ = nullptr;
  bool simulated_ = true;  // every slot is simulated
  bool leads_ = false;     // the twin's machine follows a real one
  std::vector<ObjectCertificate> certificates_;
};

}  // namespace enc::trial
