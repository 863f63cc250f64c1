// The twin's stereo camera where a world keeps wall-clock time, and for fakes. A thread of its own draws each
// picture, which takes many periods. On the wall clock the world goes on meanwhile; in lockstep it waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "core/base/image.h"
#include "core/devices/device.h"
#include "sim/camera/stage.h"

namespace enc::trial {

class DrawnCamera final : public StereoCamera {
 public:
  enum class Exposure : std::uint8_t {
    // poll() exposes what is due, and returns the picture at a later call.
    polled,
    // poll() exposes what is due, and returns the picture at once, as the twin's camera does.
    awaited,
    // Only expose() exposes, so that the world and poll() may have different threads.
    called,
  };

  // Throws Error as Stage does. `module` and whatever `show` reads outlive the camera.
  DrawnCamera(const sim::CameraModule& module, const sim::TwinCameraSpec& spec, sim::Show show,
              Exposure exposure);
  ~DrawnCamera() override;
  DrawnCamera(const DrawnCamera&) = delete;
  DrawnCamera& operator=(const DrawnCamera&) = delete;

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] ImageSize size() const override { return spec_.stage.camera.size(); }
  // Takes what `show` shows if an exposure is due. Leaves out an exposure that comes before the last picture
  // was drawn and fetched. Time may begin again.
  void expose(Time now) noexcept;
  // A picture has the stamp of its exposure. During a stall it reports faults as the twin's camera does.
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;

 private:
  enum class Phase : std::uint8_t { idle, drawing, drawn, fetched, failed, ended };
  void work(const sim::CameraModule& module) noexcept;
  void change(Phase phase) noexcept;
  [[nodiscard]] bool due(Time now) noexcept;
  bool fetch(Time now, Measurement<StereoFrame>& newest) noexcept;
  [[nodiscard]] bool silent(Time now) const noexcept;

  sim::TwinCameraSpec spec_;
  sim::Show show_;
  Exposure exposure_;
  std::string renderer_;
  // Data of the thread that exposes.
  DueTimes exposures_;
  Time last_{};
  // Data of the thread that polls.
  std::atomic<bool> linked_ = true;

  // Data of the thread that exposes while idle, of the drawing thread while it draws, then of the one that
  // polls.
  sim::CameraScene scene_;
  Image left_, right_;
  Time exposed_{};
  std::uint64_t frame_ = 0;

  std::atomic<Phase> phase_ = Phase::drawing;  // the thread begins with its stage
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace enc::trial
