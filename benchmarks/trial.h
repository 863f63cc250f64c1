// One run of a scene: the loop of the architecture, with what every run counts. Used by `run`, by benchmarks
// and by tests.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/record/record.h"
#include "core/rig.h"
#include "models/scene_file.h"
#include "sim/world.h"

namespace enc::bench {

// What a tick was, for measures that look on. Truth is for them alone; the core does not see it.
struct Glance {
  const Scene& scene;
  const Tick& tick;
  const sim::Truth& truth;
  const Inputs& in;
  const Outputs& out;
};

struct TrialOptions {
  std::uint64_t seed = 1;
  double seconds = kUnset;            // unset: until the user or the probe of the scene is done
  double pace = 0.0;                  // experiment seconds for each wall second; 0: as fast as it goes
  bool draw_all = false;              // build what is only looked at, too
  std::function<void(Rig&)> fit_out;  // puts other devices in place of simulated ones
  std::function<void(const Glance&)> watch;
  std::function<void(double)> progress;  // share done, about ten times a second
};

struct TrialResult {
  std::int64_t ticks = 0;
  double simulated = 0.0, wall = 0.0;  // s
  std::array<double, kModes> mode_time{};
  std::int32_t contacts = 0;
  std::int64_t mode_changes = 0;
  std::vector<std::pair<Time, std::uint32_t>> holds;  // when each began, and why; the first 16
  Mode last_mode = Mode::away;
  std::uint32_t last_why = 0;
  std::uint64_t hash = 0;
  std::vector<std::uint32_t> step_ns;  // of each step(), as the wall clock saw it
  std::int64_t diverged_at = -1;
  std::string divergence;
  bool stopped = false;  // record could not be written
};

class Trial {
 public:
  Trial(models::Setup setup, TrialOptions options);
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  void record_to(RecordWriter* record) { record_ = record; }  // null: nowhere
  TrialResult run();
  // One tick; false when the run is over. run() is this in a loop.
  bool tick();
  [[nodiscard]] const TrialResult& result() const { return result_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] sim::World& world() { return *world_; }
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  [[nodiscard]] State& state() { return state_; }
  [[nodiscard]] const Outputs& outputs() const { return out_; }
  [[nodiscard]] Inputs& inputs() { return in_; }

 private:
  void count(const Tick& tick);

  models::Setup setup_;
  TrialOptions options_;
  Scene scene_;
  std::unique_ptr<sim::World> world_;
  Rig rig_;
  Inputs in_;
  Outputs out_;
  State state_;
  StateHash hash_;
  TrialResult result_;
  std::int64_t last_tick_ = 0;
  RecordWriter* record_ = nullptr;
};

// prepare(), with the place in the file put before what is wrong.
[[nodiscard]] Scene prepare_setup(const models::Setup& setup);
// The twin of a set-up, with the place in the file put before what is wrong. Both must outlive it.
[[nodiscard]] std::unique_ptr<sim::World> make_world(const models::Setup& setup, const Scene& prepared,
                                                     std::uint64_t seed, bool draw_all = false);
// A device that can do less than the rig file promises is refused before anything moves.
void check_devices(const Rig& rig, const RigSpec& spec);

}  // namespace enc::bench
