#include "benchmarks/identification/identification_trial.h"

#include <cmath>

#include <fmt/format.h>

#include "sim/bodies/ball_contact.h"
#include "sim/truth/random.h"
#include "trial/trial.h"

namespace enc::bench::identification {
namespace {

std::vector<std::string> drawn_ball(const IdentificationCase& which, std::uint64_t seed) {
  constexpr double kModulus = 0.15, kOthers = 0.3, kThickness = 0.2e-3;
  sim::Stream random(seed, "identification");
  std::vector<std::string> settings;
  const auto draw = [&](std::size_t number, double share) {
    const trial::BallNumber& n = trial::ball_numbers()[number];
    const double value = trial::value_of(n, {}) * (1.0 + share * (2.0 * random.uniform() - 1.0));
    settings.push_back(fmt::format("truth.ball.{}={}", n.name, value / n.unit));
  };
  for (std::size_t i = 0; i < trial::kNearer; ++i) draw(i, i == trial::kRubberModulus ? kModulus : kOthers);
  if (which.draw_wall)
    draw(trial::kWall, kThickness / trial::value_of(trial::ball_numbers()[trial::kWall], {}));
  return settings;
}

// The ball in the world of a set-up.
trial::StandingBall truth_of(const models::Setup& setup, const Scene& scene) {
  const ObjectSpec& object = setup.scene.objects[static_cast<std::size_t>(scene.probe()->object)];
  const Vec<'W'> out = scene.probe()->X_WN * Vec<'N'>(0, 0, 1);
  return {sim::ball_of(setup.twin.ball, object.radius), dot(Vec<'W'>(setup.twin.ball.misplaced), out)};
}

}  // namespace

bool IdentificationTrial::holds(const trial::BallEstimate& estimate) const {
  return estimate.interval.holds(trial::value_of(trial::ball_numbers()[estimate.number], truth));
}

trial::Pushes pushes_of_run(const models::Setup& setup, std::uint64_t seed, double& simulated) {
  trial::Pushes pushes;
  trial::TrialOptions options;
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) {
    const Outputs& out = glance.out;
    if (out.mode != Mode::probe || out.contacts == 0 || !(out.deflection > 0.0) || !out.felt.finite()) return;
    pushes.resize(static_cast<std::size_t>(out.contacts));
    const double force = dot(out.felt, glance.scene.probe()->X_WN * Vec<'N'>(0, 0, 1));
    pushes.back().push_back({out.deflection, force, true, seconds(glance.tick.t.time_since_epoch())});
  };
  simulated += trial::Trial(setup, options).run().simulated;
  return pushes;
}

IdentificationTrial identify_once(const BenchContext& context, const IdentificationCase& which,
                                  std::uint64_t seed) {
  std::vector<std::string> settings = drawn_ball(which, seed);
  settings.insert(settings.end(), which.settings.begin(), which.settings.end());
  settings.insert(settings.end(), context.set.begin(), context.set.end());
  const models::Setup setup =
      models::load(fmt::format("{}/scenes/{}.toml", context.models, which.scene), "sim", settings);
  IdentificationTrial trial;
  trial.truth = truth_of(setup, trial::prepare_setup(setup));
  trial::BallFitOptions options;
  options.free[trial::kNearer] = !which.hold_nearer;
  options.free[trial::kWall] = which.free_wall;
  trial.fit = trial::fit_ball(trial::BallLoops({pushes_of_run(setup, seed, trial.simulated)}), options);
  return trial;
}

}  // namespace enc::bench::identification
