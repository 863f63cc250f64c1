// The trackers on drawn pairs: place, velocity, window, occlusion, unusable frames, stamps and stalls.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/vision/finger_tracker.h"
#include "core/vision/vision_tracker.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

using drawn::small;
using testing::Contains, testing::HasSubstr;

StereoRig crooked() {
  StereoRig rig = small();
  rig.left.distortion = {-0.2, 0.08, 0.0005, -0.0003, 0.01};
  rig.right = {362, 363, 161, 118, {-0.18, 0.07, 0, 0, 0}};
  rig.X_CD = {Quat(Eigen::AngleAxisd(0.03, Vec3(0.2, -0.9, 0.3).normalized())), Vec3(0.09, 0.001, -0.002)};
  return rig;
}
using drawn::at_frame;

const drawn::Pair& empty_room() {
  static const drawn::Pair kEmpty = drawn::pair_of(small(), nullptr, 90);
  return kEmpty;
}
FingerTracker ready(const StereoRig& rig, const drawn::Pair& room, const TrackSpec& track = {}) {
  FingerTracker tracker(rig, drawn::segmentation(), {}, track);
  EXPECT_EQ(tracker.see(room.frame(), at_frame(-3)).state, FingerState::learning);
  (void)tracker.see(room.frame(), at_frame(-2));
  return tracker;
}
FingerTracker ready() { return ready(small(), empty_room()); }
drawn::HandAt hand_at(double x, double y, double z, const Vec3& along = {0.3, -1, 0.1}) {
  drawn::HandAt hand{.tip = {x, y, z}, .along = along};
  return hand;
}

TEST(FingerTracker, SeesATipWhereItIs) {
  FingerTracker tracker = ready();
  EXPECT_EQ(tracker.see(empty_room().frame(), at_frame(0)).state, FingerState::away);
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45);
  const Finger finger = tracker.see(drawn::pair_of(small(), &hand).frame(), at_frame(1));
  ASSERT_EQ(finger.state, FingerState::seen);
  EXPECT_EQ(finger.exposed, at_frame(1));
  EXPECT_LT((finger.tip.e() - hand.tip).norm(), 2e-3);
  const Triplet truth = seen_at(tracker.pair(), Point<'C'>(hand.tip));
  // A finger of 13 px in a mask of tiles of 5 px.
  EXPECT_LT(std::hypot(finger.column - truth.column, finger.row - truth.row), 2.0);
  EXPECT_NEAR(finger.disparity, truth.disparity, 0.5);
  EXPECT_GT(finger.score, 0.9);
  const Vec3 off = finger.tip.e() - hand.tip;
  EXPECT_LT(off.dot(finger.covariance.inverse() * off), 16.0);
  EXPECT_FALSE(tracker.finger_in_background());
}

TEST(FingerTracker, CamerasMayBeCrookedAndLensesBend) {
  const drawn::Pair room = drawn::pair_of(crooked(), nullptr, 90);
  FingerTracker tracker = ready(crooked(), room);
  const drawn::HandAt hand = hand_at(0.05, -0.02, 0.45);
  const Finger finger = tracker.see(drawn::pair_of(crooked(), &hand).frame(), at_frame(1));
  ASSERT_EQ(finger.state, FingerState::seen);
  EXPECT_LT((finger.tip.e() - hand.tip).norm(), 2e-3);
}

// 300 mm/s across: predicted places are nearer than held ones, and the small window gives the result of the
// whole frame.
TEST(FingerTracker, FollowsAMovingFingerInAWindow) {
  FingerTracker tracker = ready(), whole = ready();
  double held = 0.0, ahead = 0.0, speed = 0.0;
  std::optional<Finger> last;
  for (int i = 1; i <= 12; ++i) {
    const drawn::HandAt hand = hand_at(-0.02 + 0.015 * i, 0.01, 0.45);
    const drawn::Pair pair = drawn::pair_of(small(), &hand, static_cast<std::uint64_t>(i));
    const Finger finger = tracker.see(pair.frame(), at_frame(i));
    ASSERT_EQ(finger.state, FingerState::seen) << i;
    if (i > 4) {
      EXPECT_FALSE(tracker.stats().whole_frame);
      EXPECT_LT(tracker.stats().pixels, 320 * 240 / 2);
      whole.forget();
      (void)whole.see(pair.frame(), at_frame(i));
      EXPECT_TRUE(whole.stats().whole_frame);
      EXPECT_EQ(whole.stats().found.e(), tracker.stats().found.e());
      EXPECT_EQ(whole.stats().variance, tracker.stats().variance);
      held += (hand.tip - last->tip.e()).squaredNorm();
      ahead += (hand.tip - last->tip.e() - 0.05 * last->velocity.e()).squaredNorm();
      speed += (finger.velocity.e() - Vec3(0.3, 0, 0)).squaredNorm();
    }
    last = finger;
  }
  std::printf("300 mm/s at 20 Hz: held %.2f mm, foreseen %.2f mm rms, velocity %.1f mm/s rms\n",
              1e3 * std::sqrt(held / 8), 1e3 * std::sqrt(ahead / 8), 1e3 * std::sqrt(speed / 8));
  EXPECT_LT(ahead, 0.16 * held);  // 60 % less
  // Two finds 50 ms apart, each 1 px and 0.4 px of disparity off: 89 mm/s.
  EXPECT_LT(std::sqrt(speed / 8), 0.089);
}

TEST(FingerTracker, TellsAHiddenFingerForAWhileAndFindsItAgain) {
  FingerTracker tracker = ready();
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45), later = hand_at(0.0, 0.03, 0.5);
  const drawn::Pair pair = drawn::pair_of(small(), &hand), elsewhere = drawn::pair_of(small(), &later);
  for (int i = 1; i <= 3; ++i) ASSERT_EQ(tracker.see(pair.frame(), at_frame(i)).state, FingerState::seen);
  const double certain = tracker.see(pair.frame(), at_frame(4)).covariance.trace();
  std::int64_t pixels = 0;
  for (int i = 5; i <= 7; ++i) {
    const Finger finger = tracker.see(empty_room().frame(), at_frame(i));
    EXPECT_EQ(finger.state, FingerState::predicted) << i;
    EXPECT_GT(finger.covariance.trace(), certain);
    EXPECT_TRUE(std::isnan(finger.score));
    EXPECT_GE(tracker.stats().pixels, pixels);  // the window grows
    pixels = tracker.stats().pixels;
  }
  for (int i = 8; i <= 12; ++i) (void)tracker.see(empty_room().frame(), at_frame(i));
  EXPECT_TRUE(tracker.stats().whole_frame);
  const Finger gone = tracker.see(empty_room().frame(), at_frame(13));
  EXPECT_EQ(gone.state, FingerState::away);
  EXPECT_FALSE(gone.tip.finite());
  const Finger back = tracker.see(elsewhere.frame(), at_frame(14));  // the first frame that shows it
  EXPECT_EQ(back.state, FingerState::seen);
  EXPECT_LT((back.tip.e() - later.tip).norm(), 3e-3);
}

TEST(FingerTracker, ALeapIsNotBelievedAtOnce) {
  FingerTracker tracker = ready();
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45), leap = hand_at(0.075, 0.01, 0.36);
  const drawn::Pair pair = drawn::pair_of(small(), &hand), other = drawn::pair_of(small(), &leap);
  for (int i = 1; i <= 8; ++i) (void)tracker.see(pair.frame(), at_frame(i));
  const Finger told = tracker.see(other.frame(), at_frame(9));
  EXPECT_EQ(told.state, FingerState::predicted);
  EXPECT_LT((told.tip.e() - hand.tip).norm(), 5e-3);
}

TEST(FingerTracker, FramesThatCannotBeUsedChangeNothing) {
  FingerTracker tracker = ready();
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45);
  const drawn::Pair pair = drawn::pair_of(small(), &hand);
  ASSERT_EQ(tracker.see(pair.frame(), at_frame(5)).state, FingerState::seen);
  const auto refused = [&](const StereoFrame& frame, Time t, FrameRefusal why) {
    const Finger finger = tracker.see(frame, t);
    EXPECT_EQ(tracker.stats().refused, why);
    EXPECT_FALSE(finger.tip.finite());
    EXPECT_NE(finger.state, FingerState::seen);
  };
  StereoFrame frame = pair.frame();
  refused(frame, at_frame(5), FrameRefusal::stamp);
  refused(frame, at_frame(4), FrameRefusal::stamp);
  refused(frame, Time(Duration::min()), FrameRefusal::stamp);
  frame.right = {};
  refused(frame, at_frame(6), FrameRefusal::missing);
  refused({}, at_frame(6), FrameRefusal::missing);
  frame = pair.frame();
  frame.left.width = 319;
  refused(frame, at_frame(6), FrameRefusal::size);
  const Image dot(1, 1);
  refused({dot.view(), dot.view()}, at_frame(6), FrameRefusal::size);
  EXPECT_EQ(tracker.see(pair.frame(), at_frame(6)).state, FingerState::seen);
}

TEST(FingerTracker, BlackSaturatedAndFlatFramesHaveNoFinger) {
  for (const int level : {0, 128, 255}) {
    FingerTracker tracker = ready();
    Image flat(320, 240);
    std::fill(flat.rgb.begin(), flat.rgb.end(), static_cast<std::uint8_t>(level));
    EXPECT_EQ(tracker.see({flat.view(), flat.view()}, at_frame(1)).state, FingerState::away) << level;
    for (std::size_t i = 0; i < flat.rgb.size(); i += 3)
      flat.rgb[i] = 200, flat.rgb[i + 1] = 150, flat.rgb[i + 2] = 118;
    EXPECT_EQ(tracker.see({flat.view(), flat.view()}, at_frame(2)).state,
              FingerState::away);  // all of it skin
  }
}

// One image for both eyes: no disparity, so no part of it has a depth.
TEST(FingerTracker, ZeroDisparityIsNoFinger) {
  FingerTracker tracker = ready();
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45);
  const drawn::Pair pair = drawn::pair_of(small(), &hand);
  EXPECT_EQ(tracker.see({pair.left.view(), pair.left.view()}, at_frame(1)).state, FingerState::away);
  EXPECT_FALSE(tracker.stats().tip.found && tracker.stats().found.e().allFinite());
}

TEST(FingerTracker, WarnsOfAFingerInTheBackground) {
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45);
  EXPECT_TRUE(ready(small(), drawn::pair_of(small(), &hand)).finger_in_background());
  EXPECT_FALSE(ready().finger_in_background());
}

TEST(FingerTracker, StampsFarApartAreNoHarm) {
  FingerTracker tracker = ready();
  const drawn::HandAt hand = hand_at(0.06, 0.01, 0.45);
  const drawn::Pair pair = drawn::pair_of(small(), &hand);
  (void)tracker.see(pair.frame(), at_frame(1));
  (void)tracker.see(pair.frame(), Time(Duration::max() / 2));
  const Finger finger = tracker.see(empty_room().frame(), Time(Duration::max()));
  EXPECT_NE(finger.state, FingerState::seen);
}

// The finger leaves past a corner, so its search window lies beside the image. It is away, and vision finds
// it wherever it returns.
TEST(FingerTracker, AFingerThatLeavesPastACornerComesBackAnywhere) {
  for (const double side : {-1.0, 1.0}) {
    TrackSpec track{.window_growth = 1.0};
    FingerTracker tracker = ready(small(), empty_room(), track);
    int frame = 1;
    for (; frame <= 4; ++frame) {
      const drawn::HandAt hand = hand_at(0.06 + side * 0.03 * frame, -0.03 * frame, 0.45);
      const Finger finger = tracker.see(
          drawn::pair_of(small(), &hand, static_cast<std::uint64_t>(frame)).frame(), at_frame(frame));
      if (frame <= 2) {
        EXPECT_EQ(finger.state, FingerState::seen) << side << " " << frame;
      }
    }
    for (; frame <= 24; ++frame) (void)tracker.see(empty_room().frame(), at_frame(frame));
    const drawn::HandAt back = hand_at(0.05, 0.02, 0.45);
    const Finger finger = tracker.see(drawn::pair_of(small(), &back, 30).frame(), at_frame(frame));
    EXPECT_EQ(finger.state, FingerState::seen) << side;
    EXPECT_LT((finger.tip.e() - back.tip).norm(), 6e-3) << side;
  }
}

TEST(FingerTracker, ImpossibleSpecsAreRefused) {
  const auto refused = [](const auto& spoil) {
    TrackSpec track;
    spoil(track);
    EXPECT_THROW(FingerTracker(small(), drawn::segmentation(), {}, track), Error);
  };
  refused([](TrackSpec& track) { track.pixel_noise = 0.0; });
  refused([](TrackSpec& track) { track.gate = kUnset; });
  refused([](TrackSpec& track) { track.window_least = 0.0; });
  refused([](TrackSpec& track) { track.window_growth = 0.5; });
  refused([](TrackSpec& track) { track.full_frame_after = -1; });
  EXPECT_THROW(FingerTracker(small(), drawn::segmentation(), {}, {}, {}, {700, 0, 900, 100}), Error);
}

// Vision as a tracker: the times of its results, their stamps, and the effect of a stalled camera.

Time at_ms(std::int64_t ms) { return Time(Duration(1'000'000) * ms); }

struct ScriptedCamera : StereoCamera {
  std::map<Time, StereoFrame> frames;  // there as soon as they are exposed
  bool up = true;
  ImageSize px;
  Time ahead = Time::max();  // the frame of this time has a stamp an hour later
  [[nodiscard]] ImageSize size() const override { return px; }
  [[nodiscard]] std::vector<std::string> remarks() const override { return {"drawn so"}; }
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
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
  ScriptedCamera* camera = nullptr;
  std::unique_ptr<VisionTracker> tracker;
  Measurement<TrackedTool> newest;
  Set() {
    hand.tip = {0.06, 0.01, 0.45};
    seen = drawn::pair_of(small(), &hand);
    auto fed = std::make_unique<ScriptedCamera>();
    camera = fed.get();
    camera->frames = {{at_ms(0), room.frame()}, {at_ms(50), room.frame()}};
    tracker = std::make_unique<VisionTracker>(std::move(fed), small(),
                                              FingerTracker(small(), drawn::segmentation(), {}, {}));
  }
  // Return true if there was a result in that span; polled each millisecond.
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
  // Depth comes from a small difference of two pictures, the sideways place from one picture.
  EXPECT_GT(set.newest.value.along, 2.0 * set.newest.value.across);
  EXPECT_NEAR(square_sum(set.newest.value), set.tracker->finger().shown_covariance.trace(), 1e-12);
  EXPECT_EQ(set.tracker->finger().state, FingerState::seen);
  EXPECT_FALSE(set.told(151, 160));
}

// The core filters by itself: vision reports a finger that leaps where the frame shows it, not at the
// filter's place of the search.
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

// The latency in wall time is the duration of the work.
TEST(VisionTracker, TellsAtOnceWhereItIsAskedTo) {
  Set set;
  std::unique_ptr<ScriptedCamera> fed = std::make_unique<ScriptedCamera>();
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

// Exchanged images show no finger: the tracker reports no result and names the reason.
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

// The report of the run lists faults that a person would not notice otherwise.
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

// One wrong stamp must not blind it for later frames.
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
  auto fed = std::make_unique<ScriptedCamera>();
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
    EXPECT_THROW(VisionTracker(std::make_unique<ScriptedCamera>(), rig,
                               FingerTracker(small(), drawn::segmentation(), {}, {})),
                 Error);
  }
}

}  // namespace
}  // namespace enc
