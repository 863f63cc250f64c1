// The twin's stereo camera for fakes. A thread of its own draws each picture, which takes many periods. On
// the wall clock the world goes on meanwhile; in lockstep it waits.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/base/image.h"
#include "core/devices/device.h"
#include "sim/camera/stage.h"

namespace enc::trial {

class DrawnCamera final : public StereoCamera {
 public:
  // Throws Error as Stage does. `module` and whatever `show` reads outlive the camera. `waits`: poll()
  // returns a due picture at once, as the twin's camera does.
  DrawnCamera(const sim::CameraModule& module, const sim::StageSpec& stage, sim::Show show, bool waits);
  ~DrawnCamera() override;
  DrawnCamera(const DrawnCamera&) = delete;
  DrawnCamera& operator=(const DrawnCamera&) = delete;

  [[nodiscard]] ImageSize size() const override { return size_; }
  // At a due exposure it takes what `show` shows. Unless it waits it returns that picture at a later call,
  // with the stamp of the exposure, and leaves out an exposure that comes while the thread draws. Time may
  // begin again.
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;

 private:
  enum class Phase : std::uint8_t { idle, drawing, drawn };
  void work(const sim::CameraModule& module, const sim::StageSpec& stage) noexcept;
  [[nodiscard]] bool due(Time now) noexcept;
  void expose(Time now) noexcept;

  ImageSize size_;
  sim::Show show_;
  bool waits_;
  DueTimes exposures_;
  Time last_{};

  // The thread's while it draws, else the caller's.
  sim::CameraScene scene_;
  Image left_, right_;
  Time exposed_{};
  std::uint64_t frame_ = 0;

  std::mutex changes_;
  std::condition_variable change_;
  std::atomic<Phase> phase_ = Phase::drawing;  // the thread begins with its stage
  bool stop_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace enc::trial
