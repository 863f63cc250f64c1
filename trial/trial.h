// One run of a scene: the loop of the product, with what every run counts. All that runs scenes shares it.
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

#include "core/devices/rig.h"
#include "core/devices/stereo_camera.h"
#include "core/record/record.h"
#include "models/setup/scene_file.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"
#include "trial/certificates.h"
#include "trial/devices/device_log.h"
#include "trial/gate.h"
#include "trial/steered/faults.h"
#include "trial/time/real_time.h"
#include "trial/trial_options.h"
#include "trial/trial_result.h"

namespace enc::trial {

class Trial {
 public:
  // Throws Error for all that can be refused: nothing moves before a tick() is asked for.
  Trial(models::Setup setup, TrialOptions options);
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;
  ~Trial();  // whatever moves is stopped, as at the end of run()

  void record_to(RecordWriter* record) { record_ = record; }  // null: nowhere
  TrialResult run();
  // One tick; false when the run is over. run() is this in a loop.
  bool tick();
  // From the next tick on devices are believed and told again; a link that is still lost is lost again.
  void resume() noexcept { gate_.resume(); }
  [[nodiscard]] const Gate& gate() const { return gate_; }
  [[nodiscard]] const TrialResult& result() const { return result_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  [[nodiscard]] const std::vector<Certified>& certificates() const { return certificates_; }
  [[nodiscard]] const Tick& now() const { return now_; }  // of the last tick
  [[nodiscard]] Rig& rig() { return rig_; }
  [[nodiscard]] Inputs& inputs() { return in_; }
  [[nodiscard]] const Inputs& inputs() const { return in_; }
  [[nodiscard]] State& state() { return state_; }
  [[nodiscard]] Outputs& outputs() { return out_; }
  [[nodiscard]] const Outputs& outputs() const { return out_; }
  [[nodiscard]] std::vector<std::string> said() const;                // by the devices so far, a line each
  [[nodiscard]] bool has_world() const { return world_ != nullptr; }  // the twin, if a slot is simulated
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
  std::unique_ptr<RealTime> real_time_;  // before the devices, whose threads are as this one
  Scene scene_;
  std::unique_ptr<sim::World> world_;
  sim::Truth unknown_;
  DeviceLog log_;
  Rig rig_;  // after world and log, so that it goes first
  Gate gate_;
  Tick now_;
  Inputs in_;
  Faults faults_;  // between devices and core
  Outputs out_;
  State state_;
  StateHash hash_;
  std::chrono::nanoseconds before_{};  // of the wall clock, when the last step() began
  TrialResult result_;
  std::int64_t last_tick_ = 0;
  RecordWriter* record_ = nullptr;
  bool simulated_ = true;  // every slot
  bool leads_ = false;     // the twin's machine follows one that is not simulated
  std::vector<Certified> certificates_;
};

}  // namespace enc::trial
