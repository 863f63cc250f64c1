// Capture and pairing in virtual time: drifting cameras, lost frames, unplugging, refusals.
#include "hw_drivers/v4l2/drive/capture.h"

#include <gmock/gmock.h>
#include <malloc.h>

#include "core/base/error.h"
#include "tests/support/refusal.h"
#include "tests/unit/hw_drivers/v4l2/drive/virtual_video.h"

namespace enc::v4l2 {
namespace {

using testing::AllOf, testing::HasSubstr, testing::StartsWith;

constexpr ImageSize kEach{16, 8};
constexpr double kRate = 20.0, kFrame = 1.0 / kRate;

VirtualCamera grey(int width = kEach.width) {
  VirtualCamera camera;
  camera.spec.modes = {{Pixels::grey, width, kEach.height, kRate}};
  camera.phase = 1.0;
  return camera;
}
V4l2Settings two() {
  V4l2Settings settings;
  settings.left = "/dev/video0";
  settings.right = "/dev/video2";
  settings.format = "GREY";
  return settings;
}
V4l2Settings one() {
  V4l2Settings settings = two();
  settings.right.clear();
  return settings;
}

struct CaptureErrors {
  std::int64_t pairs = 0;
  double worst_pairing = 0.0, worst_stamp = 0.0, worst_age = 0.0;  // s, against ground truth
};
// Runs for so many seconds, and compares each pair with the ground truth.
CaptureErrors watch(VirtualVideo& video, Capture& capture, const VirtualCamera& left,
                    const VirtualCamera& right, double until) {
  CaptureErrors seen;
  StereoPicture picture;
  while (seconds(video.now()) < until) {
    if (!capture.turn(Duration(50'000'000), picture)) continue;
    ++seen.pairs;
    const double l = left.exposed(VirtualVideo::number_in(picture.left));
    const double r = right.exposed(VirtualVideo::number_in(picture.right));
    seen.worst_pairing = std::max(seen.worst_pairing, std::abs(r - l));
    seen.worst_stamp = std::max(seen.worst_stamp, std::abs(seconds(picture.exposed) - 0.5 * (l + r)));
    seen.worst_age = std::max(seen.worst_age, seconds(video.now()) - l);
  }
  return seen;
}

// One camera gains 45 ms on the other within ten minutes, so that the nearest partner changes once.
TEST(V4l2Capture, TwoDriftingCamerasArePairedForTenMinutes) {
  VirtualVideo video;
  VirtualCamera left = grey(), right = grey();
  left.ppm = 40.0;
  right.ppm = -35.0;
  right.phase += 0.010;
  left.jitter = right.jitter = 0.012;
  video.add("/dev/video0", left);
  video.add("/dev/video2", right);
  Capture capture(video, two(), kEach, kRate);
  CaptureErrors seen = watch(video, capture, left, right, 3.0);
  const std::size_t heap = mallinfo2().uordblks;
  const double length = 600.0;
  const std::int64_t before = capture.counts().pairs;
  seen = watch(video, capture, left, right, seconds(video.now()) + length);
  EXPECT_GE(capture.counts().pairs - before, static_cast<std::int64_t>(length * kRate) - 1);
  EXPECT_EQ(capture.counts().lost, 0);
  EXPECT_LE(capture.counts().unpaired, 1);
  EXPECT_EQ(capture.counts().replaced, 0);
  EXPECT_LE(seen.worst_pairing, 0.5 * kFrame * (1.0 + 40e-6));  // half a frame of the slower camera
  EXPECT_GT(seen.worst_pairing, 0.45 * kFrame);                 // they did drift that far
  EXPECT_NEAR(capture.counts().errors.largest, seen.worst_pairing, 2e-6);
  EXPECT_LE(seen.worst_stamp, 1e-6);  // the kernel's stamps are whole microseconds
  EXPECT_LE(seen.worst_age, 0.030 + 2 * 0.012 + 0.5 * kFrame);
  EXPECT_LE(mallinfo2().uordblks, heap + (64U << 10U));
}

TEST(V4l2Capture, JitterOfTheStampsCostsNoPair) {
  VirtualVideo video;
  VirtualCamera left = grey(), right = grey();
  right.phase += 0.5 * kFrame;  // the worst place
  left.stamp_error = right.stamp_error = 0.1e-3;
  left.ppm = 1.0;
  video.add("/dev/video0", left);
  video.add("/dev/video2", right);
  Capture capture(video, two(), kEach, kRate);
  const CaptureErrors seen = watch(video, capture, left, right, 101.0);
  EXPECT_GE(seen.pairs, 1998);
  EXPECT_EQ(capture.counts().unpaired, 0);
  EXPECT_LE(seen.worst_pairing, 0.5 * kFrame + 0.3e-3);
  EXPECT_LE(seen.worst_stamp, 1e-3);
}

TEST(V4l2Capture, CountsLostAndDamagedFrames) {
  VirtualVideo video;
  VirtualCamera left = grey(), right = grey();
  left.lost = {20, 21, 22};
  right.lost = {40};
  left.damaged = {60};
  video.add("/dev/video0", left);
  video.add("/dev/video2", right);
  Capture capture(video, two(), kEach, kRate);
  const CaptureErrors seen = watch(video, capture, left, right, 6.02);
  EXPECT_EQ(capture.counts().lost, 4);
  EXPECT_EQ(capture.counts().damaged, 1);
  EXPECT_EQ(capture.counts().unpaired, 1);  // whose partner was lost
  EXPECT_EQ(seen.pairs, 100 - 5);
  EXPECT_LT(seen.worst_pairing, 1e-6);
}

TEST(V4l2Capture, OfOneDeviceTheNewestFrameWins) {
  VirtualVideo video;
  VirtualCamera both = grey(2 * kEach.width);
  video.add("/dev/video0", both);
  Capture capture(video, one(), kEach, kRate);
  StereoPicture picture;
  video.sleep(1.0);  // the buffers fill up, and the kernel drops the rest
  ASSERT_TRUE(capture.turn(Duration(50'000'000), picture));
  EXPECT_EQ(capture.counts().replaced, 3);  // of four buffers
  EXPECT_EQ(VirtualVideo::number_in(picture.left), 3);
  ASSERT_TRUE(capture.turn(Duration(100'000'000), picture));
  EXPECT_GT(VirtualVideo::number_in(picture.left), 15);
  EXPECT_GT(capture.counts().lost, 10);
  EXPECT_EQ(picture.left.width, kEach.width);
  EXPECT_EQ(picture.right.width, kEach.width);
}

TEST(V4l2Capture, ACameraThatIsPluggedInAgainIsOpenedWithFreshStamps) {
  VirtualVideo video;
  VirtualCamera left = grey(), right = grey();
  right.unplugged_from = 4.0;
  right.unplugged_to = 7.0;
  video.add("/dev/video0", left);
  video.add("/dev/video2", right);
  Capture capture(video, two(), kEach, kRate);
  StereoPicture picture;
  while (capture.there()) static_cast<void>(capture.turn(Duration(50'000'000), picture));
  EXPECT_NEAR(seconds(video.now()), 4.0, 0.1);
  const Duration last = picture.exposed;
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { capture.reopen(); }),
              AllOf(StartsWith("/dev/video2: is not there"), HasSubstr("plug it in")));
  for (int i = 0; i < 100 && !capture.there(); ++i) {
    video.sleep(0.25);
    test::refusal(ErrorKind::device, [&] { capture.reopen(); });
  }
  EXPECT_NEAR(seconds(video.now()), 7.0, 0.3);
  const double back = seconds(video.now());
  const CaptureErrors seen = watch(video, capture, left, right, back + 5.02);
  EXPECT_GE(seen.pairs, 98);
  EXPECT_LE(seen.worst_stamp, 1e-6);
  EXPECT_GT(capture.counts().errors.pairs, 150);
  EXPECT_EQ(capture.counts().gone, 1);
  EXPECT_EQ(capture.counts().lost, 0);  // the sequence begins again
  EXPECT_LT(seconds(last), 4.0);
}

TEST(V4l2Capture, StampsAreMovedToTheMiddleOfTheExposure) {
  VirtualVideo video;
  video.add("/dev/video0", grey(2 * kEach.width));
  V4l2Settings settings = one();
  settings.stamp_late = -0.008;  // the kernel stamps the beginning of 16 ms
  Capture capture(video, settings, kEach, kRate);
  StereoPicture picture;
  ASSERT_TRUE(capture.turn(Duration(1'000'000'000), picture));
  EXPECT_NEAR(seconds(picture.exposed), 1.008, 1e-6);
}

// Its driver in the kernel promises stamps and leaves them 0: such pairs would all be older than the run.
TEST(V4l2Capture, FramesWithoutAStampHaveTheTimeOfTheirReading) {
  VirtualVideo video;
  VirtualCamera camera = grey(2 * kEach.width);
  camera.sets_stamps = false;
  video.add("/dev/video0", camera);
  Capture capture(video, one(), kEach, kRate);
  StereoPicture picture;
  ASSERT_TRUE(capture.turn(Duration(1'000'000'000), picture));
  EXPECT_EQ(picture.exposed, video.now());
  EXPECT_THAT(capture.describe(), HasSubstr("stamped when read"));
}

// ---- refusals: one line with the way out

class V4l2Refusal : public testing::Test {
 protected:
  std::string refusal(const V4l2Settings& settings) {
    return test::refusal(ErrorKind::device, [&] { Capture(video_, settings, kEach, kRate); });
  }
  VirtualVideo video_;
};

TEST_F(V4l2Refusal, NamesTheDeviceAndTheRemedy) {
  EXPECT_THAT(refusal(one()), AllOf(StartsWith("/dev/video0: is not there"), HasSubstr("plug it in")));
  video_.refuse("/dev/video0", EACCES);
  EXPECT_THAT(refusal(one()), AllOf(HasSubstr("group 'video'"), HasSubstr("usermod -aG video USER")));
  video_.refuse("/dev/video0", ENOTTY);
  EXPECT_THAT(refusal(one()), HasSubstr("is no device"));
  video_.refuse("/dev/video0", EBUSY);
  EXPECT_THAT(refusal(one()), AllOf(HasSubstr("another program uses it"), HasSubstr("fuser")));
  video_.refuse("/dev/video0", EIO);
  EXPECT_THAT(refusal(one()), HasSubstr("Input/output error"));
  V4l2Settings same = two();
  same.right = same.left;
  EXPECT_THAT(refusal(same), HasSubstr("is named as left and right"));
}

TEST_F(V4l2Refusal, ABusyDevice) {
  video_.add("/dev/video0", grey(2 * kEach.width));
  Capture first(video_, one(), kEach, kRate);
  EXPECT_THAT(refusal(one()), HasSubstr("another program uses it"));
  StereoPicture picture;
  EXPECT_TRUE(first.turn(Duration(1'000'000'000), picture));  // the first one is not disturbed
}

TEST_F(V4l2Refusal, AnotherFormatOrRateListsWhatIsOffered) {
  VirtualCamera camera = grey();
  camera.spec.modes = {
      {Pixels::mjpeg, 1280, 480, 30.0}, {Pixels::yuyv, 32, 8, 30.0}, {Pixels::yuyv, 32, 8, 15.0}};
  video_.add("/dev/video0", camera);
  V4l2Settings settings = one();
  EXPECT_THAT(refusal(settings),
              AllOf(HasSubstr("expected GREY 32 x 8 px"),
                    HasSubstr("it offers MJPG 1280 x 480 at 30 Hz; YUYV 32 x 8 at 15, 30 Hz")));
  settings.format = "YUYV";
  EXPECT_THAT(refusal(settings),
              AllOf(HasSubstr("gives 15 frames a second; expected 20"), HasSubstr("rate_hz")));
}

TEST_F(V4l2Refusal, ADeviceOfMetadata) {
  VirtualCamera camera = grey(2 * kEach.width);
  camera.spec.captures = false;
  video_.add("/dev/video0", camera);
  EXPECT_THAT(refusal(one()), HasSubstr("sends no images there"));
}

// A regular file and the kernel's own calls.
TEST_F(V4l2Refusal, AFileThatIsNoDevice) {
  const std::unique_ptr<System> real = kernel();
  V4l2Settings settings = one();
  for (const char* path : {"/etc/passwd", "/dev/null"}) {
    settings.left = path;
    EXPECT_THAT(test::refusal(ErrorKind::device, [&] { Capture(*real, settings, kEach, kRate); }),
                testing::ContainsRegex("is no (video )?device; expected"))
        << path;
  }
  EXPECT_FALSE(group_of("/dev/null").empty());
}

}  // namespace
}  // namespace enc::v4l2
