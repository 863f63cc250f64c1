// `encounter fit --ball` finds the ball of a rig and knows how well: balls whose numbers the fit does not
// know are pressed in the test rig, through sensor, servo and haptic loop.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "models/order_statistics.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/ball_contact.h"
#include "sim/truth/random.h"
#include "tests/support/built.h"
#include "trial/assemble/prepare.h"
#include "trial/identify/ball/ball_fit.h"
#include "trial/trial.h"

namespace enc {
namespace {

// Modulus within 15 %, the others within 30 % of the nominal ball.
std::vector<std::string> drawn_ball(std::uint64_t seed) {
  sim::Stream random(seed, "identification");
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < trial::kNearer; ++i) {
    const trial::BallNumber& n = trial::ball_numbers()[i];
    const double share = i == trial::kRubberModulus ? 0.15 : 0.3;
    const double value = trial::value_of(n, {}) * (1.0 + share * (2.0 * random.uniform() - 1.0));
    settings.push_back(fmt::format("truth.ball.{}={}", n.name, value / n.unit));
  }
  return settings;
}

// What the rig reads while the probe presses.
trial::Pushes pushes_of(const models::Setup& setup, std::uint64_t seed) {
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
  trial::Trial(setup, options).run();
  return pushes;
}

// Of each number, over balls: how often the interval holds the injected value, and the interval's full width
// over the value (of kNearer over 0.1 mm).
struct Found {
  std::array<int, trial::kNearer + 1> inside{};
  std::array<std::vector<double>, trial::kNearer + 1> widths;
};
void identify(std::uint64_t seed, std::vector<std::string> more, bool nearer_free, Found& found) {
  std::vector<std::string> settings = drawn_ball(seed);
  settings.insert(settings.end(), more.begin(), more.end());
  const models::Setup setup =
      models::load(tests::source_dir() + "/models/scenes/rig_identify.toml", "sim", settings);
  const Scene scene = trial::prepare_setup(setup);
  const double radius = setup.scene.objects[static_cast<std::size_t>(scene.probe()->object)].radius;
  const Vec<'W'> out = scene.probe()->X_WN * Vec<'N'>(0, 0, 1);
  const trial::StandingBall truth{sim::ball_of(setup.twin.ball, radius),
                                  dot(Vec<'W'>(setup.twin.ball.misplaced), out)};
  trial::BallFitOptions options;
  options.free[trial::kNearer] = nearer_free;
  const trial::BallFit fit = trial::fit_ball(trial::BallLoops({pushes_of(setup, seed)}), options);
  for (const trial::BallEstimate& e : fit.estimates) {
    const double injected = trial::value_of(trial::ball_numbers()[e.number], truth);
    found.inside.at(e.number) += e.interval.holds(injected) ? 1 : 0;
    found.widths.at(e.number).push_back(e.width());
  }
}
int inside(const Found& found) {  // of the numbers of the ball's law
  int sum = 0;
  for (std::size_t i = 0; i < trial::kNearer; ++i) sum += found.inside.at(i);
  return sum;
}

void expect_narrow(const Found& found) {
  for (std::size_t i = 0; i < trial::kNearer; ++i)
    EXPECT_LE(models::median(found.widths.at(i)), 0.2) << trial::ball_numbers()[i].name;
}

TEST(Identification, IntervalsHoldTheBallOfTheRig) {
  constexpr int kBalls = 6;
  Found found;
  for (std::uint64_t seed = 1; seed <= kBalls; ++seed) identify(seed, {}, true, found);
  EXPECT_GE(inside(found), 43) << "nine of ten of the 48 numbers";
  expect_narrow(found);
}

TEST(IdentificationLong, IntervalsHoldEachNumberOfAHundredBalls) {
  constexpr int kBalls = 100;
  Found found;
  for (std::uint64_t seed = 1; seed <= kBalls; ++seed) identify(seed, {}, true, found);
  for (std::size_t i = 0; i <= trial::kNearer; ++i)
    EXPECT_GE(found.inside.at(i), 90) << trial::ball_numbers()[i].name;
  expect_narrow(found);
}

// A ball that stands 0.1 mm nearer along the push is found with the rest. Taken to be in place, other numbers
// answer for it, and their intervals, which know of noise only, do not hold.
TEST(Identification, FindsWhereTheBallStands) {
  const std::string nearer = "truth.ball.misplaced_mm=[0,0,-0.1]";
  Found free, held;
  for (const std::uint64_t seed : {1, 2}) {
    identify(seed, {nearer}, true, free);
    identify(seed, {nearer}, false, held);
  }
  EXPECT_GE(inside(free), 15);
  EXPECT_LE(inside(held), 8);
}

}  // namespace
}  // namespace enc
