// Runs a scene in the twin from C++, as fast as possible. It prints force over deflection of each press.
// Usage: twin models/scenes/tennis_ball.toml
#include <cstdio>

#include "models/setup/scene_file.h"
#include "trial/trial.h"

int main(int count, char** words) {
  if (count != 2) return std::fputs("twin SCENE.toml\n", stderr), 2;
  enc::trial::TrialOptions options;
  options.seed = 1;
  options.seconds = 20.0;
  enc::trial::Trial trial(enc::models::load(words[1], ""), options);
  std::puts("time_s,deflection_mm,force_N");
  while (trial.tick()) {
    const enc::Outputs& out = trial.outputs();     // commands and estimates of the core
    const enc::sim::Truth& truth = trial.truth();  // ground truth, which no device measures
    if (out.mode != enc::Mode::contact || trial.now().index % 50 != 0) continue;
    std::printf("%.3f,%.3f,%.3f\n", enc::seconds(trial.now().t.time_since_epoch()), 1e3 * out.deflection,
                truth.contact_force.norm());
  }
}
