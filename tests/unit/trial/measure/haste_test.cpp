// An arm that hastens to where a reach will touch is where it is told when they meet.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "trial/measure/finger_measure.h"
#include "trial/trial.h"

namespace enc {
namespace {

// m, sorted: between the tip and its target along the surface, at each touch of random reaches.
std::vector<double> apart_when_they_meet(const char* scene) {
  models::Setup setup = models::load(fmt::format("{}/models/scenes/{}.toml", tests::source_dir(), scene), "",
                                     {"truth.hand.aborted=0"});
  setup.scene.user->kind = UserKind::reaches;
  if (!setup.scene.user->reaches) setup.scene.user->reaches.emplace();
  setup.scene.user->reaches->count = 12;
  std::vector<double> apart;
  bool met = true;
  sim::Phase phase = sim::Phase::wait;
  trial::TrialOptions options;
  options.watch = [&](const trial::Glance& glance) {
    if (glance.truth.phase == sim::Phase::approach && phase != glance.truth.phase) met = false;
    phase = glance.truth.phase;
    if (met || glance.truth.aim < 0) return;
    const Object& aimed = glance.scene.objects[static_cast<std::size_t>(glance.truth.aim)];
    const trial::Wanted at = trial::wanted_at(aimed, glance.truth.tool_tip);
    if (at.distance > glance.truth.tool_radius) return;
    met = true;
    const Vec3 way = (recall<Meeting>(*glance.state).aim.target - glance.truth.tip).e();
    apart.push_back((way - at.normal.e() * at.normal.e().dot(way)).norm());
  };
  trial::Trial(std::move(setup), options).run();
  std::sort(apart.begin(), apart.end());
  return apart;
}

// Without its acceleration told to the law the tip lags: 0.5 mm in the middle, 1.6 mm in one of ten.
TEST(Haste, TheTipIsWhereItsTargetIsWhenTheFingerTouches) {
  const std::vector<double> apart = apart_when_they_meet("wall");
  ASSERT_GE(apart.size(), 10U);
  EXPECT_LT(apart[apart.size() / 2], 0.3e-3);
  EXPECT_LT(apart[apart.size() * 9 / 10], 0.6e-3);
}

// Two keys, one 20 mm above the other: from the plane of each the finger comes to the other one.
TEST(Haste, TheChosenKeyDoesNotFlickerBetweenPictures) {
  for (const std::uint64_t seed : {1U, 5U, 29U}) {
    models::Setup setup =
        models::load(fmt::format("{}/models/scenes/keypad.toml", tests::source_dir()), "",
                     {"object.key_1.position_mm=[-20,20,20]", "object.key_2.position_mm=[-20,-20,0]",
                      "user.object=key_2", "user.approach_mm_s=[100]", "user.approach_tilt_deg=40"});
    setup.scene.objects.resize(2);
    int changes = 0;
    std::int32_t chosen = -1;
    double since = 0.0;
    trial::TrialOptions options;
    options.seed = seed;
    options.watch = [&](const trial::Glance& glance) {
      if (glance.out.object == chosen) return;
      const double now = seconds(glance.truth.t.time_since_epoch());
      changes += now - since < 0.02 ? 1 : 0;  // sooner than the next picture
      chosen = glance.out.object;
      since = now;
    };
    trial::Trial(std::move(setup), options).run();
    EXPECT_LE(changes, 2) << seed;
  }
}

}  // namespace
}  // namespace enc
