// A simulated world of a shipped scene, and settings of scenes for tests.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/record/state_hash.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::test {

inline std::string scene_file(const std::string& name) {
  std::string file =
      tests::source_dir() + "/models/scenes/";  // literals joined: g++ 12 warns wrongly of string + literal
  file.append(name).append(".toml");
  return file;
}

// A trial without an end whose parts a test may use one by one. It must not be moved.
struct Twin {
  explicit Twin(const std::vector<std::string>& set = {}, std::uint64_t seed = 1,
                const std::string& name = "tennis_ball")
      : Twin(seed, models::load(scene_file(name), "sim", set)) {}
  Twin(std::uint64_t seed, models::Setup made) : trial(std::move(made), options(seed)) {}
  Twin(const Twin&) = delete;
  Twin& operator=(const Twin&) = delete;

  trial::TrialOptions options(std::uint64_t seed) {
    trial::TrialOptions options;
    options.seed = seed;
    options.seconds = std::numeric_limits<double>::infinity();
    options.disturb = [this](Inputs& read) {
      if (disturb) disturb(read);
    };
    return options;
  }
  // Runs one tick of the loop with the haptic core in it.
  const Tick& tick() {
    trial.tick();
    return k;
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  [[nodiscard]] double now() const { return seconds(k.t.time_since_epoch()); }

  std::function<void(Inputs&)> disturb;  // between reading and step()
  trial::Trial trial;
  const models::Setup& setup = trial.setup();
  const Scene& scene = trial.scene();
  sim::World* world = &trial.world();
  Rig& rig = trial.rig();
  Inputs& in = trial.inputs();
  State& state = trial.state();
  Outputs& out = trial.outputs();
  const Tick& k = trial.now();
};

// Hash of the core's whole state over the next ticks.
inline std::uint64_t hashed(Twin& twin, int ticks) {
  StateHash hash;
  for (int i = 0; i < ticks; ++i) {
    twin.tick();
    add_tick(hash, twin.state, twin.out);
  }
  return hash.value;
}

// Settings for the true force only: no noise, no zero error, no drift, no steps.
inline std::vector<std::string> exact_force() {
  return {"truth.force.noise_N=0", "truth.force.torque_noise_Nm=0", "truth.force.zero_N=0",
          "truth.force.drift_N_per_sqrt_s=0"};
}

// Settings of a scene that uses the twin's camera: images with a quarter of the pixels.
[[nodiscard]] inline std::vector<std::string> quarter_size() {
  return {"rig.camera.width_px=320",
          "rig.camera.height_px=240",
          "rig.camera.left.focal_px=[360.5, 360.5]",
          "rig.camera.left.centre_px=[159.5, 119.5]",
          "rig.camera.right.focal_px=[360.5, 360.5]",
          "rig.camera.right.centre_px=[159.5, 119.5]",
          "truth.camera.width_px=320",
          "truth.camera.height_px=240",
          "truth.camera.focal_px=360.5"};
}

}  // namespace enc::test
