// A simulated world of the tennis ball scene, for the suites here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/scene_file.h"
#include "sim/world.h"

namespace enc::test {

inline std::string scene_file(const std::string& name) {
  std::string file =
      ENCOUNTER_SOURCE_DIR "/models/scenes/";  // literals joined: g++ 12 warns wrongly of string + literal
  file.append(name).append(".toml");
  return file;
}

// Owns what a world refers to; not to be moved.
struct Twin {
  explicit Twin(const std::vector<std::string>& set = {}, std::uint64_t seed = 1,
                const std::string& name = "tennis_ball")
      : setup(models::load(scene_file(name), "sim", set)) {
    build(seed);
  }
  Twin(std::uint64_t seed, models::Setup made) : setup(std::move(made)) { build(seed); }
  Twin(const Twin&) = delete;
  Twin& operator=(const Twin&) = delete;

  void build(std::uint64_t seed) {
    scene = prepare(setup.scene, setup.rig);
    world = std::make_unique<sim::World>(sim::WorldSpec{setup.scene, setup.rig, setup.twin, scene,
                                                        ENCOUNTER_SOURCE_DIR "/models/mjcf", seed, false});
    rig = world->rig();
  }
  // One tick of the loop with the haptic core in it.
  const Tick& tick() {
    k = rig.clock->next();
    rig.read(in);
    step(scene, k, in, state, out);
    rig.write(out);
    return k;
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  [[nodiscard]] double now() const { return seconds(k.t.time_since_epoch()); }

  models::Setup setup;
  Scene scene;
  std::unique_ptr<sim::World> world;
  Rig rig;  // after the world, so that it goes first
  Inputs in;
  State state;
  Outputs out;
  Tick k;
};

// Nothing but the true force: no noise, no zero error, no drift, no steps.
inline std::vector<std::string> exact_force() {
  return {"truth.force.noise_N=0", "truth.force.torque_noise_Nm=0", "truth.force.zero_N=0",
          "truth.force.drift_N_per_sqrt_s=0"};
}

}  // namespace enc::test
