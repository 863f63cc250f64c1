// The live camera against fake devices behind sockets, on the wall clock and in threads, as in a laboratory.
#include "hw_drivers/v4l2/drive/live_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <unistd.h>

#include "core/base/error.h"
#include "hw_drivers/v4l2/fake/server.h"
#include "hw_drivers/v4l2/wire/relay.h"
#include "tests/support/devices.h"
#include "tests/support/refusal.h"
#include "trial/time/real_time.h"

namespace enc::v4l2 {
namespace {

using testing::AllOf, testing::HasSubstr, testing::StartsWith;
using Kind = Trouble::Kind;

constexpr int kWidth = 64, kHeight = 16;
constexpr double kLiveRate = 100.0;

// The twin's camera: each picture has its number as a grey value, and the time of its exposure is kept.
class Counter final : public StereoCamera {
 public:
  Counter(ImageSize size, double rate)
      : exposures_{rate}, left_(size.width, size.height), right_(size.width, size.height) {}
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override {
    bool due = false;
    while (exposures_.due(now)) due = true;
    if (!due) return false;
    number_ = number_ % 200 + 1;
    std::fill(left_.rgb.begin(), left_.rgb.end(), static_cast<std::uint8_t>(number_));
    std::fill(right_.rgb.begin(), right_.rgb.end(), static_cast<std::uint8_t>(number_ + 50));
    const std::lock_guard lock(mutex_);
    exposed_[static_cast<std::size_t>(number_)] = net::steady_now();
    newest = {{left_.view(), right_.view()}, now, Health::ok};
    return true;
  }
  Duration exposed(int number) {  // CLOCK_MONOTONIC
    const std::lock_guard lock(mutex_);
    return exposed_[static_cast<std::size_t>(number)];
  }

 private:
  DueTimes exposures_;
  Image left_, right_;
  int number_ = 0;
  std::mutex mutex_;
  std::array<Duration, 201> exposed_{};
};

struct Notes final : Log {
  std::mutex mutex;
  std::string text;
  void say(const std::string& line) override {
    const std::lock_guard lock(mutex);
    text += line + "\n";
  }
  std::string all() {
    const std::lock_guard lock(mutex);
    return text;
  }
};

// Serves fakes as `encounter fake` does; troubles are handed over to its thread.
class Laboratory {
 public:
  explicit Laboratory(ServerSettings settings)
      : settings_(std::move(settings)),
        counter_(settings_.each, settings_.rate),
        server_(counter_, settings_) {
    thread_ = std::thread([this] { work(); });
  }
  ~Laboratory() {
    end_ = true;
    thread_.join();
  }
  Laboratory(const Laboratory&) = delete;
  Laboratory& operator=(const Laboratory&) = delete;
  void suffer(Kind kind, double value = 1.0) {
    ask([this, kind, value] { server_.suffer({kind, value}); });
  }
  void heal(Kind kind) {
    ask([this, kind] { server_.heal(kind); });
  }
  Counter& counter() { return counter_; }

 private:
  void ask(std::function<void()> what) {
    const std::lock_guard lock(mutex_);
    asked_.push_back(std::move(what));
  }
  void work() {
    while (!end_) {
      {
        const std::lock_guard lock(mutex_);
        for (const auto& what : asked_) what();
        asked_.clear();
      }
      const Time now(net::steady_now() - begun_);
      server_.serve(now);
      server_.publish(now);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
  ServerSettings settings_;
  Counter counter_;
  Server server_;
  Duration begun_ = net::steady_now();
  std::mutex mutex_;
  std::vector<std::function<void()>> asked_;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

long resident_kilobytes() {
  std::ifstream status("/proc/self/statm");
  long pages = 0, resident = 0;
  status >> pages >> resident;
  return resident * ::sysconf(_SC_PAGESIZE) / 1024;
}

class V4l2LiveCamera : public testing::TestWithParam<const char*> {
 protected:
  static std::string name(const char* side) {
    return std::string("@encounter_test_") + std::to_string(::getpid()) + side;
  }
  static ServerSettings served(const std::string& format, bool two) {
    return {name("l"), two ? name("r") : "", settings(format, two).pixels(), {kWidth, kHeight}, kLiveRate};
  }
  static V4l2Settings settings(const std::string& format, bool two) {
    V4l2Settings of;
    of.left = name("l");
    of.right = two ? name("r") : "";
    of.format = format;
    of.silent = 0.3;
    of.timeout = 5.0;
    return of;
  }
  std::unique_ptr<LiveCamera> camera(const V4l2Settings& of) {
    offer_.rig.camera.width = kWidth;
    offer_.rig.camera.height = kHeight;
    offer_.rig.camera.rate = kLiveRate;
    return std::make_unique<LiveCamera>(
        Offer{offer_.table, offer_.rig, offer_.reach, Duration(1'000'000), notes_}, of, relayed());
  }
  // Polls each millisecond of the run until `done`, 10 s at most.
  bool poll_until(LiveCamera& of, const std::function<bool(const Measurement<StereoFrame>&)>& done) {
    const Duration until = net::steady_now() + from_seconds(10.0);
    while (net::steady_now() < until) {
      Measurement<StereoFrame> newest;
      if (of.poll(Time(net::steady_now() - begun_), newest) && done(newest)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  test::DefaultOffer offer_;
  Notes notes_;
  Duration begun_ = net::steady_now();
};

TEST_P(V4l2LiveCamera, PicturesComeWithTheTimeOfTheirExposure) {
  const std::string format = GetParam();
  for (const bool two : {false, true}) {
    Laboratory laboratory(served(format, two));
    const auto live = camera(settings(format, two));
    EXPECT_TRUE(live->is_fake());
    EXPECT_THAT(live->describe(), AllOf(StartsWith(two ? "paired camera @" : "side-by-side camera @"),
                                        HasSubstr("Encounter fake"), HasSubstr(format),
                                        HasSubstr("stamped at the beginning of the exposure")));
    std::vector<double> errors;  // s
    Time last{};
    ASSERT_TRUE(poll_until(*live, [&](const Measurement<StereoFrame>& frame) {
      EXPECT_EQ(frame.health, Health::ok);
      EXPECT_GT(frame.t, last);
      last = frame.t;
      EXPECT_EQ(frame.value.left.width, kWidth);
      const int number = *frame.value.left.at(kWidth / 2, kHeight / 2);
      EXPECT_NEAR(*frame.value.right.at(kWidth / 2, kHeight / 2), number + 50, 3);
      double nearest = 1.0;  // a grey value may be wrong by one
      for (int i = std::max(1, number - 1); i <= std::min(200, number + 1); ++i)
        nearest = std::min(nearest, std::abs(seconds(frame.t.time_since_epoch() -
                                                     (laboratory.counter().exposed(i) - begun_))));
      errors.push_back(nearest);
      return errors.size() >= 60;
    }));
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() * 9 / 10], 1e-3);  // a busy machine may delay one
    EXPECT_TRUE(live->linked());
    EXPECT_THAT(live->remarks().front(), HasSubstr(" damaged, "));
  }
}
INSTANTIATE_TEST_SUITE_P(Of, V4l2LiveCamera, testing::Values("YUYV", "MJPG", "GREY", "RGB3"));

using V4l2Trouble = V4l2LiveCamera;

// The images of a head on the wall clock: none is damaged, and the memory stays. In the full form,
// ENCOUNTER_CAMERA_SECONDS=600, no frame is lost and the caller of poll() misses at most one pair; it has the
// fixed priority of a run, and so do the fakes. A busy machine may delay the short form.
TEST_F(V4l2Trouble, NoneForAHeadAtTwentyHertz) {
  const char* text = std::getenv("ENCOUNTER_CAMERA_SECONDS");
  const double length = text != nullptr ? std::strtod(text, nullptr) : 2.0;
  const trial::RealTime priority(text != nullptr);
  ServerSettings head = served("YUYV", true);
  head.each = {640, 480};
  head.rate = 20.0;
  Laboratory laboratory(head);
  offer_.rig.camera.width = head.each.width;
  offer_.rig.camera.height = head.each.height;
  offer_.rig.camera.rate = head.rate;
  LiveCamera live(Offer{offer_.table, offer_.rig, offer_.reach, Duration(1'000'000), notes_},
                  settings("YUYV", true), relayed());
  const auto poll_for = [&](double s) {
    std::int64_t frames = 0;
    for (const Duration until = net::steady_now() + from_seconds(s); net::steady_now() < until;) {
      Measurement<StereoFrame> newest;
      frames += live.poll(Time(net::steady_now() - begun_), newest) && newest.health == Health::ok ? 1 : 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return frames;
  };
  poll_for(1.0);
  [[maybe_unused]] const long memory = resident_kilobytes();
  const std::int64_t pairs = poll_for(length);
  if (text != nullptr) {
    EXPECT_GE(pairs, std::llround(length * head.rate) - 1);
  }
  EXPECT_GT(pairs, 0);
#ifndef __SANITIZE_ADDRESS__  // ASan keeps freed memory
  EXPECT_LE(resident_kilobytes(), memory + 1024);
#endif
  EXPECT_THAT(live.remarks().front(),
              HasSubstr(text != nullptr ? " 0 frames lost, 0 damaged" : ", 0 damaged"));
  EXPECT_EQ(notes_.all(), "");
}

TEST_F(V4l2Trouble, UnpluggedAndPluggedInAgain) {
  Laboratory laboratory(served("GREY", true));
  const auto live = camera(settings("GREY", true));
  const auto good = [](const Measurement<StereoFrame>& frame) { return frame.health == Health::ok; };
  ASSERT_TRUE(poll_until(*live, good));
  laboratory.suffer(Kind::disconnect);
  ASSERT_TRUE(poll_until(*live, [](const auto& frame) { return frame.health == Health::fault; }));
  EXPECT_FALSE(live->linked());
  laboratory.heal(Kind::disconnect);
  Time again{};
  ASSERT_TRUE(poll_until(*live, [&](const Measurement<StereoFrame>& frame) {
    again = frame.t;
    return good(frame);
  }));
  EXPECT_LT(age(Time(net::steady_now() - begun_), again), 0.5);  // a fresh stamp
  EXPECT_TRUE(live->linked());
  EXPECT_THAT(notes_.all(), AllOf(HasSubstr("unplugged after"), HasSubstr("sends frames again")));
  EXPECT_THAT(live->remarks().front(), HasSubstr("it was unplugged 1 time"));
}

TEST_F(V4l2Trouble, ASilentCameraIsStale) {
  Laboratory laboratory(served("GREY", false));
  const auto live = camera(settings("GREY", false));
  ASSERT_TRUE(poll_until(*live, [](const auto& frame) { return frame.health == Health::ok; }));
  laboratory.suffer(Kind::stall);
  ASSERT_TRUE(poll_until(*live, [](const auto& frame) { return frame.health == Health::stale; }));
  EXPECT_FALSE(live->linked());
  laboratory.heal(Kind::stall);
  ASSERT_TRUE(poll_until(*live, [](const auto& frame) { return frame.health == Health::ok; }));
  EXPECT_THAT(notes_.all(), HasSubstr("silent for 300 ms"));
}

TEST_F(V4l2Trouble, DamagedAndLostFramesAreCounted) {
  Laboratory laboratory(served("MJPG", false));
  const auto live = camera(settings("MJPG", false));
  laboratory.suffer(Kind::half_message, 0.3);
  laboratory.suffer(Kind::garbage, 0.2);
  laboratory.suffer(Kind::loss, 0.2);
  int count = 0;
  ASSERT_TRUE(poll_until(*live, [&](const Measurement<StereoFrame>& frame) {
    EXPECT_EQ(frame.health, Health::ok);
    return ++count == 30;
  }));
  EXPECT_THAT(live->remarks().front(),
              testing::ContainsRegex(", [1-9][0-9]* frames lost, [1-9][0-9]* damaged"));
}

TEST_F(V4l2Trouble, ACameraThatSendsNothingIsRefused) {
  Laboratory laboratory(served("GREY", false));
  laboratory.suffer(Kind::slow_start, 1e6);
  V4l2Settings impatient = settings("GREY", false);
  impatient.timeout = 0.2;
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { camera(impatient); }),
              AllOf(StartsWith("@encounter_test_"), HasSubstr("sent no frame within 200 ms")));
}

TEST_F(V4l2Trouble, WithoutAFakeTheRemedyIsToStartIt) {
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { camera(settings("GREY", true)); }),
              AllOf(HasSubstr("no fake camera listens there"), HasSubstr("encounter fake RIG")));
  const Laboratory laboratory(served("GREY", false));
  Counter other({kWidth, kHeight}, kLiveRate);
  EXPECT_THAT(test::refusal(ErrorKind::device, [&] { Server(other, served("GREY", false)); }),
              AllOf(HasSubstr("cannot listen there"), HasSubstr("end the other fake")));
}

}  // namespace
}  // namespace enc::v4l2
