#include "tests/benchmarks/devices/camera_line.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include "tests/support/devices.h"

namespace enc::bench::devices {
namespace {

constexpr Duration kStart{1'000'000'000};  // CLOCK_MONOTONIC at the loop's time 0
constexpr int kDescriptor = 1;

v4l2::NodeSpec side_by_side(int width, int height, double rate) {
  v4l2::NodeSpec spec;
  spec.modes = {{v4l2::Pixels::grey, width, height, rate}};
  return spec;
}

}  // namespace

// The kernel's calls of the camera's thread.
class CameraLine::Kernel final : public v4l2::System {
 public:
  explicit Kernel(CameraLine& of) : of_(of) {}
  int open(const std::string&) noexcept override {
    const std::lock_guard lock(of_.mutex_);
    of_.idle_ = !of_.plugged_;  // then the thread sleeps before it tries again
    of_.changed_.notify_all();
    return of_.plugged_ ? kDescriptor : -ENOENT;
  }
  void close(int descriptor) noexcept override {
    const std::lock_guard lock(of_.mutex_);
    of_.node_.leave(descriptor);
  }
  int control(int descriptor, unsigned long request, void* data) noexcept override {
    const std::lock_guard lock(of_.mutex_);
    if (!of_.plugged_) return -ENODEV;
    return of_.node_.control(descriptor, static_cast<std::uint32_t>(request),
                             {static_cast<std::byte*>(data), _IOC_SIZE(request)});
  }
  void* map(int, std::size_t size, std::int64_t offset) noexcept override {
    const std::lock_guard lock(of_.mutex_);
    void* at = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, of_.node_.memory(), offset);
    return at == MAP_FAILED ? nullptr : at;
  }
  void unmap(void* memory, std::size_t size) noexcept override { ::munmap(memory, size); }
  void wait(std::span<const int>, Duration most) noexcept override {
    std::unique_lock lock(of_.mutex_);
    const Duration deadline = of_.now_ + most;
    while (!of_.end_ && of_.plugged_ && !full() && of_.now_ < deadline) {
      of_.deadline_ = deadline;
      of_.idle_ = true;
      of_.changed_.notify_all();
      of_.changed_.wait(lock);
    }
    of_.idle_ = false;
  }
  Duration now() noexcept override {
    const std::lock_guard lock(of_.mutex_);
    return of_.now_;
  }

 private:
  [[nodiscard]] bool full() const {
    pollfd ready{of_.node_.event(), POLLIN, 0};
    return ::poll(&ready, 1, 0) > 0;
  }
  CameraLine& of_;
};

class CameraLine::Eye final : public PoseTracker {
 public:
  explicit Eye(CameraLine& of) : of_(of) {}
  ~Eye() override {
    {
      const std::lock_guard lock(of_.mutex_);
      of_.end_ = true;
    }
    of_.changed_.notify_all();
    of_.camera_.reset();
  }
  Eye(const Eye&) = delete;
  Eye& operator=(const Eye&) = delete;
  [[nodiscard]] bool linked() const noexcept override { return of_.camera_->linked(); }
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override {
    Measurement<StereoFrame> frame;
    if (!of_.camera_->poll(now, frame) || frame.health != Health::ok) return false;
    const auto place = static_cast<std::size_t>(*frame.value.left.at(0, 0)) % of_.shown_.size();
    const Measurement<TrackedTool>& pose = of_.shown_[place].pose;
    of_.worst_stamp_ = std::max(of_.worst_stamp_, std::abs(seconds(frame.t - pose.t)));
    newest = pose;
    newest.t = frame.t;
    return true;
  }

 private:
  CameraLine& of_;
};

class CameraLine::LineClock final : public Clock {
 public:
  LineClock(CameraLine& of, std::unique_ptr<Clock> clock) : of_(of), clock_(std::move(clock)) {}
  Tick next() override {
    const Tick tick = clock_->next();
    of_.pass(tick.t);
    return tick;
  }

 private:
  CameraLine& of_;
  std::unique_ptr<Clock> clock_;
};

CameraLine::CameraLine() : node_(side_by_side(2 * kWidth, kHeight, kRate)) {}

CameraLine::~CameraLine() = default;

std::string CameraLine::said() const { return fmt::format("{}", fmt::join(log_.lines(), "; ")); }

void CameraLine::fit_out(Rig& rig) {
  twin_ = std::move(rig.tracker);
  test::DefaultOffer offer;
  offer.rig.camera.width = kWidth;
  offer.rig.camera.height = kHeight;
  offer.rig.camera.rate = kRate;
  v4l2::V4l2Settings settings;
  settings.format = "GREY";
  // The first pair comes while the camera is made, from before the run.
  std::atomic<bool> made = false;
  std::thread first([&] {
    while (!made) {
      {
        const std::lock_guard lock(mutex_);
        if (node_.streams() && exposed_ == 0) expose({});
        changed_.notify_all();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  camera_ = std::make_unique<v4l2::LiveCamera>(
      Offer{offer.table, offer.rig, offer.reach, Duration(1'000'000), log_}, settings,
      std::make_unique<Kernel>(*this));
  made = true;
  first.join();
  rig.tracker = std::make_unique<Eye>(*this);
  rig.clock = std::make_unique<LineClock>(*this, std::move(rig.clock));
}

// Call with the lock. The picture of a pose, in the buffers of the node.
void CameraLine::expose(const Measurement<TrackedTool>& pose) {
  const std::int64_t number = ++exposed_;
  shown_[static_cast<std::size_t>(number) % shown_.size()] = {pose, number};
  if (fault_ == Fault::silent || (fault_ == Fault::lossy && number % 5 == 0)) return;
  std::vector<std::uint8_t> bytes(
      std::size_t{2} * kWidth * kHeight,
      static_cast<std::uint8_t>(static_cast<std::size_t>(number) % shown_.size()));
  if (fault_ == Fault::half) bytes.resize(bytes.size() / 2);
  node_.put(static_cast<std::uint32_t>(number), kStart + pose.t.time_since_epoch(), bytes,
            fault_ == Fault::damaged);
}

void CameraLine::suffer(Fault fault) {
  const std::lock_guard lock(mutex_);
  fault_ = fault;
  plugged_ = fault != Fault::unplugged;
  idle_ = false;  // its thread has to see that
  node_.fail(fault == Fault::error ? EIO : 0);
  changed_.notify_all();
}

void CameraLine::pass(Time now) {
  Measurement<TrackedTool> pose;
  const bool news = twin_->poll(now, pose);
  {
    const std::lock_guard lock(mutex_);
    now_ = kStart + now.time_since_epoch();
    if (news && plugged_ && node_.streams()) expose(pose);
    changed_.notify_all();
  }
  settle();
}

// Waits until the thread has done all that is due: then it waits for something later.
void CameraLine::settle() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::seconds(20), [this] {
    pollfd ready{node_.event(), POLLIN, 0};
    const bool full = plugged_ && node_.streams() && ::poll(&ready, 1, 0) > 0;
    return idle_ && !full && (!plugged_ || now_ < deadline_);
  });
}

}  // namespace enc::bench::devices
