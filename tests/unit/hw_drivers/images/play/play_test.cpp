// A camera that plays files: the frame that comes at each time, and the message at the end.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "hw_drivers/images/play/frame_source.h"
#include "hw_drivers/images/play/image_camera.h"
#include "sim/picture/picture.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace enc::images {
namespace {

using testing::AllOf, testing::HasSubstr, testing::IsEmpty, testing::StartsWith;

struct Notes : Log {
  std::mutex mutex;
  std::vector<std::string> lines;
  void say(const std::string& line) override {
    const std::lock_guard lock(mutex);
    lines.push_back(line);
  }
  std::string all() {
    const std::lock_guard lock(mutex);
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }
};
bool eventually(const std::function<bool()>& is) {
  for (int i = 0; i < 2000 && !is(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return is();
}

Time at(double s) { return Time(from_seconds(s)); }

class ImageCameraTest : public testing::Test {
 protected:
  ImageCameraTest() {
    for (int i = 0; i < 10; ++i) put(i);
    reel_.path = folder_.path().string();
    reel_.rate = 20.0;
  }
  // Frame i has the grey value 10 i on the left and 10 i + 1 on the right.
  void put(int i) const {
    for (const char* side : {"left", "right"}) {
      Image image(8, 4);
      image.rgb.assign(image.rgb.size(), static_cast<std::uint8_t>(10 * i + (*side == 'r' ? 1 : 0)));
      std::ofstream(folder_.file(side + std::to_string(i) + ".png"), std::ios::binary) << sim::png(image);
    }
  }
  [[nodiscard]] std::string refusal() {
    return test::refusal(ErrorKind::device, [&] { const ImageCamera camera(reel_, notes_, true); });
  }
  test::TemporaryFolder folder_;
  Reel reel_;
  Notes notes_;
};

struct FrameSample {
  double t = 0.0, exposed = 0.0;
  int left = -1, right = -1;
  Health health = Health::absent;
  bool operator==(const FrameSample&) const = default;
};
std::vector<FrameSample> seen(ImageCamera& camera, double from, double to, double step) {
  std::vector<FrameSample> all;
  Measurement<StereoFrame> newest;
  const int steps = static_cast<int>(std::lround((to - from) / step));
  for (int i = 0; i < steps; ++i) {
    const double t = from + i * step;
    if (camera.poll(at(t), newest))
      all.push_back({t, seconds(newest.t.time_since_epoch()), newest.value.left.rgb[0],
                     newest.value.right.rgb[0], newest.health});
  }
  return all;
}

TEST_F(ImageCameraTest, FrameNIsOfNOverTheRateAfterTheFirstPoll) {
  ImageCamera camera(reel_, notes_, true);
  EXPECT_EQ(camera.describe(), "images " + reel_.path + ", 10 pairs: 8 x 4 px each at 20 Hz");
  const std::vector<FrameSample> all = seen(camera, 3.0, 3.4, 0.7e-3);
  ASSERT_EQ(all.size(), 8U);
  for (std::size_t n = 0; n < all.size(); ++n) {
    EXPECT_NEAR(all[n].exposed, 3.0 + static_cast<double>(n) / 20.0, 1e-9);
    EXPECT_LT(all[n].t - all[n].exposed, 0.8e-3);
    EXPECT_EQ(all[n].left, 10 * static_cast<int>(n));
    EXPECT_EQ(all[n].right, all[n].left + 1);
    EXPECT_EQ(all[n].health, Health::ok);
  }
}

// Polled less often than frames come: the camera gives the newest and skips the frames in between.
TEST_F(ImageCameraTest, TheNewestThatIsDue) {
  ImageCamera camera(reel_, notes_, true);
  const std::vector<FrameSample> all = seen(camera, 0.0, 0.6, 0.2);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].left, 40);
  EXPECT_EQ(all[2].left, 80);
  EXPECT_NEAR(all[2].exposed, 0.4, 1e-9);
}

TEST_F(ImageCameraTest, EveryRunSeesTheSame) {
  reel_.repeat = true;
  reel_.rate = 60.0;
  ImageCamera first(reel_, notes_, true), second(reel_, notes_, true);
  const std::vector<FrameSample> all = seen(first, 0.0, 3.0, 1e-3);
  EXPECT_EQ(all.size(), 180U);
  EXPECT_EQ(all, seen(second, 0.0, 3.0, 1e-3));
  EXPECT_EQ(all[13].left, 30);
  EXPECT_THAT(notes_.all(), IsEmpty());  // none came late
}

TEST_F(ImageCameraTest, TheEndIsToldOnceAndIsALostLink) {
  reel_.start = 7;
  ImageCamera camera(reel_, notes_, true);
  EXPECT_TRUE(camera.linked());
  const std::vector<FrameSample> all = seen(camera, 0.0, 2.0, 1e-3);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].left, 70);
  EXPECT_EQ(all[3].health, Health::stale);
  EXPECT_EQ(all[3].left, 90);  // the last one once more, with its own time
  EXPECT_EQ(all[3].exposed, all[2].exposed);
  EXPECT_FALSE(camera.linked());
  EXPECT_TRUE(eventually([&] { return notes_.all().find("ended after 3 frames") != std::string::npos; }));
}

// Polled so seldom that the last frame and the end come at once: the frame counts.
TEST_F(ImageCameraTest, TheLastFrameIsGoodThoughTheEndIsKnown) {
  ImageCamera camera(reel_, notes_, true);
  const std::vector<FrameSample> all = seen(camera, 0.0, 3.0, 0.6);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].left, 90);
  EXPECT_EQ(all[1].health, Health::ok);
  EXPECT_EQ(all[2].health, Health::stale);
}

TEST_F(ImageCameraTest, ADamagedFileInMidRunIsAFaultWithItsName) {
  std::filesystem::resize_file(folder_.file("right4.png"), 60);
  ImageCamera camera(reel_, notes_, true);
  const std::vector<FrameSample> all = seen(camera, 0.0, 1.0, 1e-3);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[4].health, Health::fault);
  EXPECT_EQ(all[4].left, 30);
  EXPECT_FALSE(camera.linked());
  EXPECT_TRUE(eventually([&] { return !notes_.all().empty(); }));
  EXPECT_THAT(notes_.all(), AllOf(HasSubstr(folder_.file("right4.png")), HasSubstr("cut off")));
}

TEST_F(ImageCameraTest, WhatCanBeKnownBeforehandIsRefusedBeforehand) {
  reel_.start = 10;
  EXPECT_THAT(refusal(), HasSubstr("has 10 frames and start is 10"));
  reel_.start = 0;
  std::filesystem::remove(folder_.file("right4.png"));
  EXPECT_THAT(refusal(), AllOf(StartsWith(folder_.file("left4.png")), HasSubstr("has no right image")));
  reel_.path = folder_.file("none");
  EXPECT_THAT(refusal(), AllOf(StartsWith(folder_.file("none")), HasSubstr("is not there")));
  // The camera never waits for a named pipe.
  reel_.path = folder_.file("pipe");
  ASSERT_EQ(mkfifo(reel_.path.c_str(), 0600), 0);
  EXPECT_THAT(refusal(), HasSubstr("is neither a file nor a folder; expected a folder of images or a video"));
  ASSERT_EQ(mkfifo(folder_.file("left4x.png").c_str(), 0600), 0);
  put(4);
  std::filesystem::copy_file(folder_.file("left0.png"), folder_.file("right4x.png"));
  reel_.path = folder_.path().string();
  EXPECT_THAT(refusal(), AllOf(StartsWith(folder_.file("left4x.png")), HasSubstr("is no file")));
}

TEST_F(ImageCameraTest, IsGoneAtOnceWhereverItIs) {
  for (double to : {0.0, 0.1, 0.3, 2.0}) {
    ImageCamera camera(reel_, notes_, true);
    seen(camera, 0.0, to, 1e-2);
  }
}

// ---- on the wall clock: never a wait
// -------------------------------------------------------------------------

// A source slower than its rate, which waits for good after some frames.
class SlowSource final : public FrameSource {
 public:
  static constexpr std::chrono::seconds kStall{10};

  explicit SlowSource(int stalls_after) : stalls_after_(stalls_after) {}
  [[nodiscard]] int asked() const { return asked_; }
  bool next(ImagePair& into) override {
    ++asked_;
    into.left = into.right = Image(2, 2);
    constexpr std::chrono::milliseconds kNap{2};
    for (auto slept = kNap; slept < kStall && count_ == stalls_after_ && !stopped_; slept += kNap)
      std::this_thread::sleep_for(kNap);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return !stopped_ && ++count_ <= 4;
  }
  [[nodiscard]] ImageSize size() const override { return {2, 2}; }
  [[nodiscard]] std::string words() const override { return "slow"; }
  void stop() noexcept override { stopped_ = true; }

 private:
  int stalls_after_;
  std::atomic<int> count_ = 0, asked_ = 0;
  std::atomic<bool> stopped_ = false;
};

// Ahead of the wall clock the run waits for every frame, however slow the reading.
TEST(Playback, ARunThatKeepsNoWallClockWaits) {
  std::string said;  // set by the reader thread, which ends with the playback
  {
    Playback playback(
        std::make_unique<SlowSource>(-1), 1000.0, [&](const std::string& line) { said += line; }, true);
    for (int ms = 0; ms < 4; ++ms) EXPECT_TRUE(playback.take(Time(Duration(1'000'000 * ms)))) << ms;
    EXPECT_FALSE(playback.take(Time(Duration(4'000'000))));
    EXPECT_EQ(playback.state(), Playback::State::ended);
  }
  EXPECT_EQ(said, "slow: ended after 4 frames");  // and nothing about a frame that came late
}

// The test counts the wall's time, which begins after the frames before the stall. So no other frame is late,
// however busy the machine is.
TEST(Playback, OnTheWallClockNobodyWaitsForAStall) {
  std::string said;
  std::mutex mutex;
  auto source = std::make_unique<SlowSource>(3);
  const SlowSource& slow = *source;
  Playback playback(
      std::move(source), 100.0,
      [&](const std::string& line) {
        const std::lock_guard lock(mutex);
        said += line;
      },
      false);
  ASSERT_TRUE(eventually([&] { return slow.asked() == 4; }));  // waiting for the one that stalls
  const auto begin = std::chrono::steady_clock::now();
  const auto take = [&](int ms) { return playback.take(Time(Duration(1'000'000 * ms))); };
  for (int frame = 0; frame < 3; ++frame) EXPECT_TRUE(take(10 * frame)) << frame;
  for (int ms = 21; ms <= 560; ++ms) {
    EXPECT_FALSE(take(ms)) << ms;
    EXPECT_EQ(playback.state(), Playback::State::playing) << ms;
  }
  for (int ms = 561; ms <= 600; ++ms) EXPECT_FALSE(take(ms)) << ms;
  EXPECT_EQ(playback.state(), Playback::State::stalled);  // half a second, and three frames
  EXPECT_EQ(playback.exposed(), Time(Duration(20'000'000)));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, SlowSource::kStall / 2);
  const auto said_late = [&] {
    const std::lock_guard lock(mutex);
    return said.find("frame 3 came late") != std::string::npos &&
           said.find("stalled after 3 frames") != std::string::npos;
  };
  EXPECT_TRUE(eventually(said_late));
}

// A video through ffmpeg, for which a shell script stands in: the frames, and that no child process remains.

class Video : public testing::Test {
 protected:
  Video() : path_(std::getenv("PATH")) {
    reel_.path = folder_.file("film.mp4");
    std::ofstream(reel_.path) << "a film";
    setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1);
  }
  ~Video() override { setenv("PATH", path_.c_str(), 1); }
  void ffmpeg(const std::string& script) const {
    std::ofstream(folder_.file("ffmpeg")) << "#!/bin/sh\necho $$ >" << folder_.file("pid") << "\n" << script;
    std::filesystem::permissions(folder_.file("ffmpeg"), std::filesystem::perms::owner_all);
  }
  [[nodiscard]] bool child_is_there() const {
    int pid = 0;
    std::ifstream(folder_.file("pid")) >> pid;
    return pid > 0 && kill(pid, 0) == 0;  // a zombie is there, too
  }
  // Error of opening the video and reading it to the end.
  [[nodiscard]] std::string refusal() const {
    return test::refusal([&] {
      const std::unique_ptr<FrameSource> source = open_reel(reel_);
      ImagePair pair;
      while (source->next(pair)) {
      }
    });
  }
  test::TemporaryFolder folder_;
  std::string path_;
  Reel reel_;
};

const std::string kFrame = "printf 'P6\\n4 2\\n255\\n'; printf 'aaaaaabbbbbbccccccdddddd'\n";
const std::string kOther = "printf 'P6\\n4 2\\n255\\n'; printf 'AAAAAABBBBBBCCCCCCDDDDDD'\n";

TEST_F(Video, FramesAreSplitAndRead) {
  ffmpeg(kFrame + kOther);
  const std::unique_ptr<FrameSource> source = open_reel(reel_);
  EXPECT_EQ(source->size(), (ImageSize{2, 2}));
  ImagePair pair;
  ASSERT_TRUE(source->next(pair));
  EXPECT_EQ(std::string(pair.left.rgb.begin(), pair.left.rgb.end()), "aaaaaacccccc");
  EXPECT_EQ(std::string(pair.right.rgb.begin(), pair.right.rgb.end()), "bbbbbbdddddd");
  ASSERT_TRUE(source->next(pair));
  EXPECT_EQ(pair.left.rgb[0], 'A');
  EXPECT_FALSE(source->next(pair));
}

TEST_F(Video, RepeatsAndStartsLater) {
  ffmpeg(kFrame + kOther);
  reel_.repeat = true;
  reel_.start = 1;
  const std::unique_ptr<FrameSource> source = open_reel(reel_);
  std::string firsts;
  ImagePair pair;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(source->next(pair));
    firsts += static_cast<char>(pair.left.rgb[0]);
  }
  EXPECT_EQ(firsts, "AaAaA");
  reel_.start = 2;
  EXPECT_THAT(refusal(), HasSubstr("has 2 frames and start is 2"));
}

TEST_F(Video, TheChildIsGoneWithTheSource) {
  ffmpeg(kFrame + "exec sleep 1000\n");
  {
    const std::unique_ptr<FrameSource> source = open_reel(reel_);
    EXPECT_TRUE(child_is_there());
  }
  EXPECT_FALSE(child_is_there());
}

// A script that waits for another program: both must end, or the pipe would stay open.
TEST_F(Video, StopEndsAReadThatWaits) {
  ffmpeg(kFrame + "sleep 1000\n");
  const std::unique_ptr<FrameSource> source = open_reel(reel_);
  ImagePair pair;
  ASSERT_TRUE(source->next(pair));
  bool more = true;
  std::thread reader([&] { more = source->next(pair); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  source->stop();
  reader.join();
  EXPECT_FALSE(more);
}

TEST_F(Video, WhatFfmpegSaysIsInTheLine) {
  ffmpeg("echo 'film.mp4: Invalid data found' >&2\nexit 1\n");
  EXPECT_THAT(refusal(), AllOf(StartsWith(reel_.path), HasSubstr("Invalid data found")));
  ffmpeg(kFrame + "echo 'moov atom broken' >&2\nexit 1\n");
  EXPECT_THAT(refusal(), HasSubstr("ffmpeg stopped: moov atom broken"));
  ffmpeg(kFrame + "echo '[mov,mp4 @ 0x55d0c0de] moov atom broken' >&2\nexit 1\n");
  EXPECT_THAT(refusal(), HasSubstr("ffmpeg stopped: moov atom broken"));
  ffmpeg(kFrame + "printf 'P6\\n4 2\\n255\\n'; printf 'abc'\nkill -9 $$\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("cut off within a frame"), HasSubstr("signal 9")));
  ffmpeg("exit 0\n");
  EXPECT_THAT(refusal(), HasSubstr("finds no frame"));
  ffmpeg(kFrame + "printf 'P6\\n6 2\\n255\\n'; printf 'aaaaaaaaabbbbbbbbbccccccccczzzzzzzzz'\n");
  EXPECT_THAT(refusal(), HasSubstr("a frame is 6 x 2 px; expected 4 x 2"));
  ffmpeg("printf 'P6\\n5 1\\n255\\n'; printf 'aaaaaaaaabbbbbb'\n");
  EXPECT_THAT(refusal(), HasSubstr("is 5 px wide; expected two images side by side"));
  ffmpeg("printf 'P6\\n99999 99999\\n255\\n'\n");
  EXPECT_THAT(refusal(), HasSubstr("not to be had"));
  ffmpeg("printf 'this is certainly no image, is it? no, it is not'\n");
  EXPECT_THAT(refusal(), HasSubstr("is no PPM image"));
}

TEST_F(Video, WithoutFfmpegOneLineSaysWhatToDo) {
  setenv("PATH", folder_.path().c_str(), 1);
  EXPECT_THAT(refusal(), AllOf(StartsWith(reel_.path), HasSubstr("apt-get install ffmpeg"),
                               HasSubstr("folder of PNG or JPEG")));
}

}  // namespace
}  // namespace enc::images
