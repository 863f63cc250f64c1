// Vision as a tracker: when it tells, what it stamps, and what becomes of a camera that stalls.
#include "core/vision/vision_tracker.h"

#include <map>
#include <utility>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

using drawn::small;
using testing::Contains;
using testing::HasSubstr;

Time at_ms(std::int64_t ms) { return Time(Duration(1'000'000) * ms); }

struct Fed : StereoCamera {
  std::map<Time, StereoFrame> frames;  // there as soon as they are exposed
  bool up = true;
  ImageSize px;
  Time ahead = Time::max();  // the frame of then has a stamp of an hour later
  [[nodiscard]] ImageSize size() const override { return px; }
  [[nodiscard]] std::vector<std::string> remarks() const override { return {"drawn so"}; }
  bool poll(Time now, Stamped<StereoFrame>& newest) noexcept override {
    if (frames.empty() || frames.begin()->first > now) return false;
    newest = {frames.begin()->second, frames.begin()->first, Health::ok};
    if (newest.t == ahead) newest.t += std::chrono::hours(1);
    frames.erase(frames.begin());
    return true;
  }
  [[nodiscard]] bool linked() const noexcept override { return up; }
  [[nodiscard]] std::string describe() const override { return "drawn pairs"; }
};

struct Set {
  drawn::HandAt hand;
  drawn::Pair room = drawn::pair_of(small(), nullptr, 5), seen;
  Fed* camera = nullptr;
  std::unique_ptr<VisionTracker> tracker;
  Stamped<TrackedTool> newest;
  Set() {
    hand.tip = {0.06, 0.01, 0.45};
    seen = drawn::pair_of(small(), &hand);
    auto fed = std::make_unique<Fed>();
    camera = fed.get();
    camera->frames = {{at_ms(0), room.frame()}, {at_ms(50), room.frame()}};
    tracker = std::make_unique<VisionTracker>(std::move(fed), small(),
                                              FingerTracker(small(), drawn::segmentation(), {}, {}));
  }
  // True if something was told in that span; polled each millisecond.
  bool told(int from, int to) {
    bool any = false;
    for (int ms = from; ms <= to; ++ms) any = tracker->poll(at_ms(ms), newest) || any;
    return any;
  }
};

double square_sum(const TrackedTool& tool) {
  return tool.along * tool.along + 2.0 * tool.across * tool.across;
}

TEST(VisionTracker, TellsWhenTheLatencyIsOverWithTheStampOfTheExposure) {
  Set set;
  set.camera->frames[at_ms(100)] = set.seen.frame();
  EXPECT_TRUE(set.told(0, 120));  // no tool yet
  EXPECT_EQ(set.newest.value.tool, -1);
  EXPECT_TRUE(set.told(121, 149) == false || set.newest.t < at_ms(100));
  EXPECT_TRUE(set.told(150, 150));
  EXPECT_EQ(set.newest.t, at_ms(100));
  EXPECT_EQ(set.newest.health, Health::ok);
  EXPECT_EQ(set.newest.value.tool, VisionTracker::kFinger);
  EXPECT_TRUE(set.newest.value.X_CT.valid());
  EXPECT_LT((set.newest.value.X_CT.p() - set.hand.tip).norm(), 2e-3);
  // Depth comes of a small difference of two pictures, what is beside of one of them.
  EXPECT_GT(set.newest.value.along, 2.0 * set.newest.value.across);
  EXPECT_NEAR(square_sum(set.newest.value), set.tracker->finger().shown_covariance.trace(), 1e-12);
  EXPECT_EQ(set.tracker->finger().state, FingerState::seen);
  EXPECT_FALSE(set.told(151, 160));
}

// The core filters by itself: a finger that leaps is told where the frame shows it, not where the filter of
// the search has got to.
TEST(VisionTracker, TellsWhatTheFrameShowsAndNotWhatTheFilterMakesOfIt) {
  Set set;
  for (int ms = 100; ms <= 400; ms += 50) set.camera->frames[at_ms(ms)] = set.seen.frame();
  set.hand.tip.x() += 0.008;
  const drawn::Pair aside = drawn::pair_of(small(), &set.hand);
  set.camera->frames[at_ms(450)] = aside.frame();
  ASSERT_TRUE(set.told(0, 500));
  ASSERT_EQ(set.newest.t, at_ms(450));
  ASSERT_EQ(set.newest.value.tool, VisionTracker::kFinger);
  const Finger& finger = set.tracker->finger();
  EXPECT_EQ(set.newest.value.X_CT.p(), finger.shown.e());
  EXPECT_LT((finger.shown.e() - set.hand.tip).norm(), 2e-3);
  EXPECT_GT((finger.tip - finger.shown).norm(), 1e-5);
}

// In wall time the latency is what the work takes.
TEST(VisionTracker, TellsAtOnceWhereItIsAskedTo) {
  Set set;
  std::unique_ptr<Fed> fed = std::make_unique<Fed>();
  fed->frames = set.camera->frames;
  fed->frames[at_ms(100)] = set.seen.frame();
  VisionTracker tracker(std::move(fed), small(), FingerTracker(small(), drawn::segmentation(), {}, {}),
                        Release::when_done);
  for (int ms = 0; ms <= 100; ++ms) EXPECT_EQ(tracker.poll(at_ms(ms), set.newest), ms % 50 == 0) << ms;
  EXPECT_EQ(set.newest.t, at_ms(100));
  EXPECT_EQ(set.newest.value.tool, VisionTracker::kFinger);
}

TEST(VisionTracker, AFingerThatIsOnlyForeseenIsNoTool) {
  Set set;
  for (const int ms : {100, 150, 200}) set.camera->frames[at_ms(ms)] = set.seen.frame();
  set.camera->frames[at_ms(250)] = set.room.frame();
  ASSERT_TRUE(set.told(0, 250));
  EXPECT_EQ(set.newest.value.tool, 0);
  ASSERT_TRUE(set.told(251, 300));
  EXPECT_EQ(set.newest.t, at_ms(250));
  EXPECT_EQ(set.newest.value.tool, -1);
  EXPECT_EQ(set.tracker->finger().state, FingerState::predicted);
}

TEST(VisionTracker, AStallIsToldOnceAndEndsWithTheNextFrame) {
  Set set;
  set.camera->frames[at_ms(100)] = set.seen.frame();
  ASSERT_TRUE(set.told(0, 200));
  EXPECT_FALSE(set.told(201, 300));  // 100 + 50 + 3 * 50
  EXPECT_TRUE(set.told(301, 301));
  EXPECT_EQ(set.newest.health, Health::stale);
  EXPECT_EQ(set.newest.t, at_ms(100));
  EXPECT_FALSE(set.told(302, 900));
  set.camera->frames[at_ms(900)] = set.seen.frame();
  ASSERT_TRUE(set.told(901, 960));
  EXPECT_EQ(set.newest.health, Health::ok);
  EXPECT_EQ(set.newest.t, at_ms(900));
}

TEST(VisionTracker, FramesThatCannotBeUsedAreAStall) {
  Set set;
  set.camera->frames[at_ms(100)] = set.seen.frame();
  for (int ms = 150; ms < 600; ms += 50) set.camera->frames[at_ms(ms)] = {set.seen.left.view(), {}};
  ASSERT_TRUE(set.told(0, 200));
  ASSERT_TRUE(set.told(201, 500));
  EXPECT_EQ(set.newest.health, Health::stale);
}

// What is seen the wrong way round is nowhere: nothing is told of it, and it is said.
TEST(VisionTracker, LeftAndRightExchangedIsAStallThatIsSaid) {
  Set set;
  set.camera->frames[at_ms(100)] = set.seen.frame();
  for (int ms = 150; ms < 600; ms += 50)
    set.camera->frames[at_ms(ms)] = {set.seen.right.view(), set.seen.left.view()};
  ASSERT_TRUE(set.told(0, 200));
  ASSERT_EQ(set.newest.value.tool, 0);
  ASSERT_TRUE(set.told(201, 650));
  EXPECT_EQ(set.newest.health, Health::stale);
  EXPECT_EQ(set.newest.t, at_ms(100));
  EXPECT_THAT(set.tracker->remarks(),
              Contains(HasSubstr("9 frames were not used: left and right are exchanged")));
  set.camera->frames[at_ms(700)] = set.seen.frame();
  ASSERT_TRUE(set.told(651, 760));
  EXPECT_EQ(set.newest.health, Health::ok);
}

TEST(VisionTracker, OfExchangedFramesNoBackgroundIsLearned) {
  Set set;
  set.camera->frames.clear();
  for (int ms = 0; ms < 500; ms += 50)
    set.camera->frames[at_ms(ms)] = {set.room.right.view(), set.room.left.view()};
  (void)set.told(0, 700);
  EXPECT_EQ(set.newest.value.tool, -1);
  EXPECT_THAT(set.tracker->remarks(),
              testing::IsSupersetOf({HasSubstr("the background was not learned, of which 0"),
                                     HasSubstr("10 frames were not used: left and right")}));
}

TEST(VisionTracker, SaysWhatItIsAndWhetherItIsLinked) {
  Set set;
  EXPECT_EQ(set.tracker->describe(), "fingertip of drawn pairs");
  EXPECT_TRUE(set.tracker->linked());
  set.camera->up = false;
  EXPECT_FALSE(set.tracker->linked());
}

// What a person would not see otherwise stands in the report of the run.
TEST(VisionTracker, SaysAfterwardsWhatWentWrong) {
  Set good;
  good.camera->frames[at_ms(100)] = good.seen.frame();
  ASSERT_TRUE(good.told(0, 200));
  EXPECT_THAT(good.tracker->remarks(), testing::ElementsAre("drawn so"));

  Set early;
  early.camera->frames = {{at_ms(0), early.room.frame()}};
  (void)early.told(0, 200);
  EXPECT_THAT(early.tracker->remarks(), Contains(HasSubstr("not learned, of which 1 frames came")));

  Set finger;
  finger.camera->frames = {{at_ms(0), finger.seen.frame()}, {at_ms(50), finger.seen.frame()}};
  (void)finger.told(0, 200);
  EXPECT_THAT(finger.tracker->remarks(), Contains(HasSubstr("a finger stood in the frames")));

  Set blind;
  for (int ms = 100; ms < 1050; ms += 50) blind.camera->frames[at_ms(ms)] = blind.room.frame();
  (void)blind.told(0, 1200);
  EXPECT_THAT(blind.tracker->remarks(), testing::ElementsAre("drawn so")) << "a hand may still come";
  blind.camera->frames[at_ms(1250)] = blind.room.frame();
  (void)blind.told(1201, 1400);
  EXPECT_THAT(blind.tracker->remarks(), Contains(HasSubstr("none of 20 frames showed a finger")));

  Set other;
  const Image dot(1, 1);
  for (const int ms : {100, 150}) other.camera->frames[at_ms(ms)] = {dot.view(), dot.view()};
  (void)other.told(0, 400);
  EXPECT_THAT(other.tracker->remarks(), Contains(HasSubstr("2 frames were not used: another size")));
}

// One wrong stamp must not blind it for the frames that come after.
TEST(VisionTracker, AStampThatIsStillToComeIsNotBelieved) {
  Set set;
  set.camera->frames[at_ms(100)] = set.seen.frame();
  set.camera->ahead = at_ms(100);
  for (const int ms : {150, 200}) set.camera->frames[at_ms(ms)] = set.seen.frame();
  ASSERT_TRUE(set.told(0, 260));
  EXPECT_EQ(set.newest.t, at_ms(200));
  EXPECT_EQ(set.newest.value.tool, VisionTracker::kFinger);
  EXPECT_THAT(set.tracker->remarks(), Contains(HasSubstr("1 frames were not used: a stamp")));
}

TEST(VisionTracker, ImagesOfAnotherSizeThanTheRigsAreRefusedAtOnce) {
  auto fed = std::make_unique<Fed>();
  fed->px = {640, 480};
  try {
    const VisionTracker tracker(std::move(fed), small(),
                                FingerTracker(small(), drawn::segmentation(), {}, {}));
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(e.key(), "rig.camera.width_px");
    EXPECT_THAT(e.what(), HasSubstr("640 x 480 px and the rig file says 320 x 240 px"));
  }
}

TEST(VisionTracker, ImpossibleRatesAreRefused) {
  for (const auto& [rate, latency] : {std::pair{0.0, 0.05}, {20.0, -0.1}, {20.0, 5.0}, {kUnset, 0.05}}) {
    StereoRig rig = small();
    rig.rate = rate;
    rig.latency = latency;
    EXPECT_THROW(
        VisionTracker(std::make_unique<Fed>(), rig, FingerTracker(small(), drawn::segmentation(), {}, {})),
        Error);
  }
}

}  // namespace
}  // namespace enc
