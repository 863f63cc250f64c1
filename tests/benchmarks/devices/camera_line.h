// A live camera with its thread in virtual time: the kernel's calls reach a fake node, their clock stands
// from tick to tick, and each tick waits until the thread waits again.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "core/devices/rig.h"
#include "hw_drivers/v4l2/drive/live_camera.h"
#include "hw_drivers/v4l2/fake/node.h"
#include "trial/devices/device_log.h"

namespace enc::bench::devices {

class CameraLine {
 public:
  CameraLine();
  ~CameraLine();
  CameraLine(const CameraLine&) = delete;
  CameraLine& operator=(const CameraLine&) = delete;

  // A tracker that sees through the camera, in place of the rig's: the picture of each exposure has the
  // number of the pose that the earlier tracker found then. It stands for vision.
  void fit_out(Rig& rig);

  enum class Fault : std::uint8_t { none, unplugged, silent, damaged, half, error, lossy };
  void suffer(Fault fault);
  [[nodiscard]] double worst_stamp() const { return worst_stamp_; }  // s, against the exposure
  [[nodiscard]] std::string said() const;

 private:
  class Kernel;
  class Eye;
  class LineClock;
  struct NumberedPose {
    Measurement<TrackedTool> pose;
    std::int64_t number = 0;
  };
  void pass(Time now);
  void expose(const Measurement<TrackedTool>& pose);
  void settle();

  static constexpr int kWidth = 16, kHeight = 4;  // px, of each side
  static constexpr double kRate = 20.0;           // Hz

  // Shared with the camera's thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  v4l2::Node node_;
  Duration now_{1'000'000'000}, deadline_{};  // CLOCK_MONOTONIC
  bool idle_ = false, plugged_ = true, end_ = false;

  // Used by the loop.
  trial::DeviceLog log_;
  std::unique_ptr<PoseTracker> twin_;
  std::unique_ptr<v4l2::LiveCamera> camera_;
  std::array<NumberedPose, 16> shown_{};
  std::int64_t exposed_ = 0;
  Fault fault_ = Fault::none;
  double worst_stamp_ = 0.0;
};

}  // namespace enc::bench::devices
