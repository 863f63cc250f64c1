// Video devices in virtual time behind the kernel calls of the driver: each camera has its own clock, delays,
// lost frames and times without a plug. Pixels hold the number of the frame.
#pragma once

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <sys/ioctl.h>
#include <sys/mman.h>

#include "hw_drivers/v4l2/fake/node.h"
#include "hw_drivers/v4l2/wire/system.h"

namespace enc::v4l2 {

struct VirtualCamera {
  NodeSpec spec;
  double ppm = 0.0;          // drift of its clock: below 0 it is fast
  double phase = 0.0;        // s, first exposure
  double delay = 0.030;      // s, from exposure to full buffer
  double jitter = 0.0;       // s, longest further delay
  double stamp_error = 0.0;  // s, largest
  bool sets_stamps = true;   // false: each stamp is 0
  std::set<std::int64_t> lost;
  std::set<std::int64_t> damaged;
  double unplugged_from = std::numeric_limits<double>::infinity(), unplugged_to = 0.0;  // s

  // Ground truth.
  [[nodiscard]] double exposed(std::int64_t n) const {
    return phase + static_cast<double>(n) * (1.0 + 1e-6 * ppm) / spec.modes.front().rate;
  }
};

class VirtualVideo final : public System {
 public:
  VirtualCamera& add(const std::string& path, VirtualCamera camera) {
    cameras_.push_back(std::make_unique<CameraRun>(path, std::move(camera)));
    return cameras_.back()->camera;
  }
  void refuse(const std::string& path, int error) { refused_[path] = error; }
  void sleep(double s) { run_to(now_ + from_seconds(s), false); }
  // The number in the pixels of a grey frame.
  static std::int64_t number_in(const Image& image) {
    std::int64_t number = 0;
    for (int i = 0; i < 4; ++i) number = number * 256 + *image.view().at(i, 0);
    return number;
  }

  int open(const std::string& path) noexcept override {
    if (const auto error = refused_.find(path); error != refused_.end()) return -error->second;
    for (std::size_t i = 0; i < cameras_.size(); ++i)
      if (cameras_[i]->path == path)
        return plugged(*cameras_[i]) ? static_cast<int>(i) + 100 * ++opened_ : -ENOENT;
    return -ENOENT;
  }
  void close(int descriptor) noexcept override { of(descriptor).node.leave(descriptor); }
  int control(int descriptor, unsigned long request, void* data) noexcept override {
    CameraRun& camera = of(descriptor);
    if (!plugged(camera)) return -ENODEV;
    return camera.node.control(descriptor, static_cast<std::uint32_t>(request),
                               {static_cast<std::byte*>(data), _IOC_SIZE(request)});
  }
  void* map(int descriptor, std::size_t size, std::int64_t offset) noexcept override {
    void* at =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, of(descriptor).node.memory(), offset);
    return at == MAP_FAILED ? nullptr : at;
  }
  void unmap(void* memory, std::size_t size) noexcept override { ::munmap(memory, size); }
  void wait(std::span<const int> descriptors, Duration most) noexcept override;
  Duration now() noexcept override { return now_; }

 private:
  struct CameraRun {
    CameraRun(std::string name, VirtualCamera of)
        : path(std::move(name)), camera(std::move(of)), node(camera.spec) {}
    std::string path;
    VirtualCamera camera;
    Node node;
    std::int64_t next = 0;
    double after = 0.0;  // s: earliest time of the next frame, as frames stay in order
    std::mt19937_64 random{7};
  };
  CameraRun& of(int descriptor) { return *cameras_[static_cast<std::size_t>(descriptor % 100)]; }
  [[nodiscard]] bool plugged(const CameraRun& camera) const {
    const double now = seconds(now_);
    return now < camera.camera.unplugged_from || now >= camera.camera.unplugged_to;
  }
  double uniform(CameraRun& camera) { return std::generate_canonical<double, 53>(camera.random); }
  // Delivers frames up to `until`, or up to the first one.
  void run_to(Duration until, bool first);
  bool deliver(CameraRun& of);

  std::vector<std::unique_ptr<CameraRun>> cameras_;
  std::map<std::string, int> refused_;
  Duration now_{1'000'000'000};  // CLOCK_MONOTONIC is above 0
  int opened_ = 0;
};

}  // namespace enc::v4l2
