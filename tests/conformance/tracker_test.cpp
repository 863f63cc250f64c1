// Every PoseTracker; so far the simulated one. Rates and delays must come out as the rig's truth has them.
#include <gtest/gtest.h>

#include "sim/plants/tracker_plant.h"
#include "tests/conformance/bench_world.h"

namespace enc::test {
namespace {

struct Tally {
  int news = 0;
  double age = 0.0, longest_gap = 0.0;  // s
  bool backwards = false;
};

// Runs the clock and watches what comes. The core is left out: it costs time and the tracker does not care.
Tally watch(Twin& twin, double duration) {
  Tally tally;
  Stamped<TrackedTool> sample;
  Time before{};
  Time arrived{};
  for (int i = 0; i < static_cast<int>(duration * 1e3); ++i) {
    const Tick k = twin.rig.clock->next();
    if (!twin.rig.tracker->poll({}, sample)) continue;
    tally.backwards = tally.backwards || sample.t <= before || sample.t > k.t;
    if (tally.news > 0) tally.longest_gap = std::max(tally.longest_gap, seconds(k.t - arrived));
    before = sample.t;
    arrived = k.t;
    tally.age += seconds(k.t - sample.t);
    ++tally.news;
  }
  return tally;
}

TEST(SimulatedTracker, SaysNothingBeforeItsFirstSample) {
  Twin twin;
  Stamped<TrackedTool> sample;
  twin.rig.clock->next();
  EXPECT_FALSE(twin.rig.tracker->poll({}, sample));
  EXPECT_EQ(sample.health, Health::absent);
}

TEST(SimulatedTracker, NewsIsToldOnceAndOtherwiseTheSampleIsLeftAlone) {
  Twin twin;
  Stamped<TrackedTool> sample;
  while (!twin.rig.tracker->poll({}, sample)) twin.rig.clock->next();
  const Time first = sample.t;
  sample.value.tool = 77;
  EXPECT_FALSE(twin.rig.tracker->poll({}, sample));
  EXPECT_EQ(sample.value.tool, 77);
  EXPECT_EQ(sample.t, first);
}

// Server at 100 Hz polls exposures at 120 Hz: 100 packets a second. Age when one reaches the core, on
// average: 3.5 ms to the host, half an exposure period (4.17 ms) in the server's wait, 9.2 ms of its
// application, 0.5 ms of network, half a tick. (docs/notes/tracking.md)
TEST(SimulatedTracker, RateAndAgeAreThoseOfTheRig) {
  Twin twin;
  const Tally tally = watch(twin, 60.0);
  EXPECT_FALSE(tally.backwards);
  EXPECT_NEAR(tally.news / 60.0, 100.0, 2.0);
  const double expected = 3.5e-3 + 0.5 / 120.0 + 9.2e-3 + 0.5e-3 + 0.5e-3;
  EXPECT_NEAR(tally.age / tally.news, expected, 0.05 * expected);
}

// Sent when ready: every exposure comes, and none waits for the server.
TEST(SimulatedTracker, PacketsByEventComeAtTheExposuresRateWithoutTheServersWait) {
  Twin twin({"truth.tracker.packets=event", "truth.tracker.server_rate_hz=1"});
  const Tally tally = watch(twin, 60.0);
  const sim::TrackerTruth& truth = twin.setup.twin.tracker;
  EXPECT_FALSE(tally.backwards);
  EXPECT_GT(tally.news / 60.0,
            110.0);  // of 120: a packet that is overtaken, or comes with the next, is not news
  EXPECT_LE(tally.news / 60.0, 120.1);
  const double expected = truth.latency + truth.process + truth.udp_delay + 0.5e-3;
  EXPECT_NEAR(tally.age / tally.news, expected, 0.1 * expected);
}

TEST(SimulatedTracker, AStampErrorIsInTheStampsAndNowhereElse) {
  Twin right;
  Twin wrong({"truth.tracker.stamp_error_ms=3"});
  Stamped<TrackedTool> a;
  Stamped<TrackedTool> b;
  int news = 0;
  for (int i = 0; i < 1000; ++i) {
    right.rig.clock->next();
    wrong.rig.clock->next();
    const bool is_news = right.rig.tracker->poll({}, a);
    ASSERT_EQ(wrong.rig.tracker->poll({}, b), is_news);
    if (!is_news) continue;
    ++news;
    EXPECT_EQ(b.t - a.t, from_seconds(0.003));
    EXPECT_EQ(b.value.X_CT.xyz, a.value.X_CT.xyz);
  }
  EXPECT_GT(news, 90);
}

TEST(SimulatedTracker, BlackOutIsAsLongAsSaid) {
  Twin twin({"truth.tracker.blackout_at_s=1", "truth.tracker.blackout_for_s=0.2"});
  const Tally tally = watch(twin, 3.0);
  EXPECT_GT(tally.longest_gap, 0.18);
  EXPECT_LT(tally.longest_gap, 0.24);
}

TEST(SimulatedTracker, LosesItsShareOfPackets) {
  Twin twin({"truth.tracker.loss=0.3"});
  const Tally tally = watch(twin, 20.0);
  EXPECT_NEAR(tally.news / 20.0, 70.0, 4.0);  // 2,000 packets: 4 sigma is 4.1 a second
  EXPECT_NEAR(static_cast<double>(twin.world->tracker->state().dropped) / 2000.0, 0.3, 0.041);
}

TEST(SimulatedTracker, MeasuresTheToolWithBiasAndNoise) {
  Twin twin({"truth.hand.tremor_mm=0", "truth.hand.drift_mm=0"});
  Stamped<TrackedTool> sample;
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (int i = 0; i < 590; ++i) {  // before the tool sets out
    twin.rig.clock->next();
    if (!twin.rig.tracker->poll({}, sample)) continue;
    EXPECT_EQ(sample.value.tool, 0);
    const Pose<'W', 'T'> X_WT = twin.scene.X_WC * sample.value.X_CT;
    const Point<'W'> tip = X_WT * Point<'T'>(twin.setup.scene.tools[0].tip);
    sum += (tip - twin.world->truth().tool_tip).e();
    ++n;
  }
  ASSERT_GT(n, 40);
  const Vec3 bias = sum / n;
  const ToolSpec& tool = twin.setup.scene.tools[0];
  const sim::TrackerTruth truth = sim::with_tool_known(twin.setup.twin.tracker, tool.markers, tool.tip);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(bias(i), truth.bias(i), 4.0 * truth.noise(i) / std::sqrt(n)) << i;
}

TEST(SimulatedDisplay, ADentComesNoEarlierThanItsLatency) {
  Twin twin({"truth.display.latency_ms=25"});
  Stamped<DentSample> dent;
  twin.rig.clock->next();
  EXPECT_FALSE(twin.rig.display->poll({}, dent));
  EXPECT_EQ(dent.health, Health::absent);
  Time before{};
  int news = 0;
  for (int i = 0; i < 2000; ++i) {
    const Tick k = twin.rig.clock->next();
    View view;
    view.t = k.t;
    twin.rig.display->show(view);
    if (!twin.rig.display->poll({}, dent)) continue;
    EXPECT_GE(k.t - dent.t, from_seconds(0.025));
    EXPECT_LT(k.t - dent.t, from_seconds(0.027));  // and no later than the tick after
    EXPECT_GT(dent.t, before);
    before = dent.t;
    ++news;
  }
  EXPECT_NEAR(news, 120, 3);  // 60 Hz
}

}  // namespace
}  // namespace enc::test
